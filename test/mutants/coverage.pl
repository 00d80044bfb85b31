:- module(test_coverage,
          [ record_coverage/2,          % +File, +Names
            load_coverage/1,            % +File
            suites_of/3,                % +File, +Predicate, -Suites
            tests_executing/3           % +Noted, -Tests, -Masks
          ]).

/** <module> Which suites execute which predicates

The suites run once in a copy of this project in which each rule of prolog/,
app/ and experiments/ notes that it was executed. What was recorded is a file
of

| suite(Suite, Processor, Seconds)      | it passed, in these times             |
| tests(Suite, Tests)                   | its tests, Unit:Name-Seconds          |
| executes(Suite, File, Predicates)     | Predicate-Tests of File: bit N is set if the Nth test executed it, counted from 0 |

Suites that fail in such a copy, since they look at the text of the product or
are late, run once more in a copy without notes, and are left out if they fail
there, too.

*Threading*: the main thread only, as for test/run.pl.
*/

:- use_module(changes, [file_rules/2]).
:- use_module(copies, [with_copy/1, write_in_copy/3]).
:- use_module('../lib/common', [project_file/2]).
:- use_module('../lib/run_log', [suite_time/2]).
:- use_module('../lib/suites', [all_suites/1, suite_name/2]).
:- use_module('../lib/touched', [suite_times/1, touched_suites/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(assoc), [empty_assoc/1, get_assoc/3, put_assoc/4]).
:- use_module(library(filesex),
              [directory_file_path/3, directory_member/3, make_directory_path/1]).
:- use_module(library(lists),
              [ append/3, last/2, list_to_set/2, member/2, memberchk/2, nth0/3,
                nth1/3, sum_list/2 ]).
:- use_module(library(pairs),
              [ group_pairs_by_key/2, pairs_keys_values/3, pairs_values/2 ]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3, read_file_to_terms/3]).

:- dynamic suite/3, tests/2, executes/3.

noted(prolog).
noted(app).
noted(experiments).

%!  record_coverage(+File, +Names:list) is det.
%
%   Of the suites Names, as test/run.pl takes them; of all if there are none.
%   What File has of other suites is kept.

record_coverage(File, Names) :-
    with_copy(record(File, Names)).

record(File, Names, Copy) :-
    findall(Program, noted_program(Program), Programs),
    foldl(note_program(Copy), Programs, 1-[], _-Numbers),
    directory_file_path(Copy, hits, Hits),
    make_directory_path(Hits),
    run_suites(Copy, Names, Hits, Times0),
    suite_paths(Paths),
    run_again(Hits, Times0, Times1),
    append(Times0, Times1, Times),
    former(File, Former),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        write_coverage(Out, Hits, Numbers, Times, Paths, Former),
        close(Out)).

%   run_again(+Hits, +Times, -Again): of the suites that executed something
%   and are not in Times.

run_again(Hits, Times, Again) :-
    directory_files(Hits, Files),
    findall(Name,
            ( member(File, Files),
              suite_name(File, Name),
              \+ ( member(time(Base, _, _), Times), atom_string(File, Base) )
            ),
            Names),
    (   Names == []
    ->  Again = []
    ;   with_copy(run_plainly(Names, Again))
    ).

run_plainly(Names, Again, Copy) :-
    directory_file_path(Copy, hits, Hits),
    run_suites(Copy, Names, Hits, Again).

former(File, Former) :-
    (   exists_file(File)
    ->  read_file_to_terms(File, Former, [encoding(utf8)])
    ;   Former = []
    ).

noted_program(Program) :-
    noted(Part),
    project_file(Part, Dir),
    directory_member(Dir, Path, [recursive(true), extensions([pl])]),
    project_file(Program, Path).

%   note_program(+Copy, +Program, +State0, -State): State is Next-Numbers, of
%   number(Number, Program, Predicate).

note_program(Copy, Program, Next0-Numbers0, Next-Numbers) :-
    project_file(Program, Path),
    (   file_rules(Path, rules(End, Bodies)),
        Bodies \== []
    ->  read_file_to_string(Path, Text, [encoding(utf8)]),
        findall(P, member(body(P, _, _, _), Bodies), Ps0),
        sort(Ps0, Ps),
        numbered(Ps, Program, Next0, Next, Numbers0, Numbers),
        project_file('test/mutants/hits', Hits),
        loading_text(Hits, Load),
        findall(At-New,
                ( At = End, New = Load
                ; member(body(P, Kind, Start, Stop), Bodies),
                  member(number(N, Program, P), Numbers),
                  noting(Kind, N, Start, Stop, At, New)
                ),
                Inserts0),
        msort(Inserts0, Inserts),
        inserted(Inserts, Text, 0, Parts),
        atomic_list_concat(Parts, Noting),
        write_in_copy(Copy, Program, Noting)
    ;   Next = Next0,
        Numbers = Numbers0
    ).

%   A cell has no files of test/.

loading_text(Hits, Load) :-
    format(string(Load),
           " :- catch(use_module('~w', []), error(_, _), \c
                      assertz(system:'$hit'(_))).", [Hits]).

numbered([], _, Next, Next, Numbers, Numbers).
numbered([P|Ps], Program, Next0, Next, Numbers0, Numbers) :-
    Next1 is Next0+1,
    numbered(Ps, Program, Next1, Next, [number(Next0, Program, P)|Numbers0],
             Numbers).

noting(rule, N, Start, _, Start, New) :-
    format(string(New), "system:'$hit'(~d),(", [N]).
noting(dcg, N, Start, _, Start, New) :-
    format(string(New), "{system:'$hit'(~d)},(", [N]).
noting(_, _, _, Stop, Stop, ")").

inserted([], Text, At, [Rest]) :-
    sub_string(Text, At, _, 0, Rest).
inserted([Place-New|Inserts], Text, At, [Before, New|Parts]) :-
    Length is Place-At,
    sub_string(Text, At, Length, _, Before),
    inserted(Inserts, Text, Place, Parts).

%   run_suites(+Copy, +Names, +Hits, -Times): time(Suite, Processor, Seconds) of those
%   that passed, read from what test/run.pl prints.

run_suites(Copy, Names, Hits, Times) :-
    directory_file_path(Copy, 'test/run.pl', Runner),
    directory_file_path(Copy, 'run.log', Log),
    ( Names == [] -> Args = [] ; Args = ['--'|Names] ),
    setup_call_cleanup(
        open(Log, write, Out),
        ( process_create(path(swipl), [file(Runner)|Args],
                         [ cwd(Copy), stdin(null), stdout(stream(Out)),
                           stderr(stream(Out)), process(Pid),
                           environment(['TYPHON_HITS'=Hits])
                         ]),
          process_wait(Pid, _)
        ),
        close(Out)),
    read_file_to_string(Log, Text, []),
    split_string(Text, "\n", "", Lines),
    findall(time(Suite, Processor, Seconds),
            ( member(Line, Lines),
              suite_time(Line, time(Suite, Processor, Seconds, 0)) ),
            Times).

write_coverage(Out, Hits, Numbers, Times, Paths, Former) :-
    forall(( member(Term, Former),
             arg(1, Term, Suite),
             member(Base-Suite, Paths),
             \+ memberchk(time(Base, _, _), Times)
           ),
           format(Out, '~q.~n', [Term])),
    forall(( member(time(Base, Processor, Seconds), Times),
             member(Base-Suite, Paths)
           ),
           ( format(Out, '~q.~n', [suite(Suite, Processor, Seconds)]),
             write_executed(Out, Hits, Base, Suite, Numbers)
           )).

suite_paths(Paths) :-
    all_suites(Files),
    findall(Base-Suite,
            ( member(File, Files),
              file_base_name(File, Base0),
              atom_string(Base0, Base),
              project_file(Suite, File)
            ),
            Paths).

write_executed(Out, Hits, Base, Suite, Numbers) :-
    directory_file_path(Hits, Base, File),
    (   exists_file(File)
    ->  read_file_to_terms(File, Noted, [])
    ;   Noted = []
    ),
    tests_executing(Noted, Tests, Masks),
    format(Out, '~q.~n', [tests(Suite, Tests)]),
    findall(Program-(P-Mask),
            ( member(number(N, Program, P), Numbers),
              get_assoc(N, Masks, Mask) ),
            Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    forall(member(Program-Ps, Groups),
           format(Out, '~q.~n', [executes(Suite, Program, Ps)])).

%!  tests_executing(+Noted:list, -Tests:list, -Masks) is det.
%
%   Of what hits.pl notes in one suite. Masks is an assoc from numbers of
%   predicates. What is executed before a test, and by a process that began
%   earlier, belongs to all tests of the unit.

tests_executing(Noted, Tests, Masks) :-
    findall(Test, member(begins(_, Test, _), Noted), Named0),
    list_to_set(Named0, Named),
    maplist(test_seconds(Noted), Named, Tests),
    empty_assoc(Empty),
    foldl(executed(Named), Noted, now(none, [], [], Empty),
          now(_, _, _, Masks)).

test_seconds(Noted, Test, Test-Seconds) :-
    aggregate_all(sum(End-Start), test_time(Noted, Test, Start, End), Seconds0),
    Seconds is round(1000*Seconds0)/1000.0.

%   Cases of one test begin once.

test_time(Noted, Test, Start, End) :-
    append(_, [begins(Pid, Test, Start)|Rest], Noted),
    once(( nth1(Next, Rest, begins(Pid, _, _)) ; length(Rest, Next) )),
    length(Own, Next),
    append(Own, _, Rest),
    findall(Clock, member(ends(Pid, Clock), Own), Clocks),
    last(Clocks, End).

%   now(Test, Before, Processes, Masks): Test is Named, Unit:between or `none`;
%   Before are numbers that were executed before the next test; Processes are
%   those that executed something, each Pid-Test.

executed(Named, begins(Pid, Test, _), now(_, Before, Ps, Masks0),
         now(Test, [], [Pid-main|Ps], Masks)) :-
    Test = Unit:_,
    unit_mask(Named, Unit, Mask),
    foldl(add_mask(Mask), Before, Masks0, Masks).
executed(_, ends(_, _), now(Test, Before, Ps, Masks),
         now(between(Test), Before, Ps, Masks)).
executed(Named, hit(Pid, N), now(Test, Before0, Ps0, Masks0),
         now(Test, Before, Ps, Masks)) :-
    (   memberchk(Pid-First, Ps0)
    ->  Ps = Ps0
    ;   First = Test,
        Ps = [Pid-Test|Ps0]
    ),
    (   Test = Unit:_
    ->  Before = Before0,
        (   memberchk(First, [main, Test])
        ->  nth0(Index, Named, Test),
            Mask is 1<<Index
        ;   unit_mask(Named, Unit, Mask)
        ),
        add_mask(Mask, N, Masks0, Masks)
    ;   Before = [N|Before0],
        Masks = Masks0
    ).

unit_mask(Named, Unit, Mask) :-
    aggregate_all(sum(1<<Index), nth0(Index, Named, Unit:_), Mask).

add_mask(Mask, N, Masks0, Masks) :-
    ( get_assoc(N, Masks0, Old) -> true ; Old = 0 ),
    New is Old\/Mask,
    put_assoc(N, Masks0, New, Masks).

%!  load_coverage(+File) is det.

load_coverage(File) :-
    retractall(suite(_, _, _)),
    retractall(tests(_, _)),
    retractall(executes(_, _, _)),
    read_file_to_terms(File, Terms, [encoding(utf8)]),
    forall(member(Term, Terms), assertz(Term)).

%!  suites_of(+File, +Predicate, -Suites:list) is det.
%
%   The suites with tests that execute Predicate of File, as suite(Suite,
%   Processor, Seconds, Tests), the times being those of Tests. First the suite
%   of the same place in test/, then the quickest. Of predicates that no test is
%   known to execute, such as those of facts only, the tests that execute another
%   one of File; if there are none, as for programs of agents, the suites that
%   a change of File touches, Tests being `all`. Also those of its folder that are
%   newer than the record.

suites_of(File, Predicate, Suites) :-
    findall(Suite, executing(File, Predicate, Suite), Executing0),
    (   Executing0 == []
    ->  findall(Suite, executing(File, _, Suite), Executing)
    ;   Executing = Executing0
    ),
    (   Executing == []
    ->  touched_suites([File], Touched)
    ;   Touched = []
    ),
    findall(Order-suite(Suite, Processor, Seconds, Tests),
            ( (   member(suite(Suite, Processor, Seconds, Tests), Executing)
              ;   Tests = all,
                  (   member(time(Suite, Processor, Seconds), Touched)
                  ;   newer(File, time(Suite, Processor, Seconds)),
                      \+ memberchk(time(Suite, _, _), Touched)
                  )
              ),
              order(File, Suite, Processor, Order) ),
            Pairs0),
    keysort(Pairs0, Pairs),
    pairs_values(Pairs, Suites).

executing(File, Predicate, suite(Suite, Processor, Seconds, Names)) :-
    suite(Suite, Processor0, Seconds0),
    executes(Suite, File, Masks),
    findall(Mask, member(Predicate-Mask, Masks), Own),
    foldl(united, Own, 0, Mask),
    Mask =\= 0,
    tests(Suite, Tests),
    findall(Name-Time,
            ( nth0(Index, Tests, Name-Time), getbit(Mask, Index) =:= 1 ),
            Pairs),
    pairs_keys_values(Pairs, Names, Times),
    pairs_values(Tests, AllTimes),
    sum_list(Times, Sum),
    sum_list(AllTimes, All),
    Share is (Sum+0.01)/(All+0.01),
    loading(Loading),
    Processor is min(Processor0, Loading)+Share*max(0, Processor0-Loading),
    Seconds is Seconds0*Share.

united(Mask, Mask0, Mask1) :-
    Mask1 is Mask0\/Mask.

loading(0.5).                           % seconds, of any suite

newer(File, Time) :-
    suite_times(Times),
    member(Time, Times),
    Time = time(Suite, _, _),
    \+ suite(Suite, _, _),
    same_place(File, Suite).

order(File, Suite, Processor, Place-Processor) :-
    (   mirrored(File, Suite)
    ->  Place = 1
    ;   same_place(File, Suite)
    ->  Place = 2
    ;   Place = 3
    ).

%   prolog/typhon/kernel/wire/frame.pl: test/prolog/kernel/wire/test_frame.pl

mirrored(File, Suite) :-
    file_base_name(File, Base),
    atom_concat(test_, Base, SuiteBase),
    file_base_name(Suite, SuiteBase).

same_place(File, Suite) :-
    folder(File, Folder),
    file_directory_name(Suite, Folder).

folder(File, Folder) :-
    file_directory_name(File, Dir),
    member(From-To, [ 'prolog/typhon/'-'test/prolog/',
                      'payloads/'-'test/agents/', ''-'test/' ]),
    atom_concat(From, Rest, Dir),
    !,
    atom_concat(To, Rest, Folder).
