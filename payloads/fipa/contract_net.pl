:- payload(fipa_contract_net, [provides([fipa_call/4, fipa_award/4])]).

/*  The initiator of FIPA's contract net (FIPA00029): calls for proposals,
    and awards the contract to one of the proposers.  Needs reply/3, which
    the place of a FIPA platform host or the payload fipa/reply defines.
*/

%!  fipa_call(+Participants, +Task, +Seconds, -Proposals) is det.
%
%   Asks each of Participants for a proposal for Task.  Proposals is a list of
%   Offer-Acl in order of arrival, complete when all have answered or Seconds
%   of host time have passed.

fipa_call(Participants, Task, Seconds, Proposals) :-
    N is random(1<<60),
    format(atom(Id), 'c~36r', [N]),
    now(Now),
    Until is Now+Seconds,
    get_time(Real),
    By is Real+Seconds,
    forall(member(To, Participants),
           send(To, acl(cfp, [ content(Task), protocol('fipa-contract-net'),
                               conversation_id(Id), reply_with(Id),
                               reply_by(By) ]))),
    length(Participants, Count),
    fipa_call_answers(Count, Id, Until, Proposals).

fipa_call_answers(0, _, _, []) :-
    !.
fipa_call_answers(Count, Id, Until, Proposals) :-
    now(Now),
    Left is max(0, Until-Now),
    (   receive(_-acl(Performative, [conversation_id(Id)|Parameters]), Left)
    ->  Count1 is Count-1,
        Acl = acl(Performative, [conversation_id(Id)|Parameters]),
        fipa_call_answer(Performative, Acl, Parameters, Proposals, More),
        fipa_call_answers(Count1, Id, Until, More)
    ;   Proposals = []
    ).

fipa_call_answer(propose, Acl, Parameters, [Offer-Acl|More], More) :-
    memberchk(content(Offer), Parameters),
    !.
fipa_call_answer(_, _, _, More, More).

%!  fipa_award(+Proposals, +Chosen, +Seconds, -Outcome) is det.
%
%   Accepts Chosen, one of Proposals, and rejects the others.  Outcome is
%   inform-Result, failure-Why or another performative with its content, or
%   `timeout`.  Proposals that arrive during this call are rejected as too
%   late.

fipa_award(Proposals, Chosen, Seconds, Outcome) :-
    Chosen = Offer-Acl,
    Acl = acl(propose, [conversation_id(Id)|Parameters]),
    memberchk(sender(fipa(Name, _)), Parameters),
    now(Now),
    Until is Now+Seconds,
    reply(Acl, 'accept-proposal', Offer),
    forall(( member(OtherOffer-Other, Proposals), Other \== Acl ),
           reply(Other, 'reject-proposal', OtherOffer)),
    fipa_award_outcome(Id, Name, Until, Outcome).

fipa_award_outcome(Id, Name, Until, Outcome) :-
    now(Now),
    Left is max(0, Until-Now),
    (   receive(From-acl(Performative, [conversation_id(Id)|Parameters]), Left)
    ->  Acl = acl(Performative, [conversation_id(Id)|Parameters]),
        fipa_award_heard(Performative, From, Acl, Id, Name, Until, Outcome)
    ;   Outcome = timeout
    ).

fipa_award_heard(propose, _, Acl, Id, Name, Until, Outcome) :-
    !,
    reply(Acl, 'reject-proposal', "too late"),
    fipa_award_outcome(Id, Name, Until, Outcome).
fipa_award_heard(Performative, fipa(From), acl(_, Parameters), Id, Name, Until,
                 Outcome) :-
    (   fipa_award_about(Performative, From, Name, Parameters)
    ->  (   memberchk(content(Content), Parameters)
        ->  true
        ;   Content = ""
        ),
        Outcome = Performative-Content
    ;   fipa_award_outcome(Id, Name, Until, Outcome)
    ).

%   The sender is the contractor itself, or an AMS that could not reach it.

fipa_award_about(_, Name, Name, _) :-
    !.
fipa_award_about(failure, _, Name, Parameters) :-
    memberchk(content([_, 'MTS-error'(fipa(Name, _), _)]), Parameters).
