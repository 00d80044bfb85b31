:- module(test_mutants, []).

/** <module> Takes something away, and looks whether a test fails

    swipl test/mutants/run.pl -- [--count N] [--seed N] [--part PART] [--jobs N]

Changes of the product, drawn at random or those that ../promises.pl declares,
each run in a copy of the project with the tests that execute the changed
predicate, until one fails, again if it is run alone, and not without the change.
Those are the tests of the file out/coverage.pl, which the first run records, in
the time of all suites; `--record` records it anew, of the suites that are named,
or of all. Changes that are not tried within `--seconds` are counted.

Printed are, of each change, the test that failed, or that it survived. The
exit status is 1 if a change survived. A change in equivalent.pl
changes nothing that can be observed, for the reason given there; it is not
drawn.

*Threading*: the main thread only.
*/

:- use_module(changes, 
              [changed_text/3, change_text/2, file_changes/2, file_rules/2]).
:- use_module(copies, [with_copy/1, write_in_copy/3, suite_in_copy/5]).
:- use_module(coverage,
              [load_coverage/1, record_coverage/2, suites_of/3]).
:- use_module(equivalent, [equivalent_change/2]).
:- use_module('../promises',
              [promise/5, promise_change/3, promising/2]).
:- use_module('../lib/changed_files', [changed_files/1]).
:- use_module('../lib/common', [project_file/2, with_tmp_dir/1]).
:- use_module('../lib/process_stat', [children_seconds/1]).
:- use_module('../../app/typhon/arguments', [arguments/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3, maplist/3, maplist/4]).
:- use_module(library(filesex),
              [directory_file_path/3, directory_member/3,
               make_directory_path/1]).
:- use_module(library(lists), [append/2, member/2, nth1/3, numlist/3]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(random), [random_permutation/2]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_file_to_terms/3]).

:- initialization(main, main).

opt_type(count, count, nonneg).
opt_type(seed, seed, nonneg).
opt_type(part, part, oneof([kernel,options,network,tools,bridges,agents,
                            experiments,app,security,all,
                            declared])).
opt_type(record, record, boolean).
opt_type(jobs, jobs, nonneg).
opt_type(only, only, atom).
opt_type(worker, worker, atom).
opt_type(documents, documents, atom).
opt_type(seconds, seconds, nonneg).
opt_type(touched, touched, atom).
opt_type(until, until, float).
opt_help(count, 'changes at random (default 300)').
opt_help(seed, 'of the draw (default 1)').
opt_help(part, 'of the product (default all); declared: those of promises.pl').
opt_help(record, 'record anew which suites execute what').
opt_help(jobs, 'changes at a time (default 2)').
opt_help(only, 'only the declared change of this name').
opt_help(worker, 'try the changes in this file').
opt_help(documents, 'of the declared, those of these: security,wire').
opt_help(seconds, 'begin no change later, in random order').
opt_help(touched, 'only if a file of this part was changed').
opt_help(until, 'of a worker: the end of --seconds').

%   The suites that run for one change take about this long, in seconds of
%   processor time.

budget(45).

%   part(Part, Start): files of Part begin with Start.

part(kernel, 'prolog/typhon/kernel/').
part(options, 'prolog/typhon/options/').
part(network, 'prolog/typhon/network/').
part(tools, 'prolog/typhon/tools/').
part(bridges, 'prolog/typhon/bridges/').
part(agents, 'agents/').
part(agents, 'payloads/').
part(experiments, 'experiments/').
part(app, 'app/').
part(security, 'prolog/typhon/kernel/wire/kinds.pl').
part(security, 'prolog/typhon/kernel/wire/handshake').
part(security, 'prolog/typhon/kernel/host/rights.pl').
part(security, 'prolog/typhon/kernel/program/libraries.pl').
part(security, 'prolog/typhon/options/access').
part(security, 'prolog/typhon/options/cell').
part(security, 'prolog/typhon/options/guard').
part(security, 'prolog/typhon/options/identity').
part(security, 'prolog/typhon/options/keys').
part(security, 'prolog/typhon/options/quotas').
part(security, 'prolog/typhon/options/tls').
part(security, 'prolog/typhon/options/trail').
part(security, 'prolog/typhon/tools/page').
part(all, Start) :-
    member(Part, [ kernel, options, network, tools, bridges, agents,
                   experiments, app ]),
    part(Part, Start).

main(Argv) :-
    arguments(Argv, Names, Options),
    (   option(worker(File), Options)
    ->  option(until(Until), Options, 1.0e12),
        with_copy(work_beside(File, Until))
    ;   mutants([names(Names)|Options], Status),
        halt(Status)
    ).

mutants(Options, 0) :-
    option(record(true), Options),
    !,
    option(names(Names), Options),
    record(Names).
mutants(Options, 0) :-
    option(touched(Part), Options),
    changed_files(Files),
    \+ ( member(File, Files), in_part(Part, File) ),
    !,
    format("no file of ~w was changed~n", [Part]).
mutants(Options, Status) :-
    get_time(Now),
    option(seconds(Seconds), Options, 1.0e9),
    Until is Now+Seconds,
    chosen(Options, Mutants0),
    in_order(Options, Mutants0, Mutants),
    (   member(mutant(_, _, executing), Mutants),
        \+ recorded
    ->  record([])
    ;   true
    ),
    with_tmp_dir(try(Mutants, Options, Until, Results)),
    report(Mutants, Results, Status).

%   Another seed tries other changes, if there is no time for all.

in_order(Options, Mutants0, Mutants) :-
    option(seconds(_), Options),
    !,
    option(seed(Seed), Options, 1),
    set_random(seed(Seed)),
    random_permutation(Mutants0, Mutants).
in_order(_, Mutants, Mutants).

recorded :-
    project_file('out/coverage.pl', File),
    exists_file(File).

record(Names) :-
    project_file(out, Out),
    make_directory_path(Out),
    directory_file_path(Out, 'coverage.pl', File),
    format("recording which suites execute what, in ~w~n", [File]),
    flush_output,
    record_coverage(File, Names).

                /*******************************
                *            CHOICE            *
                *******************************/

%   mutant(Name, Change, Suites): Suites of a declared one, or `executing`.

chosen(Options, Mutants) :-
    option(only(Name), Options),
    !,
    promise_change(Name, Change, Suites),
    Mutants = [mutant(Name, Change, Suites)].
chosen(Options, Mutants) :-
    option(part(declared), Options),
    !,
    findall(mutant(Name, Change, Suites),
            ( promise_of(Options, Name),
              promise_change(Name, Change, Suites) ),
            Mutants).
chosen(Options, Mutants) :-
    option(part(Part), Options, all),
    option(count(Count), Options, 300),
    option(seed(Seed), Options, 1),
    findall(File, part_program(Part, File), Files0),
    sort(Files0, Files),
    maplist(program_changes, Files, Lists),
    append(Lists, Changes),
    set_random(seed(Seed)),
    random_permutation(Changes, Shuffled),
    exclude(is_equivalent, Shuffled, Different),
    first(Count, Different, Drawn),
    findall(mutant(N, Change, executing), nth1(N, Drawn, Change), Mutants).

promise_of(Options, Name) :-
    (   option(documents(Names), Options)
    ->  atomic_list_concat(List, ',', Names),
        member(Base, List),
        promising(Base, Document)
    ;   true
    ),
    promise(Name, Document, _, _, _).

is_equivalent(Change) :-
    equivalent_change(Change, _).

part_program(Part, File) :-
    member(Top, [prolog, agents, payloads, experiments, app]),
    project_file(Top, Dir),
    directory_member(Dir, Path, [recursive(true), extensions([pl])]),
    project_file(File, Path),
    in_part(Part, File),
    File \== 'prolog/typhon/kernel/base/index.pl'. % generated, see make check

in_part(Part, File) :-
    part(Part, Start),
    sub_atom(File, 0, _, _, Start).

program_changes(File, Changes) :-
    project_file(File, Path),
    file_changes(Path, Changes0),
    maplist(set_file(File), Changes0, Changes).

set_file(File, change(_, S, E, New, Kind, P, Line),
         change(File, S, E, New, Kind, P, Line)).

first(Count, List, First) :-
    length(List, Length),
    N is min(Count, Length),
    length(First, N),
    append([First, _], List).

                /*******************************
                *            TRIALS            *
                *******************************/

%   Workers are processes, each with a copy; they take turns.

try(Mutants, Options, Until, Results, Dir) :-
    option(jobs(Jobs), Options, 2),
    numlist(1, Jobs, Workers),
    maplist(start_worker(Dir, Jobs, Until, Mutants), Workers, Pids, Files),
    forall(member(Pid, Pids), process_wait(Pid, _)),
    findall(Result,
            ( member(File, Files),
              read_file_to_terms(File, Terms, [encoding(utf8)]),
              member(Result, Terms)
            ),
            Results).

start_worker(Dir, Jobs, Until, Mutants, Worker, Pid, Results) :-
    findall(Mutant,
            ( nth1(N, Mutants, Mutant), N mod Jobs =:= Worker mod Jobs ),
            Own),
    format(atom(File), '~w/worker~d', [Dir, Worker]),
    atom_concat(File, '.results', Results),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        forall(member(Mutant, Own), format(Out, '~q.~n', [Mutant])),
        close(Out)),
    project_file('test/mutants/run.pl', Run),
    process_create(path(swipl),
                   [file(Run), '--', '--worker', file(File), '--until', Until],
                   [ stdin(null), process(Pid) ]).

%   One copy stays unchanged.

:- dynamic unchanged/1.

work_beside(File, Until, Unchanged) :-
    assertz(unchanged(Unchanged)),
    with_copy(work(File, Until)).

work(File, Until, Copy) :-
    read_file_to_terms(File, Mutants, [encoding(utf8)]),
    project_file('out/coverage.pl', Coverage),
    ( exists_file(Coverage) -> load_coverage(Coverage) ; true ),
    atom_concat(File, '.results', Results),
    setup_call_cleanup(
        open(Results, write, Out, [encoding(utf8)]),
        forall(( member(Mutant, Mutants), left(Until, _) ),
               try_one(Copy, Until, Mutant, Out)),
        close(Out)).

%   left(+Until, -Seconds) is semidet.

left(Until, Seconds) :-
    get_time(Now),
    Seconds is Until-Now,
    Seconds > 0.

%   A change whose suites were cut off is not tried.

try_one(Copy, Until, mutant(Name, Change, Suites0), Out) :-
    change_suites(Suites0, Change, Suites),
    Change = change(File, _, _, _, _, _, _),
    project_file(File, Path),
    read_file_to_string(Path, Text, [encoding(utf8)]),
    changed_text(Text, Change, Changed0),
    without_style_warnings(Path, Changed0, Changed),
    get_time(Start),
    children_seconds(Before),
    setup_call_cleanup(
        write_in_copy(Copy, File, Changed),
        outcome(Suites, Copy, Until, Outcome),
        write_in_copy(Copy, File, Text)),
    get_time(End),
    children_seconds(After),
    Seconds is End-Start,
    Processor is After-Before,
    change_text(Change, Line),
    note_outcome(Out, Name, Line, Outcome, times(Seconds, Processor)).

note_outcome(_, _, _, cut_off, _) :-
    !.
note_outcome(Out, Name, Line, Outcome, Times) :-
    format(Out, '~q.~n', [result(Name, Line, Outcome, Times)]),
    flush_output(Out),
    print_outcome(Name, Line, Outcome, Times),
    flush_output.

change_suites(executing, change(File, _, _, _, _, Predicate, _), Suites) :-
    !,
    suites_of(File, Predicate, Suites0),
    within_budget(Suites0, 0, Suites).
change_suites(Names, _, Suites) :-
    findall(suite(Name, 60, 120, all), member(Name, Names), Suites).

within_budget([], _, []).
within_budget([suite(S, P, T, Tests)|Suites0], Sum0, Suites) :-
    Sum is Sum0+P,
    budget(Budget),
    (   Sum =< Budget
    ->  Suites = [suite(S, P, T, Tests)|Suites1],
        within_budget(Suites0, Sum, Suites1)
    ;   Sum0 =:= 0
    ->  Suites = [suite(S, P, T, Tests)]
    ;   Suites = []
    ).

outcome([], _, _, survived) :-
    !.
outcome(_, _, Until, cut_off) :-
    \+ left(Until, _),
    !.
outcome([suite(Suite, Processor, Seconds, Tests)|Suites], Copy, Until, Outcome) :-
    Limit is ceiling(8+3*Processor),
    left(Until, Left),
    Deadline is min(Left, 60+5*Seconds),
    suite_in_copy(Copy, Suite, Tests, limits(Limit, Deadline), Result),
    (   Result == killed(hangs),
        \+ left(Until, _)
    ->  Outcome = cut_off
    ;   Result = killed(Test),
        is_witness(Copy, Suite, Test, limits(Limit, Deadline))
    ->  Outcome = killed(Suite, Test)
    ;   outcome(Suites, Copy, Until, Outcome)
    ).

%   A test that fails is a witness if it fails again, and not in the project as
%   it is: on a busy machine tests may be late, or cannot run in a copy.

is_witness(Copy, Suite, Unit:Test, Limits) :-
    !,
    without_case(Unit:Test, Unit:Name),
    suite_in_copy(Copy, Suite, [Unit:Name], Limits, killed(_)),
    passes_unchanged(Suite, Unit:Name, Limits).
is_witness(_, _, _, _).

without_case(Unit: @(Name, _), Plain) :-
    !,
    Plain = Unit:Name.
without_case(Test, Test).

:- dynamic passed_unchanged/2.          % Suite, Test

passes_unchanged(Suite, Test, _) :-
    passed_unchanged(Suite, Test),
    !.
passes_unchanged(Suite, Test, Limits) :-
    unchanged(Copy),
    suite_in_copy(Copy, Suite, [Test], Limits, passed),
    assertz(passed_unchanged(Suite, Test)).

%   A variable that occurs once, since a goal is left out, is no test.  The file
%   of an agent takes no directives but its own.

without_style_warnings(Path, Text0, Text) :-
    file_rules(Path, rules(End, _)),
    !,
    sub_string(Text0, 0, End, _, Before),
    sub_string(Text0, End, _, 0, After),
    atomics_to_string(
        [ Before,
          " :- style_check(-singleton), style_check(-discontiguous).", After ],
        Text).
without_style_warnings(_, Text, Text).

atomics_to_string(Parts, String) :-
    atomic_list_concat(Parts, Atom),
    atom_string(Atom, String).

                /*******************************
                *            REPORT            *
                *******************************/

print_outcome(Name, Line, killed(Suite, Test), times(Seconds, Processor)) :-
    without_case(Test, Plain),
    format("~w killed ~1fs ~1fs of processor by ~w ~p~n    ~s~n",
           [Name, Seconds, Processor, Suite, Plain, Line]).
print_outcome(Name, Line, survived, times(Seconds, Processor)) :-
    format("~w SURVIVED ~1fs ~1fs of processor~n    ~s~n",
           [Name, Seconds, Processor, Line]).

report(Mutants, Results, Status) :-
    aggregate_all(count, member(result(_, _, killed(_, _), _), Results),
                  Killed),
    length(Results, All),
    length(Mutants, Chosen),
    Untried is Chosen-All,
    ( Untried > 0 -> format("~d not tried in time~n", [Untried]) ; true ),
    aggregate_all(sum(P), member(result(_, _, _, times(_, P)), Results), Spent),
    format("~d of ~d killed, in ~0f s of processor~n", [Killed, All, Spent]),
    forall(member(result(Name, Line, survived, _), Results),
           format("survived: ~w ~s~n", [Name, Line])),
    (   Killed =:= All
    ->  Status = 0
    ;   Status = 1
    ).
