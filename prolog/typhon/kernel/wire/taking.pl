:- module(typhon_taking,
          [ frame_term/3,               % +Codec, +Bytes, -Frame
            take_frame/2,               % +Frame, +Session
            take_bundle/2               % +Frame, +Session
          ]).

/** <module> From bytes to who takes them

A frame that cannot be read has come all the same: asking for it again
would not help. Whoever waits for an answer hears of it at once, here or
there.

*Threading*: in the thread of a connection.
*/

:- use_module(library(apply), [maplist/3, partition/4]).
:- use_module(library(lists), [member/2]).
:- use_module(frame, [bundle_parts/2, bytes_mark/2, bytes_term/3]).
:- use_module(outbox, [session_answer/2]).
:- use_module(request, [dispatch/2, dispatch_all/2]).
:- use_module(session, [session_codec/2, session_peer/3]).

%!  frame_term(+Codec, +Bytes, -Frame) is det.
%
%   Frame is what Bytes say, or unreadable(Formal, Mark).

frame_term(Codec, Bytes, Term) :-
    catch(bytes_term(Codec, Bytes, Term),
          error(Formal, _),
          unreadable(Formal, Bytes, Term)).

unreadable(Formal, Bytes, unreadable(Formal, Mark)) :-
    (   bytes_mark(Bytes, Mark0)
    ->  Mark = Mark0
    ;   Mark = none
    ).

%!  take_frame(+Frame, +Session) is det.
%!  take_bundle(+Frame, +Session) is semidet.
%
%   Hand Frame over to whom it is for; hand over what is in it, if it is a
%   bundle.

take_frame(unreadable(Formal, Mark), Session) :-
    !,
    session_peer(Session, _, Address),
    print_message(warning, typhon(endpoint, unreadable(Address, Formal))),
    spoil(Mark, Session).
take_frame(Frame, Session) :-
    dispatch(Session, Frame).

take_bundle(Frame, Session) :-
    bundle_parts(Frame, Parts),
    session_codec(Session, Codec),
    maplist(frame_term(Codec), Parts, Frames),
    partition(is_unreadable, Frames, Unreadable, Others),
    dispatch_all(Session, Others),
    forall(member(One, Unreadable), take_frame(One, Session)).

is_unreadable(unreadable(_, _)).

spoil(request(Id), Session) :-
    !,
    catch(session_answer(Session, spoilt(Id)),
          error(session_closed, _),
          true).
spoil(answer(Id), Session) :-
    !,
    dispatch(Session, spoilt(Id)).
spoil(_, _).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, unreadable(Address, Formal))) -->
    [ 'Endpoint: a frame of ~w cannot be read: ~p'-[Address, Formal] ].
