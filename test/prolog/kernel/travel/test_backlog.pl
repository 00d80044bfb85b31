:- module(test_backlog, []).
:- use_module('../../../lib/common').
:- use_module(library(apply), [maplist/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/travel/backlog)).

/** <module> Messages that wait for a route: in order, and tried by one thread

*Threading*: the main thread, inside with_agent/2 as it were.
*/

:- begin_tests(backlog).

test(tried_in_order, true(Letters-Tries == [a,b]-0)) :-
    with_backlog([a,b], backlog_begin(x, Letters, Tries)).
test(one_tries_at_a_time) :-
    with_backlog([a], ( backlog_begin(x, _, _),
                        \+ backlog_begin(x, _, _) )).
test(back_in_front_of_what_came, true(Letters-Tries == [a,b,c]-3)) :-
    with_backlog([a,b],
                 ( backlog_begin(x, L0, _),
                   backlog_add(x, c),
                   backlog_again(x, L0, 3),
                   backlog_begin(x, Letters, Tries) )).
test(not_done_if_more_came, true(Letters == [c])) :-
    with_backlog([a],
                 ( backlog_begin(x, _, _),
                   backlog_add(x, c),
                   \+ backlog_done(x),
                   backlog_begin(x, Letters, _) )).
test(done) :-
    with_backlog([a],
                 ( backlog_begin(x, _, _),
                   backlog_done(x),
                   \+ backlog(x) )).
test(for_who_has_arrived, true(Letters == [a,b])) :-
    with_backlog([a,b], backlog_all(x, Letters)).
test(not_what_is_being_tried, true(Letters == [])) :-
    with_backlog([a,b],
                 ( backlog_begin(x, _, _),
                   backlog_all(x, Letters) )).

:- end_tests(backlog).

:- meta_predicate with_backlog(+, 0).

with_backlog(Letters, Goal) :-
    no_leaks(setup_call_cleanup(
                 maplist(backlog_add(x), Letters),
                 once(Goal),
                 emptied)).

emptied :-
    (   backlog_begin(x, _, _)
    ->  true
    ;   true
    ),
    (   backlog(x)
    ->  ( backlog_done(x) -> true ; emptied )
    ;   true
    ).
