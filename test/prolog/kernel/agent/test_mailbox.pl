:- module(test_mailbox, []).
:- use_module('../../../lib/common').
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/agent)).

/** <module> Mailboxes: each message once, in order, whatever other agents get

*Threading*: each thread has the mailboxes of its own agents, as it would
have inside with_agent/2.
*/

:- begin_tests(mailbox).

test(oldest_unifying_message_is_taken, true(X-Rest == 2-[a-1,b-3])) :-
    filled(me, [a-1,b-2,b-3]),
    mail_take(me, b-X),
    mail_all(me, Rest).
test(other_messages_keep_their_order,
     [forall(member(N-K, [1-1, 2-1, 2-2, 12-3,
                          16-16, 17-9, 40-40])),
      true(Left == Others)]) :-
    numlist(1, N, Numbers),
    findall(x-I, member(I, Numbers), All),
    filled(me, All),
    mail_take(me, x-K),
    mail_all(me, Left),
    findall(x-I, ( member(I, Numbers), I =\= K ), Others).
test(no_message_unifies, true(Rest == [a-1])) :-
    filled(me, [a-1]),
    \+ mail_take(me, b-_),
    mail_all(me, Rest).
test(no_mailbox, true(All-List == []-[])) :-
    \+ mail_take(unknown, _),
    mail_all(unknown, All),
    mail_list(unknown, List).
test(peek_keeps_the_message, true(Twice == [[1,2],[1,2]])) :-
    filled(me, [1,2]),
    mail_list(me, First),
    mail_all(me, Second),
    Twice = [First,Second].
test(older_messages_are_put_back_first, true(All == [1,2,3,4])) :-
    filled(me, [3,4]),
    mail_back(me, [1,2]),
    mail_all(me, All).
test(no_queue_is_left) :-
    no_leaks(( filled(me, [1,2]),
               mail_all(me, _) )).
test(other_messages_survive_repeated_takes, true(Length-Waiting == 5000-8)) :-
    forall(between(1, 7, I),
           ( N is 60*I*I,
             numlist(1, N, Long),
             added(me, [from-no(I, Long)]) )),
    numlist(1, 5000, Longest),
    added(me, [from-yes(Longest)]),
    taken_again(200, [], Length),
    mail_all(me, Mail),
    length(Mail, Waiting).
test(each_message_is_received_once, true(Bad == [])) :-
    busy_boxes(4, 8000, Bad).

:- end_tests(mailbox).

filled(Id, Messages) :-
    mail_all(Id, _),
    mail_back(Id, Messages).

%   New messages are added at the end.

added(Id, Messages) :-
    mail_all(Id, Older),
    append(Older, Messages, All),
    mail_back(Id, All).

%   The last message is taken and put back repeatedly, while more and more of
%   the taken messages are kept, so that stacks are collected in between.

taken_again(0, [Last|_], Length) :-
    !,
    length(Last, Length).
taken_again(N, Kept0, Length) :-
    mail_take(me, from-yes(List)),
    added(me, [from-yes(List)]),
    (   N mod 7 =:= 0
    ->  Kept = [List]
    ;   Kept = [List|Kept0]
    ),
    N1 is N-1,
    taken_again(N1, Kept, Length).

%   Several threads fill and empty the mailboxes of their agents; Bad are the
%   lists that differ from the messages put in.

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
              mail_back(Id, Messages),
              mail_all(Id, All),
              All \== Messages ),
            Bad).
