:- module(test_clusters_network, []).

% Networks whose processes a real ssh daemon and a real Slurm start, both on
% this machine.

:- use_module('../../lib/common').

:- needs([cluster]).

:- use_module('../../lib/clusters', [with_slurm/1, with_sshd/1]).
:- use_module('../../lib/fixtures').
:- use_module('../../lib/networks').
:- use_module('../../lib/texts', [message_text/2]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [append/3, last/2, member/2, nth1/3]).
:- use_module(library(plunit)).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_line_to_string/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire), [cookie/1]).

%   Some machines do not permit daemons.

starts(Goal) :-
    catch(call(Goal), error(timeout_error(_, _), _), fail),
    !.
starts(Goal) :-
    format(user_error, '% skipped: ~w does not start here~n', [Goal]),
    fail.

nothing(_).

%   swipl is the program of this process.

swipl(swipl(Swipl)) :-
    current_prolog_flag(executable, Swipl).

processes(Network, Pids) :-
    network_property(Network, processes(Pids)).

process_file(Pid, Name, Text) :-
    format(atom(File), '/proc/~w/~w', [Pid, Name]),
    catch(read_file_to_string(File, Text, [encoding(octet)]),
          error(_, _), fail).

state(Pid, State) :-
    process_file(Pid, stat, Text),
    split_string(Text, ")", "", Parts),
    last(Parts, Rest),
    split_string(Rest, " ", " ", [State|_]).

ended(Pid) :-
    \+ ( state(Pid, State), State \== "Z" ).

%   No argument and no environment of a process of this machine has the cookie,
%   which no other suite has: of a process of the network, or of a program that
%   reaches one.

cookie_is_hidden :-
    cookie(Cookie),
    current_prolog_flag(pid, Me),
    expand_file_name('/proc/[0-9]*', Dirs),
    findall(Pid-Name,
            ( member(Dir, Dirs),
              atom_concat('/proc/', Pid, Dir),
              \+ atom_number(Pid, Me),
              member(Name, [cmdline, environ]),
              process_file(Pid, Name, Text),
              sub_string(Text, _, _, _, Cookie) ),
            Seen),
    assertion(Seen == []).

%   rounds(+Hosts, -Count): an agent visits Hosts, over all processes.

rounds(Hosts, Count) :-
    Hosts = [First|_],
    create([ route(Hosts),
             (main :- route(L), go(L, 0)),
             (go([], N) :- result(N)),
             (go([H|Hs], N) :- move(H), N1 is N+1, go(Hs, N1)) ],
           Agent, [host(First)]),
    agent_result(Agent, Count, 60).

%   The hosts of Network answer, and process P has another number than Pid.

again(Network, P, Pid) :-
    processes(Network, Pids),
    nth1(P, Pids, Now),
    Now \== Pid.

killed_process_is_restarted(Network, Hosts) :-
    processes(Network, [_, Pid]),
    process_kill(Pid, kill),
    wait_until(again(Network, 2, Pid), 60),
    network_property(Network, hosts(Hosts)),
    rounds(Hosts, 4).

%   error_of(+How, -Text): what the start of a network says in one line.

error_of(How, Text) :-
    no_leaks(capturing(catch(network_start(ring(2), _, [start(How)]), Error,
                             true), _)),
    assertion(nonvar(Error)),
    message_text(Error, Text),
    split_string(Text, "\n", "\n", Lines),
    assertion(Lines = [_]).

says(How, Part) :-
    error_of(How, Text),
    (   sub_string(Text, _, _, _, Part)
    ->  true
    ;   assertion(Text == Part)
    ).

                /*******************************
                *              SSH             *
                *******************************/

%   over_ssh(:Goal, +Dir, +Ssh): call Goal with a machine that Ssh reaches, and
%   the arguments of Ssh.

:- meta_predicate over_ssh(2, +, +).

over_ssh(Goal, _, Ssh) :-
    atomic_list_concat([ssh|Args], ' ', Ssh),
    swipl(Swipl),
    call(Goal, machine('127.0.0.1', [more(Args), Swipl]), Args).

ssh_works(_, Ssh) :-
    current_prolog_flag(executable, Swipl),
    format(atom(Command), '~w 127.0.0.1 ~w --version', [Ssh, Swipl]),
    process_create(path(sh), ['-c', Command],
                   [stdout(null), stderr(null), process(Pid)]),
    process_wait(Pid, exit(0)).

:- begin_tests(ssh, [condition(test_clusters_network:
                               starts(with_sshd(ssh_works)))]).

test(processes_run_there_until_the_network_stops) :-
    with_sshd(over_ssh(run_over_ssh)).
test(killed_process_is_restarted) :-
    with_sshd(over_ssh(restart_over_ssh)).
test(stopped_process_ends_with_the_network) :-
    with_sshd(over_ssh(stop_over_ssh)).
test(errors_name_the_machine_and_the_remedy) :-
    with_sshd(over_ssh(errors_over_ssh)).

:- end_tests(ssh).

run_over_ssh(Machine, _) :-
    Machine = machine(_, Options),
    Other = machine(localhost, [bind('127.0.0.1')|Options]),
    with_network(ring(4), [start(ssh([Machine, Other]))], Network, Hosts,
        ( processes(Network, Pids),
          assertion(length(Pids, 2)),
          cookie_is_hidden,
          rounds(Hosts, Count),
          assertion(Count == 4) )),
    maplist(ended, Pids).

restart_over_ssh(Machine, _) :-
    capturing(with_network(ring(4),
                           [ start(ssh([Machine])), processes(2),
                             restart(true) ],
                           Network, Hosts,
                           killed_process_is_restarted(Network, Hosts)),
              _).

stop_over_ssh(Machine, _) :-
    with_settings([typhon_processes:answer_seconds=0.5,
                   typhon_children:stop_seconds=1],
        capturing(with_network(ring(4), [start(ssh([Machine])), processes(2)],
                               Network, _,
                               ( processes(Network, [Pid, Other]),
                                 process_kill(Pid, stop) )),
                  _)),
    wait_until(( ended(Pid), ended(Other) ), 20).

errors_over_ssh(machine(Target, Options), Args) :-
    append(Before, ['-i', _|After], Args),
    append(Before, ['-o', 'IdentitiesOnly=yes', '-i', '/dev/null'|After],
           Other),
    says(ssh([machine(Target, [more(Other)])]),
         "on 127.0.0.1: ssh cannot log in, try: ssh 127.0.0.1 true"),
    says(ssh([machine('no.such.host.invalid', Options)]),
         "on no.such.host.invalid: ssh cannot log in"),
    says(ssh([machine(Target, [more(Args), swipl('no/such; program')])]),
         "on 127.0.0.1: swipl is not found there"),
    says(ssh([machine(Target, [node('/no/such.pl')|Options])]),
         "on 127.0.0.1: Typhon does not start there"),
    says(ssh([machine(Target, [bind('192.0.2.7')|Options])]),
         "on 127.0.0.1").

                /*******************************
                *             SLURM            *
                *******************************/

:- begin_tests(slurm, [condition(test_clusters_network:
                                 starts(with_slurm(nothing)))]).

test(processes_run_in_an_allocation) :-
    with_slurm(in_slurm).

:- end_tests(slurm).

in_slurm(_) :-
    swipl(Swipl),
    run_in_slurm(Swipl),
    restart_in_slurm(Swipl),
    end_of_this_process(Swipl),
    errors_in_slurm(Swipl).

jobs(Jobs) :-
    setup_call_cleanup(
        process_create(path(squeue), ['--noheader', '--format=%i %T'],
                       [stdout(pipe(Out)), process(Pid)]),
        read_string(Out, _, Text),
        close(Out)),
    process_wait(Pid, exit(0)),
    split_string(Text, "\n", "\n ", Lines),
    findall(Job,
            ( member(Line, Lines),
              split_string(Line, " ", "", [Job, "RUNNING"]) ),
            Jobs).

run_in_slurm(Swipl) :-
    with_network(ring(4),
                 [ start(slurm([ nodes(1), partition(all), time(10),
                                 more(['--job-name=typhon']), Swipl ])),
                   processes(2) ],
                 Network, Hosts,
        ( processes(Network, Pids),
          assertion(length(Pids, 2)),
          jobs(Jobs),
          assertion(Jobs = [_]),
          cookie_is_hidden,
          rounds(Hosts, Count),
          assertion(Count == 4) )),
    maplist(ended, Pids),
    wait_until(jobs([]), 60).

restart_in_slurm(Swipl) :-
    capturing(with_network(ring(4),
                           [ start(slurm([Swipl])), processes(2),
                             restart(true) ],
                           Network, Hosts,
                           killed_process_is_restarted(Network, Hosts)),
              _).

%   A process that starts a network is killed: its processes end, and its nodes
%   are free.

end_of_this_process(Swipl) :-
    project_file(prolog, Library),
    format(atom(Path), 'library=~w', [Library]),
    format(atom(Goal), '~q',
           [( use_module(library(typhon)),
              network_start(ring(2), N, [start(slurm([Swipl]))]),
              network_property(N, processes(P)),
              format("~q.~n", [P]), flush_output, thread_get_message(x) )]),
    with_swipl(['-f', none, '-p', Path, '-g', Goal], Pid, _, Out,
               ( read_line_to_string(Out, Line),
                 term_string(Pids, Line),
                 process_kill(Pid, kill) )),
    wait_until(maplist(ended, Pids), 60),
    wait_until(jobs([]), 60).

errors_in_slurm(Swipl) :-
    says(slurm([partition(none_such)]), "partition specified: none_such"),
    with_settings([typhon_processes:start_seconds=2],
                  says(slurm([nodes(3)]), "Slurm: ")),
    says(slurm([swipl('/no/such/swipl')]), ": swipl is not found there"),
    says(slurm([Swipl, node('/no/such.pl')]), ": Typhon does not start there"),
    wait_until(jobs([]), 60).
