:- payload(fipa_reply, [provides([reply/3])]).

/*  Answers to messages of FIPA's ACL.  The place of hosts with
    library(typhon/fipa) defines reply/3; an agent that answers from other
    hosts attaches this payload.
*/

:- include(answer).

%!  reply(+Acl, +Performative, +Content) is det.
%
%   Answers the message Acl of fipa(Name) in its conversation.  The host that
%   received Acl sends the answer.

reply(Acl, Performative, Content) :-
    fipa_answer(Acl, Performative, Content, To, Answer),
    Acl = acl(_, Parameters),
    (   memberchk(via(Host), Parameters)
    ->  send(at(To, Host), Answer)
    ;   send(To, Answer)
    ).
