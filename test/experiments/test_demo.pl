:- use_module('../lib/common', [run_swipl/5, wait_until/2, with_tmp_dir/1,
                       project_file/2]).
:- use_module('../lib/event_log', [stopped_executing/4]).
:- use_module(library(aggregate)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(readutil)).
:- use_module('../../experiments/sync/metrics').

/** <module> The demo, small

The experiment of `make demo` with its own command line, on six hosts in
two processes, with a fast clock.
*/

arguments(Dir, More, Arguments) :-
    project_file('experiments/synchronisation.pl', Script),
    append([ Script, '--', '--topology', 'grid(2,3)', '--processes', '2',
             '--agents', '3', '--tasks', '3', '--clock', '50', '--out', Dir
           ], More, Arguments).

small_run(Dir, More, Out) :-
    arguments(Dir, More, Arguments),
    run_swipl(Arguments, [timeout(60)], Status, Out, Err),
    (   Status == exit(0)
    ->  true
    ;   throw(error(demo_failed(Status, Err), _))
    ).

file(Dir, Name, File) :-
    atomic_list_concat([Dir, /, Name], File).

%   Processes that run on behalf of this suite: they inherit a variable of
%   the environment.

marked(Pid) :-
    expand_file_name('/proc/[0-9]*', Dirs),
    member(Dir, Dirs),
    file_base_name(Dir, Name),
    atom_number(Name, Pid),
    \+ current_prolog_flag(pid, Pid),
    file(Dir, environ, File),
    catch(read_file_to_string(File, Environment, [encoding(octet)]),
          error(_, _), fail),
    sub_string(Environment, _, _, _, "TYPHON_TEST_DEMO=1").

nothing_left :-
    wait_until(\+ marked(_), 20).

:- begin_tests(demo, [ setup(setenv('TYPHON_TEST_DEMO', 1)),
                       cleanup(unsetenv('TYPHON_TEST_DEMO')) ]).

test(run) :-
    with_tmp_dir(whole_run).
test(several_runs) :-
    with_tmp_dir(two_runs).
test(failure_is_healed) :-
    with_tmp_dir(healed_run).
test(wrong_parameters, [ forall(wrong(Option, Value, Name)),
                         true(Status-Text == exit(1)-true) ]) :-
    with_tmp_dir(refused(Option, Value, Name, Status, Text)).
test(interrupted, [Status == exit(130), nondet]) :-
    with_tmp_dir(stopped_by(int, Status)),
    nothing_left.
test(terminated, [Status == exit(143), nondet]) :-
    with_tmp_dir(stopped_by(term, Status)),
    nothing_left.
test(killed, [Status == killed(9), nondet]) :-
    with_tmp_dir(stopped_by(kill, Status)),
    nothing_left.

whole_run(Dir) :-
    small_run(Dir, [], Out),
    sub_string(Out, _, _, _, "first start"),
    sub_string(Out, _, _, _, "τ at most"),
    ( sub_string(Out, _, _, _, "claims held.")
    ; sub_string(Out, _, _, _, "claims did not hold")
    ),
    !,
    check_events(Dir),
    check_metadata(Dir),
    forall(member(Name, ['executions.csv', 'tasks.csv', 'starts.dat']),
           ( file(Dir, Name, File), size_file(File, Size), Size > 0 )),
    nothing_left.

check_events(Dir) :-
    file(Dir, 'events.pl', File),
    read_file_to_terms(File, Events0, []),
    from_start(Events0, Events),
    executions(Events, Executions),
    out_of_order(Executions, []),
    findall(Host-Task, member(execution(Task, Host, _, _), Executions), All),
    sort(All, Distinct),
    length(All, 18),
    length(Distinct, 18),
    aggregate_all(count, member(event(_, _, _, begun), Events), 3),
    aggregate_all(count, member(event(_, _, _, ended(done)), Events), 3).

check_metadata(Dir) :-
    file(Dir, 'metadata.pl', File),
    read_file_to_terms(File, Facts, []),
    memberchk(parameter(seed, 1), Facts),
    memberchk(parameter(topology, grid(2,3)), Facts),
    memberchk(version(swi_prolog, _), Facts),
    memberchk(claim('every host executes every task exactly once', true, _),
              Facts).

two_runs(Dir) :-
    small_run(Dir, ['--runs', '2', '--seed', '7', '--tasks', '1'], _),
    forall(member(Name, [ 'seed7/events.pl', 'seed8/events.pl', 'runs.csv']),
           ( file(Dir, Name, File), exists_file(File) )).

%   Tasks of different length; two hosts lose T1 when T3 begins.

healed_run(Dir) :-
    small_run(Dir, [ '--failure', 'atomic(1,2,3)', '--delta', '0.2',
                     '--task_time', '[1,0.5-1.5,2]', '--no-picture' ], _),
    file(Dir, 'metadata.pl', File),
    read_file_to_terms(File, Facts, []),
    memberchk(result(lost, 2), Facts),
    memberchk(result(redone, 2), Facts),
    memberchk(result(executions, 20), Facts),
    memberchk(hosts([_, _, _, _, _, _]), Facts),
    file(Dir, 'synchronisation.png', Picture),
    \+ exists_file(Picture).

wrong('--delta', '0', "delta").
wrong('--hop_time', '2-1', "hop_time").
wrong('--task_time', '[1,2]', "task_time").
wrong('--failure', 'atomic(1,2,9)', "failure").

refused(Option, Value, Name, Status, Text, Dir) :-
    arguments(Dir, [Option, Value], Arguments),
    run_swipl(Arguments, [timeout(30)], Status, _, Err),
    (   sub_string(Err, _, _, _, Name)
    ->  Text = true
    ;   Text = Err
    ).

%   A run with a slow clock is stopped in the middle.

stopped_by(Signal, Status, Dir) :-
    arguments(Dir, ['--clock', '1'], Arguments),
    file(Dir, 'events.pl', Log),
    stopped_executing(Arguments, Log, Signal, Status).

:- end_tests(demo).
