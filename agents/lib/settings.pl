:- module(agent_settings,
          [ setting_facts/2,            % +Options, -Facts
            known_settings/3,           % +Names, +Options, -Pairs
            unknown_setting/2           % +Names, +Pair
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(option), [option/3]).

/** <module> What replaces the defaults of agents

Predicates that start a mechanism have an option settings(Pairs), of Name-Value;
agents get them as facts, see parameters.pl.

*Threading*: pure.
*/

%!  setting_facts(+Options, -Facts) is det.
%
%   Facts are setting(Name, Value) for each of settings(Pairs) in Options,
%   if that is there.
%
%   @error type_error(list(pair), Pairs)

setting_facts(Options, Facts) :-
    pairs(Options, Pairs),
    findall(setting(Name, Value), member(Name-Value, Pairs), Facts).

%!  known_settings(+Names, +Options, -Pairs) is det.
%
%   The Pairs of Options have no other names than Names.
%
%   @error type_error(list(pair), Pairs), domain_error(setting, Pair)

known_settings(Names, Options, Pairs) :-
    pairs(Options, Pairs),
    forall(member(Pair, Pairs), known(Names, Pair)).

known(Names, Name-_) :-
    memberchk(Name, Names),
    !.
known(Names, Pair) :-
    unknown_setting(Names, Pair).

%!  unknown_setting(+Names, +Pair) is failure.
%
%   Say that Pair is none of the settings Names, or has no such value.
%
%   @error domain_error(setting, Pair)

unknown_setting(Names, Pair) :-
    atomic_list_concat(Names, ', ', Known),
    atom_concat('there are ', Known, Text),
    throw(error(domain_error(setting, Pair), context(_, Text))).

pairs(Options, Pairs) :-
    option(settings(Pairs), Options, []),
    must_be(list(pair), Pairs).
