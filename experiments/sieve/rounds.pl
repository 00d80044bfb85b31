:- module(sieve_rounds,
          [ plan/2,                     % ?Figure, -Plan
            plan_rounds/2,              % +Plan, -Rounds
            application/2,              % +Figure, -Payload
            event_rounds/3,             % +Events, +Starts, -Rounds
            population/3,               % +Rounds, +Round, -Population
            born/4,                     % +Rounds, ?Round, ?How, ?Kind
            waits/4                     % +Rounds, +Round, +Antigen, -Waits
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> What is attacked in each round, and what came of it

A plan is a list of Antigens-Count: in so many rounds each of Antigens
attacks.  Kinds are antibodies.  What happened is a list of terms
round(Events), one for each round; Events, in order, are

    born(How, Kind)             How is `host` or `clone`
    died(Cause, Kind)           `suppressed` or `aged`
    served(Antigen, Kind, Wait) by an agent, Wait host seconds after the
                                attack
    generated(Antigen, Kind, Wait)
                                by the host itself
    memory_cell(Kind)           an agent was appointed

*Threading*: pure.
*/

%!  plan(?Figure, -Plan) is nondet.
%
%   The antigens of the figures of thesis section 3.6, and of those for
%   memory cells and programs.

plan('3.3', [First-15]) :-
    First = [[0,0,0,0,0], [1,1,1,1,1], [1,0,1,0,1]].
plan('3.4', [First-15]) :-
    close_antigens(First).
plan('3.5', [First-5, Second-5]) :-
    close_antigens(First),
    Second = [[1,1,1,0,0], [1,1,1,0,1], [1,1,0,0,1]].
plan(memory, [[[0,0,0,0,0]]-5, [[1,1,1,1,1]]-8, [[0,0,0,0,0]]-3]).
plan(programs, [[block(left), corner(right), corridor(left)]-12]).

close_antigens([[0,0,0,0,0], [0,0,0,0,1], [0,0,0,1,1]]).

%!  application(+Figure, -Payload) is det.
%
%   What is sieved.

application(programs, payloads(sieve/maze)) :-
    !.
application(_, payloads(sieve/bits)).

%!  plan_rounds(+Plan, -Rounds:list) is det.
%
%   The antigens of each round.

plan_rounds(Plan, Rounds) :-
    findall(Antigens,
            ( member(Antigens-Count, Plan), between(1, Count, _) ),
            Rounds).

%!  event_rounds(+Events, +Starts:list(number), -Rounds) is det.
%
%   Events are those of a log; a round lasts from its start to that of the
%   next one.

event_rounds(Events, Starts, Rounds) :-
    findall(round(Whats),
            ( nth1(R, Starts, From),
              R1 is R + 1,
              ( nth1(R1, Starts, To) -> true ; To = inf ),
              findall(What, within(Events, From, To, What), Whats)
            ),
            Rounds).

within(Events, From, To, What) :-
    member(event(Time, _, _, Told), Events),
    Time >= From,
    Time < To,
    told(Told, What).

told(born(How, Kind), born(How, Kind)).
told(died(Cause, Kind), died(Cause, Kind)).
told(served(Antigen, Kind, Wait, _), served(Antigen, Kind, Wait)).
told(generated(Antigen, Kind, Wait), generated(Antigen, Kind, Wait)).
told(memory_cell(Kind), memory_cell(Kind)).

%!  population(+Rounds, +Round:integer, -Population) is det.
%
%   Population are pairs Count-Kind at the end of Round, the most numerous
%   first.

population(Rounds, Round, Population) :-
    findall(Kind-Change,
            ( nth1(R, Rounds, round(Events)),
              R =< Round,
              member(Event, Events),
              change(Event, Kind, Change)
            ),
            Changes0),
    keysort(Changes0, Changes),
    foldl(add, Changes, [], Counts),
    pairs_keys_values(Counts, Kinds, Numbers),
    pairs_keys_values(Population0, Numbers, Kinds),
    findall(N-K, ( member(N-K, Population0), N > 0 ), Population1),
    sort(1, @>=, Population1, Population).

change(born(_, Kind), Kind, 1).
change(died(_, Kind), Kind, -1).

add(Kind-Change, [Kind-Count0|Counts], [Kind-Count|Counts]) :-
    !,
    Count is Count0 + Change.
add(Kind-Change, Counts, [Kind-Change|Counts]).

%!  born(+Rounds, ?Round, ?How, ?Kind) is nondet.

born(Rounds, Round, How, Kind) :-
    nth1(Round, Rounds, round(Events)),
    member(born(How, Kind), Events).

%!  waits(+Rounds, +Round, +Antigen, -Waits:list(number)) is det.
%
%   How long hosts under attack waited, also those that had to help
%   themselves.

waits(Rounds, Round, Antigen, Waits) :-
    nth1(Round, Rounds, round(Events)),
    findall(Wait,
            ( member(served(Antigen, _, Wait), Events)
            ; member(generated(Antigen, _, Wait), Events)
            ),
            Waits).
