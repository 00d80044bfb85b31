:- module(test_work, []).

% Queues of work in the engine: each task has one result, whoever dies.

:- use_module('../../../lib/common').
:- use_module('../../../lib/redis').
:- use_module(library(lists), [numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(settings), [set_setting/2, setting/2]).
:- use_module(library(typhon)).

:- needs([fleet]).

:- meta_predicate
    joined(0),
    joined(-, 0),
    within(+, 0).

joined(Goal) :-
    joined(_, Goal).

joined(Redis, Goal) :-
    with_fleet([], Redis, [], Goal).

%   within(+Seconds, :Goal): workers may be silent for Seconds.

within(Seconds, Goal) :-
    fleet_join_settings,
    setting(typhon_fleet:work_seconds, Old),
    setup_call_cleanup(set_setting(typhon_fleet:work_seconds, Seconds),
                       Goal,
                       set_setting(typhon_fleet:work_seconds, Old)).

%   The setting exists when its module is loaded.

fleet_join_settings :-
    catch(work_results(no_fleet, q, _), error(existence_error(_, _), _), true).

done(Queue, Worker, Result) :-
    work_take(lab, Queue, Worker, Work),
    Work = work(_, _, _),
    work_done(lab, Queue, Work, Result).

%   got(+Queue, +Worker, -Work): when others have lost it.

got(Queue, Worker, Work) :-
    wait_until(( work_take(lab, Queue, Worker, Work), Work \== none ), 10).

:- begin_tests(work).

test(tasks_are_taken_in_order_and_numbered,
     Tasks == [1-f(x),2-"t",3-('A b'-[])]) :-
    joined(( work_put(lab, q, [f(x), "t", 'A b'-[]]),
             findall(N-Task,
                     ( between(1, 3, _),
                       work_take(lab, q, w, work(_, N, Task)) ),
                     Tasks) )).
test(what_others_have_is_none_and_an_end_is_failure) :-
    joined(( work_put(lab, q, [a]),
             work_take(lab, q, w1, Work),
             work_take(lab, q, w2, none),
             work_left(lab, q, 1),
             work_done(lab, q, Work, r),
             work_left(lab, q, 0),
             \+ work_take(lab, q, w2, _),
             work_results(lab, q, [1-r]) )).
test(queue_that_was_never_put_is_at_its_end, fail) :-
    joined(work_take(lab, q, w, _)).
test(same_tasks_may_be_put_again, Results == [1-x,2-y,3-z]) :-
    joined(( work_put(lab, q, [a, b]),
             done(q, w, x),
             work_put(lab, q, [a, b, c]),
             done(q, w, y),
             work_put(lab, q, [a, b, c]),
             done(q, w, z),
             \+ work_take(lab, q, w, _),
             work_results(lab, q, Results) )).
test(silent_worker_loses_its_task_and_the_first_result_counts, Rs == [1-late]) :-
    joined(within(0.3,
        ( work_put(lab, q, [a]),
          work_take(lab, q, slow, Work),
          got(q, quick, Work2),
          Work = work(_, 1, a),
          Work2 = work(_, 1, a),
          work_done(lab, q, Work, late),
          work_done(lab, q, Work2, second),
          work_results(lab, q, Rs) ))).
test(worker_that_keeps_its_task_has_it) :-
    joined(within(1,
        ( work_put(lab, q, [a]),
          work_take(lab, q, slow, Work),
          get_time(T0),
          kept_until(T0+2, Work),
          \+ work_keep(lab, q, quick, Work),
          got(q, quick, Work),
          \+ work_keep(lab, q, slow, Work),
          work_done(lab, q, Work, r),
          \+ work_keep(lab, q, quick, Work) ))).
test(queues_are_separate, Rs == [1-a]) :-
    joined(( work_put(lab, p, [x]),
             work_put(lab, q, [x]),
             done(q, w, a),
             work_results(lab, p, []),
             work_results(lab, q, Rs) )).
test(empty_engine_has_no_work_and_takes_it_again, Rs == [1-b]) :-
    joined(Redis,
           ( work_put(lab, q, [x]),
             work_take(lab, q, w, Work),
             redis_empty(Redis),
             \+ work_keep(lab, q, w, Work),
             \+ work_take(lab, q, w, _),
             work_put(lab, q, [x]),
             work_done(lab, q, Work, b),
             work_results(lab, q, Rs) )).
test(more_than_a_thousand_tasks, Sum == 2503) :-
    numlist(1, 2503, Tasks),
    joined(( work_put(lab, q, Tasks),
             findall(x, done(q, w, r), _),
             all_done(q),
             work_results(lab, q, Results) )),
    length(Results, Sum).
test(errors) :-
    joined(forall(mistake(Goal, Formal),
                  catch(( Goal, fail ), error(Formal, _), true))).

:- end_tests(work).

all_done(Queue) :-
    (   done(Queue, w, r)
    ->  all_done(Queue)
    ;   true
    ).

kept_until(End, Work) :-
    get_time(Now),
    (   Now > End
    ->  true
    ;   work_keep(lab, q, slow, Work),
        work_take(lab, q, quick, none),
        kept_until(End, Work)
    ).

mistake(work_put(other, q, []), existence_error(fleet, other)).
mistake(work_put(lab, q, a), type_error(list, a)).
mistake(work_take(lab, "q", w, _), type_error(atom, "q")).
mistake(work_take(lab, q, f(x), _), type_error(atomic, f(x))).
