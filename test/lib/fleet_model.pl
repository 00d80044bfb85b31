:- module(fleet_model,
          [ model_begin/1,              % -State
            model_step/5                % +Call, +Now, -Answer, +State0, -State
          ]).

/** <module> What the scripts of a fleet decide, as relations

The scripts of options/fleet/scripts/ without Redis: State maps

    lease(E)    when it lapses          gone(E)     since when it is away
    process(E)  p(Token, Epoch, Ttl, At, Journal)
    host(H)     h(E, Load, Tags)        tag(T)      known
    orphan(E)   when its journal may be opened
    agent(Id)   Hops-Address            end(Id)     N-Outcome, the Nth of its home
    parked(E)   number                  usurped(J)  true
    at(E)       of a process that listens elsewhere
    epoch, ends, last, grace            events      What-H, the last one first

Times are milliseconds.

*Threading*: pure.
*/

:- use_module(library(apply), [foldl/4]).
:- use_module(library(assoc),
              [ del_assoc/4, empty_assoc/1, gen_assoc/3, get_assoc/3,
                put_assoc/4 ]).
:- use_module(library(lists), [append/3, member/2, subtract/3]).
:- use_module(library(pairs), [pairs_values/2]).

%!  model_begin(-State) is det.

model_begin(State) :-
    empty_assoc(Empty),
    foldl(set, [epoch-0, ends-0, last-0, grace-0, events-[]], Empty, State).

set(Key-Value, State0, State) :-
    put_assoc(Key, State0, Value, State).

unset(Key, State0, State) :-
    (   del_assoc(Key, State0, _, State1)
    ->  State = State1
    ;   State = State0
    ).

is(Key, Value, State) :-
    (   ground(Key)
    ->  get_assoc(Key, State, Value)
    ;   gen_assoc(Key, State, Value)
    ).

all(Template, Key, Value, State, All) :-
    findall(Template, is(Key, Value, State), All).

event(What, Host, State0, State) :-
    is(events, Events, State0),
    set(events-[What-Host|Events], State0, State).

%!  model_step(+Call, +Now, -Answer, +State0, -State) is det.
%
%   Calls: beat(E, Token, Ttl, First, At, Journal, Recover, Hosts), of Hosts
%   H-Load-Tags; leave(E, Token); hosts(Tags); where(Ids), of Id-Hops-Address;
%   ends(Most, Ends), of Id-Outcome; park(E) and usurp(Journal), which are no
%   scripts.

model_step(beat(E, Token, _, false, _, _, _, _), _, fenced, State, State) :-
    is(process(E), p(Other, _, _, _, _), State),
    Other \== Token,
    !.
model_step(beat(_, _, _, _, _, Journal, _, _), _, usurped, State, State) :-
    is(usurped(Journal), true, State),
    !.
model_step(beat(E, Token, Ttl, _, At, Journal, Recover, Hosts), Now,
           beat(Status, Parked, Orphans), State0, State) :-
    process(E, Token, Ttl, At, Journal, Status, State0, State1),
    ( is(lease(E), _, State1) -> Back = false ; Back = true ),
    Lapses is Now+Ttl,
    set(lease(E)-Lapses, State1, State2),
    foldl(unset, [orphan(E), gone(E)], State2, State3),
    foldl(host(E, Back), Hosts, State3, State4),
    all(H, host(H), h(E, _, _), State4, Had),
    findall(H, member(H-_-_, Hosts), Has),
    subtract(Had, Has, Left),
    foldl(leaves, Left, State4, State5),
    others(Ttl, Now, State5, State6),
    orphans(Recover, Now, Orphans, State6, State),
    parked(E, State, Parked).
model_step(leave(E, Token), Now, Answer, State0, State) :-
    (   is(process(E), p(Token, _, _, _, _), State0)
    ->  Answer = 1,
        all(H, host(H), h(E, _, _), State0, Hosts),
        foldl(leaves, Hosts, State0, State1),
        foldl(unset, [lease(E), orphan(E)], State1, State2),
        at(E, E, State2, State3),
        set(gone(E)-Now, State3, State)
    ;   Answer = 0,
        State = State0
    ).
model_step(hosts(Tags), Now, Answer, State, State) :-
    (   member(Tag, Tags),
        \+ is(tag(Tag), _, State)
    ->  Answer = unknown(Tag)
    ;   findall(Load-(H-Load-Up),
                ( is(host(H), h(E, Load, Has), State),
                  subtract(Tags, Has, []),
                  state(E, Now, State, Up) ),
                Rows0),
        msort(Rows0, Rows1),
        pairs_values(Rows1, Rows),
        Answer = rows(Rows)
    ).
model_step(where(Ids), _, 1, State0, State) :-
    foldl(where, Ids, State0, State).
model_step(ends(Most, Ends), _, 1, State0, State) :-
    foldl(end(Most), Ends, State0, State).
model_step(park(E), _, done, State0, State) :-
    parked(E, State0, N0),
    N is N0+1,
    set(parked(E)-N, State0, State).
model_step(usurp(Journal), _, done, State0, State) :-
    set(usurped(Journal)-true, State0, State).

parked(E, State, N) :-
    ( is(parked(E), N0, State) -> N = N0 ; N = 0 ).

state(E, Now, State, Up) :-
    (   is(lease(E), Lapses, State),
        is(process(E), p(_, _, Ttl, _, _), State),
        Now < Lapses+Ttl
    ->  Up = up
    ;   Up = away
    ).

process(E, Token, _, At, Journal, ok, State0, State) :-
    is(process(E), p(Token, Epoch, Ttl, _, _), State0),
    !,
    set(process(E)-p(Token, Epoch, Ttl, At, Journal), State0, State1),
    at(E, At, State1, State).
process(E, Token, Ttl, At, Journal, new, State0, State) :-
    is(epoch, Epoch0, State0),
    Epoch is Epoch0+1,
    set(epoch-Epoch, State0, State1),
    set(process(E)-p(Token, Epoch, Ttl, At, Journal), State1, State2),
    at(E, At, State2, State).

at(E, At, State0, State) :-
    (   At == E
    ->  unset(at(E), State0, State)
    ;   set(at(E)-At, State0, State)
    ).

host(E, Back, H-Load-Tags, State0, State) :-
    (   is(host(H), h(E, _, _), State0)
    ->  ( Back == true -> event(back, H, State0, State1) ; State1 = State0 )
    ;   event(joined, H, State0, State1)
    ),
    findall(tag(Tag)-true, member(Tag, Tags), Known),
    foldl(set, [host(H)-h(E, Load, Tags)|Known], State1, State).

leaves(H, State0, State) :-
    unset(host(H), State0, State1),
    event(left, H, State1, State).

%   A beat looks after others, twenty times in a lease.  If no beat came for a
%   lease none lapses for another one.

others(Ttl, Now, State0, State) :-
    is(last, Last, State0),
    (   ( Now > Last+Ttl/20 ; Now < Last )
    ->  set(last-Now, State0, State1),
        grace(Ttl, Last, Now, State1, State2),
        lapses(Now, State2, State3),
        forgets(Now, State3, State)
    ;   State = State0
    ).

grace(Ttl, Last, Now, State0, State) :-
    (   Now > Last+Ttl
    ->  Until is Now+Ttl,
        set(grace-Until, State0, State)
    ;   State = State0
    ).

lapses(Now, State0, State) :-
    is(grace, Grace, State0),
    (   Now > Grace
    ->  due(lease, Now, 20, State0, Es),
        foldl(lapses_one(Now), Es, State0, State)
    ;   State = State0
    ).

lapses_one(Now, E, State0, State) :-
    unset(lease(E), State0, State1),
    set(gone(E)-Now, State1, State2),
    all(H, host(H), h(E, _, _), State2, Hosts),
    foldl(event(away), Hosts, State2, State3),
    is(process(E), p(_, _, Ttl, _, Journal), State3),
    (   Journal == ''
    ->  State = State3
    ;   Time is Now+Ttl,
        set(orphan(E)-Time, State3, State)
    ).

forgets(Now, State0, State) :-
    WeekAgo is Now-7*24*3600*1000,
    due(gone, WeekAgo, 4, State0, Es),
    foldl(forgets_one(Now), Es, State0, State).

forgets_one(Now, E, State0, State) :-
    (   is(process(E), p(_, _, _, _, ''), State0),
        parked(E, State0, 0)
    ->  all(H, host(H), h(E, _, _), State0, Hosts),
        foldl(leaves, Hosts, State0, State1),
        findall(Key, ( is(Key, _, State1), born(Key, E) ), Keys),
        foldl(unset, [gone(E), process(E), at(E)|Keys], State1, State)
    ;   set(gone(E)-Now, State0, State)
    ).

born(agent(Id), E) :-
    home(Id, E).
born(end(Id), E) :-
    home(Id, E).

home(Id, E) :-
    atomic_list_concat(Parts, @, Id),
    append(_, [E], Parts).

%   due(+What, +Until, +Most, +State, -Es): the first that are not after Until.

due(What, Until, Most, State, Es) :-
    Key =.. [What,E],
    findall(Time-E, ( is(Key, Time, State), Time =< Until ), Due0),
    msort(Due0, Due),
    (   length(First, Most),
        append(First, _, Due)
    ->  true
    ;   First = Due
    ),
    pairs_values(First, Es).

orphans(false, _, [], State, State).
orphans(true, Now, Orphans, State0, State) :-
    due(orphan, Now, 4, State0, Es),
    Next is Now+10000,
    findall(E-Journal, ( member(E, Es),
                         is(process(E), p(_, _, _, _, Journal), State0) ),
            Orphans),
    findall(orphan(E)-Next, member(E, Es), Later),
    foldl(set, Later, State0, State).

where(Id-Hops-Address, State0, State) :-
    (   is(agent(Id), Known-_, State0),
        Known > Hops
    ->  State = State0
    ;   set(agent(Id)-(Hops-Address), State0, State)
    ).

end(Most, Id-Outcome, State0, State) :-
    unset(agent(Id), State0, State1),
    (   is(end(Id), _, State1)
    ->  State = State1
    ;   is(ends, N0, State1),
        N is N0+1,
        foldl(set, [ends-N, end(Id)-(N-Outcome)], State1, State2),
        home(Id, E),
        findall(K-Old, ( is(end(Old), K-_, State2), home(Old, E) ), Olds),
        bounded(Olds, Most, State2, State)
    ).

bounded(Ends, Most, State0, State) :-
    length(Ends, Count),
    (   Count > Most
    ->  msort(Ends, [_-Oldest|_]),
        unset(end(Oldest), State0, State)
    ;   State = State0
    ).
