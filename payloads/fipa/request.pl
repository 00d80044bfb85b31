:- payload(fipa_request, [provides([fipa_request/4])]).

/*  The initiator of FIPA's request protocol (FIPA00026): requests an action
    from another agent, and waits for the result.
*/

%!  fipa_request(+To, +Content, +Seconds, -Outcome) is det.
%
%   Outcome is the answer of To, inform-Answer, refuse-Why, failure-Why or
%   'not-understood'-Why, or `timeout`.  A preceding `agree` is skipped.  The
%   AMS also answers failure-Why, if To is unreachable.  Seconds are host
%   seconds.

fipa_request(To, Content, Seconds, Outcome) :-
    N is random(1<<60),
    format(atom(Id), 'c~36r', [N]),
    now(Now),
    Until is Now+Seconds,
    send(To, acl(request, [ content(Content), protocol('fipa-request'),
                            conversation_id(Id), reply_with(Id) ])),
    fipa_request_outcome(Id, Until, Outcome).

fipa_request_outcome(Id, Until, Outcome) :-
    now(Now),
    Left is max(0, Until-Now),
    (   receive(_-acl(Performative, [conversation_id(Id)|Parameters]), Left)
    ->  fipa_request_heard(Performative, Parameters, Id, Until, Outcome)
    ;   Outcome = timeout
    ).

fipa_request_heard(agree, _, Id, Until, Outcome) :-
    !,
    fipa_request_outcome(Id, Until, Outcome).
fipa_request_heard(Performative, Parameters, _, _, Performative-Content) :-
    (   memberchk(content(Content), Parameters)
    ->  true
    ;   Content = ""
    ).
