:- use_module('../lib/common', [run_swipl/5, wait_until/2, with_tmp_dir/1,
                       project_file/2]).
:- use_module('../lib/project_studies',
              [first_run/5, project_study/2, verdicts/3]).
:- use_module('../lib/event_log', [stopped_executing/4]).
:- use_module(library(aggregate)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(readutil)).
:- use_module('../../experiments/sync/metrics').

/** <module> The demo, small

The study of `make demo`, on twenty hosts in two processes, with a fast
clock.
*/

arguments(Dir, More, Arguments) :-
    project_file('experiments/study.pl', Script),
    append([ Script, '--', demo, '--runs', '1', '--set', 'processes=2',
             '--set', 'hosts=20', '--set', 'agents=4', '--set', 'tasks=2',
             '--logs', '--out', Dir
           ], More, Arguments).

small_run(Dir, More, Out, Err) :-
    arguments(Dir, ['--set', 'clock=50'|More], Arguments),
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
    current_prolog_flag(pid, Me),
    format(string(Mark), "TYPHON_TEST_DEMO=~d\0\", [Me]),
    sub_string(Environment, _, _, _, Mark).

mark :-
    current_prolog_flag(pid, Me),
    setenv('TYPHON_TEST_DEMO', Me).

nothing_left :-
    wait_until(\+ marked(_), 20).

:- begin_tests(demo, [ setup(mark),
                       cleanup(unsetenv('TYPHON_TEST_DEMO')) ]).

test(claims_are_of_virtual_time, Held == Claims) :-
    project_study('sync/study_demo', Study),
    with_tmp_dir({Study, Point}/[Dir]>>first_run(Study, [], 1, Dir, Point)),
    verdicts(Study, [Point], Verdicts),
    findall(Text, member(Text-_, Verdicts), Claims),
    findall(Text, member(Text-true, Verdicts), Held),
    Point = Case-_,
    assertion(Case.clock == virtual).
test(run) :-
    with_tmp_dir(whole_run).
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
    small_run(Dir, [], Out, Err),
    sub_string(Out, _, _, _, "never more than two distinct tasks"),
    ( sub_string(Out, _, _, _, "claims held")
    ; sub_string(Out, _, _, _, "claims did not hold")
    ),
    sub_string(Err, _, _, _, "40/40 events"),
    !,
    run_file(Dir, 'events.pl', Log),
    check_events(Log),
    run_file(Dir, 'result.pl', Result),
    check_result(Result),
    forall(member(Name, [ 'demo/demo.gnuplot', 'demo/runs.csv',
                          'demo/claims.csv', 'demo/starts.dat',
                          'index.html' ]),
           ( file(Dir, Name, File), size_file(File, Size), Size > 0 )),
    nothing_left.

%   The run has a directory below that of the study, while it is made, too.

run_file(Dir, Name, File) :-
    file(Dir, 'runs/demo/*/', Pattern0),
    atom_concat(Pattern0, Name, Pattern),
    expand_file_name(Pattern, [File|_]).

check_events(Log) :-
    read_file_to_terms(Log, Events0, []),
    from_start(Events0, Events),
    executions(Events, Executions),
    out_of_order(Executions, []),
    findall(Host-Task, member(execution(Task, Host, _, _), Executions), All),
    sort(All, Distinct),
    length(All, 40),
    length(Distinct, 40),
    aggregate_all(count, member(event(_, _, _, begun), Events), 4),
    aggregate_all(count, member(event(_, _, _, ended(done)), Events), 4).

check_result(Result) :-
    read_file_to_terms(Result, Facts, []),
    memberchk(seed(1), Facts),
    memberchk(parameter(hosts, 20), Facts),
    memberchk(version(prolog, _), Facts),
    memberchk(measure(missing, 0), Facts).

%   A run with a slow clock is stopped in the middle.

stopped_by(Signal, Status, Dir) :-
    arguments(Dir, ['--set', 'clock=1'], Arguments),
    file(Dir, 'runs/demo/*/events.pl', Pattern),
    stopped_executing(Arguments, Pattern, Signal, Status).

:- end_tests(demo).
