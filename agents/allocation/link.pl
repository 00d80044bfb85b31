/*  Links to the neighbours, for an agent that does not move: the agenda of a
    node, messages over one link, and floods.  Included in the programs of
    nodes, see node.pl.

    A message over a link takes as long as a hop of an agent would (setting
    hop_time).  It is sent at once, with the host time at which it is due;
    until then it is on the agenda of who gets it.  What is passed on was
    passed on at the time it was due, so the computer adds nothing to the
    time of a flood as long as it keeps pace.

    Each node passes a flood on once, to all neighbours but the one it came
    from: over N hosts with E links it takes 2E - (N-1) messages.

    State: peer(Host, Node) for each node there is; wave(Flood, Due), of
    floods known, -1 once they are passed on; agenda(Next, Dues) and
    item(Key, What), what is to be done when; sent(Kind, Count).
*/

                /*******************************
                *            AGENDA            *
                *******************************/

node_loop :-
    next_due(Left),
    (   receive(From-Message, Left)
    ->  heard(Message, From)
    ;   true
    ),
    do_due,
    node_loop.

next_due(Left) :-
    (   agenda(_, [Due-_|_])
    ->  now(Now),
        Left is max(0, Due - Now)
    ;   Left = inf
    ).

do_due :-
    agenda(_, [Due-_|_]),
    now(Now),
    Due =< Now,
    !,
    retract(agenda(Next, [_-Key|Rest])),
    assertz(agenda(Next, Rest)),
    retract(item(Key, What)),
    perform(What, Due),
    do_due.
do_due.

%   at(+Due, +What): have perform(What, Due) called at host time Due.

at(Due, What) :-
    retract(agenda(Key, Dues0)),
    Next is Key + 1,
    insert_due(Dues0, Due, Key, Dues),
    assertz(agenda(Next, Dues)),
    assertz(item(Key, What)).

insert_due([Due0-Key0|Rest0], Due, Key, [Due0-Key0|Rest]) :-
    Due0 =< Due,
    !,
    insert_due(Rest0, Due, Key, Rest).
insert_due(Rest, Due, Key, [Due-Key|Rest]).

after(Seconds, What) :-
    now(Now),
    Due is Now + Seconds,
    at(Due, What).

                /*******************************
                *            LINKS             *
                *******************************/

%   cross(+To, +Load, +Now) is semidet: over the link to host To.  Fails if
%   there is none, or nobody at its end, who is forgotten.

cross(To, Load, Now) :-
    neighbours(Neighbours),
    memberchk(To, Neighbours),
    peer(To, _),
    here(Here),
    transmit([To], Here, Now, Load),
    load_kind(Load, Kind),
    add_sent(Kind, 1),
    peer(To, _),
    !.

transmit([], _, _, _).
transmit([To|Tos], Here, Now, Load) :-
    link_seconds(Seconds),
    Due is Now + Seconds,
    peer(To, Node),
    (   tell(Node, link(Due, Here, Load))
    ->  true
    ;   retractall(peer(To, _))
    ),
    transmit(Tos, Here, Now, Load).

link_seconds(Seconds) :-
    (   setting(hop_time, uniform(Min, Max))
    ->  Seconds is Min + random_float*(Max - Min)
    ;   Seconds = 0
    ).

%   crossed(+Due, +From, +Load): a message from host From is here, and due
%   later.  Of a flood that is known the first to be due counts.

crossed(Due, From, flood(Id, Body)) :-
    !,
    (   wave(Id, Due0),
        Due0 =< Due
    ->  true
    ;   new_wave(Id, Due),
        at(Due, flooded(From, Id, Body))
    ).
crossed(Due, From, only(Body)) :-
    at(Due, told(From, Body)).

                /*******************************
                *            FLOODS            *
                *******************************/

%   flood(+Body): to all nodes but this one.

flood(Body) :-
    new_id(Id),
    new_wave(Id, -1),
    now(Now),
    spread(none, Id, Body, Now).

flooded(From, Id, Body, Now) :-
    (   wave(Id, -1)
    ->  true
    ;   retractall(wave(Id, _)),
        assertz(wave(Id, -1)),
        (   onward(Body, Onward)
        ->  spread(From, Id, Onward, Now)
        ;   true
        ),
        arrived(Body, From, Now)
    ).

spread(From, Id, Body, Now) :-
    here(Here),
    neighbours(Neighbours),
    others(Neighbours, From, Count, Others),
    transmit(Others, Here, Now, flood(Id, Body)),
    body_kind(Body, Kind),
    add_sent(Kind, Count).

others([], _, 0, []).
others([Host|Hosts], From, Count, Others) :-
    (   Host \== From,
        peer(Host, _)
    ->  Others = [Host|Others1],
        others(Hosts, From, Count1, Others1),
        Count is Count1 + 1
    ;   others(Hosts, From, Count, Others)
    ).

new_wave(Id, Due) :-
    (   wave(Id, _)
    ->  retractall(wave(Id, _)),
        assertz(wave(Id, Due))
    ;   parameter(memory, Most),
        keep(wave(Id, Due), wave(_, _), Most)
    ).

                /*******************************
                *            MEMORY            *
                *******************************/

%   keep(+Fact, +Any, +Most): assert Fact; of more than Most that match Any
%   the oldest goes.

keep(Fact, Any, Most) :-
    assertz(Fact),
    functor(Fact, Name, _),
    (   retract(kept(Name, Count0))
    ->  true
    ;   Count0 = 0
    ),
    (   Count0 >= Most
    ->  once(retract(Any)),
        Count = Count0
    ;   Count is Count0 + 1
    ),
    assertz(kept(Name, Count)).

%   Numbers of floods and jobs differ among nodes but for a chance of one in
%   10^5 in a network of a hundred.

first_id :-
    First is random(1<<30) << 24,
    assertz(next_id(First)).

new_id(Id) :-
    retract(next_id(Id)),
    Next is Id + 1,
    assertz(next_id(Next)).

                /*******************************
                *            COUNTS            *
                *******************************/

load_kind(only(Body), Kind) :-
    body_kind(Body, Kind).

add_sent(_, 0) :-
    !.
add_sent(Kind, Count) :-
    (   retract(sent(Kind, Count0))
    ->  true
    ;   Count0 = 0
    ),
    Count1 is Count0 + Count,
    assertz(sent(Kind, Count1)).

%   Tell the log what was sent since the last time.

account :-
    forall(retract(sent(Kind, Count)), log(communications(Kind, Count))).
