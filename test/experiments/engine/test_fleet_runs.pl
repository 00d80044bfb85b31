:- module(test_fleet_runs, []).

% Runs of one study, shared by processes that meet in a fleet: each is made, and
% counted, once, whoever dies.

:- use_module('../../lib/common').
:- use_module('../../lib/redis').
:- use_module('../../lib/study_files', [study_command/4, with_study_file/4]).
:- use_module('../../lib/texts', [file_lines/2, write_file/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_kill/2]).
:- use_module(library(readutil), [read_file_to_string/3, read_file_to_terms/3]).

:- needs([fleet]).

:- meta_predicate with_toy(-, -, -, 0).

with_toy(Dir, File, Redis, Goal) :-
    project_file('test/lib/toy_study.pl', Toy),
    file_lines(Toy, Lines),
    with_study_file(Lines, Dir, File, with_redis(Redis, Goal)).

%   words(+File, +Whats, +Out, +More, -Words): the arguments of study.pl.

words(File, Whats, Out, More, [File, '--set', Set, '--out', Out|More]) :-
    format(atom(Set), 'what=~w', [Whats]).

shared(Redis, More, ['--fleet', lab, '--redis', At|More]) :-
    redis_address(Redis, Host:Port),
    atomic_list_concat([Host, Port], :, At).

%   started(+Dir, +Words, +Name, -Pid): its output is in the file Name.

started(Dir, Words, Name, Pid) :-
    project_file('experiments/study.pl', Script),
    current_prolog_flag(executable, Swipl),
    directory_file_path(Dir, Name, File),
    setup_call_cleanup(
        open(File, write, Out),
        process_create(Swipl, [Script, --|Words],
                       [ cwd(Dir), stdin(null), stdout(stream(Out)),
                         stderr(stream(Out)), process(Pid) ]),
        close(Out)).

%   Those that have ended have been waited for.

killed(Pid) :-
    catch(( process_kill(Pid, kill), wait_for_end(Pid, 10, _) ),
          error(_, _), true).

notes(Dir, What, Count) :-
    directory_file_path(Dir, log, File),
    (   exists_file(File),
        catch(read_file_to_terms(File, Terms, []), error(_, _), fail)
    ->  aggregate_all(count, member(run(_, _-What), Terms), Count)
    ;   Count = 0
    ).

noted(Dir, What, Count) :-
    notes(Dir, What, Count).

go(Dir) :-
    directory_file_path(Dir, go, File),
    write_file(File, "").

%   tables(+Dir, +Out, -Tables): what analysis reads.

tables(Dir, Out, Tables) :-
    atomic_list_concat([Dir, Out, toy], /, Where),
    findall(Name-Text,
            ( directory_member(Where, File, [extensions([csv, jsonl])]),
              file_base_name(File, Name),
              read_file_to_string(File, Text, []) ),
            Tables0),
    sort(Tables0, Tables).

locally(Dir, File, Whats, Runs, Tables) :-
    words(File, Whats, local, ['--runs', Runs], Words),
    study_command(Dir, Words, exit(0), _),
    tables(Dir, local, Tables).

contains(Text, Part) :-
    assertion(once(sub_string(Text, _, _, _, Part))).

                /*******************************
                *            DEATHS            *
                *******************************/

%   Four processes have a run that waits each; two of them die.

two_of_four_die(Dir, File, Redis) :-
    shared(Redis, ['--runs', 4, '--jobs', 1], More),
    findall(Out-Pid,
            ( member(Out, [one, two, three, four]),
              words(File, '[a,until,b]', Out, More, Words),
              atom_concat(Out, '.txt', Name),
              started(Dir, Words, Name, Pid) ),
            All),
    All = [_-Pid1, _-Pid2|Left],
    call_cleanup(
        ( wait_until(test_fleet_runs:noted(Dir, until, 4), 60),
          process_kill(Pid1, kill),
          process_kill(Pid2, kill),
          wait_for_end(Pid1, 10, _),
          wait_for_end(Pid2, 10, _),
          go(Dir),
          forall(member(_-Pid, Left),
                 ( wait_for_end(Pid, 120, Status),
                   assertion(Status == exit(0)) )) ),
        forall(member(_-Pid, All), killed(Pid))),
    notes(Dir, until, Made),
    assertion(Made == 6),               % those of the dead are repeated
    forall(member(What, [a, b]), ( notes(Dir, What, Once), assertion(Once == 4) )),
    locally(Dir, File, '[a,until,b]', 4, Expected),
    assertion(Expected = [_,_|_]),
    forall(member(Out-_, Left),
           ( tables(Dir, Out, Tables), assertion(Tables == Expected) )).

engine_is_lost(Dir, File, Redis) :-
    shared(Redis, ['--runs', 2, '--jobs', 2], More),
    words(File, '[a,until]', one, More, Words),
    started(Dir, Words, 'one.txt', Pid),
    call_cleanup(
        ( wait_until(test_fleet_runs:noted(Dir, until, 2), 60),
          redis_signal(Redis, kill),
          go(Dir),
          directory_file_path(Dir, 'one.txt', Said),
          wait_until(test_fleet_runs:says(Said, "it is asked again"), 30),
          redis_restart(Redis),
          redis_empty(Redis),
          wait_for_end(Pid, 120, Status) ),
        killed(Pid)),
    read_file_to_string(Said, Text, []),
    assertion(Status-Text == exit(0)-Text),
    locally(Dir, File, '[a,until]', 2, Expected),
    tables(Dir, one, Tables),
    assertion(Tables == Expected).

says(File, Part) :-
    read_file_to_string(File, Text, []),
    once(sub_string(Text, _, _, _, Part)).

fails_for_all(Dir, File, Redis) :-
    shared(Redis, ['--runs', 1, '--jobs', 1], More),
    words(File, '[a,fail]', one, More, Words1),
    words(File, '[a,fail]', two, More, Words2),
    study_command(Dir, Words1, exit(1), Text1),
    contains(Text1, "failed; see"),
    study_command(Dir, Words2, exit(1), _),
    notes(Dir, a, Made),
    assertion(Made == 1),               % the second process got its result
    notes(Dir, fail, Tried),
    assertion(Tried == 2).

failure_arrives(Dir, File, Redis) :-
    shared(Redis, ['--runs', 1, '--jobs', 1], More),
    findall(Out-Pid,
            ( member(Out, [one, two]),
              words(File, '[until,fail,until2]', Out, More, Words),
              atom_concat(Out, '.txt', Name),
              started(Dir, Words, Name, Pid) ),
            All),
    call_cleanup(
        ( wait_until(test_fleet_runs:noted(Dir, until, 1), 60),
          wait_until(test_fleet_runs:noted(Dir, fail, 1), 60),
          go(Dir),
          forall(member(_-Pid, All),
                 ( wait_for_end(Pid, 120, Status),
                   assertion(Status == exit(1)) )) ),
        forall(member(_-Pid, All), killed(Pid))),
    forall(member(Out-_, All), failure_is_kept(Dir, Out)).

failure_is_kept(Dir, Out) :-
    atomic_list_concat([Dir, /, Out, '/runs'], Runs),
    directory_member(Runs, Failed, [recursive(true)]),
    atom_concat(_, '.failed', Failed),
    !,
    directory_file_path(Failed, output, Output),
    read_file_to_string(Output, Text, []),
    contains(Text, "fail says it"),
    contains(Text, "luck").

:- begin_tests(fleet_runs).

test(two_of_four_processes_die) :-
    with_toy(Dir, File, Redis, two_of_four_die(Dir, File, Redis)).
test(engine_that_comes_back_empty_is_filled_again) :-
    with_toy(Dir, File, Redis, engine_is_lost(Dir, File, Redis)).
test(failed_run_is_repeated_the_next_time) :-
    with_toy(Dir, File, Redis, fails_for_all(Dir, File, Redis)).
test(failure_is_reported_by_all) :-
    with_toy(Dir, File, Redis, failure_arrives(Dir, File, Redis)).
test(mistakes,
     [ forall(member(More-Part,
                     [ ['--fleet', lab]-"study needs --redis",
                       ['--redis', 'a:1']-"study needs --fleet",
                       ['--fleet', lab, '--redis', here]-"HOST:PORT expected",
                       ['--fleet', lab, '--redis', '127.0.0.1:1']-
                           "cannot be reached" ])) ]) :-
    project_file('test/lib/toy_study.pl', Toy),
    with_tmp_dir(Dir,
        ( words(Toy, '[a]', out, More, Words),
          study_command(Dir, Words, exit(1), Text) )),
    contains(Text, Part).

:- end_tests(fleet_runs).
