:- payload(fipa_participant, [provides([fipa_take_part/1, fipa_contract/4])]).

/*  The participant in FIPA's request protocol (FIPA00026) and contract net
    (FIPA00029).  An agent with this payload defines

        on_message(_, Acl) :- fipa_take_part(Acl).

    and

      - perform(Action, Result): executes a request.  If perform/2 fails, the
        answer is `refuse`; if it raises an error, `failure`.
      - bid(Task, Offer): the proposal after a call for proposals, in contract
        nets only.  If bid/2 fails, the answer is `refuse`.

    For a content [action(Agent, Action)], as in SL, perform/2 gets Action, and
    the answer is result(action(Agent, Action), Result), or done(...) where
    Result is `done`.  For any other content perform/2 gets the content itself,
    and the answer is Result.  Needs reply/3, which the place of a FIPA platform
    host or the payload fipa/reply defines.
*/

%   A proposal of this agent: the conversation, the initiator, the message,
%   and the time of its expiry.

fipa_contract(none, none, none, 0).

%   Proposals expire, since an initiator may never answer them.

fipa_contract_seconds(600).

%!  fipa_take_part(+Acl) is semidet.
%
%   Fails for messages of other protocols.

fipa_take_part(Acl) :-
    Acl = acl(Performative, Parameters),
    (   memberchk(content(Content), Parameters)
    ->  true
    ;   Content = ""
    ),
    fipa_part(Performative, Content, Acl).

fipa_part(request, Content, Acl) :-
    fipa_performed(Content, Performative, Answer),
    reply(Acl, Performative, Answer).
fipa_part(cfp, Content, Acl) :-
    fipa_part_action(Content, Task),
    fipa_part_conversation(Acl, Id, From),
    (   catch(bid(Task, Offer), error(_, _), fail)
    ->  now(Now),
        fipa_contracts_over(Now),
        fipa_contract_seconds(Seconds),
        Until is Now+Seconds,
        assertz(fipa_contract(Id, From, Content, Until)),
        reply(Acl, propose, Offer)
    ;   reply(Acl, refuse, Content)
    ).
fipa_part('accept-proposal', _, Acl) :-
    fipa_part_conversation(Acl, Id, From),
    (   retract(fipa_contract(Id, From, Content, _))
    ->  fipa_performed(Content, Performative0, Answer),
        (   Performative0 == refuse     % an accepted proposal is not refused
        ->  Performative = failure
        ;   Performative = Performative0
        ),
        reply(Acl, Performative, Answer)
    ;   reply(Acl, 'not-understood', ['unexpected-act'('accept-proposal')])
    ).
fipa_part('reject-proposal', _, Acl) :-
    fipa_part_conversation(Acl, Id, From),
    retractall(fipa_contract(Id, From, _, _)).

fipa_part_conversation(acl(_, Parameters), Id, From) :-
    memberchk(sender(fipa(From, _)), Parameters),
    (   memberchk(conversation_id(Id), Parameters)
    ->  true
    ;   Id = none
    ).

fipa_contracts_over(Now) :-
    forall(( fipa_contract(Id, From, _, Until), Id \== none, Until < Now ),
           retract(fipa_contract(Id, From, _, Until))).

fipa_part_action([action(_, Action)|_], Action) :-
    !.
fipa_part_action(Content, Content).

fipa_performed(Content, Performative, Answer) :-
    fipa_part_action(Content, Action),
    catch(fipa_performed(Action, Content, Performative, Answer),
          error(Formal, _),
          ( format(string(Why), '~p', [Formal]),
            fipa_part_reason(Content, Why, Answer),
            Performative = failure )).

fipa_performed(Action, Content, Performative, Answer) :-
    (   perform(Action, Result)
    ->  Performative = inform,
        fipa_part_result(Content, Result, Answer)
    ;   Performative = refuse,
        fipa_part_reason(Content, "it cannot be done", Answer)
    ).

fipa_part_result([action(Agent, Action)|_], done,
                 [done(action(Agent, Action))]) :-
    !.
fipa_part_result([action(Agent, Action)|_], Result,
                 [result(action(Agent, Action), Result)]) :-
    !.
fipa_part_result(_, Result, Result).

fipa_part_reason([action(Agent, Action)|_], Why,
                 [action(Agent, Action), Why]) :-
    !.
fipa_part_reason(_, Why, Why).
