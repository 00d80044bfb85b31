:- module(typhon_unsent,
          [ unsent_request/4,           % +Address, +Kind, +Term, :OnAnswer
            unsent/1,                   % ?Address
            unsent_send/2,              % +Address, +Session
            unsent_again/2,             % +Session, +Unsent
            unsent_closed/4,            % +Address, +Kind, +Term, :OnAnswer
            unsent_fail/1,              % ?Address
            unsent_fail/2,              % ?Address, +Asked
            unsent_forget/1             % :OnAnswer
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module(attempts, [asking/1]).
:- use_module(peer_cache, [contact_expected/1]).
:- use_module(request,
              [ request_answer/2, request_forget/1, request_send/4,
                request_take/3 ]).
:- use_module(session, [session_peer/3]).
:- use_module(threads, [manager_notify/1]).

/** <module> Requests that wait for a session

A request to a peer that is not connected is held here, in order, until
there is a session to send it in, or it is known that there can be none.

*Threading*: any thread adds to the held requests. The connection manager, which
receives requests(Address), sends them, and removes what it has sent only then:
as long as something is held for an address, nothing of the same thread may
overtake it. The thread that removes a request answers it.
*/

:- meta_predicate
    unsent_request(+, +, +, 1),
    unsent_closed(+, +, +, 1),
    unsent_forget(1).

:- dynamic
    unsent/5.                           % Address, Number, Kind, Term,
                                        % OnAnswer

%!  unsent_request(+Address, +Kind, +Term, :OnAnswer) is det.
%
%   As endpoint_request/4, when there is a connection with Address.

unsent_request(Address, Kind, Term, OnAnswer) :-
    asking(Number),
    assertz(unsent(Address, Number, Kind, Term, OnAnswer)),
    (   manager_notify(requests(Address))
    ->  true
    ;   fail_one(Address, Number)
    ).

%!  unsent(?Address) is semidet.
%
%   Something is held for Address.

unsent(Address) :-
    unsent(Address, _, _, _, _),
    !.

%!  unsent_send(+Address, +Session) is det.
%
%   Send in Session all that is held for Address. For the connection manager
%   only.

unsent_send(Address, Session) :-
    oldest(Address, Row),
    !,
    (   send(Row, Session)
    ->  sent(Row),
        unsent_send(Address, Session)
    ;   ignore(manager_notify(requests(Address)))
    ).
unsent_send(_, _).

oldest(Address, Row) :-
    Row = unsent(Address, _, _, _, _),
    call(Row),
    !.

send(unsent(Address, _, Kind, Term, OnAnswer), Session) :-
    catch(request_send(Session, Kind, Term, OnAnswer),
          error(Formal, Context),
          not_sent(Formal, Context, Address, OnAnswer)).

%   The caller may have given up meanwhile.

sent(unsent(Address, Number, _, _, OnAnswer)) :-
    (   retract(unsent(Address, Number, _, _, _))
    ->  true
    ;   request_forget(OnAnswer)
    ).

%   not_sent(+Formal, +Context, +Address, +OnAnswer) fails if the next process
%   at Address is to be asked.

not_sent(session_closed, _, Address, OnAnswer) :-
    !,
    \+ contact_expected(Address),
    request_answer(unreachable, OnAnswer).
not_sent(Formal, Context, _, OnAnswer) :-
    print_error(error, error(Formal, Context)),
    request_answer(unreachable, OnAnswer).

%!  unsent_closed(+Address, +Kind, +Term, :OnAnswer) is det.
%!  unsent_again(+Session, +Unsent) is det.
%
%   The peer is gone for good, and was not asked this; nor what is among the
%   frames Unsent.  If a process is expected there soon, that waits for it.

unsent_closed(Address, Kind, Term, OnAnswer) :-
    (   contact_expected(Address)
    ->  unsent_request(Address, Kind, Term, OnAnswer)
    ;   request_answer(unreachable, OnAnswer)
    ).

unsent_again(Session, Unsent) :-
    session_peer(Session, _, Address),
    contact_expected(Address),
    !,
    forall(( member(request(Id, Kind, Term), Unsent),
             request_take(Session, Id, OnAnswer) ),
           unsent_request(Address, Kind, Term, OnAnswer)).
unsent_again(_, _).

%!  unsent_fail(?Address) is det.
%!  unsent_fail(?Address, +Asked) is det.
%
%   There is no way to Address: say so, to those with a number below Asked, see
%   asking/1.

unsent_fail(Address) :-
    unsent_fail(Address, inf).

unsent_fail(Address, Asked) :-
    findall(A-Number, unsent(A, Number, _, _, _), All),
    forall(( member(Address-Number, All), Number < Asked ),
           fail_one(Address, Number)).

fail_one(Address, Number) :-
    (   retract(unsent(Address, Number, _, _, OnAnswer))
    ->  request_answer(unreachable, OnAnswer)
    ;   true
    ).

%!  unsent_forget(:OnAnswer) is det.
%
%   No caller waits for this answer any more.

unsent_forget(OnAnswer) :-
    retractall(unsent(_, _, _, _, OnAnswer)).
