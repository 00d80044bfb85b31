:- module(typhon_person_questions,
          [ is_person/1,                % +Host
            invite/3,                   % +Host, +Seconds, -Token
            invited/2,                  % +Token, -Host
            uninvite/1,                 % +Host
            question_put/5,             % +Host, +Number, +Agent, +What, +Kind
            person_page/2,              % +Host, -Rows
            person_answer/3             % +Host, +Number, +Given
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(error),
              [domain_error/2, existence_error/2, must_be/2, resource_error/1]).
:- use_module(library(lists), [append/3, member/2, nth1/3, subtract/3]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/durable',
              [ deferred_act/4, durable/5, durable_assertz/1, durable_closed/0,
                durable_drop/3, durable_put/4, durable_retractall/1,
                effects_deferred/0, sync_changes/0, unit_of_work/1 ]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../../kernel/host', [host_option/2]).
:- use_module('../../kernel/travel', [agent_outcome/2, post/3, post_on/2]).
:- use_module('../../kernel/wire', [random_hex/2]).

/** <module> Questions that wait for a person, and tokens of those who answer

With a journal a person sees a question when the turn of its agent is committed, so
no question is asked twice; an answer, and the end of its question, are one unit of
work.  Of several answers to a question the first counts.

*Threading*: any thread.  Exactly one thread retracts a question, and that one
sends the message.  A mutex serialises changes of tokens.
*/

:- multifile
    typhon_durable:act/3,
    typhon_host_parts:ends/1.

:- setting(questions, positive_integer, 200,
           "Questions that wait for a person, at most").
:- setting(characters, positive_integer, 2000,
           "Characters of the answer of a person, at most").

:- dynamic
    question/6,                         % Number, N, Host, Agent, What, Kind
    invitation/3.                       % Host, Hash, Until: as in get_time/1

:- durable(question, Number, N, asked(Host, Agent, What, Kind),
           question(Number, N, Host, Agent, What, Kind)).
:- durable(invitation, Host, 0, Hash-Until, invitation(Host, Hash, Until)).

                /*******************************
                *            HOSTS             *
                *******************************/

%   If the journal is closed already, the questions stay in it.

typhon_host_parts:ends(Host) :-
    findall(Number-Agent, question(Number, _, Host, Agent, _, _), Pairs),
    forall(member(Number-Agent, Pairs), unanswered(Number, Agent)),
    uninvite(Host).

unanswered(Number, Agent) :-
    (   retract(question(Number, N, _, _, _, Kind)),
        \+ durable_closed
    ->  durable_drop(question, Number, N),
        ( Kind == shown -> true ; answer_none(Agent, Number) )
    ;   true
    ).

answer_none(Agent, Number) :-
    ignore(post_on(Agent, [people-answer(Number, none)])).

%!  is_person(+Host) is semidet.
%
%   Host, of this process, has people(true).

is_person(Host) :-
    host_option(Host, people(true)).

%!  invite(+Host, +Seconds, -Token:atom) is det.
%!  uninvite(+Host) is det.
%
%   Token, of 128 random bits, is valid for Seconds, and replaces an earlier
%   token for Host; no token is valid for Host any more.  Only the hash of a
%   token is kept, also in journals and saved networks.

invite(Host, Seconds, Token) :-
    random_hex(16, Token),
    hash(Token, Hash),
    get_time(Now),
    Until is Now+Seconds,
    with_mutex(typhon_invitations,
               ( durable_retractall(invitation(Host, _, _)),
                 durable_assertz(invitation(Host, Hash, Until)) )).

uninvite(Host) :-
    with_mutex(typhon_invitations, durable_retractall(invitation(Host, _, _))).

%!  invited(+Token:atom, -Host) is semidet.
%
%   Token is valid for Host now.  The comparison is one of hashes, so its time
%   tells nothing about valid tokens.

invited(Token, Host) :-
    hash(Token, Hash),
    invitation(Host, Hash, Until),
    !,
    get_time(Now),
    Now < Until.

hash(Token, Hash) :-
    sha_hash(Token, Bytes, [algorithm(sha256), encoding(utf8)]),
    hash_atom(Bytes, Hash).

                /*******************************
                *           QUESTIONS          *
                *******************************/

%!  question_put(+Host, +Number, +Agent, +What, +Kind) is det.
%
%   Show What to the person of Host.  Kind is as in person_ask/3, or `shown`.
%
%   @error resource_error(questions)

question_put(Host, Number, Agent, What, Kind) :-
    ( fits(Kind, Host) -> true ; resource_error(questions) ),
    (   effects_deferred
    ->  deferred_act(asked, Host, asked(Number, Agent, What, Kind), any)
    ;   put(Host, Number, Agent, What, Kind)
    ).

typhon_durable:act(asked, Host, asked(Number, Agent, What, Kind)) :-
    (   fits(Kind, Host)
    ->  put(Host, Number, Agent, What, Kind)
    ;   answer_none(Agent, Number)
    ).

fits(shown, _) :-
    !.
fits(_, Host) :-
    setting(questions, Most),
    aggregate_all(count, ( question(_, _, Host, _, _, Kind), Kind \== shown ),
                  Count),
    Count < Most.

put(Host, Number, Agent, What, Kind) :-
    durable_assertz(question(Number, _, Host, Agent, What, Kind)),
    ( Kind == shown -> hide_oldest(Host) ; true ).

%   The last twenty remain visible.

hide_oldest(Host) :-
    findall(Number, question(Number, _, Host, _, _, shown), Numbers),
    length(Last, 20),
    (   append([Oldest|_], Last, Numbers)
    ->  unanswered(Oldest, none),
        hide_oldest(Host)
    ;   true
    ).

%!  person_page(+Host, -Rows:list) is det.
%
%   Rows are asked(Number, Agent, What, Kind), the oldest first, without
%   questions of agents that are known to have ended.  On return they are
%   committed where there is a journal.

person_page(Host, Rows) :-
    findall(asked(Number, Agent, What, Kind),
            ( question(Number, _, Host, Agent, What, Kind),
              ( Kind == shown -> true ; \+ over(Number, Agent) ) ),
            Rows),
    ( Rows == [] -> true ; sync_changes ).

over(Number, Agent) :-
    agent_outcome(Agent, _),
    unanswered(Number, Agent).

                /*******************************
                *            ANSWERS           *
                *******************************/

%!  person_answer(+Host, +Number:atom, +Given) is det.
%
%   The person of Host answers the question Number.  Given comes from anywhere:
%   a string, or, for choices, the place of one of them.  On return the message
%   is sent, and committed where there is a journal.  If the caller is
%   interrupted the answer counts all the same.
%
%   @error existence_error(question, Number): Host has no such question, or it
%          has been answered
%   @error existence_error(agent, Agent): the agent has ended
%   @error host_unreachable(Host), resource_error(mailbox): the question stays
%   @error type_error(_, Given), domain_error(choice, Given),
%          resource_error(answer_characters)

person_answer(Host, Number, Given) :-
    must_be(atom, Number),
    (   question(Number, _, Host, _, What, Kind),
        Kind \== shown
    ->  answer_of(Kind, What, Given, Answer)
    ;   existence_error(question, Number)
    ),
    in_own_thread(typhon_person_questions:settle(Number, Answer)).

answer_of(choice(Choices), _, Given, Choice) :-
    must_be(integer, Given),
    ( nth1(Given, Choices, Choice) -> true ; domain_error(choice, Given) ).
answer_of(text, What, Given, Answer) :-
    must_be(string, Given),
    string_length(Given, Length),
    setting(characters, Most),
    ( Length =< Most -> true ; resource_error(answer_characters) ),
    (   subsumes_term(number(_), What)
    ->  must_be_number(Given, Answer)
    ;   Answer = Given
    ).

%   number_string/2 reads Prolog, which has more numbers than people.

must_be_number(Given, Number) :-
    split_string(Given, "", " ", [Text]),
    string_codes(Text, Codes),
    (   subtract(Codes, `0123456789+-.eE`, []),
        length(Codes, Length),
        Length =< 40,
        catch(number_string(Number, Text), error(_, _), fail)
    ->  true
    ;   domain_error(number, Given)
    ).

settle(Number, Answer) :-
    Fact = question(Number, N, _, Agent, _, _),
    ( retract(Fact) -> true ; existence_error(question, Number) ),
    catch(unit_of_work(( durable_drop(question, Number, N),
                         post(Agent, people, answer(Number, given(Answer))) )),
          error(Formal, Context),
          not_sent(Formal, Context, Fact)),
    sync_changes.

%   What was dropped may be queued already: so the question is put again.

not_sent(existence_error(agent, Agent), Context, Fact) :-
    !,
    Fact = question(Number, N, _, _, _, _),
    durable_drop(question, Number, N),
    throw(error(existence_error(agent, Agent), Context)).
not_sent(Formal, Context, Fact) :-
    Fact = question(Number, N, Host, Agent, What, Kind),
    durable_put(question, Number, N, asked(Host, Agent, What, Kind)),
    assertz(Fact),
    throw(error(Formal, Context)).
