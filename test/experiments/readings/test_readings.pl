:- module(test_readings, []).

% Readings of what the thesis does not print: which are tried, and what they make
% of the claims.

:- use_module('../../lib/common').
:- use_module('../../lib/study_files', [with_study_file/4]).
:- use_module('../../../experiments/engine/cases', [study_parameter/2]).
:- use_module('../../../experiments/engine/catalogue', [studies_named/2]).
:- use_module('../../../experiments/engine/plan', [plans/3]).
:- use_module('../../../experiments/engine/studies', [study_call/2, study_load/2]).
:- use_module('../../../experiments/readings/designs').
:- use_module('../../../experiments/readings/unprinted').
:- use_module('../../../experiments/readings/verdicts').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).

open([a-[1, 2], b-[x], c-[7]]).

%   Of the first four seeds, with the reading as it is, and with two others.

tried([ [] -      [verdict(s-one, 4, 4), verdict(s-two, 1, 4), verdict(s-three, 0, 0)],
        [a-1] -   [verdict(s-one, 1, 4), verdict(s-two, 2, 4), verdict(s-three, 1, 2)],
        [a-1, b-x] - [verdict(s-one, 4, 4), verdict(s-two, 0, 4), verdict(s-three, 2, 2)] ]).

%   A study in which a claim holds from depth 3 on.

lines([ 'study(pool, "A pool").',
        'vary(side, [1, 2]).',
        'fixed(depth, 1, assumed("no one knows")).',
        'measure(volume, Log, V) :- V is Log.case.side*Log.case.depth.',
        'claim("large", [line(7)], at([side=2], volume >= 6)).',
        'claim("small", [line(8)], at([side=1], volume < 3)).',
        'claim("mine", [line(9), ours], volume > 0).' ]).

program(Dir, File, Arguments, Text) :-
    project_file('experiments/readings.pl', Script),
    directory_file_path(Dir, out, Out),
    append([Script, --, sync, '--study', File, '--out', Out, '--jobs', 1],
           Arguments, Argv),
    with_swipl(Argv, Pid, _, Output,
               ( read_string(Output, _, Text),
                 wait_for_end(Pid, 60, Status) )),
    assertion(Status == exit(0)).

has(Text, Parts) :-
    forall(member(Part, Parts), assertion(once(sub_string(Text, _, _, _, Part)))).

:- begin_tests(readings).

test(one_value_at_a_time,
     Readings == [[], [a-1], [a-2], [b-x], [c-7]]) :-
    open(Open),
    readings(one, 1, Open, Readings).
test(each_two_values_of_different_parameters) :-
    open(Open),
    readings(pairs, 1, Open, Readings),
    findall(Reading, ( member(Reading, Readings), Reading = [_, _] ), Pairs),
    assertion(Pairs == [[a-1, b-x], [a-1, c-7], [a-2, b-x], [a-2, c-7],
                        [b-x, c-7]]).
test(drawn_readings_follow_the_seed) :-
    open(Open),
    readings(random(20), 3, Open, One),
    readings(random(20), 3, Open, Two),
    readings(random(20), 4, Open, Other),
    assertion(One == Two),
    assertion(One \== Other),
    assertion(One = [[]|_]),
    forall(( member(Reading, One), member(Name-Value, Reading) ),
           ( memberchk(Name-Values, Open),
             assertion(memberchk(Value, Values)) )),
    assertion(( member([_, _|_], One) )).
test(no_such_design, error(domain_error(design, two))) :-
    readings(two, 1, [], _).
test(half_of_the_seeds_are_enough) :-
    assertion(holds_mostly(verdict(s-c, 2, 4))),
    assertion(\+ holds_mostly(verdict(s-c, 1, 4))),
    assertion(\+ holds_mostly(verdict(s-c, 0, 0))).
test(what_a_reading_gains_and_loses, Gained-Lost == [s-two, s-three]-[s-one]) :-
    tried([_-Before, _-After|_]),
    gained(Before, After, Gained),
    gained(After, Before, Lost).
test(claims_that_some_reading_reaches,
     Found == [(s-two)-[[a-1]], (s-three)-[[a-1], [a-1, b-x]]]) :-
    tried(Tried),
    findall(Claim-Readings, reachable(Tried, Claim, Readings), Found).
test(reading_with_most_claims_is_first) :-
    tried(Tried),
    best_first(Tried, Sorted),
    assertion(Sorted = [[a-1, b-x]-_, [a-1]-_, []-_]).
test(claims_of_the_project_do_not_count, Verdicts == [verdict(s-"b", 1, 2)]) :-
    Outcome = _{ claims: [ claim("a", [line(1), ours], 2, 2, true, ''),
                           claim("b", [line(2)], 1, 2, true, ''),
                           claim("c", [line(3), formula], 2, 2, true, ''),
                           claim("d", [], 2, 2, true, '') ] },
    verdicts(s, Outcome, [], Verdicts).
test(unprinted_values_are_parameters_of_the_studies_that_decide) :-
    forall(evidence(Chapter, Named, Sets),
           ( studies_named([Named], [File]),
             study_load(File, Study),
             findall(set(Set), member(Set, Sets), Options),
             plans([Study], Options, [plan(_, _, Cases)]),
             assertion(Cases = [_|_]),
             forall(unprinted(Chapter, Name, Values, _),
                    ( assertion(study_parameter(Study, Name)),
                      forall(study_call(Study, fixed(Name, Value, Why)),
                             ( assertion(Why \= printed(_)),
                               assertion(\+ memberchk(Value, Values)) )) )) )).
test(program_tries_readings_and_records_them) :-
    lines(Lines),
    with_study_file(Lines, Dir, File,
        ( program(Dir, File, ['--reading', 'depth=3', '--reading', 'depth=2',
                         '--runs', 2],
                  Text),
          has(Text, ["Of 2 claims", "pool large\n      depth=3\n"]),
          directory_file_path(Dir, 'out/readings-sync.tsv', Table),
          read_file_to_string(Table, Rows, []),
          has(Rows, ["seeds 1 to 2\n", "# pool: sources ",
                     "as it is\tpool\tlarge\t0\t2\n",
                     "depth=3\tpool\tlarge\t2\t2\n",
                     "depth=3\tpool\tsmall\t0\t2\n"]) )).

:- end_tests(readings).
