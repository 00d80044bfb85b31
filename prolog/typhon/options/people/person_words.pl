:- module(typhon_person_words,
          [ ask/2,                      % +Question, -Answer
            choose/3,                   % +Question, +Choices, -Choice
            show/1,                     % +What
            person_ask/3                % +Question, +Kind, -Number
          ]).
:- use_module(library(error),
              [domain_error/2, must_be/2, resource_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/error_text', [is_tree/2]).
:- use_module('../../kernel/wire', [mobile_term/1, random_hex/2]).
:- use_module('../../kernel/host', [context/3, context_now/2, parts_call/3]).
:- use_module(person_questions, [question_put/5]).

/** <module> Services of a host that has a person

The machine unfolds ask/2 and choose/3, see waiting_service/3 of typhon_bodies:
the agent waits for a message, occupies no thread, and may be moved meanwhile.

*Threading*: the thread that runs the agent.
*/

:- setting(cells, positive_integer, 2000,
           "Cells of a question with its choices, at most; eight characters of a text count as one").

%!  ask(+Question, -Answer) is semidet.
%!  choose(+Question, +Choices:list, -Choice) is semidet.
%
%   Ask the person of this host.  Question is text, or a term, which is shown as
%   Prolog writes it.  Answer is a string; for number(Question) it is a number.
%   Choice is one of Choices, which are ground.  Both fail if the host stops
%   before the person has answered.
%
%   @error permission_error(call, control_predicate, PI) inside a goal that
%          Prolog runs to its end, such as findall/3
%   @error the errors of person_ask/3

ask(_, _) :-
    cannot_wait(ask/2).

choose(_, _, _) :-
    cannot_wait(choose/3).

cannot_wait(PI) :-
    throw(error(permission_error(call, control_predicate, PI),
                context(PI, 'an agent cannot stop inside a goal that \c
                             Prolog runs to its end'))).

%!  show(+What) is det.
%
%   Show What, text or a term, to the person of this host.  The last twenty
%   remain visible.
%
%   @error type_error(mobile_term, Culprit), resource_error(question_cells)

show(What) :-
    context_now(Host, Agent),
    put(Host, Agent, What, shown, _).

%!  person_ask(+Question, +Kind, -Number:atom) is det.
%
%   Put a question to the person of this host, and do not wait.  Kind is `text`
%   or choice(Choices).  This agent gets one message
%   people-answer(Number, Given), where Given is given(Answer), or `none` if the
%   host stops before the person has answered.
%
%   @error type_error(mobile_term, Culprit), resource_error(question_cells)
%   @error resource_error(questions): too many wait for this person
%   @error domain_error(question_kind, Kind), instantiation_error,
%          type_error(list, Choices), domain_error(choices, Choices)

person_ask(Question, Kind, Number) :-
    must_be_kind(Kind),
    context(Host, Id, _),
    put(Host, Id, Question, Kind, Number).

put(Host, Agent, What, Kind, Number) :-
    mobile_term(What-Kind),
    setting(cells, Most),
    ( is_tree(What-Kind, Most) -> true ; resource_error(question_cells) ),
    parts_call(acts, Host, [Agent, say(What-Kind)]),
    random_hex(8, Number),
    question_put(Host, Number, Agent, What, Kind).

must_be_kind(Kind) :-
    must_be(nonvar, Kind),
    (   Kind = choice(Choices)
    ->  must_be(list, Choices),
        must_be(ground, Choices),
        ( Choices == [] -> domain_error(choices, Choices) ; true )
    ;   Kind == text
    ->  true
    ;   domain_error(question_kind, Kind)
    ).
