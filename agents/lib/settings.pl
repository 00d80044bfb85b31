:- module(agent_settings,
          [ setting_facts/3,            % +Predicate, +Options, -Facts
            setting_declared/2          % +Predicate, -Declared
          ]).
:- use_module('../../prolog/typhon/kernel/program/reading', [program_load/6]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [must_be/2, is_of_type/2]).
:- use_module(library(lists), [list_to_set/2, member/2, memberchk/2]).
:- use_module(library(option), [option/3]).

/** <module> Settings that replace the defaults of agents

Predicates that start a mechanism have an option settings(Pairs), of Name-Value;
agents get them as facts, see parameters.pl.  Their programs declare each by a
clause default(Name, Value, Range, About).  About is a text, which begins with
the unit, if there is one; Range is

  - range(From, To, Step)
    Numbers above 0, or from 0 on if From is 0; integers if Step is one.  A
    slider goes from From to To by Step.
  - within(From, To, Step)
    The same, but only numbers from From to To.
  - a list
    Its members; one of them may be a range.
  - a type of must_be/2

*Threading*: any thread that may wait.
*/

:- multifile
    takes/4,                    % Predicate, Programs, Own, Others: the option has the
                                % parameters of Programs, but those in Own, which
                                % Predicate sets itself.  Others, which payloads
                                % have, are `taken` or `refused`
    typhon_page_overlays:parameter/3.

%!  setting_facts(+Predicate, +Options, -Facts) is det.
%
%   Facts are setting(Name, Value) for each pair of the option
%   settings(Pairs), or empty without that option.
%
%   @error type_error(list(pair), Pairs)
%   @error domain_error(setting, Pair): unknown, or not in its range

setting_facts(Predicate, Options, Facts) :-
    option(settings(Pairs), Options, []),
    must_be(list(pair), Pairs),
    (   Pairs == []
    ->  Facts = []
    ;   setting_declared(Predicate, Declared),
        maplist(setting_fact(Predicate, Declared), Pairs, Facts)
    ).

setting_fact(_, Declared, Name-Value, setting(Name, Value)) :-
    memberchk(default(Name, _, Range, _), Declared),
    in_range(Range, Value),
    !.
setting_fact(_, Declared, Name-Value, _) :-
    memberchk(default(Name, _, Range, About), Declared),
    !,
    range_text(Range, Text),
    wrong(Name-Value, '~w is ~w: ~w', [Name, Text, About]).
setting_fact(Predicate, _, Name-Value, setting(Name, Value)) :-
    takes(Predicate, _, _, taken),
    atom(Name),
    !.
setting_fact(_, Declared, Pair, _) :-
    findall(Name, member(default(Name, _, _, _), Declared), Names),
    atomic_list_concat(Names, ', ', Known),
    wrong(Pair, 'there are ~w', [Known]).

wrong(Pair, Format, Args) :-
    format(atom(Text), Format, Args),
    throw(error(domain_error(setting, Pair), context(_, Text))).

%!  setting_declared(+Predicate, -Declared:list) is det.
%
%   Declared are default(Name, Value, Range, About), of all settings that
%   Predicate takes from agents; none if it has no such option.

setting_declared(Predicate, Declared) :-
    findall(Default,
            ( takes(Predicate, Programs, Own, _),
              member(Spec, Programs),
              program_load(Spec, program(_, _, _, Clauses), _, _, _, _),
              Default = default(Name, _, _, _),
              member(Default, Clauses),
              \+ memberchk(Name, Own) ),
            All),
    list_to_set(All, Declared).

%   The page shows them.

typhon_page_overlays:parameter(Predicate, parameter(Name, Value, Shown), About) :-
    setting_declared(Predicate, Declared),
    member(default(Name, Value, Range, About), Declared),
    ( Range = within(From, To, Step) -> Shown = range(From, To, Step) ; Shown = Range ).

                /*******************************
                *            RANGES            *
                *******************************/

in_range(range(From, _, Step), Value) =>
    of_kind(Step, Value),
    ( From > 0 -> Value > 0 ; Value >= From ).
in_range(within(From, To, Step), Value) =>
    of_kind(Step, Value),
    Value >= From,
    Value =< To.
in_range(Choices, Value), is_list(Choices) =>
    member(Choice, Choices),
    in_choice(Choice, Value),
    !.
in_range(Type, Value) =>
    is_of_type(Type, Value).

of_kind(Step, Value) :-
    ( integer(Step) -> integer(Value) ; number(Value) ).

in_choice(Choice, Value) :-
    ( is_range(Choice) -> in_range(Choice, Value) ; Choice == Value ).

is_range(range(_, _, _)).
is_range(within(_, _, _)).

range_text(range(From, _, Step), Text) =>
    kind(Step, Kind),
    ( From > 0 -> Bound = 'above 0' ; format(atom(Bound), 'from ~w on', [From]) ),
    format(atom(Text), '~w ~w', [Kind, Bound]).
range_text(within(From, To, Step), Text) =>
    kind(Step, Kind),
    format(atom(Text), '~w from ~w to ~w', [Kind, From, To]).
range_text(Choices, Text), is_list(Choices) =>
    maplist(choice_text, Choices, Texts),
    atomic_list_concat(Texts, ' or ', Text).
range_text(Type, Text) =>
    format(atom(Text), 'of type ~w', [Type]).

kind(Step, Kind) :-
    ( integer(Step) -> Kind = 'an integer' ; Kind = 'a number' ).

choice_text(Choice, Text) :-
    ( is_range(Choice) -> range_text(Choice, Text) ; Text = Choice ).
