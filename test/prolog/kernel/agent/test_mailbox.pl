:- module(test_mailbox, []).
:- use_module('../../../lib/common').
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/travel/backlog)).
:- use_module(library(typhon/kernel/agent/mailbox)).

/** <module> Mailboxes: each message once, in order, whatever others get

*Threading*: each thread has the mailboxes of its own agents, as it would
have inside with_agent/2.
*/

:- begin_tests(mailbox).

test(the_oldest_that_unifies, true(X-Rest == 2-[a-1,b-3])) :-
    filled(me, [a-1,b-2,b-3]),
    mail_take(me, b-X),
    mail_all(me, Rest).
test(the_others_stay_in_order, [forall(member(N-K, [1-1, 2-1, 2-2, 12-3,
                                                    16-16, 17-9, 40-40])),
                                true(Left == Others)]) :-
    numlist(1, N, Numbers),
    findall(x-I, member(I, Numbers), All),
    filled(me, All),
    mail_take(me, x-K),
    mail_all(me, Left),
    findall(x-I, ( member(I, Numbers), I =\= K ), Others).
test(nothing_unifies, true(Rest == [a-1])) :-
    filled(me, [a-1]),
    \+ mail_take(me, b-_),
    mail_all(me, Rest).
test(no_mailbox, true(All-List == []-[])) :-
    \+ mail_take(nobody, _),
    mail_all(nobody, All),
    mail_list(nobody, List).
test(a_look_takes_nothing, true(Twice == [[1,2],[1,2]])) :-
    filled(me, [1,2]),
    mail_list(me, First),
    mail_all(me, Second),
    Twice = [First,Second].
test(older_ones_come_back_first, true(All == [1,2,3,4])) :-
    filled(me, [3,4]),
    mail_back(me, [1,2]),
    mail_all(me, All).
test(leaves_no_queue) :-
    no_leaks(( filled(me, [1,2]),
               mail_all(me, _) )).
test(others_that_wait_are_not_disturbed, true(Length-Waiting == 5000-8)) :-
    forall(between(1, 7, I),
           ( N is 60*I*I,
             numlist(1, N, Long),
             mail_put(me, [from-no(I, Long)]) )),
    numlist(1, 5000, Longest),
    mail_put(me, [from-yes(Longest)]),
    taken_again(200, [], Length),
    mail_all(me, Mail),
    length(Mail, Waiting).
test(each_once_while_others_receive, true(Bad == [])) :-
    busy_boxes(4, 8000, Bad).

:- end_tests(mailbox).

filled(Id, Messages) :-
    mail_all(Id, _),
    mail_put(Id, Messages).

%   The last message is taken, and put back, again and again, while more and
%   more of what was taken is kept: so stacks are collected in between.

taken_again(0, [Last|_], Length) :-
    !,
    length(Last, Length).
taken_again(N, Kept0, Length) :-
    mail_take(me, from-yes(List)),
    mail_put(me, [from-yes(List)]),
    (   N mod 7 =:= 0
    ->  Kept = [List]
    ;   Kept = [List|Kept0]
    ),
    N1 is N-1,
    taken_again(N1, Kept, Length).

%   Each of some threads fills and empties the box of its agent; Bad are the
%   lists that were not what had been put in.

busy_boxes(Threads, Rounds, Bad) :-
    numlist(1, Threads, Numbers),
    numlist(1, 8, Messages),
    concurrent_maplist(rounds(Rounds, Messages), Numbers, Lists),
    append(Lists, Bad).

rounds(Rounds, Messages, Number, Bad) :-
    findall(All,
            ( between(1, Rounds, Round),
              Agents is Round mod 40,
              atomic_list_concat([agent, Number, Agents], '.', Id),
              mail_put(Id, Messages),
              mail_all(Id, All),
              All \== Messages ),
            Bad).

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
