:- module(test_run, []).

/** <module> Runs the test suites and adds up

    swipl test/run.pl [-- suite ...]

runs every test_*.pl in the folders of test/, or those named (`frame` for
test/prolog/kernel/wire/test_frame.pl, `prolog/kernel/wire` for all in that
folder; or by their paths), each in a process of its own, some at a time, and
reports.  The last line is `N passed, N failed`; above it are the names of
failed tests, and `N skipped`.  The exit status is 0 only if nothing failed.

A suite that does not load cleanly, has no tests, ends with a status other
than 0, does not end within its deadline or leaves a process behind, which is
killed, counts as a failure.

*Threading*: the main thread only.  A process started by another thread would
inherit its blocked signals, SIGINT for one.
*/

:- use_module('../app/typhon/arguments', [arguments/3]).
:- use_module('lib/common', [project_file/2, wait_until/2, with_tmp_dir/1]).
:- use_module('lib/left_behind',
              [ kill_all_left_behind/0, kill_left_behind/2, suite_mark/2 ]).
:- use_module('lib/process_stat', [children_seconds/1]).
:- use_module('lib/quick_swipl', [quick_swipl/3]).
:- use_module('lib/slowness', [measure_slowness/0, patience/2]).
:- use_module('lib/suites',
              [ all_suites/1, left_out_suites/2, of_studies/1, runs_plainly/1,
                suite_named/2 ]).
:- use_module('lib/touched', [suite_times/1]).
:- use_module(library(apply), [exclude/3, foldl/4, maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists),
              [ append/2, member/2, memberchk/2, selectchk/3, sum_list/2 ]).
:- use_module(library(main), [main/0]).
:- use_module(library(pairs), [map_list_to_pairs/3, pairs_values/2]).
:- use_module(library(process),
              [ process_create/3, process_kill/2, process_wait/2,
                process_wait/3
              ]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_line_to_string/2]).

:- initialization(main, main).

:- public main/1.

%   Many suites mostly wait: so many run at a time, and more if processors are
%   idle.

suites_at_a_time(3, 8).
idle_share(0.08).                       % of the time of all processors

%   In seconds, more on a slow machine; `make fuzz-programs` takes longer.

suite_deadline(Seconds) :-
    getenv('TYPHON_SUITE_SECONDS', Atom),
    atom_number(Atom, Seconds),
    !.
suite_deadline(Seconds) :-
    patience(200, Seconds).

main(Argv) :-
    arguments(Argv, Names, []),
    left_out_suites(Names, LeftOut),
    suite_files(Names, Files0),
    longest_first(Files0, Files),
    at_halt(kill_all_left_behind),
    on_signal(term, _, terminated),
    measure_slowness,
    with_tmp_dir(run_suites(Files, Suites0)),
    foldl(report_left_out, LeftOut, Suites0, Suites),
    forall(member(Suite, Suites), print_failures(Suite)),
    foldl(add_suite, Suites, sum(0, 0, 0), Sum),
    print_sum(Sum),
    exit_status(Sum, Status),
    note_passed(Names, Status),
    halt(Status).

%   After all suites have passed, out/passed.pl has their times, for quick.pl.

:- dynamic time/3.                      % File, Processor, Seconds

note_passed([], 0) :-
    project_file(out, Out),
    catch(note_times(Out), error(_, _), true),
    !.
note_passed(_, _).

note_times(Out) :-
    make_directory_path(Out),
    directory_file_path(Out, 'passed.pl', File),
    setup_call_cleanup(
        open(File, write, Stream, [encoding(utf8)]),
        forall(( time(Path, Processor, Seconds), project_file(Suite, Path) ),
               format(Stream, '~q.~n', [suite(Suite, Processor, Seconds)])),
        close(Stream)).

%   By default SIGTERM, which `timeout` sends, ends Prolog without at_halt/1.

:- public terminated/1.

terminated(_) :-
    halt(143).

run_suites(Files, Suites, Dir) :-
    quick_swipl(quick_start, Dir, Quick),
    study_swipl(Files, Dir, Quick, Study),
    run_suites(Files, [], Suites, by(quick(Quick, Study), Dir)).

study_swipl(Files, Dir, _, Study) :-
    member(File, Files),
    of_studies(File),
    !,
    directory_file_path(Dir, studies, StudyDir),
    make_directory(StudyDir),
    quick_swipl(quick_study, StudyDir, Study).
study_swipl(_, _, Quick, Quick).

%   run_suites(+Files, +Jobs, -Suites, +By): Jobs are running now.

run_suites([], [], [], _) :-
    !.
run_suites(Files0, Jobs0, Suites, By) :-
    wait_until(step(Files0, Jobs0, Step), 1 000 000),
    run_step(Step, Files0, Jobs0, Suites, By).

run_step(start, [File|Files], Jobs, Suites, By) :-
    free_place(Jobs, Place),
    start_suite(File, By, Place, Job),
    run_suites(Files, [Job|Jobs], Suites, By).
run_step(ended(Job, Status), Files, Jobs0, [Suite|Suites], By) :-
    selectchk(Job, Jobs0, Jobs),
    end_suite(Job, Status, Suite),
    run_suites(Files, Jobs, Suites, By).

%   step(+Files, +Jobs, -Step) is semidet.

step([_|_], Jobs, start) :-
    length(Jobs, Running),
    suites_at_a_time(Some, Most),
    (   Running < Some
    ->  true
    ;   Running < Most,
        processors_idle
    ),
    !.
step(_, Jobs, ended(Job, Status)) :-
    ended_job(Jobs, Job, Status).

%   processors_idle is semidet.
%
%   The processors were mostly idle for a second since the last check. Fails if
%   there is no /proc/stat.

processors_idle :-
    looked(look(Then, Idle0, All0)),
    get_time(Now),
    Now >= Then+1,
    processor_times(Idle, All),
    nb_setval(looked, look(Now, Idle, All)),
    idle_share(Share),
    Idle-Idle0 > Share*(All-All0).

%   The first time it is the state since the start of the machine.

looked(Look) :-
    nb_current(looked, Look),
    !.
looked(look(0, 0, 0)).

%   processor_times(-Idle, -All) is semidet: of all processors, in ticks.

processor_times(Idle, All) :-
    catch(setup_call_cleanup(
              open('/proc/stat', read, In),
              read_line_to_string(In, Line),
              close(In)),
          error(_, _), fail),
    split_string(Line, " ", " ", ["cpu"|Words0]),
    exclude(==(""), Words0, Words),
    maplist(word_number, Words, Times),
    Times = [_, _, _, Idle|_],
    sum_list(Times, All).

word_number(Word, Number) :-
    number_string(Number, Word).

suite_files([], Files) :-
    !,
    all_suites(Files).
suite_files(Names, Files) :-
    maplist(named_suites, Names, Lists),
    append(Lists, Files0),
    sort(Files0, Files).

named_suites(Name, Files) :-
    findall(File, suite_named(Name, File), Files),
    (   Files == [],
        left_out_suites([Name], [])
    ->  format(user_error, 'No such test suite: ~w~n', [Name]),
        halt(1)
    ;   true
    ).

%   longest_first(+Files0, -Files): then all end at about the same time.

longest_first(Files0, Files) :-
    suite_times(Times),
    map_list_to_pairs(seconds(Times), Files0, Pairs0),
    sort(1, @>=, Pairs0, Pairs),
    pairs_values(Pairs, Files).

seconds(Times, File, Seconds) :-
    project_file(Suite, File),
    memberchk(time(Suite, _, Seconds), Times).

add_suite(suite(_, P1, Failures, Skipped), sum(P0, F0, S0), sum(P, F, S)) :-
    length(Failures, F1),
    length(Skipped, S1),
    P is P0+P1,
    F is F0+F1,
    S is S0+S1.

%   The failed tests are printed at the end.

print_failures(suite(Base, _, Failures, _)) :-
    forall(member(Failure, Failures),
           format('failed ~w ~w~n', [Base, Failure])).

print_sum(sum(Passed, Failed, Skipped)) :-
    (   Skipped > 0
    ->  format('~d skipped~n', [Skipped])
    ;   true
    ),
    format('~d passed, ~d failed~n', [Passed, Failed]).

exit_status(sum(Passed, 0, _), 0) :-
    Passed > 0,
    !.
exit_status(_, 1).

                /*******************************
                *           ONE SUITE          *
                *******************************/

%   job(File, Mark, Log, Results, Pid, Start, Place): suites that run at the same
%   time have places of their own, and so other ports.

free_place(Jobs, Place) :-
    suites_at_a_time(_, Most),
    between(1, Most, Place),
    \+ memberchk(job(_, _, _, _, _, _, Place), Jobs),
    !.

ports(_, Ports) :-
    getenv('TYPHON_PORTS', Ports),      % this is a suite itself
    !.
ports(Place, Ports) :-
    suites_at_a_time(_, Most),
    Count is 20000//Most,
    First is 10000+(Place-1)*Count,
    term_to_atom(First+Count, Ports).

start_suite(File, by(quick(Quick, Study), Dir), Place,
            job(File, Mark, Log, Results, Pid, Start, Place)) :-
    get_time(Start),
    ports(Place, Ports),
    file_base_name(File, Base),
    suite_mark(Base, Mark),
    directory_file_path(Dir, Base, Log),
    file_name_extension(Log, results, Results),
    file_name_extension(Log, cookie, Cookie),   % not that of other suites
    project_file('test/suite.pl', Runner),
    runs(File, quick(Quick, Study), Swipl),
    setup_call_cleanup(
        open(Log, write, Out),
        suite_process(Swipl,
                      [ '--on-error=print', '--on-warning=print',
                        Runner, '--', File, Results
                      ], Out,
                      [ 'TYPHON_SUITE'=Mark, 'TYPHON_QUICK'=Quick,
                        'TYPHON_RUN'=Dir, 'TYPHON_COOKIE_FILE'=Cookie,
                        'TYPHON_PORTS'=Ports ],
                      Pid),
        close(Out)).

runs(File, _, Swipl) :-
    runs_plainly(File),
    !,
    current_prolog_flag(executable, Swipl).
runs(File, quick(_, Study), Study) :-
    of_studies(File),
    !.
runs(_, quick(Quick, _), Quick).

suite_process(Swipl, Args, Out, Environment, Pid) :-
    project_file('.', Root),
    process_create(Swipl, Args,
                   [ stdin(null), stdout(stream(Out)), stderr(stream(Out)),
                     cwd(Root), environment(Environment), process(Pid)
                   ]).

ended_job(Jobs, Job, Status) :-
    member(Job, Jobs),
    Job = job(_, _, _, _, Pid, Start, _),
    process_wait(Pid, Status0, [timeout(0)]),
    (   Status0 \== timeout
    ->  Status = Status0
    ;   suite_deadline(Deadline),
        get_time(Now),
        Now > Start+Deadline,
        process_kill(Pid, kill),
        process_wait(Pid, _),
        Status = timeout
    ).

end_suite(Job, Status, Suite) :-
    Job = job(File, Mark, Log, Results, _, Start, _),
    file_base_name(File, Base),
    suite_results(Results, Status, suite(Passed, Failed, Skipped, Problems0)),
    findall(Problem, late_problem(Status, Mark, Problem), Problems1),
    append(Problems0, Problems1, Problems),
    append(Failed, Problems, Failures),
    Suite = suite(Base, Passed, Failures, Skipped),
    get_time(End),
    Seconds is End-Start,
    spent(Spent),
    assertz(time(File, Spent, Seconds)),
    report(Suite, Problems, Seconds, Spent, Log).

%   spent(-Seconds) is det: the processor time of the suite that has just been
%   waited for.

spent(Seconds) :-
    children_seconds(Now),
    nb_getval(suite_seconds, Before),
    nb_setval(suite_seconds, Now),
    Seconds is Now-Before.

:- initialization(nb_setval(suite_seconds, 0)).

suite_results(File, _, Suite) :-
    exists_file(File),
    !,
    setup_call_cleanup(open(File, read, In), read(In, Suite), close(In)).
suite_results(_, exit(0), suite(0, [], [], ['no results'])) :-
    !.
suite_results(_, _, suite(0, [], [], [])).

late_problem(Status, _, Problem) :-
    Status \== exit(0),
    (   Status == timeout
    ->  Problem = 'did not end in time'
    ;   format(atom(Problem), 'ended with ~w', [Status])
    ).
late_problem(_, Mark, Problem) :-
    kill_left_behind(Mark, Killed),
    Killed \== [],
    atomic_list_concat(Killed, ', ', Names),
    atom_concat('left processes behind: ', Names, Problem).

                /*******************************
                *            REPORTS           *
                *******************************/

report(suite(Base, Passed, Failures, Skipped), Problems, Seconds, Spent, Log) :-
    format('~w~t~30|~t~d~36| passed~t~1f~52| s~t~1f~62| s of processor',
           [Base, Passed, Seconds, Spent]),
    length(Failures, Failed),
    (   Failed > 0
    ->  format('   ~d FAILED', [Failed])
    ;   true
    ),
    nl,
    forall(member(Test, Skipped), format('  skipped ~w~n', [Test])),
    (   Failed > 0
    ->  report_failures(Base, Problems, Log)
    ;   true
    ),
    flush_output.

report_left_out(File-Part, Suites, [suite(Base, 0, [], [Part])|Suites]) :-
    file_base_name(File, Base),
    format('~w~t~30|  skipped, without the part ~w~n', [Base, Part]).

report_failures(Base, Problems, Log) :-
    format('---- output of ~w~n', [Base]),
    read_file_to_string(Log, Text, []),
    write(Text),
    forall(member(Problem, Problems), format('~N~w: ~w~n', [Base, Problem])),
    format('~N----~n').
