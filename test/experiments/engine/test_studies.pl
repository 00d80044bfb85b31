:- module(test_studies, []).

% The catalogue of studies, the reports about faulty ones, and the command.

:- use_module('../../lib/common').
:- use_module('../../lib/project_studies', [project_study/2, study_names/1]).
:- use_module('../../lib/study_files',
              [ study_command/4, study_messages/2, with_study/2,
                with_study_file/2, with_study_file/4 ]).
:- use_module('../../../experiments/engine/catalogue').
:- use_module('../../../experiments/engine/studies').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, nth1/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).

base([ 'study(toy, "A toy").', 'vary(a, [1, 2]).',
       'measure(m, _, 1).' ]).

loads(_).

problems(Lines, Problems) :-
    catch(( with_study(Lines, loads), Problems = [] ),
          error(study(_, Problems), _),
          true).

title(Title, Study) :-
    study_title(Study, Name, Text),
    Title = Name-Text.

has(Text, Parts) :-
    forall(member(Part, Parts),
           assertion(once(sub_string(Text, _, _, _, Part)))).

%   problems(Name, More, Problems): of the study base/1 with the lines More.

problems(arity, ['claim("small", m < 2).'], [arity(claim/2, claim/3)]).
problems(helpers_may_share_names_of_hooks, ['run(a, b, c).', 'label(a).'], []).
problems(no_values, ['vary(b, 1).'], [no_values(b)]).
problems(no_test, ['claim("small", [], smal(m)).'],
         [said(claim("small"), no_test(smal(m)))]).
problems(unknown_in_a_claim, ['claim("small", [], n < a).'],
         [said(claim("small"), unknown(n))]).
problems(unknown_value, [ 'vary(k, [grid, ring]).',
                          'claim("small", [], least(m, k=gird)).' ],
         [said(claim("small"), no_case(k=gird))]).
problems(condition_of_a_claim,
         [ 'measure(Name, _, 2) :- member(Name, [n, o]).',
           'claim("small", [], at([1=a], m < 2)).' ],
         [said(claim("small"), no_parameter(1))]).
problems(condition_of_a_printed_value,
         ['printed(m, [a=1], 3).', 'printed(m, [b=1], 3).',
          'printed(m, [1=a], 3).', 'printed(m, [], 3).'],
         [ said(printed(m), no_parameter(b)), said(printed(m), no_parameter(1))
         ]).
problems(unknown_in_a_plot,
         ['plot(p, "P", lines([x(b), y([m, n]), line(a)])).'],
         [said(plot(p), unknown(b)), said(plot(p), unknown(n))]).
problems(measures_may_have_many_names,
         [ 'measure(Name, _, 2) :- member(Name, [n, o]).',
           'claim("small", [], n < a).' ], []).
problems(parameters_may_be_derived, [ 'derive(d, Case, D) :- D is Case.a.',
                                      'claim("small", [], m < d).' ], []).
problems(option_of_a_plot, ['plot(p, "P", lines([x(a), y(m), xlabl(t)])).'],
         [said(plot(p), wrong(domain_error(lines_option, xlabl(t))))]).
problems(unknown_picture, ['plot(p, "P", bars([])).'],
         [said(plot(p), no_picture(bars([])))]).
problems(own_test_is_missing, ['claim("own", [], holds(own)).'],
         [said(claim("own"), no_test(holds(own)))]).

:- begin_tests(studies).

test(title, Title == toy-"A toy") :-
    base(Lines),
    with_study(Lines, title(Title)).
test(no_study, Problems == [missing(study/2), missing(measure/3)]) :-
    problems(['a.'], Problems).
test(problems_of_a_study, [ forall(problems(_, More, Expected)),
                            Problems == Expected ]) :-
    base(Base),
    append(Base, More, Lines),
    problems(Lines, Problems).
test(mistyped_word) :-
    base(Base),
    study_messages(problems(['labl(m, "M").'|Base], Problems), Text),
    assertion(Problems == []),
    has(Text, ["labl/2 is not a predicate of studies (did you mean label/2?)"]).
test(all_errors_are_reported) :-
    with_study_file([ 'study(toy, "A toy").', 'vary(b, 1).',
                      'measure(m, _, 1).', 'plot(p, bars([])).',
                      'claim("small", [], n < 1).',
                      'claim("large", [], big(m)).', 'a b.' ], Dir, File,
        study_command(Dir, [File], exit(1), Text)),
    has(Text, [ "study.pl is not a valid study", "it has errors",
                "vary(b, Values)", "it defines plot/2; studies have plot/3",
                "claim(\"small\"): n is neither a measure nor a parameter",
                "claim(\"large\"): big(m) is not a test" ]).

:- end_tests(studies).

%   claims(Folder, Counts): how many claims each study in a folder has.

claims(algorithms, [ beyond_cloning-3, beyond_contest-3, beyond_crews-7,
                     beyond_exchange-1,
                     beyond_islands-3, beyond_mixed-4, beyond_settings-5 ]).
claims(allocation, [ beyond_integrated-5, beyond_replacement-6,
                     beyond_sharing-6, beyond_urgent-5, figure_7_1_to_7_3-49,
                     figure_7_4-17, figure_7_5-6, study_contention-34 ]).
claims(applications, [ study_fire_alarm-5, study_fire_signs-5,
                       study_irrigation-6, study_solar-10,
                       study_warehouse-9 ]).
claims(fleet, [study_away-7]).
claims(hierarchy, [beyond_lead-7, beyond_lead_learning-4]).
claims(learning, [ figure_4_13-5, figure_4_7-16, figure_4_9-34,
                   study_bounds-10, study_light-6 ]).
claims(population, [figure_6_3-9, figure_6_4-14, table_6_1-8]).
claims(robots, [study_boxes-6, study_pole-12]).
claims(sieve, [ beyond_memory-3, beyond_programs-2, beyond_return-6,
                figure_3_3-6, figure_3_4-5, figure_3_5-5,
                study_comparisons-12 ]).
claims(sync, [ beyond_guarantee-3, beyond_selected-4, beyond_several-7,
               figure_5_11-28, figure_5_12-8, figure_5_2-6, figure_5_5-35,
               figure_5_6-18, figure_5_7-19, figure_5_8-4, figure_5_9-12,
               study_choices-7, study_demo-6, study_links-3,
               study_long_tasks-5, study_onset-3, study_readings-3,
               study_surface-14 ]).

claims_made(Folder, Counts) :-
    study_names(Names0),
    msort(Names0, Names),
    findall(Base-Count,
            ( member(Name, Names),
              atomic_list_concat([Folder, Base], /, Name),
              project_study(Name, Study),
              aggregate_all(count, study_call(Study, claim(_, _, _)), Count) ),
            Counts).

%   drawn(-Study, -Measure): a picture of lines shows Measure.

drawn(Study, Measure) :-
    study_names(Names),
    member(Name, Names),
    project_study(Name, Study),
    study_call(Study, plot(_, _, Picture)),
    ( Picture = lines(Options) ; Picture = over_time(Options) ),
    member(y(Measures), Options),
    ( is_list(Measures) -> member(Measure, Measures) ; Measure = Measures ).

named(Names, Bases) :-
    studies_named(Names, Files),
    maplist(file_base_name, Files, Bases).

:- begin_tests(catalogue).

test(each_study_of_the_project_is_valid, Text == "") :-
    study_messages(catalogue(_), Text).
test(claims_of_each_study, [ forall(claims(Folder, Counts)),
                             true(Found == Counts) ]) :-
    claims_made(Folder, Found).
test(measures_that_are_drawn_have_labels, Missing == []) :-
    findall(Study-Measure,
            ( drawn(Study, Measure),
              \+ study_call(Study, label(Measure, _)) ),
            Missing).
test(names, true(memberchk(['5.6', _], Rows))) :-
    catalogue(Rows).
test(names_are_unique, Names == Sorted) :-
    catalogue(Rows),
    findall(Name, member([Name, _], Rows), Names0),
    msort(Names0, Names),
    sort(Names0, Sorted).
test(numbers_are_in_order, Keys == [[5, 9], [5, 10], [a]]) :-
    maplist(study_catalogue:natural_key, ['5.9', '5.10', a], Keys0),
    msort(Keys0, Keys).
test(study_by_number, Bases == ['figure_5_6.pl']) :-
    named(['5.6'], Bases).
test(study_by_folder, true(memberchk('figure_5_6.pl', Bases))) :-
    named([sync], Bases).
test(studies_of_the_thesis_are_ordered_by_figure, Figures == Sorted) :-
    named([thesis], Bases),
    assertion(append(_, ['figure_4_7.pl', 'figure_4_9.pl',
                         'figure_4_13.pl', 'figure_5_2.pl'|_], Bases)),
    assertion(append(_, ['table_6_1.pl', 'figure_6_3.pl'|_], Bases)),
    findall(I, ( nth1(I, Bases, Base), member(Kind, [figure_, table_]),
                 sub_atom(Base, 0, _, _, Kind) ),
            Figures),
    length(Bases, Count),
    numlist(1, Count, Sorted).
test(studies_beyond_the_thesis_have_a_name_of_their_own) :-
    named([beyond], Bases),
    assertion(memberchk('beyond_urgent.pl', Bases)),
    forall(member(Base, Bases),
           assertion(sub_atom(Base, 0, _, _, beyond_))).
test(each_study_occurs_once, Bases == ['figure_5_6.pl']) :-
    project_file('experiments/sync/figure_5_6', File),
    named(['5.6', File, '5.6'], Bases).
test(name_identifies_one_study, Bases == ['study_readings.pl']) :-
    named([readings], Bases).
test(unknown, error(existence_error(study, '99.9'))) :-
    named(['99.9'], _).

:- end_tests(catalogue).

                /*******************************
                *            COMMAND           *
                *******************************/

command_study([ 'study(toy, "A toy").', 'vary(a, [1, 2]).',
                'vary(b, [x, \'it is\']).', 'fixed(c, 3, assumed("so")).',
                'measure(m, Log, M) :- M is 10*Log.case.a + Log.case.c.',
                'measure(n, Log, M) :- M = Log.case.b, number(M).',
                'claim("m grows", [], rises(m, along(a))).',
                'claim("n is small", [], n < 5).' ]).

:- meta_predicate with_command(2).

with_command(Goal) :-
    command_study(Lines),
    with_study_file(Lines, Goal).

prints(Args, Status, Text, Dir, File) :-
    study_command(Dir, [File|Args], Status, Text).

prints(Args, Status, Text) :-
    with_command(prints(Args, Status, Text)).

%   The output of --list is a program for the shell.

listed(Dir, File) :-
    study_command(Dir, [ File, '--list', '--runs', 2, '--out', 'o u t',
                         '--set', 'c=it\'s here', '--set', 'a=[1,2]' ],
                  exit(0), Text),
    split_string(Text, "\n", "\n", Lines),
    length(Lines, Count),
    assertion(Count == 8),
    study_command(Dir, [ File, '--list', '--runs', 1, '--out', 'o u t' ],
                  exit(0), Short),
    split_string(Short, "\n", "\n", Commands),
    forall(member(Command, Commands), assertion(shell_in('/', Command))),
    study_command(Dir, [ File, '--collect', '--runs', 1, '--out', 'o u t' ],
                  exit(0), Shown),
    has(Shown, ["1  it is     1  13", "2  x         1  23", "held"]),
    study_command(Dir, [ File, '--collect', '--runs', 2, '--out', 'o u t' ],
                  exit(1), Half),
    has(Half, ["held in 1 of 2, 1 not known m grows"]),
    forall(nth1(1, Commands, Command), assertion(shell_in('/', Command))).

shell_in(Dir, Command) :-
    process_create(path(sh), ['-c', Command],
                   [cwd(Dir), stdout(null), process(Pid)]),
    process_wait(Pid, exit(0)).

one_case(Args, Parts, Dir, File) :-
    study_command(Dir, [File, '--out', out|Args], exit(0), Text),
    has(Text, Parts),
    directory_file_path(Dir, 'out/index.html', Page),
    assertion(\+ exists_file(Page)).

%   prints(Name, Args, Status, Parts): of what the command prints about the
%   study above.

prints(help, Args, exit(0),
       ["toy: A toy", "  a          [1,2]      varied", "assumed: so"]) :-
    member(Args, [['--help'], ['--runs', 1, '--help'], ['-h', '--set', 'c=4']]).
prints(table_and_claims, ['--runs', 2, '--out', out], exit(0),
       [ "toy: A toy", "  a  b      runs   m", "2  x         2  23",
         "held, 2 runs        m grows", "n: no value",
         "claim(\"n is small\"): no run has a value of n",
         "1 of 2 claims held in all runs.", "index.html" ]).
prints(set, ['--set', 'c=[4,5]', '--set', 'a=1', '--set', 'b=x', '--runs', 1],
       exit(0), ["  a  b  c  runs   m", "  1  x  4     1  14",
                 "  1  x  5     1  15"]).
prints(last_set_counts,
       ['--set', 'a=1', '--set', 'b=x', '--set', 'a=2', '--runs', 1],
       exit(0), ["  a  b  runs   m\n  2  x     1  23\n\n"]).
prints(set_text, ['--set', 'b=Some Text', '--set', 'a=1', '--runs', 1],
       exit(0), ["  1  Some Text     1  13"]).
prints(set_half_a_term, ['--set', Set], exit(1), [Half]) :-
    member(Half, ['[1,', 'f(1', '1,2)']),
    atom_concat('a=', Half, Set).
prints(set_nothing, ['--set', Set], exit(1), ["NAME=VALUE"]) :-
    member(Set, [b, 'a=']).
prints(no_such_case, ['--case', Case], exit(1),
       ["case", "does not exist; cases are a=1,b=x  a=1,b=it is  "]) :-
    member(Case, [9, 'a=3,b=x']).
prints(no_case_in_real_time, ['--real', '--runs', 1, '--set', 'a=1'], exit(0),
       ["--real: real/2 selects none"]).
prints(no_cases_left_to_compare, ['--set', 'a=1', '--runs', 1], exit(0),
       ["not known           m grows"]).
prints(collect_of_missing_runs, ['--collect', '--out', out], exit(1),
       ["not known", "12 of 12 runs are missing"]).
prints(no_runs, [Option, 0], exit(1), []) :-
    member(Option, ['--runs', '--jobs']).

:- begin_tests(study_command).

test(command_prints, [forall(prints(_, Args, Expected, Parts))]) :-
    prints(Args, Status, Text),
    assertion(Status = Expected),
    has(Text, Parts).
test(help) :-
    with_tmp_dir(Dir, study_command(Dir, ['--help'], exit(0), Text)),
    has(Text, ["STUDY", "--runs", "--set=NAME=VALUE", "--case", "--logs",
               "--list", "--collect", "--out"]).
test(list_of_studies) :-
    with_tmp_dir(Dir, study_command(Dir, [], exit(0), Text)),
    has(Text, ["  5.6            Idle time and overlaps"]).
test(one_case,
     [forall(member(Args-Parts,
                    [ ['--case', 3]-["  m           23", "a=2,b=x,seed=1"],
                      ['--case', 'a=1,b=it is', '--seed', 4]
                      -["  m           13", "a=1,b=it is,seed=4"],
                      ['--case', 'b=x,a=2']-["a=2,b=x,seed=1"] ]))]) :-
    with_command(one_case(Args, Parts)).
test(command_names_the_folder_of_the_runs) :-
    with_command(again).
test(no_such_study) :-
    with_tmp_dir(Dir, study_command(Dir, ['99.9'], exit(1), Text)),
    has(Text, ["There is no study 99.9"]).
test(mistyped_study) :-
    with_study_file(['study(a, b).'], Dir, _,
        study_command(Dir, ['stdy.pl'], exit(1), Text)),
    has(Text, ["There is no study stdy.pl (did you mean study.pl?)"]).
test(list) :-
    with_command(listed).

:- end_tests(study_command).

again(Dir, File) :-
    study_command(Dir, [File, '--runs', 1, '--out', there], exit(0), _),
    directory_file_path(Dir, 'there/index.html', Page),
    read_file_to_string(Page, Text, [encoding(utf8)]),
    has(Text, ["--seed 1 --out there"]).
