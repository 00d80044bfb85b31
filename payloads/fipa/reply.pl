:- payload(fipa_reply, [provides([reply/3])]).

/*  An answer to a message of FIPA's ACL.  Hosts with library(typhon/fipa)
    have it in their place; an agent that answers from other hosts attaches
    it.
*/

:- include(answer).

%!  reply(+Acl, +Performative, +Content) is det.
%
%   Answer the message Acl, which has come from fipa(Name), in its
%   conversation.  The answer goes out by the host at which Acl has come in.

reply(Acl, Performative, Content) :-
    fipa_answer(Acl, Performative, Content, To, Answer),
    Acl = acl(_, Parameters),
    (   memberchk(via(Host), Parameters)
    ->  send(at(To, Host), Answer)
    ;   send(To, Answer)
    ).
