:- module(test_fipa_answer, []).

% To which agent an answer to a message of FIPA goes, and what it takes over.

:- use_module('../../../lib/common', []).
:- use_module(library(lists), [memberchk/2, subtract/3]).
:- use_module(library(plunit)).

:- include('../../../../payloads/fipa/answer').

%   answered(+Asked, -To, -Parameters): an answer to a request with Asked, which
%   has Parameters beside its content and its own reply_with.

answered(Asked, To, Parameters) :-
    fipa_answer(acl(request, Asked), inform, done, To,
                acl(inform, [content(done)|Parameters0])),
    subtract(Parameters0, [reply_with(_)], Parameters).

%   answer(?Asked, ?To, ?Parameters)

answer([sender(a)], a, []).
answer([sender(a), reply_to([b])], b, []).
answer([reply_to([b, c]), sender(a)], b, []).
answer([sender(a), reply_to([])], a, []).
answer([sender(a), reply_with(r1)], a, [in_reply_to(r1)]).
answer([sender(a), in_reply_to(r0)], a, []).
answer([ontology(o), sender(a), protocol(p), conversation_id(c)], a,
       [conversation_id(c), protocol(p), ontology(o)]).
answer([sender(a), encoding(e), language(l), content(x), receiver([b]),
        reply_by(5), via(h)], a,
       [language(l), encoding(e)]).

:- begin_tests(fipa_answer).

test(receiver_and_conversation,
     [ forall(answer(Asked, To, Parameters)),
       true(To0-Parameters0 == To-Parameters) ]) :-
    answered(Asked, To0, Parameters0).
test(each_answer_may_be_answered, true(First \== Second)) :-
    own(First),
    own(Second).
test(message_without_a_sender_has_no_answer, fail) :-
    answered([content(x)], _, _).

own(Id) :-
    fipa_answer(acl(request, [sender(a)]), inform, done, _, acl(_, Own)),
    memberchk(reply_with(Id), Own),
    atom(Id).

:- end_tests(fipa_answer).
