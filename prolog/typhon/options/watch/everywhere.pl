:- module(typhon_everywhere,
          [ everywhere/5                % +Places, +Question, +Seconds,
                                        % -Answers, -Silent
          ]).
:- use_module(library(apply), [partition/4]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../../kernel/wire',
              [endpoint_address/1, endpoint_ask_all/6, endpoint_reply/2]).
:- use_module('../../kernel/host', [as_guest/1, scheduler_call/1]).

/** <module> One question to all processes of a watch

*Threading*: any thread may ask, but those of the endpoint.  Workers answer:
there may be much to tell.
*/

:- multifile
    answer/2,                   % Question, Answer
    typhon_endpoint:requested/4.

%!  everywhere(+Places, +Question, +Seconds, -Answers, -Silent) is det.
%
%   Answers are Place-Answer, for those of the Places, see watched_places/2,
%   that have answered within Seconds, Silent the endpoints of the others.
%   The hook answer(Question, Answer) gives the answer.

everywhere(Places, Question, Seconds, Answers, Silent) :-
    partition(is_here, Places, Here, There),
    findall(Place-Answer,
            ( member(Place, Here), answer_to(Question, Answer) ), Own),
    ask(There, Question, Seconds, Results),
    findall(Place-Answer,
            ( member(Place, There),
              Place = place(Endpoint, _, _),
              memberchk(Endpoint-answer(Answer), Results) ),
            Others),
    append(Own, Others, Answers),
    findall(Endpoint,
            ( member(Endpoint-Result, Results), Result \= answer(_) ),
            Silent).

is_here(place(Endpoint, _, _)) :-
    endpoint_address(Endpoint).

ask([], _, _, []) :-
    !.
ask(Places, Question, Seconds, Results) :-
    findall(Endpoint, member(place(Endpoint, _, _), Places), Endpoints),
    as_guest(endpoint_ask_all(Endpoints, everywhere, Question,
                              typhon_everywhere:no_further, Seconds,
                              Results)).

:- public
    no_further/2,
    reply/2.                    % goal of a worker

no_further(_, []).

typhon_endpoint:requested(everywhere, Question, _, ReplyTo) :-
    scheduler_call(typhon_everywhere:reply(Question, ReplyTo)).

reply(Question, ReplyTo) :-
    answer_to(Question, Answer),
    endpoint_reply(ReplyTo, Answer).

answer_to(Question, Answer) :-
    once(answer(Question, Answer)).
