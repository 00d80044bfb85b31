:- module(test_study_work, []).

% Many runs by several processes: each is made once, however the processes end.

:- use_module('../../lib/common').
:- use_module('../../lib/study_files',
              [study_command/4, study_messages/2, with_study_file/4]).
:- use_module('../../lib/texts', [file_lines/2]).
:- use_module('../../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../../experiments/engine/studies', [study_load/2]).
:- use_module('../../../experiments/engine/work', [runs_make/4]).
:- use_module(library(apply), [include/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_file_to_terms/3]).

:- meta_predicate with_toy(-, -, 0).

with_toy(Dir, File, Goal) :-
    project_file('test/lib/toy_study.pl', Toy),
    file_lines(Toy, Lines),
    with_study_file(Lines, Dir, File, Goal).

runs(Dir, File, Whats, More, Status, Text) :-
    format(atom(Set), 'what=~w', [Whats]),
    study_command(Dir, [File, '--out', out, '--set', Set|More], Status, Text).

noted(Dir, Notes) :-
    directory_file_path(Dir, log, File),
    (   exists_file(File)
    ->  catch(read_file_to_terms(File, Terms, []), error(_, _), Terms = [])
    ;   Terms = []
    ),
    findall(What, member(run(_, What), Terms), Notes).

%   below(+Dir, +Suffix, -Files): directories of runs that end so.

below(Dir, Suffix, Files) :-
    directory_file_path(Dir, 'out/runs', Runs),
    findall(File,
            ( exists_directory(Runs),
              directory_member(Runs, File, [recursive(true)]),
              atom_concat(_, Suffix, File) ),
            Files).

contains(Text, Part) :-
    assertion(once(sub_string(Text, _, _, _, Part))).

one_process_for_many(Dir, File) :-
    runs(Dir, File, '[a,b]', ['--runs', 3, '--jobs', 1], exit(0), _),
    directory_file_path(Dir, log, Log),
    read_file_to_terms(Log, Terms, []),
    findall(Pid, member(run(Pid, _), Terms), Pids),
    sort(Pids, Distinct),
    assertion(Distinct = [_]).

%   A run that fails is reported, others are made, and it is tried again.

failing(What, Why, Dir, File) :-
    format(atom(Whats), '[a,~w,b]', [What]),
    runs(Dir, File, Whats, ['--runs', 1, '--jobs', 1], Status, Text),
    assertion(Status == exit(1)),
    contains(Text, "failed; see"),
    contains(Text, Why),
    contains(Text, "3/3 runs"),
    below(Dir, '.failed', [Failed]),
    directory_file_path(Failed, output, Output),
    read_file_to_string(Output, Said, []),
    format(string(Start), "~w says it", [What]),
    contains(Said, Start),
    contains(Said, Why),
    below(Dir, 'result.pl', Results),
    length(Results, 2),
    below(Dir, '.part', Parts),
    assertion(Parts == []),
    runs(Dir, File, Whats, ['--runs', 1, '--jobs', 1], exit(1), _),
    noted(Dir, Notes),
    include(==(1-What), Notes, Tries),
    length(Tries, Count),
    assertion(Count == 2).

%   Of runs that fail for the same reason the first one and the number of all
%   are reported.

same_cause(Dir, File) :-
    runs(Dir, File, '[fail]', ['--runs', 3], exit(1), Text),
    contains(Text, "3 runs failed: "),
    findall(x, sub_string(Text, _, _, _, "failed; see"), Told),
    assertion(Told == [x]).

collected_anyway(Dir, File) :-
    runs(Dir, File, '[a,fail]', ['--runs', 1], exit(1), Text),
    contains(Text, "index.html"),
    runs(Dir, File, '[a,fail]', ['--runs', 1, '--collect'], exit(1), Text1),
    contains(Text1, "index.html").

%   A session gets a signal during a run.

interrupted(Signal, Status, What, Dir, File) :-
    format(atom(Whats), 'what=[a,~w]', [What]),
    project_file('experiments/study.pl', Script),
    directory_file_path(Dir, out, Out),
    with_swipl([Script, --, File, '--out', Out, '--set', Whats, '--jobs', 2],
               Pid, _, _,
               ( wait_until(under_way(Dir, 1-What), 60),
                 process_kill(Pid, Signal),
                 wait_for_end(Pid, 60, Ended) )),
    assertion(Ended == exit(Status)),
    directory_file_path(Dir, log, Log),
    read_file_to_terms(Log, Terms, []),
    forall(member(run(Worker, _), Terms),
           wait_until(\+ alive(Worker), 10)).

under_way(Dir, Run) :-
    noted(Dir, Notes),
    memberchk(Run, Notes).

alive(Pid) :-
    format(atom(Directory), '/proc/~d', [Pid]),
    exists_directory(Directory).

both(Dir) :-
    noted(Dir, Notes),
    include(==(1-until), Notes, [_, _]).

%   The study is changed while its runs are made.

changed(Dir, File) :-
    project_file('experiments/study.pl', Script),
    directory_file_path(Dir, out, Out),
    with_swipl([ Script, --, File, '--out', Out, '--set', 'what=[until,a]',
                 '--runs', 1, '--jobs', 1 ],
               Pid, _, _,
               ( wait_until(under_way(Dir, 1-until), 60),
                 set_time_file(File, _, [modified(1000)]),
                 directory_file_path(Dir, go, Go),
                 setup_call_cleanup(open(Go, write, S), true, close(S)),
                 wait_for_end(Pid, 60, Status) )),
    assertion(Status == exit(1)),
    below(Dir, '.failed', [Failed|_]),
    directory_file_path(Failed, output, Output),
    read_file_to_string(Output, Said, []),
    contains(Said, "has changed").

%   Two workers end by themselves after their run, one in its run.

in_this_process(Dir, File, Failed) :-
    directory_file_path(Dir, out, Out),
    study_load(File, Study),
    study_cases(Study, [what-[a, halt, b]], Cases),
    findall(run(Study, Case, 1), member(Case, Cases), Runs),
    no_leaks(study_messages(runs_make(Runs, Out, [jobs(2)], Failed), _)).

:- begin_tests(study_work).

test(run_is_made_once) :-
    with_toy(Dir, File,
        ( runs(Dir, File, '[a,b]', ['--runs', 2], Status, Text),
          assertion(Status == exit(0)),
          contains(Text, "4/4 runs"),
          noted(Dir, Notes),
          msort(Notes, Sorted),
          assertion(Sorted == [1-a, 1-b, 2-a, 2-b]),
          runs(Dir, File, '[a,b]', ['--runs', 2], exit(0), Again),
          assertion(\+ sub_string(Again, _, _, _, "runs,")),
          runs(Dir, File, '[a,b,c]', ['--runs', 2], exit(0), _),
          noted(Dir, More),
          length(More, Count),
          assertion(Count == 6),
          below(Dir, '.part', Left),
          assertion(Left == []) )).
test(first_seed_of_each_case_comes_first) :-
    with_toy(Dir, File,
        ( runs(Dir, File, '[a,b]', ['--runs', 2, '--jobs', 1], exit(0), _),
          noted(Dir, Notes),
          assertion(Notes == [1-a, 1-b, 2-a, 2-b]) )).
test(one_process_for_many) :-
    with_toy(Dir, File, one_process_for_many(Dir, File)).
test(output_of_a_run_is_kept) :-
    with_toy(Dir, File,
        ( runs(Dir, File, '[a]', ['--runs', 1], exit(0), Text),
          assertion(\+ sub_string(Text, _, _, _, "a says it")),
          below(Dir, '/output', [Output]),
          read_file_to_string(Output, Said, []),
          assertion(Said == "a says it\n") )).
test(failing, forall(member(What-Why, [ fail-"`here' does not exist",
                                        ball-"Unknown message: ball",
                                        halt-"exit(7)",
                                        kill-"killed(9)" ]))) :-
    with_toy(Dir, File, failing(What, Why, Dir, File)).
test(same_cause) :-
    with_toy(Dir, File, same_cause(Dir, File)).
test(failed_study_is_collected) :-
    with_toy(Dir, File, collected_anyway(Dir, File)).
test(no_such_agent) :-
    with_study_file([ ':- use_module(library(typhon)).',
                      'study(lost, "No such agent").',
                      'network(_, ring(2), []).',
                      'run(_, Network) :-',
                      '    network_property(Network, hosts([Host|_])),',
                      '    agent_create(agents(missing), _, [host(Host)]).',
                      'measure(m, _, 1).' ],
                    Dir, File, no_such_agent(Dir, File)).
test(interrupted, forall(member(Signal-Status, [int-130, term-143]))) :-
    with_toy(Dir, File,
        ( interrupted(Signal, Status, wait, Dir, File),
          below(Dir, '.part', Parts),
          assertion(Parts == []) )).

%   The next session removes its partial run.

test(stuck) :-
    with_toy(Dir, File,
        ( interrupted(term, 143, stuck, Dir, File),
          below(Dir, '.part', Parts),
          assertion(Parts = [_|_]),
          runs(Dir, File, '[a]', ['--runs', 1], exit(0), _),
          below(Dir, '.part', Left),
          assertion(Left == []) )).

test(workers_leave_no_streams, Failed == 1) :-
    with_toy(Dir, File, in_this_process(Dir, File, Failed)).

%   Two sessions need the same run, which lasts until both have started.

test(two_sessions_share_the_work) :-
    with_toy(Dir, File,
        ( project_file('experiments/study.pl', Script),
          directory_file_path(Dir, out, Out),
          Args = [ Script, --, File, '--out', Out, '--set', 'what=[until,a]',
                   '--runs', 1, '--jobs', 2 ],
          with_swipl(Args, One, _, _,
              with_swipl(Args, Two, _, _,
                  ( wait_until(both(Dir), 60),
                    directory_file_path(Dir, go, Go),
                    setup_call_cleanup(open(Go, write, S), true, close(S)),
                    wait_for_end(One, 60, StatusOne),
                    wait_for_end(Two, 60, StatusTwo) ))),
          assertion(StatusOne-StatusTwo == exit(0)-exit(0)),
          below(Dir, '.part', Parts),
          assertion(Parts == []),
          below(Dir, '/result.pl', Results),
          length(Results, Count),
          assertion(Count == 2) )).
test(other_runs_do_not_wait_for_a_long_run) :-
    with_study_file([ 'study(long, "The third waits for the last").',
                      'vary(n, [1, 2, 3, 4, 5, 6]).',
                      'measure(m, Log, 1) :- work(Log.case.n).',
                      'work(6) :- !, open(done, write, Out), close(Out).',
                      'work(3) :- !, get_time(Now), Deadline is Now + 30,',
                      '    await(Deadline).',
                      'work(_).',
                      'await(_) :- exists_file(done), !.',
                      'await(Deadline) :-',
                      '    get_time(Now),',
                      '    ( Now < Deadline -> sleep(0.05), await(Deadline)',
                      '    ; throw(error(timeout_error(await, done), _)) ).' ],
                    Dir, File,
        study_command(Dir, [File, '--runs', '1', '--jobs', '2'], exit(0), _)).
test(study_changed_during_the_run) :-
    with_toy(Dir, File, changed(Dir, File)).

no_such_agent(Dir, File) :-
    study_command(Dir, [File, '--runs', '1'], exit(1), Text),
    contains(Text, "study.pl, seed 1"),
    contains(Text, "There is no file agents(missing)").

:- end_tests(study_work).
