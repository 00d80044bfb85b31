:- module(test_top_level, []).
:- use_module(library(plunit)).
:- use_module('../../../app/packaging/parts', [installed/1]).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/2]).
:- use_module('../../lib/top_level').
:- use_module('../../lib/transcript', [typed_in_terminal/3]).
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(process)).
:- use_module(library(prolog_wrap), [current_predicate_wrapper/4]).
:- use_module(library(readutil)).
:- use_module(library(typhon)).

/** <module> Errors at the top level

*/

put(Dir, Name, Text) :-
    directory_file_path(Dir, Name, File),
    write_file(File, Text).

:- begin_tests(errors_at_the_top_level).

%   Each of these raises an error.

mistake('network_start(ring(6), N, [procesess(2)]).').
mistake('network_start(rnig(6), N, []).').
mistake('network_start(ring(six), N, []).').
mistake('network_stop(network77).').
mistake('host_start(X).').
mistake('link(alpha, nowhere).').
mistake('agent_create(no_such_file, A).').
mistake('agent_create(hi, A, [host(alhpa)]).').
mistake('agent_dispose(tim).').
mistake('watch([nowhere], foo, W).').
mistake('remote(alpha, X is a+1).').
mistake('remote(alpha, no_such_thing(X)).').
mistake('remote(alpha, throw(error(oops, _))).').
mistake('network_start(ring(2), N, [log(\'/no/such/directory/log\')]).').
mistake('network_start(ring(2), N, [hosts([consult(no_such_file)])]).').
mistake('network_start(ring(2), N, [hosts([capacty(2)])]).').
mistake('host_start(beta, [consult(no_such_file)]).').
mistake('agent_create(broken, A).').
mistake('agent_create(including, A).').
mistake('agent_create(hi, A, [payloads([broken])]).').
mistake('agent_load(broken, A).').
mistake('agent_save(bob, \'/no/such/directory/bob\').').
mistake('payload_attach(bob, broken).').
mistake('payload_detach(bob, broken).').
mistake('agent_send(tim, hello).').
mistake('agent_property(bob, sate(S)).').
mistake('agent_move(bob, gamma).').
mistake('agent_join(tim, O, 1).').
mistake('host_stop(beta).').
mistake('log_events(no_such_file, Es).').
mistake('log_server_start([file(\'/no/such/directory/log\')], A).').

file('broken.pl', ":- agent(broken, []).\nmain :- foo(.\n").
file('including.pl', ":- agent(including).\n:- include(no_such_file).\nmain.\n").
file('hi.pl', ":- agent(hi, []).\non_message(_, _).\n").

%   In a terminal each error prints one line, without a backtrace, and the next
%   query is read as a query.

test(error_prints_one_line,
     [ condition(( missing([python3], []), top_level_continues )),
       Others == [] ]) :-
    with_tmp_dir(Dir,
        ( forall(file(Name, Text), put(Dir, Name, Text)),
          findall(Mistake, mistake(Mistake), Mistakes),
          typed_in_terminal(
              ['host_start(alpha), agent_create(hi, _, [name(bob)]).'|Mistakes],
              Dir, [_|Outputs]),
          findall(Mistake-Output,
                  ( nth1(N, Mistakes, Mistake), nth1(N, Outputs, Output),
                    \+ one_error(Output) ),
                  Others) )).

one_error([Line]) :-
    sub_string(Line, 0, _, _, "ERROR: ").

test(debugging_errors_prints_a_backtrace,
     [ condition(missing([python3], [])), nondet ]) :-
    with_tmp_dir(Dir,
        ( typed_in_terminal([ 'host_start(alpha).', 'debug(typhon(errors)).',
                              'agent_create(no_such_file, A).' ],
                            Dir, [_|Outputs]) )),
    Outputs = [_, [Line|Lines]],
    assertion(sub_string(Line, 0, _, _, "ERROR: ")),
    assertion(memberchk("ERROR: In:", Lines)),
    assertion(( member(Frame, Lines),
                sub_string(Frame, _, _, _, "create_by(") )).
test(errors_of_other_predicates_keep_their_backtrace,
     condition(missing([python3], []))) :-
    with_tmp_dir(Dir, typed_in_terminal(['atom_length(_, _).'], Dir, [Lines])),
    assertion(memberchk("ERROR: In:", Lines)).

%   Goals that are arguments of public predicates run in the module of the
%   caller.

test(goals_run_in_the_module_of_the_caller,
     [ setup(host_start(callee)), cleanup(host_stop(callee)) ]) :-
    @(watch(callee, assertz, Watch), top_level_caller),
    remote(callee, leave(letter)),
    unwatch(Watch),
    assertion(top_level_caller:event(_, _, _, leave(letter))).

%   Libraries that users load.

public_library(typhon, core).
public_library(typhon/fipa, fipa).
public_library(typhon/gpio, bridges).
public_library(typhon/mqtt, bridges).
public_library(typhon/nxt, nxt).
public_library(typhon/python, bridges).
public_library(typhon/ros, bridges).
public_library(tartarus, tartarus).

test(all_public_predicates_raise_errors_of_their_callers, Missing == []) :-
    findall(Library:PI,
            ( public_library(Library, Part),
              ( Part == core -> true ; installed(Part) ),
              bare(Library, PI) ),
            Missing).

bare(Library, PI) :-
    absolute_file_name(library(Library), File,
                       [file_type(prolog), access(read)]),
    load_files(test_top_level_public:File, [if(not_loaded), imports([])]),
    module_property(Module, file(File)),
    module_property(Module, exports(PIs)),
    member(PI, PIs),
    PI = Name/Arity,
    functor(Head, Name, Arity),
    (   predicate_property(Module:Head, imported_from(Home))
    ->  true
    ;   Home = Module
    ),
    \+ current_predicate_wrapper(Home:Head, typhon_user_errors, _, _).

%   Prolog would offer the predicate of a module instead.

test(vocabulary_is_not_corrected, true(N-Written == 3-[])) :-
    with_tmp_dir(Dir,
        ( typed([ 'move(beta).', 'forall(true, move(beta)).',
                  'atom(a), move(beta).' ], Dir, Lines) )),
    findall(x, ( member(L, Lines),
                 sub_string(L, _, _, _, "agent_move(Agent, Host)") ), Xs),
    length(Xs, N),
    findall(L, ( member(L, Lines),
                 ( sub_string(L, _, _, _, "typhon_")
                 ; sub_string(L, _, _, _, "Exception") ) ), Written).

:- end_tests(errors_at_the_top_level).

:- dynamic
    delta/2.                    % Pid, Out

%   Another process has a host delta; Out is its output.

start_delta :-
    project_file('app/typhon.pl', App),
    current_prolog_flag(executable, Swipl),
    process_create(path(sh),
                   [ '-c', 'exec "$0" "$1" host delta 2>&1', Swipl, App ],
                   [stdin(null), stdout(pipe(Out)), process(Pid)]),
    read_line_to_string(Out, Line),
    atom_string(Address, Line),
    nb_setval(test_delta, Address),
    assertz(delta(Pid, Out)).

stop_delta :-
    retract(delta(Pid, Out)),
    process_kill(Pid, int),
    process_wait(Pid, _),
    close(Out).

said(Lines, Written) :-
    with_tmp_dir(said(Lines, Written)).

said(Lines, Written, Dir) :-
    put(Dir, 'hi.pl', ":- agent(hi, [state([got/1])]).\n\c
                       on_message(_, X) :- assertz(got(X)).\n"),
    typed(Lines, Dir, Written).

one_has(Lines, Text) :-
    (   member(Line, Lines),
        sub_string(Line, _, _, _, Text)
    ->  true
    ;   throw(error(existence_error(Text, Lines), _))
    ).

:- begin_tests(other_process, [setup(start_delta), cleanup(stop_delta)]).

test(process_without_hosts_creates_and_orders_agents, Answers == Wanted) :-
    nb_getval(test_delta, Delta),
    format(atom(Create), 'agent_create(hi, A, [host(~q), name(bob)]).',
           [Delta]),
    format(atom(Remote), 'remote(~q, true), once(host_property(~q, load(_))).',
           [Delta, Delta]),
    said([ Create,
           'agent_send(bob, hello).',
           'between(1, 500, _), agent_property(bob, facts(F)), \c
            ( F \\== [] ; sleep(0.02), fail ), !, print(F), nl.',
           'agent_property(bob, host(H)), sub_atom(H, 0, 5, _, N), \c
            writeln(N).',
           'agent_property(bob, state(S)), writeln(S).',
           Remote,
           'agent_dispose(bob), agent_join(bob, O, 5), writeln(O).',
           'between(1, 100, _), findall(T, ( thread_property(T, status(_)), \c
            T \\== gc ), Ts), ( Ts == [main] ; sleep(0.05), fail ), !, \c
            writeln(Ts).'
         ], Written),
    Wanted = [ "[got(hello)]", "delta", "resident", "disposed", "[main]" ],
    findall(Line, ( member(Line, Written), memberchk(Line, Wanted) ),
            Answers).

test(guests_are_created_and_ended_in_several_threads) :-
    nb_getval(test_delta, Delta),
    no_leaks(( findall(T, ( between(1, 6, _),
                            thread_create(forall(between(1, 5, _),
                                                 remote(Delta, true)), T) ),
                       Ts),
               forall(member(T, Ts),
                      ( thread_join(T, Status),
                        assertion(Status == true) )) )).

%   The second guest begins while the first is there, and stays longer.

test(guests_are_independent, Statuses == [true, true]) :-
    nb_getval(test_delta, Delta),
    no_leaks(( there(Delta, message_queue_create(_, [alias(first)])),
               there(Delta, message_queue_create(_, [alias(second)])),
               stays(Delta, first, First),
               stays(Delta, second, Second),
               maplist(goes(Delta), [first-First,second-Second], Statuses) )).

there(Delta, Goal) :-
    remote(Delta, \+ \+ Goal).

stays(Delta, Queue, Thread) :-
    thread_create(there(Delta, thread_get_message(Queue, go)), Thread),
    wait_until(there(Delta, message_queue_property(Queue, waiting(1))), 10).

goes(Delta, Queue-Thread, Status) :-
    there(Delta, thread_send_message(Queue, go)),
    thread_join(Thread, Status),
    there(Delta, message_queue_destroy(Queue)).

test(mistyped_host_and_port_in_use) :-
    nb_getval(test_delta, Delta),
    atomic_list_concat([_, Address], @, Delta),
    atomic_list_concat([_, Port], :, Address),
    format(atom(Create), 'agent_create(hi, A, [host(\'dlta@~w\')]).',
           [Address]),
    format(atom(Start), 'host_start(alpha, [port(~w)]).', [Port]),
    said([Create, Start], Written),
    one_has(Written, "There is no host dlta at "),
    one_has(Written, "(there are: delta)"),
    format(string(Where), "at ~w; choose another port", [Address]),
    one_has(Written, Where).

%   A host of another network: the error is the same for a user and for a
%   moving agent.

test(other_cookie_is_not_reported_as_a_dead_host,
     [ condition(top_level_continues),
       true(Xs == [x, x, x, x]) ]) :-
    nb_getval(test_delta, Delta),
    with_cookie('another cookie, of another network',
                another_cookie(Delta, Written)),
    findall(x, ( member(Line, Written),
                 sub_string(Line, _, _, _, "has another cookie") ), Xs),
    delta(_, Out),
    read_line_to_string(Out, There),
    one_has([There], "its cookie is not that of this process").

another_cookie(Delta, Written) :-
    format(atom(Create), 'agent_create(hi, A, [host(~q)]).', [Delta]),
    format(atom(Move),
           'agent_move(bob, ~q), payload_attach(bob, payload(x,[],[])).',
           [Delta]),       % orders are executed in sequence
    format(atom(Remote), 'remote(~q, true).', [Delta]),
    said([ Create, Remote, 'host_start(alpha).',
           'agent_create(hi, _, [name(bob)]).', Move, Remote ],
         Written).

:- meta_predicate with_cookie(+, 0).

with_cookie(Cookie, Goal) :-
    setup_call_cleanup(setenv('TYPHON_COOKIE', Cookie),
                       Goal,
                       unsetenv('TYPHON_COOKIE')).

:- end_tests(other_process).
