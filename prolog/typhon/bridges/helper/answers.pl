:- module(typhon_helper_answers,
          [ request_line/2,             % +Request, -Line
            request_line/4,             % +Request, +Seconds, -Id, -Line
            said/3,                     % +Name, +Owner, +Dict
            answer/2,                   % +Queue, +Answer
            answer_awaited/2,           % +Id, +Queue
            answer_unwanted/1,          % +Id
            answer_all/1,               % +Answer
            answer_died/2               % +Answer0, -Answer
          ]).
:- use_module('../../kernel/base/json', [atom_json_dict/3]).

/** <module> What is said to helpers, and by them

Requests and answers are JSON objects with the same id; what has no id but
an `event` was said unasked.

*Threading*: said/3 and heard/2 are run by the thread that reads what the
helper writes; heard/2 must not wait for the helper.  answer_awaited/2,
answer_all/1 and answer_died/2 are for owners.
*/

:- multifile
    heard/2.                    % Name, Dict: the helper has said it unasked

:- dynamic
    awaited/3,                  % Id, Queue, Owner: written, not yet answered
    complaint/2.                % Owner, Dict: an error, but of no request

%!  request_line(+Request:dict, -Line:string) is det.
%!  request_line(+Request:dict, +Seconds, -Id, -Line:string) is det.
%
%   Line says Request, that needs no answer; or with a new Id, and how
%   long it may take.

request_line(Request, Line) :-
    atom_json_dict(Line, Request, [as(string), width(0)]).

request_line(Request0, Seconds, Id, Line) :-
    flag(typhon_helper_request, Id, Id+1),
    put_dict(_{id:Id, timeout:Seconds}, Request0, Request),
    request_line(Request, Line).

%!  said(+Name, +Owner, +Dict) is det.
%
%   What the helper Name of the thread Owner has said.

said(_, Owner, Dict) :-
    get_dict(id, Dict, Id),
    integer(Id),
    !,
    retractall(complaint(Owner, _)),
    (   retract(awaited(Id, Queue, _))
    ->  answer_of(Dict, Answer),
        answer(Queue, Answer)
    ;   true                            % no caller waits any more
    ).
said(Name, _, Dict) :-
    get_dict(event, Dict, _),
    !,
    ignore(heard(Name, Dict)).
said(_, Owner, Dict) :-
    get_dict(error, Dict, _),
    !,
    retractall(complaint(Owner, _)),
    assertz(complaint(Owner, Dict)).
said(_, _, _).

answer_of(Dict, ok(Reply)) :-
    get_dict(ok, Dict, Reply),
    !.
answer_of(Dict, said(Dict)).

%!  answer(+Queue, +Answer) is det.

answer(Queue, Answer) :-
    catch(thread_send_message(Queue, answer(Answer)),
          error(existence_error(_, _), _),
          true).                        % no caller waits any more

%!  answer_awaited(+Id, +Queue) is det.
%!  answer_unwanted(+Id) is det.
%
%   The answer to Id, which is asked by the owner now, is for Queue; it is for
%   no caller any more.

answer_awaited(Id, Queue) :-
    thread_self(Owner),
    assertz(awaited(Id, Queue, Owner)).

answer_unwanted(Id) :-
    retractall(awaited(Id, _, _)).

%!  answer_all(+Answer) is det.
%!  answer_died(+Answer0, -Answer) is det.
%
%   What the owner has asked gets Answer: Answer0, or what the process had said
%   of itself before it ended.

answer_all(Answer) :-
    thread_self(Owner),
    (   retract(awaited(_, Queue, Owner))
    ->  answer(Queue, Answer),
        answer_all(Answer)
    ;   true
    ).

answer_died(Answer0, Answer) :-
    thread_self(Owner),
    (   retract(complaint(Owner, Dict))
    ->  Answer = said(Dict)
    ;   Answer = Answer0
    ),
    answer_all(Answer).
