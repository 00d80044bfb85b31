:- module(test_participant, []).
:- use_module('../../lib/common', []).
:- use_module('../../lib/fake_agent').
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).

/** <module> The participant in FIPA's protocols: what it answers

*Threading*: one test at a time.
*/

%   It doubles numbers, raises an error for atoms, has nothing to say after
%   `wait`, and refuses everything else; it offers to double at the price 3.

participant :-
    fake_agent('payloads/fipa/participant.pl',
               [ (perform(X, _) :- \+ number(X), \+ X == wait, atom(X),
                                   atom_length(_, _)),
                 perform(wait, done),
                 (perform(X, Y) :- number(X), Y is 2*X),
                 (bid(X, price(3)) :- number(X)),
                 (bid(X, price(0)) :- atom(X), atom_length(_, _)),
                 (reply(acl(_, _), Performative, Content) :-
                      log(Performative-Content)) ], []).

%   heard(Steps, Answers): a step is At-said(From, Id, Performative, Content), Id
%   being `none` for a message without a conversation.

heard([0-said(a, 1, request, 7)], [inform-14]).
heard([0-said(a, 1, request, "x")], [refuse-_]).
heard([0-said(a, 1, request, [action(me, 7)])],
      [inform-[result(action(me, 7), 14)]]).
heard([0-said(a, 1, request, [action(me, wait)])],
      [inform-[done(action(me, wait))]]).
heard([0-said(a, 1, request, oops)], [failure-_]).
heard([0-said(a, 1, request, [action(me, oops)])],
      [failure-[action(me, oops),_]]).
heard([0-said(a, 1, request, [action(me, f(x))])],
      [refuse-[action(me, f(x)),_]]).
heard([0-said(a, 1, cfp, 7), 1-said(a, 1, 'accept-proposal', none)],
      [propose-price(3),inform-14]).
heard([0-said(a, none, cfp, 7), 1-said(a, none, 'accept-proposal', none)],
      [propose-price(3),inform-14]).
heard([0-said(a, 1, cfp, [action(me, 7)]),
       1-said(a, 1, 'accept-proposal', none)],
      [propose-price(3),inform-[result(action(me, 7), 14)]]).
heard([0-said(a, 1, cfp, "x")], [refuse-"x"]).
heard([0-said(a, 1, cfp, oops)], [refuse-oops]).
heard([0-said(a, 1, 'accept-proposal', none)], ['not-understood'-_]).
heard([0-said(a, 1, cfp, 7), 1-said(a, 1, 'accept-proposal', none),
       2-said(a, 1, 'accept-proposal', none)],
      [propose-_,inform-14,'not-understood'-_]).
heard([0-said(a, 1, cfp, 7), 1-said(From, Id, 'accept-proposal', none)],
      [propose-_,'not-understood'-_]) :-
    member(From-Id, [b-1, a-2, a-none]).
heard([0-said(a, 1, cfp, 7), 1-said(a, 1, 'reject-proposal', none),
       2-said(a, 1, 'accept-proposal', none)],
      [propose-_,'not-understood'-_]).
heard([0-said(a, 1, cfp, 7), 1-said(From, Id, 'reject-proposal', none),
       2-said(a, 1, 'accept-proposal', none)],
      [propose-_,inform-14]) :-
    member(From-Id, [b-1, a-2]).
heard([0-said(a, 1, cfp, 7), Time-said(b, 2, cfp, 7),
       Time-said(a, 1, 'accept-proposal', none)],
      [propose-_,propose-_,Last-_]) :-
    member(Time-Last, [600-inform, 600.5-'not-understood']).

hears(Time-said(From, Id, Performative, Content)) :-
    fake_at(Time),
    findall(Parameter,
            ( member(Parameter, [ sender(fipa(From, [])), content(Content),
                                  conversation_id(Id) ]),
              arg(1, Parameter, Value),
              Value \== none ),
            Parameters),
    fake_agent:fipa_take_part(acl(Performative, Parameters)).

:- begin_tests(participant).

test(answers, [forall(heard(Steps, Expected)), nondet]) :-
    participant,
    forall(member(Step, Steps), assertion(hears(Step))),
    did(Acts),
    findall(log(Answer), member(Answer, Expected), Logged),
    assertion(alike(Logged, Acts)).
test(messages_of_other_protocols_are_left,
     [forall(member(Performative, [inform, 'query-ref']))]) :-
    participant,
    \+ fake_agent:fipa_take_part(acl(Performative, [sender(fipa(a, []))])).
test(what_is_performed_is_over,
     [forall(member(Performative, [cfp, request])), Left == [] ]) :-
    participant,
    hears(0-said(a, 1, cfp, 7)),
    hears(1-said(a, 1, 'accept-proposal', none)),
    hears(601-said(a, 2, Performative, 8)),
    hears(601-said(a, 2, 'accept-proposal', none)),
    findall(Id, ( fake_agent:fipa_contract(Id, _, _, _), Id \== none ), Left).

:- end_tests(participant).
