% Expects: lib, common; agenda, memory; body_kind/2, onward/2, arrived/3.
% Gives: cross/3, crossed/3, flood/1, flooded/4; its state.

/*  Messages over one link, and floods, for an agent that does not move.

    A message over a link takes as long as a hop of an agent (setting
    hop_time).  It is sent at once, with the host time at which it is due;
    until then it is on the agenda of the receiver.  A node passes a message
    on with the time at which it was due, so the computer adds nothing to the
    time of a flood as long as it keeps pace.

    A node sends to all neighbours at once.  With the setting `sending`
    one_by_one(Share) it has one channel: it sends a message when the previous
    one is due, and each takes this share of the time of a hop, so that many
    messages take long (thesis section 7.6.1 names bandwidth).

    Each node passes a flood on once, to all neighbours but the one that sent
    it: over N hosts with E links it takes 2E - (N-1) messages.  Two nodes
    often send each other the same flood.  The later node already has the
    earlier message, though it is not yet due: its own message would be a
    duplicate, so it is counted but not sent.

        peer(Host, Node)        all other nodes
        wave(Flood, Due, Froms) a known flood; Due is -1 once it is passed on;
                                Froms are the neighbours that sent it
        busy(Until)             when the only channel becomes free
*/

:- dynamic peer/2, wave/3, busy/1.

                /*******************************
                *            LINKS             *
                *******************************/

%!  cross(+To, +Body, +Now) is semidet.
%
%   Sends Body over the link to host To.  Fails if there is no link, or no
%   node at its end; then the node is removed from the peers.

cross(To, Body, Now) :-
    neighbours(Neighbours),
    memberchk(To, Neighbours),
    peer(To, _),
    here(Here),
    transmit([To], Here, Now, only(Body)),
    body_kind(Body, Kind),
    count(Kind, 1),
    peer(To, _),
    !.

transmit([], _, _, _).
transmit([To|Tos], Here, Now, Load) :-
    due(Now, Due),
    peer(To, Node),
    (   tell(Node, link(Due, Here, Load))
    ->  true
    ;   retractall(peer(To, _))
    ),
    transmit(Tos, Here, Now, Load).

%   due(+Now, -Due): Due is the time at which a message sent now arrives.

due(Now, Due) :-
    parameter(sending, Sending),
    link_seconds(Seconds),
    due(Sending, Seconds, Now, Due).

due(at_once, Seconds, Now, Due) :-
    Due is Now + Seconds.
due(one_by_one(Share), Seconds, Now, Due) :-
    (   retract(busy(Until))
    ->  true
    ;   Until = Now
    ),
    Due is max(Now, Until) + Share*Seconds,
    assertz(busy(Due)).

link_seconds(Seconds) :-
    (   setting(hop_time, uniform(Min, Max))
    ->  Seconds is Min + random_float*(Max - Min)
    ;   Seconds = 0
    ).

%!  crossed(+Due, +From, +Load) is det.
%
%   Schedules a message from host From for the time Due.  Of a flood that is
%   already known only the earliest due time counts.

crossed(Due, From, flood(Id, Body)) :-
    !,
    (   retract(wave(Id, Due0, Froms))
    ->  Due1 is min(Due0, Due),
        assertz(wave(Id, Due1, [From|Froms]))
    ;   Due0 = inf,
        new_wave(Id, Due, [From])
    ),
    (   Due0 =< Due
    ->  true
    ;   at(Due, flooded(From, Id, Body))
    ).
crossed(Due, From, only(Body)) :-
    at(Due, told(From, Body)).

                /*******************************
                *            FLOODS            *
                *******************************/

%!  flood(+Body) is det.
%
%   Sends Body to all other nodes.

flood(Body) :-
    new_id(Id),
    new_wave(Id, -1, []),
    now(Now),
    spread(none, [], Id, Body, Now).

%!  flooded(+From, +Id, +Body, +Now) is det.
%
%   Handles a flood that is due.

flooded(From, Id, Body, Now) :-
    (   wave(Id, Due, Froms),
        Due \== -1
    ->  retract(wave(Id, Due, Froms)),
        assertz(wave(Id, -1, Froms)),
        (   onward(Body, Onward)
        ->  spread(From, Froms, Id, Onward, Now)
        ;   true
        ),
        arrived(Body, From, Now)
    ;   true
    ).

spread(From, Froms, Id, Body, Now) :-
    here(Here),
    neighbours(Neighbours),
    others(Neighbours, From, Count, Others),
    subtract(Others, Froms, Tos),
    transmit(Tos, Here, Now, flood(Id, Body)),
    spare(Tos, Count, Now),
    body_kind(Body, Kind),
    count(Kind, Count).

%   A message that is counted but not sent also occupies the channel.

spare(Tos, Count, Now) :-
    length(Tos, Sent),
    Spared is Count - Sent,
    (   parameter(sending, at_once)
    ->  true
    ;   forall(between(1, Spared, _), due(Now, _))
    ).

others([], _, 0, []).
others([Host|Hosts], From, Count, Others) :-
    (   Host \== From,
        peer(Host, _)
    ->  Others = [Host|Others1],
        others(Hosts, From, Count1, Others1),
        Count is Count1 + 1
    ;   others(Hosts, From, Count, Others)
    ).

new_wave(Id, Due, Froms) :-
    parameter(memory, Most),
    make_room(wave(_, _, _), Most),
    assertz(wave(Id, Due, Froms)).
