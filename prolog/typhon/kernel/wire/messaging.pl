:- module(typhon_messaging,
          [ endpoint_post/3,            % +Address, +Kind, +Term
            endpoint_post_up/3,         % +Address, +Kind, +Term
            endpoint_post_by/4,         % +Deadline, +Address, +Kind, +Term
            endpoint_request/4,         % +Address, +Kind, +Term, :OnAnswer
            endpoint_reply/2,           % +ReplyTo, +Term
            endpoint_reply_later/2      % +ReplyTo, +Term
          ]).

/** <module> What is said to the endpoints of other processes

A post goes one way, a request is answered. Both go over the session to
which the address leads; where there is none that is up, a connection is
made first.

*Threading*: everything may be called from any thread; endpoint_post/3 may
block it, unless it is in a hook of the endpoint.
*/

:- use_module(library(error), [existence_error/2]).
:- use_module(alone, [alone/1, alone_request/4]).
:- use_module(endpoint, [endpoint_address/1]).
:- use_module(frame, [mobile_term/1]).
:- use_module(keeper, [keeper_connect/1, keeper_connect/2]).
:- use_module(outbox, [session_send_with/2]).
:- use_module(reader, [in_reader/0]).
:- use_module(request,
              [ request_reply/2, request_reply_later/2,
                request_send/4, take_post/3 ]).
:- use_module(session, [route/2, route_up/2]).
:- use_module(unsent, [unsent/1, unsent_closed/4, unsent_request/4]).

:- meta_predicate
    endpoint_request(+, +, +, 1).

%!  endpoint_post(+Address, +Kind, +Term) is det.
%
%   Send Term, one way. It arrives once, in the order of the posts of this
%   thread, as long as both processes live. May block while it connects. What
%   goes to this process is taken by this thread, at once.
%
%   @error unreachable(Address)
%   @error type_error(mobile_term, Culprit)

endpoint_post(Address, Kind, Term) :-
    endpoint_address(Own),
    Own == Address,
    !,
    mobile_term(Term),
    copy_term(Term, Copy),
    take_post(Kind, Copy, Address).
endpoint_post(Address, _, _) :-
    alone(_),
    !,
    throw(error(unreachable(Address), _)).
endpoint_post(Address, Kind, Term) :-
    (   way(Address, Session)
    ->  true
    ;   connect(Address, Session)
    ),
    (   post(Session, Kind, Term)
    ->  true
    ;   throw(error(unreachable(Address), _))
    ).

%!  endpoint_post_up(+Address, +Kind, +Term) is semidet.
%
%   As endpoint_post/3 if there is a connection; fails at once if not.

endpoint_post_up(Address, Kind, Term) :-
    open_way(Address, Session),
    !,
    post(Session, Kind, Term).
endpoint_post_up(Address, Kind, Term) :-
    alone(Address),
    endpoint_post(Address, Kind, Term).

%!  endpoint_post_by(+Deadline, +Address, +Kind, +Term) is semidet.
%
%   As endpoint_post_up/3; a connection is waited for until Deadline. If it goes
%   again Term waits for the next. Not for hooks nor clean-up handlers, see
%   keeper_connect/2.

endpoint_post_by(_, Address, Kind, Term) :-
    endpoint_post_up(Address, Kind, Term),
    !.
endpoint_post_by(Deadline, Address, Kind, Term) :-
    keeper_connect(Address, Deadline),
    route(Address, Session),
    !,
    post(Session, Kind, Term).

post(Session, Kind, Term) :-
    catch(session_send_with(Session, post(Kind, Term)),
          error(session_closed, _),
          fail).

%   way(+Address, -Session): nothing has to be waited for. In a hook there
%   must be no waiting: what is sent there waits in the session for the next
%   connection, which cannot be made while its thread is in a hook.

way(Address, Session) :-
    open_way(Address, Session),
    !.
way(Address, Session) :-
    in_reader,
    route(Address, Session),
    !.

%   What is asked now must not overtake what waits to be asked.

open_way(Address, Session) :-
    route_up(Address, Session),
    \+ unsent(Address),
    !.

connect(Address, Session) :-
    check_running,
    (   keeper_connect(Address),
        route(Address, Session0)
    ->  Session = Session0
    ;   throw(error(unreachable(Address), _))
    ).

check_running :-
    (   endpoint_address(_)
    ->  true
    ;   existence_error(endpoint, running)
    ).

%!  endpoint_request(+Address, +Kind, +Term, :OnAnswer) is det.
%
%   Ask; call(OnAnswer, Result) once, in some thread of the endpoint, where
%   it must be quick. Result is answer(Term), `unreachable` (it certainly
%   never arrived) or `lost` (it may have). Does not block.

endpoint_request(Address, Kind, Term, OnAnswer) :-
    alone(_),
    !,
    alone_request(Address, Kind, Term, OnAnswer).
endpoint_request(Address, Kind, Term, OnAnswer) :-
    way(Address, Session),
    !,
    catch(request_send(Session, Kind, Term, OnAnswer),
          error(session_closed, _),
          unsent_closed(Address, Kind, Term, OnAnswer)).
endpoint_request(Address, Kind, Term, OnAnswer) :-
    check_running,
    mobile_term(Term),
    unsent_request(Address, Kind, Term, OnAnswer).

%!  endpoint_reply(+ReplyTo, +Term) is det.
%
%   Answer a request, from any thread, any time later. A second answer
%   goes unnoticed.

endpoint_reply(ReplyTo, Term) :-
    catch(request_reply(ReplyTo, Term),
          error(session_closed, _),
          true).                        % whoever asked is no more

%!  endpoint_reply_later(+ReplyTo, +Term) is det.
%
%   As endpoint_reply/2, with the next frame to that peer or a millisecond
%   later; for answers that nobody waits for in earnest. Only worth while
%   in a hook.

endpoint_reply_later(ReplyTo, Term) :-
    catch(request_reply_later(ReplyTo, Term),
          error(session_closed, _),
          true).
