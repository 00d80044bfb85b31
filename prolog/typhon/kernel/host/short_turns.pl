:- module(typhon_short_turns,
          [ quick_turn/2,               % +Agent, :Turn
            quick_not/2                 % +Agent, +Seconds
          ]).

:- use_module(library(lists), [member/2]).

/** <module> Agents whose turns are short

The thread that reads an agent may run it at once, rather than wake a worker, as long
as its turns are short.  Those of a kind are taken for short until one was
not, and again after a while.

Inferences tell whether a turn was long, for on a busy machine any may take
long; but of one kind hardly two of a few, unless they wait for something.

*Threading*: any thread; one mutex.
*/

:- meta_predicate quick_turn(+, 0).

:- multifile
    typhon_scheduler:kind/2.            % Agent, Kind: agents that may block alike

:- dynamic
    slow/2.                             % Kind, Until

most_inferences(20000).                 % as many as make some wake-ups
most_seconds(0.004).
few_turns(5).

%   For so many seconds it is remembered that a turn was long, or waited.

remembered(long, 1).
remembered(waits, 10).

%!  quick_turn(+Agent, :Turn) is semidet.
%
%   Call Turn, which is one of Agent; fails if that may take long.

quick_turn(Agent, Turn) :-
    typhon_scheduler:kind(Agent, Kind),
    !,
    quick(Kind),
    get_time(Time0),
    statistics(inferences, Count0),
    call(Turn),
    statistics(inferences, Count),
    get_time(Time),
    Inferences is Count-Count0,
    Seconds is Time-Time0,
    took(Inferences, Seconds, Kind).

quick(Kind) :-
    (   slow(Kind, Until)
    ->  get_time(Now),
        Now > Until
    ;   true
    ).

took(Inferences, _, Kind) :-
    most_inferences(Most),
    Inferences > Most,
    !,
    remember(long, Kind).
took(_, Seconds, Kind) :-
    nb_turn(Turn),
    most_seconds(Most),
    (   Seconds < Most
    ->  true
    ;   nb_current(typhon_long_turn, Kind-Before),
        few_turns(Few),
        Turn-Before =< Few
    ->  remember(waits, Kind)
    ;   nb_setval(typhon_long_turn, Kind-Turn)
    ).

%   Turns of this thread are counted.

nb_turn(Turn) :-
    (   nb_current(typhon_turn, Turn0)
    ->  true
    ;   Turn0 = 0
    ),
    Turn is Turn0+1,
    nb_linkval(typhon_turn, Turn).      % a number: nothing to copy

remember(What, Kind) :-
    remembered(What, Seconds),
    slow_for(Seconds, Kind).

%!  quick_not(+Agent, +Seconds) is det.
%
%   For so long no turn of the kind of Agent is taken for short.

quick_not(Agent, Seconds) :-
    (   typhon_scheduler:kind(Agent, Kind)
    ->  slow_for(Seconds, Kind)
    ;   true
    ).

slow_for(Seconds, Kind) :-
    get_time(Now),
    Until is Now+Seconds,
    with_mutex(typhon_short_turns, slow_until(Kind, Until, Now)).

slow_until(Kind, Until, _) :-
    slow(Kind, Until0),
    Until0 > Until,
    !.
slow_until(Kind, Until, Now) :-
    findall(Old, ( slow(Old, Until0), Until0 < Now ), Olds),
    forall(member(Old, [Kind|Olds]), retractall(slow(Old, _))),
    assertz(slow(Kind, Until)).
