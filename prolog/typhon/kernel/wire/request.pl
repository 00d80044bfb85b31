:- module(typhon_request,
          [ request_send/4,             % +Session, +Kind, +Term, :OnAnswer
            endpoint_reply/2,           % +ReplyTo, +Term
            endpoint_reply_later/2,     % +ReplyTo, +Term
            request_answer/2,           % +Result, :OnAnswer
            request_forget/1,           % :OnAnswer
            request_take/3,             % +Session, +Id, -OnAnswer
            requests_lost/2,            % +Session, +Unsent
            session_unfinished/1,       % +Session
            handed_over/2,              % +Settled, +Session
            dispatch/2,                 % +Session, +Frame
            dispatch_all/2,             % +Session, +Frames
            take_post/3,                % +Kind, +Term, +Peer
            take_request/4,             % +Kind, +Term, +Peer, +ReplyTo
            endpoint_later/1            % :Goal
          ]).

/** <module> Requests and posts, and the frames that carry them

    post(Kind, Term)          one way
    request(Id, Kind, Term)   needs an answer
    answer(Id, Term)          answers request Id
    spoilt(Id)                request Id arrived, but was not served
    hand(Kind, Term)          hands over Term if the receiver accepts it
    objection(Number, Answer) the frame of that Number is not accepted

A frame that cannot be decoded is unreadable(Formal, Mark): Mark is request(Id)
or answer(Id) if it has a mark, see frame.pl, else `none`.

Posts and requests that the peer may send, see kinds.pl, go to the hooks of
typhon_endpoint, answers to the caller. A request for which the peer lacks a right
is answered not_permitted(Right).
A hand-over needs no answer: settlement of its frame means that it was accepted.
The Answer of an objection is `spoilt`, an answer of the hook, or `deferred`:
then the frame is a request from now on, under its negated number.

*Threading*: dispatch/2 runs in the thread of a connection, the hooks with
it. The table of open requests is shared; retract/1 removes a request, so
it is answered once.
*/

:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [error_lines/3]).
:- use_module('../base/reports', [report/4]).
:- use_module('../base/on_demand',
              [on_demand_later/1, on_demand_load/2, on_demand_part/2]).
:- use_module(kinds, [arrival_verdict/5]).
:- use_module(session,
              [ objection_answered/3, session_answer/2, session_key/2,
                session_object/2, session_objected/3, session_owes/0,
                session_peer/3, session_pending/2, session_send/2,
                session_send_later/2, session_to_self/1, session_window/2 ]).
:- use_module(transport, [transport_as/2, transport_proof/1]).
:- use_module(window, [window_received/2]).

:- meta_predicate
    request_send(+, +, +, 1),
    request_answer(+, 1),
    request_forget(1).

:- dynamic
    open_request/3.                     % Id, Key, OnAnswer

%!  request_send(+Session, +Kind, +Term, :OnAnswer) is det.
%
%   Send a request; its result goes to OnAnswer, see endpoint_request/4.

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
%   Give Result to the caller. Never raises: errors of OnAnswer are reported.

request_answer(Result, OnAnswer) :-
    reporting(call(OnAnswer, Result), answer).

%!  request_forget(:OnAnswer) is det.
%
%   Forget the open requests with this OnAnswer: their callers no longer wait.

request_forget(OnAnswer) :-
    retractall(open_request(_, _, OnAnswer)).

%!  endpoint_reply(+ReplyTo, +Term) is det.
%
%   Answer a request, from any thread, at any later time. A second answer is
%   ignored.  ReplyTo is reply_to(Session, Id), or alone(OnAnswer): see
%   endpoint.pl.

endpoint_reply(reply_to(Session, Id), Term) :-
    session_answer(Session, answer(Id, Term)).
endpoint_reply(alone(OnAnswer), Term) :-
    copy_term(Term, Copy),
    request_answer(answer(Copy), OnAnswer).

%!  endpoint_reply_later(+ReplyTo, +Term) is det.
%
%   As endpoint_reply/2, with the next frame to that peer or a millisecond
%   later; for answers that are not urgent. Of use only in a hook.

endpoint_reply_later(reply_to(Session, Id), Term) :-
    session_send_later(Session, answer(Id, Term)).
endpoint_reply_later(alone(OnAnswer), Term) :-
    endpoint_reply(alone(OnAnswer), Term).

%!  session_unfinished(+Session) is semidet.
%
%   A frame is not acknowledged, or some request has no answer yet.

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
%   Conclude all requests to the peer, which is gone permanently; the frames
%   Unsent were never sent.

requests_lost(Session, Unsent) :-
    session_key(Session, Key),
    forall(member(request(Id, _, _), Unsent),
           conclude(unreachable, Id, Key)),
    forall(open_request(Id, Key, _), conclude(lost, Id, Key)),
    forall(member(handed(Token, Result), Unsent), handed(Token, Result)).

%!  handed_over(+Settled, +Session) is det.
%
%   Settled is settled(Token, Number, Result), see session_settled/4: call the
%   hook handed_over(Token, Result), where Result is `accepted`, `lost`,
%   `unsent`, or the answer of the peer.

handed_over(settled(Token, Number, deferred), Session) :-
    !,
    Id is -Number,
    session_key(Session, Key),
    assertz(open_request(Id, Key, typhon_request:answered_late(Token))).
handed_over(settled(Token, _, Result), _) :-
    handed(Token, Result).

handed(Token, spoilt) :-
    !,
    handed(Token, lost).
handed(Token, Result) :-
    reporting(typhon_endpoint:handed_over(Token, Result), handed_over).

:- public answered_late/2.

answered_late(Token, answer(Answer)) :-
    !,
    handed(Token, Answer).
answered_late(Token, lost) :-
    handed(Token, lost).

%!  request_take(+Session, +Id, -OnAnswer) is semidet.
%
%   Remove request Id of Session from the open requests.

request_take(Session, Id, OnAnswer) :-
    session_key(Session, Key),
    retract(open_request(Id, Key, OnAnswer)),
    !.

%   The Key ensures that only the peer that was asked can answer.

conclude(Result, Id, Key) :-
    (   integer(Id),
        retract(open_request(Id, Key, OnAnswer))
    ->  request_answer(Result, OnAnswer)
    ;   true
    ).

%!  dispatch(+Session, +Frame) is det.
%
%   Never raises: prints errors of hooks.

dispatch(Session, post(Kind, Term)) :-
    !,
    session_peer(Session, _, Peer),
    post_in(Session, Kind, Term, Peer).
dispatch(Session, request(Id, Kind, Term)) :-
    !,
    session_peer(Session, _, Peer),
    dispatch_request(Id, Kind, Term, Peer, Session).
dispatch(Session, hand(Kind, Term)) :-
    !,
    session_peer(Session, _, Peer),
    (   permitted(Session, hand, Kind, Term, Peer),
        attempt(typhon_endpoint:handed(Kind, Term, Peer, Verdict), Kind, fail)
    ->  verdict(Verdict, Kind, Term, Peer, Session)
    ;   session_object(Session, spoilt)
    ).
dispatch(Session, objection(Number, Answer)) :-
    !,
    session_objected(Session, Number, Answer).
dispatch(Session, answer(Id, Term)) :-
    !,
    answered(Session, Id, Term, answer(Term)).
dispatch(Session, spoilt(Id)) :-
    !,
    answered(Session, Id, spoilt, lost).
dispatch(Session, unreadable(Formal, Mark)) :-
    !,
    session_peer(Session, _, Peer),
    report(warning, unreadable_frames, Peer,
           typhon(endpoint, unreadable(Peer, Formal))),
    unreadable(Mark, Session).
dispatch(_, Frame) :-                   % of a later version, or damaged
    report(warning, unknown_frames, peers,
           typhon(endpoint, unknown_frame(Frame))).

%   unreadable(+Mark, +Session): if a caller waits for an answer because of the
%   frame, in this process or the other, the caller gets `lost`.

unreadable(request(Id), Session) :-
    !,
    spoil(reply_to(Session, Id), request).
unreadable(answer(Id), Session) :-
    !,
    dispatch(Session, spoilt(Id)).
unreadable(_, Session) :-               % the frame may be a hand-over
    session_object(Session, spoilt).

verdict(accepted, _, _, _, _) :-
    !,
    session_owes.
verdict(deferred, Kind, Term, Peer, Session) :-
    !,
    session_object(Session, deferred),
    session_window(Session, Window),
    window_received(Window, Count),
    Id is -(Count+1),
    dispatch_request(Id, Kind, Term, Peer, Session),
    session_owes.                       % the answer was sent without the count
verdict(Answer, _, _, _, Session) :-
    session_object(Session, Answer).

%   answered(+Session, +Id, +Answer, +Result): Id may be that of a frame that
%   the peer has deferred, and has answered before it has counted the frame.

answered(Session, Id, Answer, Result) :-
    (   integer(Id),
        Id < 0,
        Number is -Id,
        objection_answered(Session, Number, Answer)
    ->  true
    ;   session_key(Session, Key),
        conclude(Result, Id, Key)
    ).

dispatch_request(Id, Kind, Term, Peer, Session) :-
    ReplyTo = reply_to(Session, Id),
    allowed(Session, request, Kind, Term, Peer, Verdict),
    (   Verdict = refused(Right)
    ->  reporting(endpoint_reply(ReplyTo, not_permitted(Right)), Kind)
    ;   Verdict == ok,
        take_request(Kind, Term, Peer, ReplyTo)
    ->  true
    ;   spoil(ReplyTo, Kind)
    ).

post_in(Session, Kind, Term, Peer) :-
    (   permitted(Session, post, Kind, Term, Peer)
    ->  take_post(Kind, Term, Peer)
    ;   true
    ).

permitted(Session, Form, Kind, Term, Peer) :-
    allowed(Session, Form, Kind, Term, Peer, Verdict),
    Verdict == ok.

%   allowed(+Session, +Form, +Kind, +Term, +Peer, -Verdict): see kinds.pl. This
%   process may send to itself what it likes.

allowed(Session, _, _, _, _, ok) :-
    session_to_self(Session),
    !.
allowed(_, Form, Kind, Term, Peer, Verdict) :-
    arrival_verdict(Form, Kind, Term, Peer, Verdict),
    (   Verdict == undeclared
    ->  report(warning, undeclared_terms, Peer,
               typhon(endpoint, undeclared(Peer, Form, Kind)))
    ;   true
    ).

%!  dispatch_all(+Session, +Frames:list) is det.
%
%   As dispatch/2 for Frames that have come in one frame.  The hook together/3
%   may merge successive posts of one kind.

dispatch_all(_, []) :-
    !.
dispatch_all(Session, [post(Kind, Term)|Frames0]) :-
    posts(Frames0, Kind, Terms, Frames),
    together(Kind, [Term|Terms], Fewer),
    !,
    session_peer(Session, _, Peer),
    forall(member(One, Fewer), post_in(Session, Kind, One, Peer)),
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
%
%   Call the hook for a post that Peer may send.

take_post(Kind, Term, Peer) :-
    Hook = typhon_endpoint:received(Kind, Term, Peer),
    ( attempt(Hook, Kind, taken_later(Hook)) -> true ; true ).

%!  take_request(+Kind, +Term, +Peer, +ReplyTo) is semidet.
%
%   Call the hook for a request that Peer may send.  Fails if no hook takes it.

take_request(Kind, Term, Peer, ReplyTo) :-
    Hook = typhon_endpoint:requested(Kind, Term, Peer, ReplyTo),
    attempt(Hook, Kind, taken_later(Hook)).

spoil(reply_to(Session, Id), Kind) :-
    reporting(session_answer(Session, spoilt(Id)), Kind).
spoil(alone(OnAnswer), _) :-
    request_answer(lost, OnAnswer).

reporting(Goal, Kind) :-
    ( attempt(Goal, Kind, fail) -> true ; true ).

%   attempt(:Goal, +Kind, :Otherwise) is semidet: report an error of Goal; call
%   Otherwise if it fails.

attempt(Goal, Kind, Otherwise) :-
    (   catch(Goal, Error, true)
    ->  (   var(Error)
        ->  true
        ;   is_thread_end(Error)
        ->  throw(Error)
        ;   hook_error(Kind, Error)
        )
    ;   call(Otherwise)
    ->  true
    ;   hook_error(Kind, failed)
    ).

hook_error(Kind, Problem) :-
    report(error, errors_of_hooks, Kind, typhon(endpoint, hook(Kind, Problem))),
    fail.

%   taken_later(+Hook) is semidet: Hook is defined by code that was not loaded, at
%   least when the hook was called. A worker loads the code and calls the hook.

taken_later(typhon_endpoint:Hook) :-
    functor(Hook, Seam, _),
    arg(1, Hook, Kind),
    on_demand_part(Seam, Kind),
    endpoint_later(typhon_request:load_and_take(Seam, Kind, Hook)).

%!  endpoint_later(:Goal) is semidet.
%
%   In a hook: call Goal once in a worker, with the proof that the peer has
%   given in this thread, whatever address it claims.  Fails if there are no
%   workers.

:- meta_predicate endpoint_later(0).

endpoint_later(Goal) :-
    ( transport_proof(Proof) -> true ; Proof = none ),
    on_demand_later(transport_as(Proof, Goal)).

:- public load_and_take/3.              % goal of a worker

load_and_take(Seam, Kind, Hook) :-
    (   catch(on_demand_load(Seam, Kind), Error,
              report(error, errors_of_hooks, Kind, typhon(raised(Error)))),
        var(Error),
        attempt(typhon_endpoint:Hook, Kind, fail)
    ->  true
    ;   Hook = requested(_, _, _, ReplyTo)
    ->  spoil(ReplyTo, Kind)
    ;   true
    ).

%   The exception ends the thread: it is not an error of the hook, and must not
%   be caught.

is_thread_end(wire_thread_end(_)).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, unreadable(Peer, Formal))) -->
    [ 'Endpoint: a frame of ~w cannot be read: ~p'-[Peer, Formal] ].
prolog:message(typhon(endpoint, undeclared(Peer, Form, Kind))) -->
    [ 'Endpoint: ~w has sent a ~w ~q that is not declared'-[Peer, Form, Kind] ].
prolog:message(typhon(endpoint, unknown_frame(Frame))) -->
    [ 'Endpoint: unknown frame: ~W'
      -[Frame, [quoted(true), max_depth(8)]] ].
prolog:message(typhon(endpoint, hook(Kind, failed))) -->
    [ 'Endpoint: no hook for ~q succeeded'-[Kind] ].
prolog:message(typhon(endpoint, hook(Kind, Error))) -->
    [ 'Endpoint: error in a hook for ~q: '-[Kind] ],
    error_lines(Error).
