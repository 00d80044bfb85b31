%   fipa_answer(+Acl, +Performative, +Content, -To, -Answer): Answer is the
%   answer to Acl in its conversation; To is its receiver.

fipa_answer(acl(_, Asked), Performative, Content, To,
            acl(Performative, [content(Content)|Parameters])) :-
    (   memberchk(reply_to([To0|_]), Asked)
    ->  To = To0
    ;   memberchk(sender(To), Asked)
    ),
    findall(Parameter, fipa_answer_parameter(Asked, Parameter), Parameters).

fipa_answer_parameter(Asked, in_reply_to(Id)) :-
    memberchk(reply_with(Id), Asked).
fipa_answer_parameter(_, reply_with(Id)) :-
    N is random(1<<60),
    format(atom(Id), 'r~36r', [N]).
fipa_answer_parameter(Asked, Same) :-
    member(Same, [ conversation_id(_), protocol(_), language(_), encoding(_),
                   ontology(_) ]),
    memberchk(Same, Asked).
