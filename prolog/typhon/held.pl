:- module(typhon_held,
          [ held_request/4,             % +Address, +Kind, +Term, :OnAnswer
            held/1,                     % ?Address
            held_send/2,                % +Address, +Session
            held_fail/1,                % ?Address
            held_forget/1               % :OnAnswer
          ]).

/** <module> Requests that wait for a connection

What is asked of a peer that is not connected is held here, in order, until
there is a session to send it in, or it is known that there can be none.

_Threading_: any thread adds. The keeper, which hears requests(Address),
sends, and removes what it has sent only then: as long as something is held
for an address, nothing of the same thread may overtake it. Whoever removes
a request answers for it.
*/

:- use_module(crew, [crew_tell/1]).
:- use_module(request, [request_answer/2, request_send/4]).

:- meta_predicate
    held_request(+, +, +, 1),
    held_forget(1).

:- dynamic
    held/5.                             % Address, Number, Kind, Term,
                                        % OnAnswer

%!  held_request(+Address, +Kind, +Term, :OnAnswer) is det.
%
%   As endpoint_request/4, when there is a connection with Address.

held_request(Address, Kind, Term, OnAnswer) :-
    flag(typhon_held, Number, Number+1),
    assertz(held(Address, Number, Kind, Term, OnAnswer)),
    (   crew_tell(requests(Address))
    ->  true
    ;   fail_one(Address, Number)
    ).

%!  held(?Address) is semidet.
%
%   Something is held for Address.

held(Address) :-
    held(Address, _, _, _, _),
    !.

%!  held_send(+Address, +Session) is det.
%
%   Send in Session all that is held for Address. For the keeper only.

held_send(Address, Session) :-
    oldest(Address, Number, Row),
    !,
    send(Row, Session),
    retractall(held(Address, Number, _, _, _)),
    held_send(Address, Session).
held_send(_, _).

oldest(Address, Number, Row) :-
    Row = held(Address, Number, _, _, _),
    call(Row),
    !.

send(held(_, _, Kind, Term, OnAnswer), Session) :-
    catch(request_send(Session, Kind, Term, OnAnswer),
          error(Formal, Context),
          ( report(Formal, Context),
            request_answer(unreachable, OnAnswer) )).

report(session_closed, _) :-
    !.
report(Formal, Context) :-
    print_message(error, error(Formal, Context)).

%!  held_fail(?Address) is det.
%
%   There is no way to Address: say so.

held_fail(Address) :-
    findall(A-Number, held(A, Number, _, _, _), All),
    forall(member(Address-Number, All), fail_one(Address, Number)).

fail_one(Address, Number) :-
    (   retract(held(Address, Number, _, _, OnAnswer))
    ->  request_answer(unreachable, OnAnswer)
    ;   true
    ).

%!  held_forget(:OnAnswer) is det.
%
%   Nobody waits for this answer any more.

held_forget(OnAnswer) :-
    retractall(held(_, _, _, _, OnAnswer)).
