:- module(test_quick_suite, []).
:- use_module('../lib/changed_files', [changed_files/2]).
:- use_module('../lib/common').
:- use_module('../lib/slowness', [patience/2]).
:- use_module('../lib/suites', [suite_named/2]).
:- use_module('../lib/touched', [touched_suites/2, within_budget/4]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex),
              [ directory_file_path/3, directory_member/3,
                make_directory_path/1,
                set_time_file/3 ]).
:- use_module(library(lists), [append/3, member/2, select/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(random), [random_between/3]).
:- use_module(library(readutil), [read_file_to_string/3]).

/** <module> Which suites `make test-quick` runs, and how long suites wait

*Threading*: one test at a time.
*/

write_in(Dir, Name, Text) :-
    directory_file_path(Dir, Name, File),
    file_directory_name(File, Folder),
    make_directory_path(Folder),
    setup_call_cleanup(open(File, write, Out), write(Out, Text), close(Out)).

git(Dir, Args) :-
    append(['-C', Dir, '-c', 'user.name=a', '-c', 'user.email=a@b'], Args, All),
    process_create(path(git), All,
                   [stdout(null), stderr(null), process(Pid)]),
    process_wait(Pid, exit(0)).

commit(Dir, Names) :-
    forall(member(Name, Names), write_in(Dir, Name, Name)),
    git(Dir, [add, '-A']),
    git(Dir, [commit, '-q', '-m', 'A commit']).

repository(Dir) :-
    git(Dir, [init, '-q', '-b', main]),
    write_in(Dir, '.gitignore', "out\n"),
    commit(Dir, ['a.pl', 'b.pl', 'c.pl']).

:- begin_tests(changed_files).

test(branch_differs_from_where_it_began,
     Files == ['d.pl', 'e.pl', 'new/f.pl']) :-
    with_tmp_dir(of_branch(Files)).

of_branch(Files, Dir) :-
    repository(Dir),
    git(Dir, [checkout, '-q', '-b', branch]),
    commit(Dir, ['d.pl', 'e.pl']),
    git(Dir, [checkout, '-q', main]),
    commit(Dir, ['b.pl', 'later.pl']),
    git(Dir, [checkout, '-q', branch]),
    write_in(Dir, 'e.pl', "more"),
    write_in(Dir, 'new/f.pl', "new"),
    write_in(Dir, 'out/ignored.pl', "ignored"),
    changed_files(Dir, Files).

test(main_branch_has_the_last_commit, Files == ['d.pl']) :-
    with_tmp_dir(of_main(Files)).

of_main(Files, Dir) :-
    repository(Dir),
    commit(Dir, ['d.pl']),
    changed_files(Dir, Files).

test(main_branch_has_what_is_uncommitted, Files == ['a.pl']) :-
    with_tmp_dir(of_dirty_main(Files)).

of_dirty_main(Files, Dir) :-
    repository(Dir),
    commit(Dir, ['d.pl']),
    write_in(Dir, 'a.pl', "more"),
    changed_files(Dir, Files).

test(without_git_what_is_newer_than_the_last_success,
     Files-None == ['new.pl', 'x/newer.pl']-[]) :-
    with_tmp_dir(without_git(None, Files)).

without_git(None, Files, Dir) :-
    write_in(Dir, 'old.pl', "old"),
    write_in(Dir, 'new.pl', "new"),
    write_in(Dir, 'x/newer.pl', "newer"),
    changed_files(Dir, None),
    write_in(Dir, 'out/passed.pl', ""),
    set_age(Dir, 'old.pl', 20),
    set_age(Dir, 'out/passed.pl', 10),
    changed_files(Dir, Files).

set_age(Dir, Name, Seconds) :-
    get_time(Now),
    Time is Now-Seconds,
    directory_file_path(Dir, Name, File),
    set_time_file(File, _, [modified(Time)]).

:- end_tests(changed_files).

:- begin_tests(touched).

suites(Files, Suites) :-
    touched_suites(Files, Times),
    findall(Suite, member(time(Suite, _, _), Times), Suites).

test(suite_of_the_same_name_is_first_then_its_folder,
     Suite == 'test/prolog/kernel/wire/test_frame.pl') :-
    suites(['prolog/typhon/kernel/wire/frame.pl'], [Suite|Suites]),
    append(Folder, Others, Suites),
    \+ ( member(Other, Others), in_wire(Other) ),
    !,
    Folder = [_|_],
    maplist(in_wire, Folder).

in_wire(Suite) :-
    file_directory_name(Suite, 'test/prolog/kernel/wire').

test(changed_suite_comes_before_all) :-
    Suite = 'test/prolog/kernel/base/test_on_demand.pl',
    suites(['prolog/typhon/kernel/wire/frame.pl', Suite], [Suite|_]).

test(suites_that_use_a_helper_also_of_a_helper, Missing == []) :-
    suites(['test/lib/nxt_bricks.pl'], Suites),
    findall(Suite,
            ( member(Name, ['nxt/test_brick', 'nxt/test_brick_faults']),
              format(atom(Suite), 'test/bridges/~w.pl', [Name]),
              \+ memberchk(Suite, Suites) ),
            Missing),
    \+ memberchk('test/prolog/kernel/wire/test_frame.pl', Suites).

test(file_at_the_root_touches_the_suites_of_the_project) :-
    suites(['Makefile'], Suites),
    memberchk('test/project/test_make.pl', Suites),
    \+ memberchk('test/prolog/kernel/wire/test_frame.pl', Suites).

%   Programs of agents are loaded by hosts, so no suite is recorded for them. One
%   of each directory is tried, which decides.

test(programs_of_agents_touch_the_suites_of_their_folder, Others == []) :-
    findall(Dir, program_in(Dir, _, _), Dirs0),
    sort(Dirs0, Dirs),
    findall(File-Folder,
            ( member(Dir, Dirs),
              once(program_in(Dir, Folder, File)),
              suites([File], Suites),
              \+ ( member(Suite, Suites),
                   file_directory_name(Suite, Folder) ) ),
            Others).

program_in(Dir, Folder, File) :-
    member(Top, [agents, payloads]),
    project_file(Top, Whole),
    directory_member(Whole, Path, [recursive(true), extensions([pl])]),
    project_file(File, Path),
    file_directory_name(File, Dir),
    atomic_list_concat([Top, Part|_], /, File),
    atomic_list_concat([test, agents, Part], /, Folder),
    project_file(Folder, Tests),
    exists_directory(Tests).

test(no_change_touches_none, Suites == []) :-
    suites([], Suites).

:- end_tests(touched).

:- begin_tests(budget).

test(budget_is_kept_and_no_suite_is_lost, [forall(member(_, [1, 2, 3]))]) :-
    findall(time(N, P, S),
            ( between(1, 9, N),
              random_between(1, 30, P), random_between(1, 100, S) ),
            Suites),
    within_budget(Suites, budget(50, 80), Taken, Left),
    aggregate_all(sum(P), member(time(_, P, _), Taken), Sum),
    Sum =< 50,
    \+ ( member(time(_, _, S), Taken), S > 80 ),
    append(Taken, Left, All),
    msort(All, Sorted),
    msort(Suites, Sorted),
    Rest is 50-Sum,
    \+ ( member(time(_, P, S), Left), P =< Rest, S =< 80 ).

test(choice_is_of_suites_each_once, Bad == []) :-
    project_file('test/quick.pl', Quick),
    run_swipl([Quick, --, '--list', '--seed', '7', '--seconds', '20'], [],
              exit(0), Text, _),
    split_string(Text, "\n", "\n", [Changed, Others|Lines]),
    sub_string(Changed, _, _, _, "files are changed"),
    sub_string(Others, _, _, 0, "(seed 7)"),
    !,
    findall(Line,
            ( select(Line, Lines, Rest),
              ( memberchk(Line, Rest) ; \+ suite_named(Line, _) ) ),
            Bad).

:- end_tests(budget).

:- begin_tests(slowness, [cleanup(restore_slowness), setup(keep_slowness)]).

:- dynamic kept/1.

keep_slowness :-
    ( getenv('TYPHON_SLOWNESS', Now) -> assertz(kept(Now)) ; true ).

restore_slowness :-
    unsetenv('TYPHON_SLOWNESS'),
    forall(retract(kept(Now)), setenv('TYPHON_SLOWNESS', Now)).

test(deadline_is_later_on_a_slow_machine) :-
    get_time(Start),
    setenv('TYPHON_SLOWNESS', 1000),
    wait_until(( get_time(Now), Now > Start+0.3 ), 0.05).

test(fast_machine_has_the_deadlines_as_written,
     Waits == [20.0, 20.0, 60.0, 20.0]) :-
    maplist(wait_with, ['0.5', none, '3.0', '1'], Waits).

wait_with(Slowness, Longer) :-
    unsetenv('TYPHON_SLOWNESS'),
    ( Slowness == none -> true ; setenv('TYPHON_SLOWNESS', Slowness) ),
    patience(20, Longer).

test(waits_in_suites_become_longer, Lines == Longer) :-
    with_tmp_dir(expanded('3', Lines)),
    Longer = [ "agent_result(a,b,30.0)", "agent_result(a,b,1)",
               "thread_get_message(q,m,[timeout(60.0)])",
               "peer_do(a,\\+agent_join(a,b,30.0))" ].

test(waits_in_suites_are_as_written, Lines == AsWritten) :-
    with_tmp_dir(expanded('1.0', Lines)),
    AsWritten = [ "agent_result(a,b,10)", "agent_result(a,b,1)",
                  "thread_get_message(q,m,[timeout(20)])",
                  "peer_do(a,\\+agent_join(a,b,10))" ].

expanded(Slowness, Lines, Dir) :-
    Clauses = "p(1) :- agent_result(a, b, 10).\n\c
               p(2) :- agent_result(a, b, 1).\n\c
               p(3) :- thread_get_message(q, m, [timeout(20)]).\n\c
               p(4) :- peer_do(a, \\+ agent_join(a, b, 10)).\n",
    project_file('test/lib/common.pl', Common),
    format(string(Program), ":- use_module('~w').\n~s", [Common, Clauses]),
    write_in(Dir, 'test/x.pl', Program),
    directory_file_path(Dir, 'test/x.pl', File),
    run_swipl([ '-g', 'forall(clause(p(_),B),(print(B),nl))', '-t', halt,
                File ],
              [environment(['TYPHON_SLOWNESS'=Slowness])], exit(0), Text, _),
    split_string(Text, "\n", "\n", Lines).

:- end_tests(slowness).

:- begin_tests(stability).

test(each_run_is_a_row, Statuses == [exit(0), exit(0)]) :-
    with_tmp_dir(noted_runs(Statuses)).

noted_runs([Status1, Status2], Dir) :-
    directory_file_path(Dir, 'x.md', File),
    project_file('test/stability.pl', Program),
    Args = [Program, --, '--file', File, '--runs'],
    append(Args, ['1', '--busy', '1', private], Busy),
    append(Args, ['2', '--pin', '0', private], Pinned),
    run_swipl(Busy, [timeout(120)], Status1, _, _),
    run_swipl(Pinned, [timeout(120)], Status2, _, _),
    read_file_to_string(File, Text, []),
    split_string(Text, "\n", "\n", Lines),
    maplist(columns, Lines, Rows),
    Rows = [[_, Commit, _, "1", "-", _, _, Passed, "0", ""],
            [_, Commit, _, "0", "0", _, _, Passed, "0", ""],
            [_, Commit, _, "0", "0", _, _, Passed, "0", ""]],
    number_string(Count, Passed),
    Count > 0.

columns(Line, Columns) :-
    split_string(Line, "|", " ", ["", A, B, C, D, E, F, G, H, I, J, ""]),
    Columns = [A, B, C, D, E, F, G, H, I, J].

:- end_tests(stability).
