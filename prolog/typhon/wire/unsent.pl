:- module(typhon_unsent,
          [ unsent_request/4,           % +Address, +Kind, +Term, :OnAnswer
            unsent/1,                   % ?Address
            unsent_send/2,              % +Address, +Session
            unsent_fail/1,              % ?Address
            unsent_forget/1             % :OnAnswer
          ]).

/** <module> Requests that wait for a connection

What is asked of a peer that is not connected is held here, in order, until
there is a session to send it in, or it is known that there can be none.

_Threading_: any thread adds. The keeper, which hears requests(Address),
sends, and removes what it has sent only then: as long as something is held
for an address, nothing of the same thread may overtake it. Whoever removes
a request answers for it.
*/

:- use_module(request, [request_answer/2, request_send/4]).
:- use_module(keeper_queue, [keeper_tell/1]).

:- meta_predicate
    unsent_request(+, +, +, 1),
    unsent_forget(1).

:- dynamic
    unsent/5.                           % Address, Number, Kind, Term,
                                        % OnAnswer

%!  unsent_request(+Address, +Kind, +Term, :OnAnswer) is det.
%
%   As endpoint_request/4, when there is a connection with Address.

unsent_request(Address, Kind, Term, OnAnswer) :-
    flag(typhon_unsent, Number, Number+1),
    assertz(unsent(Address, Number, Kind, Term, OnAnswer)),
    (   keeper_tell(requests(Address))
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
%   Send in Session all that is held for Address. For the keeper only.

unsent_send(Address, Session) :-
    oldest(Address, Number, Row),
    !,
    send(Row, Session),
    retractall(unsent(Address, Number, _, _, _)),
    unsent_send(Address, Session).
unsent_send(_, _).

oldest(Address, Number, Row) :-
    Row = unsent(Address, Number, _, _, _),
    call(Row),
    !.

send(unsent(_, _, Kind, Term, OnAnswer), Session) :-
    catch(request_send(Session, Kind, Term, OnAnswer),
          error(Formal, Context),
          ( report(Formal, Context),
            request_answer(unreachable, OnAnswer) )).

report(session_closed, _) :-
    !.
report(Formal, Context) :-
    print_message(error, error(Formal, Context)).

%!  unsent_fail(?Address) is det.
%
%   There is no way to Address: say so.

unsent_fail(Address) :-
    findall(A-Number, unsent(A, Number, _, _, _), All),
    forall(member(Address-Number, All), fail_one(Address, Number)).

fail_one(Address, Number) :-
    (   retract(unsent(Address, Number, _, _, OnAnswer))
    ->  request_answer(unreachable, OnAnswer)
    ;   true
    ).

%!  unsent_forget(:OnAnswer) is det.
%
%   Nobody waits for this answer any more.

unsent_forget(OnAnswer) :-
    retractall(unsent(_, _, _, _, OnAnswer)).
