:- module(agent_settings,
          [ setting_facts/2,            % +Options, -Facts
            known_settings/3,           % +Names, +Options, -Pairs
            unknown_setting/2           % +Names, +Pair
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(option), [option/3]).

/** <module> Settings that replace the defaults of agents

Predicates that start a mechanism have an option settings(Pairs), of Name-Value;
agents get them as facts, see parameters.pl.

*Threading*: pure.
*/

%!  setting_facts(+Options, -Facts) is det.
%
%   Facts are setting(Name, Value) for each pair of the option
%   settings(Pairs), or empty without that option.
%
%   @error type_error(list(pair), Pairs)

setting_facts(Options, Facts) :-
    pairs(Options, Pairs),
    findall(setting(Name, Value), member(Name-Value, Pairs), Facts).

%!  known_settings(+Names, +Options, -Pairs) is det.
%
%   Pairs are those of the option settings(Pairs); all names are in Names.
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
%   Raises an error: Pair has a name that is not in Names, or an invalid value.
%
%   @error domain_error(setting, Pair)

unknown_setting(Names, Pair) :-
    atomic_list_concat(Names, ', ', Known),
    atom_concat('there are ', Known, Text),
    throw(error(domain_error(setting, Pair), context(_, Text))).

pairs(Options, Pairs) :-
    option(settings(Pairs), Options, []),
    must_be(list(pair), Pairs).
