:- module(test_project_studies,
          [ project_study/2,            % +Name, -Study
            study_names/1,              % -Names
            case_count/2,               % +Study, -Count
            invalid_claims/2,           % +Study, -Problems
            verdicts/3,                 % +Study, +Points, -Verdicts
            holding/3,                  % +Study, +Points, -Numbers
            log_measures/5,             % +Study, +Given, +Hosts, +Events,
                                        % -Measures
            first_run/5,                % +Study, +Given, +Seed, +Dir, -Point
            run_measures/2              % +Dir, -Measures
          ]).
:- use_module(common, [project_file/2]).
:- use_module('../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../experiments/engine/claims',
              [claim_holds/2, claim_shape/2]).
:- use_module('../../experiments/engine/run', [run_make/4]).
:- use_module('../../experiments/engine/store', [run_facts/2]).
:- use_module('../../experiments/engine/studies',
              [study_call/2, study_load/2, study_says/2]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [member/2, nth1/3]).

/** <module> The studies in experiments/: cases, claims, and small runs

*Threading*: the thread that loads studies.
*/

%!  project_study(+Name, -Study) is det.
%
%   Name is as in `sync/figure_5_2`.

project_study(Name, Study) :-
    atomic_list_concat(['experiments/', Name, '.pl'], Relative),
    project_file(Relative, File),
    study_load(File, Study).

%!  study_names(-Names:list(atom)) is det.
%
%   Of all studies, as in `sync/figure_5_2`.

study_names(Names) :-
    project_file(experiments, Dir),
    findall(Name,
            ( directory_member(Dir, File, [ recursive(true),
                                            extensions([pl]) ]),
              file_base_name(File, Base),
              member(Start, [figure_, table_, beyond_, study_]),
              sub_atom(Base, 0, _, _, Start),
              file_directory_name(File, Folder),
              file_base_name(Folder, Chapter),
              file_name_extension(Stem, _, Base),
              atomic_list_concat([Chapter, Stem], /, Name) ),
            Names).

%!  case_count(+Study, -Count) is det.

case_count(Study, Count) :-
    study_cases(Study, [], Cases),
    length(Cases, Count).

claims(Study, Claims) :-
    findall(Text-Test, study_call(Study, claim(Text, _, Test)), Claims).

%!  invalid_claims(+Study, -Problems:list) is det.
%
%   Parts of claims that are not tests, texts that are none, or the absence of
%   claims.

invalid_claims(Study, Problems) :-
    claims(Study, Claims),
    odd(Claims, Study, Problems).

odd([], _, [no_claims]) :-
    !.
odd(Claims, Study, Problems) :-
    findall(Text-Problem,
            ( member(Text-Test, Claims),
              (   claim_shape(Study:Test, Problem)
              ;   \+ is_text(Text),
                  Problem = text
              ) ),
            Problems).

%   An unbound variable in a text is written as `_` and digits.

is_text(Text) :-
    string(Text),
    \+ ( sub_string(Text, Before, 1, _, "_"),
         Next is Before+1,
         sub_string(Text, Next, 1, _, Char),
         char_type(Char, digit) ).

%!  verdicts(+Study, +Points, -Verdicts:list(pair)) is det.
%
%   Of each claim Text-Boolean: whether it holds.

verdicts(Study, Points, Verdicts) :-
    claims(Study, Claims),
    findall(Text-Held,
            ( member(Text-Test, Claims), held(Study, Test, Points, Held) ),
            Verdicts).

held(Study, Test, Points, true) :-
    claim_holds(Study:Test, Points),
    !.
held(_, _, _, false).

%!  holding(+Study, +Points, -Numbers:list(integer)) is det.
%
%   The numbers of the claims that hold.

holding(Study, Points, Numbers) :-
    verdicts(Study, Points, Verdicts),
    findall(N, nth1(N, Verdicts, _-true), Numbers).

%!  log_measures(+Study, +Given, +Hosts, +Events, -Measures:list(pair)) is det.
%
%   Measures are Name-Value: those of the first case with parameters Given,
%   if its network of Hosts has logged Events.

log_measures(Study, Given, Hosts, Events, Measures) :-
    study_cases(Study, Given, [Case|_]),
    Log = log{case:Case.put(seed, 1), hosts:Hosts, events:Events},
    (   study_says(Study, view/2)
    ->  once(study_call(Study, view(Log, View)))
    ;   View = Log
    ),
    findall(Name-Value, study_call(Study, measure(Name, View, Value)),
            Measures0),
    sort(Measures0, Measures).

%!  first_run(+Study, +Given, +Seed, +Dir, -Point) is det.
%
%   Make the first case with parameters Given in Dir: Case-Measures.

first_run(Study, Given, Seed, Dir, Case-Measures) :-
    study_cases(Study, Given, [Case|_]),
    run_make(Study, Case, Seed, Dir),
    run_measures(Dir, Measures).

%!  run_measures(+Dir, -Measures:dict) is det.

run_measures(Dir, Measures) :-
    run_facts(Dir, Facts),
    findall(Name-Value, member(measure(Name, Value), Facts), Pairs),
    dict_create(Measures, measures, Pairs).
