:- module(typhon_request,
          [ request_send/4,             % +Session, +Kind, +Term, :OnAnswer
            request_reply/2,            % +ReplyTo, +Term
            request_reply_later/2,      % +ReplyTo, +Term
            request_answer/2,           % +Result, :OnAnswer
            request_forget/1,           % :OnAnswer
            requests_lost/2,            % +Session, +Unsent
            request_take/3,             % +Session, +Id, -OnAnswer
            session_unfinished/1,       % +Session
            dispatch/2,                 % +Session, +Frame
            dispatch_all/2,             % +Session, +Frames
            take_post/3,                % +Kind, +Term, +Peer
            take_request/4,             % +Kind, +Term, +Peer, +ReplyTo
            connection_is/2             % +Session, +State
          ]).

/** <module> What the frames of a session say

    post(Kind, Term)          one way
    request(Id, Kind, Term)   wants an answer
    answer(Id, Term)          here it is
    spoilt(Id)                the request was taken, and went wrong

Posts and requests go to the hooks of typhon_endpoint, answers to whoever
asked.

*Threading*: dispatch/2 runs in the thread of a connection, the hooks with
it. The table of open requests is shared; a request is taken out by retract/1
and so answered once.
*/

:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [error_told/3]).
:- use_module(outbox,
              [session_answer/2, session_send/2, session_send_later/2]).
:- use_module(session, [route/2, session_key/2, session_peer/3]).
:- use_module(unacked, [session_pending/2]).

:- meta_predicate
    request_send(+, +, +, 1),
    request_answer(+, 1),
    request_forget(1).

:- dynamic
    open_request/3.                     % Id, Key, OnAnswer

%!  request_send(+Session, +Kind, +Term, :OnAnswer) is det.

request_send(Session, Kind, Term, OnAnswer) :-
    session_key(Session, Key),
    flag(typhon_request, Id, Id+1),
    assertz(open_request(Id, Key, OnAnswer)),
    catch(session_send(Session, request(Id, Kind, Term)),
          Error,
          ( retractall(open_request(Id, _, _)),
            throw(Error) )).

%!  request_answer(+Result, :OnAnswer) is det.
%
%   Tell who asked. Never raises: what goes wrong is reported.

request_answer(Result, OnAnswer) :-
    guarded(call(OnAnswer, Result), answer).

%!  request_forget(:OnAnswer) is det.
%
%   Nobody waits for this answer any more.

request_forget(OnAnswer) :-
    retractall(open_request(_, _, OnAnswer)).

%!  request_reply(+ReplyTo, +Term) is det.
%
%   ReplyTo is reply_to(Session, Id), or alone(OnAnswer): see typhon_alone.

request_reply(reply_to(Session, Id), Term) :-
    session_answer(Session, answer(Id, Term)).
request_reply(alone(OnAnswer), Term) :-
    copy_term(Term, Copy),
    request_answer(answer(Copy), OnAnswer).

%!  request_reply_later(+ReplyTo, +Term) is det.
%
%   As request_reply/2, if possible together with what is sent next.

request_reply_later(reply_to(Session, Id), Term) :-
    session_send_later(Session, answer(Id, Term)).
request_reply_later(alone(OnAnswer), Term) :-
    request_reply(alone(OnAnswer), Term).

%!  session_unfinished(+Session) is semidet.
%
%   There is something to send, or some request has no answer yet.

session_unfinished(Session) :-
    session_pending(Session, Pending),
    Pending > 0,
    !.
session_unfinished(Session) :-
    session_key(Session, Key),
    open_request(_, Key, _),
    !.

%!  requests_lost(+Session, +Unsent) is det.
%
%   The peer is gone for good and the frames Unsent never left: tell all
%   who wait for its answers.

requests_lost(Session, Unsent) :-
    session_key(Session, Key),
    forall(member(request(Id, _, _), Unsent),
           conclude(unreachable, Id, Key)),
    forall(open_request(Id, Key, _), conclude(lost, Id, Key)).

%!  request_take(+Session, +Id, -OnAnswer) is semidet.
%
%   No answer to request Id of Session is awaited any more.

request_take(Session, Id, OnAnswer) :-
    session_key(Session, Key),
    retract(open_request(Id, Key, OnAnswer)),
    !.

%   Only who was asked can answer.

conclude(Result, Id, Key) :-
    (   integer(Id),
        retract(open_request(Id, Key, OnAnswer))
    ->  request_answer(Result, OnAnswer)
    ;   true
    ).

%!  dispatch(+Session, +Frame) is det.
%
%   Never raises: what goes wrong in a hook is reported.

dispatch(Session, post(Kind, Term)) :-
    !,
    session_peer(Session, _, Peer),
    take_post(Kind, Term, Peer).
dispatch(Session, request(Id, Kind, Term)) :-
    !,
    session_peer(Session, _, Peer),
    (   take_request(Kind, Term, Peer, reply_to(Session, Id))
    ->  true
    ;   guarded(session_answer(Session, spoilt(Id)), Kind)
    ).
dispatch(Session, answer(Id, Term)) :-
    !,
    session_key(Session, Key),
    conclude(answer(Term), Id, Key).
dispatch(Session, spoilt(Id)) :-
    !,
    session_key(Session, Key),
    conclude(lost, Id, Key).
dispatch(_, Frame) :-                   % of a later version, or damaged
    print_message(warning, typhon(endpoint, unknown_frame(Frame))).

%!  dispatch_all(+Session, +Frames:list) is det.
%
%   As dispatch/2 for Frames that have come in one.  Posts of one kind that
%   follow each other may be made fewer by who takes them.

dispatch_all(_, []) :-
    !.
dispatch_all(Session, [post(Kind, Term)|Frames0]) :-
    posts(Frames0, Kind, Terms, Frames),
    together(Kind, [Term|Terms], Fewer),
    !,
    session_peer(Session, _, Peer),
    forall(member(One, Fewer), take_post(Kind, One, Peer)),
    dispatch_all(Session, Frames).
dispatch_all(Session, [Frame|Frames]) :-
    dispatch(Session, Frame),
    dispatch_all(Session, Frames).

posts([post(Kind0, Term)|Frames0], Kind, [Term|Terms], Frames) :-
    Kind0 == Kind,
    !,
    posts(Frames0, Kind, Terms, Frames).
posts(Frames, _, [], Frames).

together(Kind, Terms, Fewer) :-
    Terms = [_,_|_],
    catch(typhon_endpoint:together(Kind, Terms, Fewer), error(_, _), fail),
    !.

%!  take_post(+Kind, +Term, +Peer) is det.
%!  take_request(+Kind, +Term, +Peer, +ReplyTo) is semidet.
%
%   Hand over what Peer sent.  The latter fails if nobody takes it.

take_post(Kind, Term, Peer) :-
    guarded(typhon_endpoint:received(Kind, Term, Peer), Kind).

take_request(Kind, Term, Peer, ReplyTo) :-
    attempt(typhon_endpoint:requested(Kind, Term, Peer, ReplyTo), Kind).

%!  connection_is(+Session, +State) is det.
%
%   Tell who wants to know that the connection is `up` or `down`, for each
%   address that leads to the peer.

connection_is(Session, State) :-
    session_peer(Session, _, Claimed),
    findall(Address, ( Address = Claimed ; route(Address, Session) ),
            Addresses0),
    sort(Addresses0, Addresses),
    forall(( member(Peer, Addresses),
             clause(typhon_endpoint:connection(Peer, State), Body) ),
           guarded(typhon_endpoint:Body, connection)).

guarded(Goal, Kind) :-
    (   attempt(Goal, Kind)
    ->  true
    ;   true
    ).

attempt(Goal, Kind) :-
    (   catch(Goal, Error, true)
    ->  (   var(Error)
        ->  true
        ;   is_order(Error)
        ->  throw(Error)
        ;   print_message(error, typhon(endpoint, hook(Kind, Error))),
            fail
        )
    ;   print_message(error, typhon(endpoint, hook(Kind, failed))),
        fail
    ).

%   The thread is to end: that is not the hook's fault, nor to be kept from it.

is_order(wire_thread_end(_)).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, unknown_frame(Frame))) -->
    [ 'Endpoint: a frame nobody understands: ~W'
      -[Frame, [quoted(true), max_depth(8)]] ].
prolog:message(typhon(endpoint, hook(Kind, failed))) -->
    [ 'Endpoint: nobody takes ~q'-[Kind] ].
prolog:message(typhon(endpoint, hook(Kind, Error))) -->
    [ 'Endpoint: taking ~q: '-[Kind] ],
    error_told(Error).
