:- module(typhon_peers,
          [ endpoint_peer/2,            % ?Address, ?Property
            endpoint_gone/1,            % +Address
            endpoint_left/1,            % +Address
            endpoint_lasting/1,         % +Address
            endpoint_missed/2,          % +Address, ?Formal
            endpoint_flush/1,           % +Seconds
            endpoint_flush/2,           % +Seconds, +Peers
            peers_flush/1               % +Seconds
          ]).

/** <module> The state of the peers

*Threading*: any thread.
*/

:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(peer_cache, [contact/3, missed/2]).
:- use_module(connection_manager, [manager_connect/2]).
:- use_module(outbox, [session_flush/2]).
:- use_module(session,
              [ route/2, route_up/2, session/2, session_codec/2, session_key/2,
                session_proof/2, session_up/1 ]).
:- use_module(unacked, [session_pending/2]).

%!  endpoint_peer(?Address, ?Property) is nondet.
%
%   Property of the peer at Address: process(Id), the one last met there,
%   state(up or down), pending(Frames), codec(fast or text), proof(cookie or
%   certificate(Name)).

endpoint_peer(Address, process(Id)) :-
    contact(Address, Id, _),
    Id \== none.
endpoint_peer(Address, Property) :-
    route(Address, Session),
    peer_property(Property, Session).

peer_property(state(State), Session) :-
    session_key(Session, Key),
    (   session_up(Key)
    ->  State = up
    ;   State = down
    ).
peer_property(pending(Count), Session) :-
    session_pending(Session, Count).
peer_property(codec(Codec), Session) :-
    session_codec(Session, Codec).
peer_property(proof(Proof), Session) :-
    session_proof(Session, Proof).

%!  endpoint_left(+Address) is semidet.
%!  endpoint_gone(+Address) is semidet.
%
%   As far as this process knows there is no process at Address any more to
%   which it can have talked: none listened there when it last tried to
%   connect, or the one that did said goodbye. Not true of a process that
%   has been stopped, or is behind a network that is cut.

endpoint_left(Address) :-
    contact(Address, _, gone),
    \+ route_up(Address, _).

endpoint_gone(Address) :-
    endpoint_left(Address),
    \+ endpoint_lasting(Address).

%!  endpoint_lasting(+Address) is semidet.
%
%   The process that was last met at Address keeps a journal: it is not gone
%   when it ends, for it will be started again.

endpoint_lasting(Address) :-
    contact(Address, Process, _),
    Process \== none,
    sub_atom(Process, 0, _, _, j).

%!  endpoint_missed(+Address, ?Formal) is semidet.
%
%   Why no process could be reached at Address when that was last tried: `late`,
%   or the formal term of an error, as permission_error(authenticate, peer, Why)
%   or socket_error(Code, Text).

endpoint_missed(Address, Formal) :-
    missed(Address, Formal0),
    !,
    Formal = Formal0.

%!  endpoint_flush(+Seconds) is semidet.
%!  endpoint_flush(+Seconds, +Peers:list) is semidet.
%
%   Wait until all that was posted has arrived, or all to these addresses;
%   fails after Seconds.

endpoint_flush(Seconds) :-
    must_be(number, Seconds),
    get_time(Now),
    Deadline is Now+Seconds,
    forall(session(_, Session), session_flush(Session, Deadline)).

endpoint_flush(Seconds, Peers) :-
    get_time(Now),
    Deadline is Now+Seconds,
    forall(( member(Peer, Peers),
             route(Peer, Session) ),
           session_flush(Session, Deadline)).

%!  peers_flush(+Seconds) is semidet.
%
%   As endpoint_flush/1, for a process about to end: nothing is waited for that
%   cannot arrive, as no process listens at the address of the peer any more.
%   Not for hooks nor clean-up handlers, see manager_connect/2.

peers_flush(Seconds) :-
    get_time(Now),
    Deadline is Now+Seconds,
    forall(( session(_, Session),
             reachable(Session, Deadline) ),
           session_flush(Session, Deadline)).

%   One connection may just be replaced by another.

reachable(Session, _) :-
    session_key(Session, Key),
    session_up(Key),
    !.
reachable(Session, Deadline) :-
    session_pending(Session, Count),
    Count > 0,
    route(Address, Session),
    manager_connect(Address, Deadline),
    !.
