:- module(algorithms_printers,
          [ shortfalls/3,               % +Seed, +Solutions, -Shortfalls
            settings_used/2,            % +Actions, -Settings
            mean_quality/4              % +Seed, +Hosts, +Settings, -Mean
          ]).
:- use_module('../../prolog/typhon/kernel/base/prng', []).
:- use_module(library(lists),
              [append/3, member/2, sum_list/2]).

/** <module> The quality of settings without noise

Computed after the run: agents in the network cannot know it.  The clauses of
payloads(learning/settings) are in this module, as in an agent.

*Threading*: one thread at a time.
*/

:- dynamic
    setting/2,                          % Name, Value
    here/1.                             % has no clauses

payload(_, _).

:- include('../../payloads/learning/settings').

%!  shortfalls(+Seed, +Solutions, -Shortfalls:list(number)) is det.
%
%   For each of Solutions, Host-Actions, the amount by which the quality of the
%   last settings on the printer of Host is below good; 0 if they are good.
%   Seed determines the properties of the printers.

shortfalls(Seed, Solutions, Shortfalls) :-
    findall(Shortfall,
            ( member(Host-Actions, Solutions),
              shortfall(Seed, Host, Actions, Shortfall) ),
            Shortfalls).

shortfall(Seed, Host, Actions, Shortfall) :-
    settings_used(Actions, Settings),
    mean_quality(Seed, [Host], Settings, Quality),
    known(good, Good),
    Shortfall is max(0, Good - Quality).

%!  settings_used(+Actions, -Settings) is det.
%
%   Settings are those of the last page of Actions.

settings_used(Actions, Settings) :-
    factory(Factory),
    last_settings(Actions, Factory, Settings).

%!  mean_quality(+Seed, +Hosts, +Settings, -Mean) is det.
%
%   Mean is the quality of pages with Settings on the printers of Hosts. Seed
%   determines the properties of the printers.

mean_quality(Seed, Hosts, Settings, Mean) :-
    retractall(setting(_, _)),
    assertz(setting(printers, Seed)),
    findall(Quality,
            ( member(Host, Hosts), atomic_list_concat([Printer|_], @, Host),
              quality(Printer, Settings, Quality) ),
            Qualities),
    sum_list(Qualities, Sum),
    length(Qualities, Count),
    Mean is Sum/Count.

last_settings([], Settings, Settings).
last_settings([use(Settings)|Actions], _, Last) :-
    last_settings(Actions, Settings, Last).
last_settings([set(Place, Level)|Actions], Settings0, Last) :-
    replaced(Place, Settings0, Level, Settings),
    last_settings(Actions, Settings, Last).
last_settings([again|Actions], Settings, Last) :-
    last_settings(Actions, Settings, Last).
