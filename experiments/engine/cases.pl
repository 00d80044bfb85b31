:- module(study_cases,
          [ study_cases/3,              % +Study, +Given, -Cases
            expected_cases/3,           % +Study, +Given, -Cases
            study_parameter/2,          % +Study, ?Name
            parameters/3,               % +Study, +Given, -Parameters
            varied/3,                   % +Study, +Cases, -Names
            case_name/3                 % +Study, +Case, -Name
          ]).
:- use_module('../../prolog/typhon/kernel/base/names', [names_proposed/3]).
:- use_module(library(apply), [exclude/3, foldl/4, maplist/3]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists), 
              [append/3, last/2, list_to_set/2, member/2, memberchk/2,
               subtract/3]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(sampling, [is_design/1, sampled_points/3]).

/** <module> The cases of a study

All combinations of the varied parameters. If a study and a file that it
includes both define a parameter, the study takes precedence.

*Threading*: no state; any thread.
*/

:- multifile
    prolog:error_message//1.

%!  study_cases(+Study, +Given:list(pair), -Cases:list(dict)) is det.
%
%   All combinations of the varied parameters, without the skipped ones, in
%   the order of the file: the first parameter varies slowest, and the sampled
%   ones, together, fastest. Given, pairs Name-Value, override the file; a
%   list is varied.
%
%   @error study_parameter(Study, Name) for a name the study does not have

study_cases(Study, Given, Cases) :-
    forall(member(Name-_, Given), must_have(Study, Name)),
    parameters(Study, Given, Parameters),
    findall(Name-Values,
            ( member(parameter(Name, Value, Why), Parameters),
              values(Why, Value, Values) ), Lists),
    points(Parameters, Points),
    findall(Name, member(parameter(Name, _, derived), Parameters), Derived),
    findall(Case, study_case(Study, Lists, Points, Derived, Case), Cases0),
    list_to_set(Cases0, Cases).

%!  expected_cases(+Study, +Given:list(pair), -Cases:list(dict)) is det.
%
%   The cases that the claims are about: those of Given, and those of the file
%   from which Given selects.  Values that are not of the file are other
%   conditions, under which the claims are tested.

expected_cases(Study, Given0, Cases) :-
    parameters(Study, [], Parameters),
    maplist(selected_from(Parameters), Given0, Given),
    study_cases(Study, Given, Cases).

selected_from(Parameters, Name-Value, Name-Values) :-
    memberchk(parameter(Name, Own, varied), Parameters),
    values(given, Value, Chosen),
    subtract(Chosen, Own, Others),
    Others \== Chosen,
    !,
    append(Own, Others, Values).
selected_from(_, Given, Given).

must_have(Study, Name) :-
    study_parameter(Study, Name),
    !.
must_have(Study, Name) :-
    throw(error(study_parameter(Study, Name), _)).

values(varied, Values, Values) :- !.
values(given, Values, Values) :- is_list(Values), !.
values(Why, _, _) :- memberchk(Why, [derived, sampled, design]), !, fail.
values(_, Value, [Value]).

%   points(+Parameters, -Points): the points of all sampled parameters; one
%   point without values if there are none.

points(Parameters, Points) :-
    findall(Name-Range, member(parameter(Name, Range, sampled), Parameters),
            Ranges),
    (   Ranges == []
    ->  Points = [[]]
    ;   memberchk(parameter(design, Design, _), Parameters),
        (   is_design(Design)
        ->  sampled_points(Ranges, Design, Points)
        ;   domain_error(study_design, Design)
        )
    ).

study_case(Study, Lists, Points, Derived, Case) :-
    choice(Lists, Pairs0),
    member(Point, Points),
    append(Pairs0, Point, Pairs),
    dict_pairs(Case0, case, Pairs),
    foldl(derive(Study), Derived, Case0, Case),
    \+ Study:skip(Case).

choice([], []).
choice([Name-Values|Lists], [Name-Value|Pairs]) :-
    member(Value, Values),
    choice(Lists, Pairs).

derive(Study, Name, Case0, Case) :-
    (   Study:derive(Name, Case0, Value)
    ->  Case = Case0.put(Name, Value)
    ;   throw(error(study_goal_failed(derive(Name)), _))
    ).

                /*******************************
                *          PARAMETERS          *
                *******************************/

%!  parameters(+Study, +Given, -Parameters:list) is det.
%
%   Parameters are parameter(Name, Value, Why) in the order of the file. Why
%   is the term of the file, `varied` or `given` (then Value may be a list),
%   `derived` (then Value is unbound), `sampled` (then Value is a range), or
%   `default` for parameters of the engine, in studies that have a network.  If
%   parameters are sampled there is also `design`, which is not a parameter of
%   cases.

parameters(Study, Given, Parameters) :-
    findall(Name, defined(Study, Name, _, _, _), Names0),
    list_to_set(Names0, Names),
    findall(parameter(Name, Value, Why),
            ( member(Name, Names),
              counts(Study, Given, Name, Value, Why) ),
            Parameters).

counts(Study, Given, design, Design, design) :-
    memberchk(design-Design, Given),
    once(clause(Study:design(_), _)),
    !.
counts(_, Given, Name, Value, given) :-
    memberchk(Name-Value, Given),
    !.
counts(Study, _, Name, Value, Why) :-
    findall(Source-(Value0-Why0), defined(Study, Name, Value0, Why0, Source),
            All),
    (   member(own-_, All)
    ->  findall(Pair, member(own-Pair, All), Pairs)
    ;   findall(Pair, member(_-Pair, All), Pairs)
    ),
    best(Pairs, Value-Why).

%   A varied parameter is not fixed; of several fixed values the last counts.

best(Pairs, Value-varied) :-
    findall(Values, member(Values-varied, Pairs), Varied),
    last(Varied, Value),
    !.
best(Pairs, Pair) :-
    exclude(is_default, Pairs, Said),
    last(Said, Pair),
    !.
best([Pair|_], Pair).

is_default(_-default).

%   defined(+Study, ?Name, -Value, -Why, -Source): the study, or a default of
%   the engine, defines Name; Source is `own` or `included`.

defined(Study, Name, Value, Why, Source) :-
    in_file(Study, Name, Value, Why, Source).
defined(Study, Name, Value, default, included) :-
    once(clause(Study:network(_, _, _), _)),
    default(Name, Value).

default(clock, virtual).
default(processes, 1).

in_file(Study, Name, Values, varied, Source) :-
    clause(Study:vary(Name, Values), Body, Clause),
    Study:Body,
    source(Study, Clause, Source).
in_file(Study, Name, Value, Why, Source) :-
    clause(Study:fixed(Name, Value, Why), Body, Clause),
    Study:Body,
    source(Study, Clause, Source).
in_file(Study, Name, Range, sampled, Source) :-
    clause(Study:sample(Name, Range), Body, Clause),
    Study:Body,
    source(Study, Clause, Source).
in_file(Study, design, Design, design, Source) :-
    clause(Study:design(Design), Body, Clause),
    Study:Body,
    source(Study, Clause, Source).
in_file(Study, Name, _, derived, Source) :-
    clause(Study:derive(Name0, _, _), _, Clause),
    atom(Name0),
    Name = Name0,
    source(Study, Clause, Source).

source(Study, Clause, Source) :-
    (   clause_property(Clause, file(Study))
    ->  Source = own
    ;   Source = included
    ).

%!  study_parameter(+Study, ?Name) is nondet.

study_parameter(Study, Name) :-
    defined(Study, Name, _, _, _).

%!  varied(+Study, +Cases, -Names:list(atom)) is det.
%
%   Names of the parameters that vary: parameters that the file varies, and
%   others that have several values in Cases.

varied(Study, Cases, Names) :-
    parameters(Study, [], Parameters),
    findall(Name,
            ( member(parameter(Name, _, Why), Parameters),
              (   memberchk(Why, [varied, sampled])
              ->  true
              ;   Why \== derived,
                  several(Name, Cases)
              ) ),
            Names).

several(Name, [Case|Cases]) :-
    get_dict(Name, Case, First),
    member(Other, Cases),
    \+ get_dict(Name, Other, First),
    !.

%!  case_name(+Study, +Case, -Name:atom) is det.
%
%   The varied parameters as text: delta=0.5,topology=ring.

case_name(Study, Case, Name) :-
    varied(Study, [], Names),
    findall(Part,
            ( member(Parameter, Names),
              get_dict(Parameter, Case, Value),
              format(atom(Part), '~w=~w', [Parameter, Value]) ),
            Parts),
    (   Parts == []
    ->  Name = case
    ;   atomic_list_concat(Parts, ',', Name)
    ).

prolog:error_message(study_parameter(Study, Name)) -->
    { file_base_name(Study, Base),
      findall(N, study_parameter(Study, N), Names) },
    no_parameter(Base, Name, Names).
prolog:error_message(existence_error(key, Name, Case)) -->
    { is_dict(Case, Tag),
      Tag == case,
      dict_pairs(Case, _, Pairs),
      pairs_keys(Pairs, Names) },
    no_parameter('A case', Name, Names).

no_parameter(Owner, Name, Names0) -->
    { sort(Names0, Names),
      names_proposed(Name, Names, Meant),
      atomic_list_concat(Names, ', ', Known) },
    [ '~w has no parameter ~q~w; it has ~w'-[Owner, Name, Meant, Known] ].
