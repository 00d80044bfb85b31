:- module(sieve_rounds,
          [ plan_rounds/2,              % +Plan, -Rounds
            event_rounds/3,             % +Events, +Starts, -Rounds
            population/3,               % +Rounds, +Round, -Population
            count/5,                    % +What, +Kind, +Rounds, +Round, -N
            born/4,                     % +Rounds, ?Round, ?How, ?Kind
            kinds/2,                    % +Rounds, -Kinds
            waits/4,                    % +Rounds, +Round, ?Antigen, -Waits
            kind_name/2                 % +Kind, -Name
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/2]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> The attacks of each round, and their results

A plan is a list of Antigens-Count: each of Antigens attacks in Count
rounds.  Kinds are antibodies; bits are an atom, as '11110'.  The results are a
list of terms round(Events), one for each round; Events, in order, are

    born(How, Kind)             How is `host` or `clone`
    died(Cause, Kind)           `suppressed` or `aged`
    served(Antigen, Kind, Wait) by an agent, Wait host seconds after the
                                attack
    generated(Antigen, Kind, Wait)
                                by the host itself
    memory_cell(Kind)           a host appointed an agent

*Threading*: pure.
*/

%!  plan_rounds(+Plan, -Rounds:list) is det.
%
%   The antigens of each round.

plan_rounds(Plan, Rounds) :-
    findall(Antigens,
            ( member(Antigens-Count, Plan), between(1, Count, _) ),
            Rounds).

%!  event_rounds(+Events, +Starts:list(number), -Rounds) is det.
%
%   Events are those of a log; a round lasts from its start to the start of the
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

told(born(How, Kind), born(How, Name)) :-
    kind_name(Kind, Name).
told(died(Cause, Kind), died(Cause, Name)) :-
    kind_name(Kind, Name).
told(served(Antigen, Kind, Wait, _), served(Attacker, Name, Wait)) :-
    kind_name(Antigen, Attacker),
    kind_name(Kind, Name).
told(generated(Antigen, Kind, Wait), generated(Attacker, Name, Wait)) :-
    kind_name(Antigen, Attacker),
    kind_name(Kind, Name).
told(memory_cell(Kind), memory_cell(Name)) :-
    kind_name(Kind, Name).

%!  kind_name(+Kind, -Name) is det.
%
%   Name is all bits as one atom; any other kind is its own name.

kind_name(Kind, Name) :-
    is_list(Kind),
    Kind = [_|_],
    maplist(integer, Kind),
    !,
    atomic_list_concat(Kind, Name).
kind_name(Kind, Kind).

%!  population(+Rounds, +Round:integer, -Population) is det.
%
%   Population are pairs Count-Kind at the end of Round, in descending order.

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

%!  count(+What, ?Kind, +Rounds, +Round:integer, -N:integer) is det.
%
%   What is `population`, at the end of Round; `clone` or `host`, the number of
%   such births in Round; or `suppressed` or `aged`, the number of such deaths.
%   For all kinds if Kind is unbound.

count(population, Kind, Rounds, Round, N) :-
    !,
    population(Rounds, Round, Population),
    aggregate_all(sum(Count), member(Count-Kind, Population), N).
count(What, Kind, Rounds, Round, N) :-
    nth1(Round, Rounds, round(Events)),
    aggregate_all(count,
                  ( member(born(What, Kind), Events)
                  ; member(died(What, Kind), Events) ),
                  N).

%!  born(+Rounds, ?Round, ?How, ?Kind) is nondet.

born(Rounds, Round, How, Kind) :-
    nth1(Round, Rounds, round(Events)),
    member(born(How, Kind), Events).

%!  kinds(+Rounds, -Kinds) is det.
%
%   Kinds are all kinds that ever existed.

kinds(Rounds, Kinds) :-
    findall(Kind, born(Rounds, _, _, Kind), Kinds0),
    sort(Kinds0, Kinds).

%!  waits(+Rounds, +Round, ?Antigen, -Waits:list(number)) is det.
%
%   Waits are the waiting times of hosts under attack, including hosts that
%   generated an antibody themselves.

waits(Rounds, Round, Antigen, Waits) :-
    nth1(Round, Rounds, round(Events)),
    findall(Wait,
            ( member(served(Antigen, _, Wait), Events)
            ; member(generated(Antigen, _, Wait), Events)
            ),
            Waits).
