:- module(test_hierarchy_agents, []).
:- use_module('../../lib/common', []).
:- use_module('../../lib/fake_agent').
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(random), [random_permutation/2]).

/** <module> Observers and customers of a hierarchy, on a simulated host
*/

%   observer(+Reports, -Sent): what an observer of three leaders sends after
%   Reports, pairs of a leader and a number. Its mechanism numbers the leaders in
%   the order of the reports.

observer(Reports, Sent) :-
    fake_agent('agents/hierarchy/observer.pl',
               [ leaders(3),
                 (decided(All, _, none, Orders) :-
                      findall(Leader-[place-N], nth1(N, All, Leader-_),
                              Orders)) ],
               []),
    maplist(reported, Reports),
    did(Acts),
    findall(To-Changes, member(send(To, change(r, Changes)), Acts), Sent).

reported(Leader-Report) :-
    fake_agent:on_message(Leader, report(r, Report)).

:- begin_tests(hierarchy_agents).

test(observer_waits_for_the_last_leader, Sent == []) :-
    observer([a-1, b-2], Sent).
test(decision_does_not_depend_on_the_order_of_reports,
     [ forall(between(1, 6, _)),
       Sent == [a-[place-1], b-[place-2], c-[place-3]] ]) :-
    random_permutation([a-3, b-2, c-1], Reports),
    observer(Reports, Sent).
test(other_round_is_another_decision, Sent == []) :-
    observer([a-1, b-2], []),
    fake_agent:on_message(c, report(s, 3)),
    did(Acts),
    findall(To, member(send(To, _), Acts), Sent).
test(customer_waits_for_all_leaders, [Served, Then] == [[], [served(one)]]) :-
    fake_agent('agents/hierarchy/customer.pl',
               [round(one), part(a, [h1]), part(b, [h2, h3])], []),
    fake_mail(a-served(one)),
    \+ fake_agent:main,
    did(Before),
    findall(R, member(log(served(R)), Before), Served),
    maplist(fake_mail, [b-served(one), a-served(one)]),
    fake_agent:main,
    did(Acts),
    findall(served(R), member(log(served(R)), Acts), Then).
test(customer_asks_each_leader_for_its_hosts,
     Sent == [a-serve(one, [h1]), b-serve(one, [h2, h3])]) :-
    fake_agent('agents/hierarchy/customer.pl',
               [round(one), part(a, [h1]), part(b, [h2, h3])], []),
    \+ fake_agent:main,
    did(Acts),
    findall(To-What, member(send(To, What), Acts), Sent).
test(leader_waits_until_its_limit,
     Ends == [ended(0, done), ended(10, late), ended(10, late)]) :-
    fake_agent('agents/hierarchy/leader.pl', [limit(10)], []),
    fake_mail(system-down(a, done)),
    fake_agent:attend([a, b, c], 0, Ends).

:- end_tests(hierarchy_agents).
