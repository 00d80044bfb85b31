:- module(typhon_peer_cache,
          [ peer_met/2,                 % +Address, +Process
            peer_gone/1,                % +Address
            peer_missed/2,              % +Address, +Formal
            peer_expect/1,              % +Address
            peer_expect_no_more/1,      % +Address
            peer_expected/1,            % +Address
            endpoint_peer/2,            % ?Address, ?Property
            endpoint_gone/1,            % +Address
            endpoint_left/1,            % +Address
            endpoint_lasting/1,         % +Address
            endpoint_missed/2,          % +Address, ?Formal
            endpoint_proof/2            % +Peer, -Proof
          ]).

/** <module> Peers: addresses, processes and proofs

Records which process was last met at an address, and whether it has left:
nothing listens there now, or it has sent `bye`. A process that is silent, or
behind a cut network, has not left. If no peer could be reached, the last
error is recorded. The number of addresses is bounded, the oldest are discarded.

*Threading*: any thread; a mutex serializes changes.
*/

:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/bounds', [bounded/3]).
:- use_module('../base/durable', [durable/5, durable_drop/3, durable_put/4]).
:- use_module(session,
              [ route/2, route_up/2, session_codec/2, session_key/2,
                session_pending/2, session_proof/2, session_up/1 ]).
:- use_module(transport, [transport_proof/1, transport_unknown/1]).

:- setting(contacts, positive_integer, 10000,
           "Addresses of which the last process met is remembered").

:- dynamic
    last_process/3,                     % Address, Process last met there or
                                        % `none`, `met` or `gone`
    missed/2,                           % Address, Formal
    peer_expected/1.                    % Address

%!  peer_met(+Address, +Process) is det.
%
%   Record that Process is at Address.

peer_met(Address, Process) :-
    with_mutex(typhon_peer_cache,
               ( note(Address, Process, met),
                 retractall(missed(Address, _)) )).

%!  peer_gone(+Address) is det.
%
%   Record that the process at Address has left.

peer_gone(Address) :-
    with_mutex(typhon_peer_cache,
               ( last_met(Address, Process),
                 note(Address, Process, gone) )).

%!  peer_missed(+Address, +Formal) is det.
%
%   Record that no process could be reached at Address because of error Formal.

peer_missed(Address, Formal) :-
    with_mutex(typhon_peer_cache,
               ( retractall(missed(Address, _)),
                 bounded(missed(_, _), typhon_peer_cache:contacts,
                         assertz(missed(Address, Formal))) )).

%!  peer_expected(+Address) is semidet.
%
%   If no process is at Address, one soon will be: its owner restarts it.

%!  peer_expect(+Address) is det.
%
%   Make peer_expected/1 true.

peer_expect(Address) :-
    with_mutex(typhon_peer_cache,
               ( retractall(peer_expected(Address)),
                 assertz(peer_expected(Address)) )).

%!  peer_expect_no_more(+Address) is det.
%
%   Make peer_expected/1 false.

peer_expect_no_more(Address) :-
    with_mutex(typhon_peer_cache, retractall(peer_expected(Address))).

last_met(Address, Process) :-
    last_process(Address, Process, _),
    !.
last_met(_, none).

note(Address, Process, State) :-
    last_process(Address, Process, State),
    !.
note(Address, Process, State) :-
    findall(Old, clause(last_process(Address, _, _), true, Old), Olds),
    assertz(last_process(Address, Process, State)),
    forall(member(Old, Olds), erase(Old)),
    note_lasting(Process, Address),
    forget_oldest.

%   After a restart this process must still know that the other one is restarted
%   when it ends.

note_lasting(Process, Address) :-
    sub_atom(Process, 0, _, _, j),
    !,
    durable_put(lasting, Address, 0, Process).
note_lasting(none, _) :-
    !.
note_lasting(_, Address) :-
    durable_drop(lasting, Address, 0).

:- durable(lasting, Address, 0, Process, last_process(Address, Process, met)).

forget_oldest :-
    predicate_property(last_process(_, _, _), number_of_clauses(Count)),
    setting(contacts, Max),
    Excess is Count-Max,
    forall(between(1, Excess, _),
           ignore(retract(last_process(_, _, _)))).

		 /*******************************
		 *          PROPERTIES          *
		 *******************************/

%!  endpoint_peer(?Address, ?Property) is nondet.
%
%   Property of the peer at Address: process(Id), the last one met there,
%   state(up or down), pending(Frames), codec(fast or text), proof(cookie or
%   certificate(Name)).

endpoint_peer(Address, process(Id)) :-
    last_process(Address, Id, _),
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
%
%   As far as this process knows, the process at Address with which it may have
%   communicated is no longer there: none listened there at the last attempt to
%   connect, or the one that did has sent `bye`.  False for a process that has
%   been suspended, or is behind a network that is cut.

endpoint_left(Address) :-
    last_process(Address, _, gone),
    \+ route_up(Address, _).

%!  endpoint_gone(+Address) is semidet.
%
%   As endpoint_left/1, for a process that will not be restarted.

endpoint_gone(Address) :-
    endpoint_left(Address),
    \+ endpoint_lasting(Address).

%!  endpoint_lasting(+Address) is semidet.
%
%   The process that was last met at Address keeps a journal: when it ends it is
%   not gone, because it will be restarted.

endpoint_lasting(Address) :-
    last_process(Address, Process, _),
    Process \== none,
    sub_atom(Process, 0, _, _, j).

%!  endpoint_missed(+Address, ?Formal) is semidet.
%
%   Formal is the reason why no process could be reached at Address at the last
%   attempt: `late`, or the formal term of an error, such as
%   permission_error(authenticate, peer, Why) or socket_error(Code, Text).

endpoint_missed(Address, Formal) :-
    missed(Address, Formal),
    !.

		 /*******************************
		 *            PROOFS            *
		 *******************************/

%!  endpoint_proof(+Peer, -Proof) is det.
%
%   Proof is the proof of the process at the address Peer, `cookie` on plain
%   TCP, see typhon_transport.  In the thread of a connection it is the proof
%   given on it, whatever address the peer claims.

endpoint_proof(_, Proof) :-
    transport_proof(Proof0),
    !,
    Proof = Proof0.
endpoint_proof(Peer, Proof) :-
    transport_unknown(Unknown),
    (   Unknown \== cookie,
        route(Peer, Session)
    ->  session_proof(Session, Proof)
    ;   Proof = Unknown
    ).
