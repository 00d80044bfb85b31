:- module(typhon_ros_answers,
          [ answer_await/5,             % +Host, +Id, :Ask, +Seconds, -Answer
            answer_come/2,              % +Id, +Answer
            answers_fail/2              % +Host, +Why
          ]).

/** <module> Callers that wait for answers

*Threading*: any thread waits, at a queue of its own, so that what comes too
late is dropped.
*/

:- meta_predicate answer_await(+, +, 0, +, -).

:- dynamic
    awaited/3.                  % Id, Host, Queue

%!  answer_await(+Host, +Id, :Ask, +Seconds, -Answer) is det.
%
%   Run Ask once, and wait for what somebody says by answer_come/2.  Answer
%   is that, lost(Why), or `timeout`.

answer_await(Host, Id, Ask, Seconds, Answer) :-
    setup_call_cleanup(
        ( message_queue_create(Queue),
          assertz(awaited(Id, Host, Queue)) ),
        ( once(Ask),
          wait(Queue, Seconds, Answer) ),
        ( retractall(awaited(Id, _, _)),
          message_queue_destroy(Queue) )).

wait(Queue, Seconds, Answer) :-
    (   thread_get_message(Queue, answer(Answer0), [timeout(Seconds)])
    ->  Answer = Answer0
    ;   Answer = timeout
    ).

%!  answer_come(+Id, +Answer) is semidet.
%
%   Fails if no caller waits for it any more.

answer_come(Id, Answer) :-
    retract(awaited(Id, _, Queue)),
    !,
    catch(thread_send_message(Queue, answer(Answer)),
          error(existence_error(_, _), _),
          fail).

%!  answers_fail(+Host, +Why) is det.
%
%   Callers on Host that wait for an answer get lost(Why).

answers_fail(Host, Why) :-
    findall(Id, awaited(Id, Host, _), Ids),
    answers_lost(Ids, Why).

answers_lost([], _).
answers_lost([Id|Ids], Why) :-
    ignore(answer_come(Id, lost(Why))),
    answers_lost(Ids, Why).
