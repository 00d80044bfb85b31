:- module(typhon_meeting,
          [ prove/5,                    % +Role, +In, +Out, +Me, -Peer
            meet/7,                     % +Role, +In, +Out, +Me, +Peer,
                                        % -Session, :Known
            own_session/1               % +Session
          ]).

/** <module> How two endpoints meet over a new connection

They prove themselves, find the session they have, or begin one, and give it
the connection.

Both ends may connect at the same time, and a connection may be dead on one
side only. So a new connection replaces an old one, and of two processes the
one with the smaller key, the arbiter, decides in which order that happens: it
speaks first, and about one connection at a time. Of two that were begun
together it refuses the later; the other process takes what the arbiter offers.

*Threading*: in the thread of the connection. Who holds the session's
adoption gives it the connection.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [syntax_error/1]).
:- use_module(library(settings), [setting/2]).
:- use_module(handshake,
              [ authenticate/6, cookie/1, hello_codec/3, hello_peer/4,
                line_read/3, line_write/2 ]).
:- use_module(session,
              [ received/2, session_adopting/2, session_key/2, session_open/4,
                session_up_since/2 ]).
:- use_module(request, [connection_is/2]).
:- use_module(resumption, [session_install/4, session_retire/1]).

:- meta_predicate
    meet(+, +, +, +, +, -, 1).

%!  prove(+Role, +In, +Out, +Me, -Peer) is det.
%
%   Me is our hello, Peer that of the peer, which has proved itself. Role is
%   server(Start), of who was called at the time Start, or client(Start), of who
%   set out to connect then.
%
%   A server tells a client in vain at the door that it does not know the
%   cookie: it need not come back.

prove(client(_), In, Out, Me, Peer) :-
    authenticate(client, In, Out, Me, cookie, Peer).
prove(server(_), In, Out, Me, Peer) :-
    catch(authenticate(server, In, Out, Me, cookie, Peer),
          error(permission_error(authenticate, peer, cookie), Context),
          ( line_write(Out, refused),
            throw(error(permission_error(authenticate, peer, cookie),
                        Context)) )).

%!  meet(+Role, +In, +Out, +Me, +Peer, -Session, :Known) is semidet.
%
%   Peer is Hello-Proof. Give the connection to the session with Peer.
%   call(Known, Session) notes the addresses that lead to it before that: whoever
%   gives it a connection does so for all.

meet(Role, In, Out, Me, Peer-Proof, Session, Known) :-
    hello_codec(Me, Peer, Codec),
    session_keys(Role, Me, Peer, MyKey, Key),
    session_open(Key, Peer-Proof, Codec, Session),
    call(Known, Session),
    hello_peer(Peer, _, _, Address),
    debug(typhon(session), '~w: a connection, with ~w, ~w',
          [Key, Address, Codec]),
    adopt(MyKey, Key, Role, Session, In, Out).

%   A process that connects to itself has a session for either end.

session_keys(Role, Me, Peer, MyKey, Key) :-
    hello_peer(Me, P1, S1, _),
    hello_peer(Peer, P2, S2, _),
    (   P1-S1 == P2-S2
    ->  own_keys(Role, MyKey, Key)
    ;   atomic_list_concat([P1, S1], '.', MyKey),
        atomic_list_concat([P2, S2], '.', Key)
    ).

own_keys(client(_), self_client, self_server).
own_keys(server(_), self_server, self_client).

%!  own_session(+Session) is semidet.
%
%   Session joins this process to itself.

own_session(Session) :-
    session_key(Session, Key),
    own_keys(_, Key, _),
    !.

adopt(MyKey, Key, Role, Session, In, Out) :-
    MyKey @< Key,
    !,
    session_adopting(Session,
                     ( needed(Role, Session),
                       session_retire(Session),
                       say_count(Key, Out),
                       hear_count(In, Count),
                       install(Session, Out, Count) )).
adopt(_, Key, _, Session, In, Out) :-
    hear_count(In, Count),
    session_adopting(Session,
                     ( session_retire(Session),
                       say_count(Key, Out),
                       install(Session, Out, Count) )).

%   We have met by another connection since this one was begun. The peer has
%   said its count over that; when it hears that this is no more it has it.

needed(Role, Session) :-
    arg(1, Role, Start),
    session_up_since(Session, Start),
    !,
    throw(wire_thread_end(met)).
needed(_, _).

%   Who wants to know is told in the same step: what was sent to a process that
%   has died is sent again by who hears of the next.

install(Session, Out, Count) :-
    thread_self(Me),
    sig_atomic(( session_install(Session, Me, Out, Count),
                 connection_is(Session, up) )).

say_count(Key, Out) :-
    received(Key, Count),
    format(string(Line), "resume ~d", [Count]),
    line_write(Out, Line).

hear_count(In, Count) :-
    setting(typhon_handshake:handshake_time, Seconds),
    get_time(Now),
    Deadline is Now+Seconds,
    line_read(In, Deadline, Line),
    (   string_concat("resume ", Digits, Line),
        number_string(Count, Digits),
        integer(Count),
        Count >= 0
    ->  true
    ;   syntax_error(resume)
    ).
