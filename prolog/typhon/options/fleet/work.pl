:- module(typhon_fleet_work,
          [ put_work/3,                 % +Fleet, +Queue, +Tasks
            take_work/4,                % +Fleet, +Queue, +Worker, -Work
            keep_work/4,                % +Fleet, +Queue, +Worker, +Work
            done_work/4,                % +Fleet, +Queue, +Work, +Result
            left_work/3,                % +Fleet, +Queue, -Left
            results_of_work/3           % +Fleet, +Queue, -Results
          ]).
:- use_module(library(error), [must_be/2, type_error/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(engine, [engine/3, engine_key/3, engine_script/4]).
:- use_module(members, [must_be_fleet/1]).

/** <module> Queues of work in a fleet

Workers are any threads of members; they need no hosts.  A worker that is alive
but too slow works in vain, and changes nothing.

*Threading*: any thread that may wait.
*/

:- setting(typhon_fleet:work_seconds, number, 5,
           "Seconds of silence after which work goes to another worker").

%!  put_work(+Fleet, +Queue, +Tasks:list) is det.
%!  take_work(+Fleet, +Queue, +Worker, -Work) is semidet.
%!  keep_work(+Fleet, +Queue, +Worker, +Work) is semidet.
%!  done_work(+Fleet, +Queue, +Work, +Result) is det.
%!  left_work(+Fleet, +Queue, -Left:integer) is det.
%!  results_of_work(+Fleet, +Queue, -Results:list) is det.
%
%   See work_put/3, work_take/4, work_keep/4, work_done/4, work_left/3,
%   work_results/3.

put_work(Fleet, Queue, Tasks) :-
    must_be(list, Tasks),
    must_be_queue(Fleet, Queue),
    put_from(Tasks, 1, Fleet, Queue).

%   The engine serves others between two thousands.

put_from(Tasks, N, Fleet, Queue) :-
    (   length(Some, 1000),
        append(Some, [Next|Rest], Tasks)
    ->  true
    ;   Some = Tasks,
        Rest = none
    ),
    numbered(Some, N, Args),
    engine_script(Fleet, work_put, [Queue|Args], _),
    (   Rest == none
    ->  true
    ;   N1 is N+1000,
        put_from([Next|Rest], N1, Fleet, Queue)
    ).

numbered([], _, []).
numbered([Task|Tasks], N, [N,Text|Args]) :-
    format(string(Text), '~k', [Task]),
    N1 is N+1,
    numbered(Tasks, N1, Args).

take_work(Fleet, Queue, Worker, Work) :-
    must_be(atomic, Worker),
    must_be_queue(Fleet, Queue),
    setting(typhon_fleet:work_seconds, Seconds),
    Patience is integer(1000*Seconds),
    engine_script(Fleet, work_take, [Queue,Worker,Patience], Reply),
    taken(Reply, Work).

taken([Entry,N0,Text], work(Entry, N, Task)) :-
    number_string(N, N0),
    term_string(Task, Text).
taken([Left], none) :-
    Left > 0.

keep_work(Fleet, Queue, Worker, Work) :-
    must_be(atomic, Worker),
    must_be_work(Work, Entry, _),
    must_be_queue(Fleet, Queue),
    engine_script(Fleet, work_keep, [Queue,Worker,Entry], 1).

done_work(Fleet, Queue, Work, Result) :-
    must_be_work(Work, Entry, N),
    must_be(ground, Result),
    must_be_queue(Fleet, Queue),
    format(string(Text), '~k', [Result]),
    engine_script(Fleet, work_done, [Queue,Entry,N,Text], _).

left_work(Fleet, Queue, Left) :-
    must_be_queue(Fleet, Queue),
    engine_key(Fleet, [work,Queue], Key),
    engine(Fleet, xlen(Key), Left).

results_of_work(Fleet, Queue, Results) :-
    must_be_queue(Fleet, Queue),
    engine_key(Fleet, [results,Queue], Key),
    engine(Fleet, hgetall(Key), Pairs),
    findall(N-Result,
            ( member(N0-Text, Pairs),
              Text \== "",
              number_string(N, N0),
              term_string(Result, Text) ),
            Unsorted),
    keysort(Unsorted, Results).

must_be_queue(Fleet, Queue) :-
    must_be(atom, Queue),
    must_be_fleet(Fleet).

must_be_work(Work, Entry, N) :-
    must_be(nonvar, Work),
    (   Work = work(Entry, N, _),
        atomic(Entry),
        integer(N)
    ->  true
    ;   type_error(work, Work)
    ).
