:- module(typhon_demo_page, []).

/** <module> A network that runs, for observation in a browser

    swipl app/demo_page.pl [--port=8080] [--seed=1]

Sixty hosts in four processes, whose links change.  Two mechanisms run there:
agents execute sequences of tasks in step, while hosts lose tasks
now and then; and antigens attack hosts, which release antibodies.  A supervisor
restarts an inspector that fails every half minute.  Prints the
link to the page, and runs until Ctrl-C.

*Threading*: the main thread starts the network; another thread causes attacks
and failures until it is stopped.
*/

:- use_module('typhon/arguments', [arguments/3]).
:- use_module('../prolog/typhon/kernel/base/monotonic', [wait_within/2]).
:- use_module('../prolog/typhon',
              [ agent_create/3, agent_property/2, network_property/2,
                network_start/3,
                network_stop/1 ]).
:- use_module('../prolog/typhon/tools/page', [page_serve/2, page_stop/0]).
:- use_module('../agents/sieve/operator', [antigen_attack/2, sieve_start/3]).
:- use_module('../agents/sync/operator', [sequence_start/5, tasks_fail/4]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [make_directory_path/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/3]).
:- use_module(library(socket),
              [ gethostname/1, tcp_bind/2, tcp_close_socket/1, tcp_setopt/2,
                tcp_socket/1 ]).
:- use_module('../prolog/typhon/kernel/base/process_setup', [on_stop_signals/1]).
:- use_module(library(uri), [uri_components/2, uri_data/3]).
:- use_module(library(random),
              [random/1, random_between/3, random_member/2]).

:- initialization(main, main).

:- public main/1.

opt_type(port, port, nonneg).
opt_type(seed, seed, integer).
opt_help(port, 'of the page (default 8080; 0: any that is free)').
opt_help(seed, 'of the network (default 1)').

main(Argv) :-
    arguments(Argv, [], Options),
    option(port(Port), Options, 8080),
    option(seed(Seed), Options, 1),
    must_be_free(Port),
    on_stop_signals(stop),
    thread_create(demo(Port, Seed), Demo),
    thread_get_message(stop),
    catch(thread_send_message(Demo, stop), error(existence_error(_, _), _),
          true),                        % it has ended by itself
    thread_join(Demo, Status),
    (   Status == true
    ->  halt(0)
    ;   Status = exception(Ball)
    ->  print_message(error, Ball),
        halt(1)
    ;   halt(1)
    ).

%   Before anything is started.

must_be_free(Port) :-
    tcp_socket(Socket),
    catch(call_cleanup(( tcp_setopt(Socket, reuseaddr),
                         tcp_bind(Socket, localhost:Port) ),
                       tcp_close_socket(Socket)),
          error(_, _), port_in_use(Port)).

port_in_use(Port) :-
    format(user_error, 'Port ~w cannot be used, another program may listen \c
                        there: choose one by make demo-page PORT=8081, or \c
                        PORT=0 for any~n', [Port]),
    halt(1).

%   In a thread of its own: while the main thread creates threads, a signal may
%   reach a new thread, and would be lost.

:- public stop/1.

stop(_Signal) :-
    thread_send_message(main, stop).

demo(Port, Seed) :-
    call_cleanup(network(Port, Seed), thread_send_message(main, stop)).

network(Port, Seed) :-
    set_random(seed(Seed)),
    log_file(Log),
    network_start(grid(6, 10), Network,
                  [ processes(4), seed(Seed), log(Log, [hops, messages]),
                    hop_time(uniform(0.3, 1.2)),
                    dynamic(toggle(uniform(4, 12), 0.2, 0.5)) ]),
    at_work(Port, Network, Result),
    page_stop,
    network_stop(Network),
    ( Result == true -> true ; throw(Result) ).

%   The log can be replayed, see app/typhon.pl page --export.

log_file(Log) :-
    make_directory_path('out/demo-page'),
    absolute_file_name('out/demo-page/log.pl', Log).

at_work(Port, Network, Result) :-
    catch(( begin(Port, Network, Hosts),
            run_demo(1, [], Hosts),
            Result = true ),
          error(Formal, Context), Result = error(Formal, Context)).

begin(Port, Network, Hosts) :-
    network_property(Network, hosts(Hosts)),
    page_serve([port(Port)], Link),
    print_link(Link),
    flush_output,
    sieve_start(Hosts, payloads(sieve/bits),
                [settings([expiry-20, omega-20])]),   % the population is level
    supervised(Hosts).

%   An inspector fails after some steps, and its supervisor restarts it.

supervised([Host|_]) :-
    inspector(Program),
    agent_create(agents(supervisor), _,
                 [ host(Host),
                   facts([child(inspector, Program, [])]) ]).

inspector(clauses(
    [ (:- agent(inspector, [])),
      (main :- inspect(6)),
      (inspect(N) :- N > 0, sleep(5), N1 is N-1, inspect(N1))
    ])).

%   The link is the first line, for programs.

print_link(Link) :-
    gethostname(Machine),
    uri_components(Link, Components),
    uri_data(authority, Components, Authority),
    atomic_list_concat([_, Port], :, Authority),
    format('~w~n~n\c
            Open this link in a browser on this machine. From another one \c
            call~n~n    ssh -L ~w:localhost:~w ~w~n~n\c
            there, and open the same link there. Ctrl-C ends the demo.~n',
           [Link, Port, Port, Machine]).

%   Every second an antigen attacks a host; now and then hosts lose tasks.  When
%   all tasks are completed, the next sequence begins.

run_demo(N0, Agents0, Hosts) :-
    thread_self(Me),
    (   wait_within(1, thread_get_message(Me, stop))
    ->  true
    ;   attack(Hosts),
        next(N0, Agents0, Hosts, N, Agents),
        set_back(N, Hosts),
        run_demo(N, Agents, Hosts)
    ).

attack(Hosts) :-
    random_member(Host, Hosts),
    length(Bits, 5),
    maplist(random_between(0, 1), Bits),
    antigen_attack([Host], Bits).

next(N, Agents, _, N, Agents) :-
    member(Agent, Agents),
    agent_property(Agent, state(_)),
    !.
next(N0, _, Hosts, N, Agents) :-
    N is N0+1,
    sequence(N, Sequence),
    maplist(task, [drill, sand, paint, dry], Tasks),
    sequence_start(Sequence, Hosts, Tasks, [agents(12), seed(N)], Agents).

sequence(N, Sequence) :-
    atom_concat(assembly, N, Sequence).

task(Name, Name-sleep(2)).

set_back(N, Hosts) :-
    random(Chance),
    (   Chance < 0.1
    ->  findall(Host, ( member(Host, Hosts), random(C), C < 0.5 ), Some),
        sequence(N, Sequence),
        tasks_fail(Sequence, sand, Some, _)
    ;   true
    ).
