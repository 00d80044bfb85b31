:- module(algorithms_printers,
          [ shortfalls/2                % +Runs, -Shortfalls
          ]).
:- use_module('../../prolog/typhon/paths', []).
:- use_module('../../prolog/typhon/program', [payload_load/2]).
:- use_module(library(lists), [member/2, memberchk/2]).

/** <module> How good settings are without noise

Nobody in the network can know this: it is asked when a run is over.  The
clauses of payloads(learning/settings) are in this module, as in an agent's.

*Threading*: one thread at a time.
*/

:- dynamic setting/2, carried/0.

%!  shortfalls(+Runs, -Shortfalls:list(number)) is det.
%
%   For each agent of Runs, pairs Seed-Result, that has converged, how much
%   worse than good its settings are on the printer where they were found; 0
%   if they are good.

shortfalls(Runs, Shortfalls) :-
    carry,
    findall(Shortfall,
            ( member(Seed-Result, Runs),
              memberchk(solutions(Solutions), Result),
              member(Host-Actions, Solutions),
              shortfall(Seed, Host, Actions, Shortfall) ),
            Shortfalls).

carry :-
    carried,
    !.
carry :-
    payload_load(payloads(learning/settings), payload(_, _, Clauses)),
    forall(member(Clause, Clauses), assertz(Clause)),
    assertz(carried).

shortfall(Seed, Host, Actions, Shortfall) :-
    retractall(setting(_, _)),
    assertz(setting(printers, Seed)),
    settings_of(Actions, Settings),
    atomic_list_concat([Printer|_], @, Host),
    call(quality, Printer, Settings, Quality),
    call(known, good, Good),
    Shortfall is max(0, Good - Quality).

%   What the last of the actions have set.

settings_of(Actions, Settings) :-
    call(factory, Factory),
    settings_of(Actions, Factory, Settings).

settings_of([], Settings, Settings).
settings_of([use(Settings)|Actions], _, Last) :-
    settings_of(Actions, Settings, Last).
settings_of([set(Place, Level)|Actions], Settings0, Last) :-
    call(replaced, Place, Settings0, Level, Settings),
    settings_of(Actions, Settings, Last).
settings_of([again|Actions], Settings, Last) :-
    settings_of(Actions, Settings, Last).
