:- module(course_first_agent, []).

% Lesson 1: a first agent.

:- use_module(course).
:- use_module('../../../prolog/typhon').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/3, max_list/2, member/2, nth1/3]).

:- multifile course:criterion/3.

                /*******************************
                *            ROUND             *
                *******************************/

course:criterion(round, 'sees each host of a ring once, home last',
                 course_first_agent:sees_all).
course:criterion(round, 'makes one hop for each host',
                 course_first_agent:hops_once).
course:criterion(round, 'works in a ring of three, too',
                 course_first_agent:sees_three).

sees_all(File) :-
    in_network(ring(6), [], goes_round(File)).

sees_three(File) :-
    in_network(ring(3), [], goes_round(File)).

goes_round(File, [Home|Hosts]) :-
    on_host(File, Home, Agent),
    ended(Agent, Seen),
    msort([Home|Hosts], All),
    ( is_list(Seen) -> msort(Seen, Sorted) ; Sorted = Seen ),
    expect('the list of hosts', Sorted, All),
    append_last(Seen, Home).

append_last(Seen, Home) :-
    append(_, [Last], Seen),
    !,
    expect('the last host', Last, Home).

hops_once(File) :-
    in_network(ring(6), [], hops(File)).

hops(File, [Home|Hosts]) :-
    on_host(File, Home, Agent),
    ended(Agent, _),
    maplist(arrived, [Home|Hosts], Counts),
    expect('how many agents have come to each host', Counts,
           [1, 1, 1, 1, 1, 1]).

                /*******************************
                *            RICHEST           *
                *******************************/

course:criterion(richest, 'finds the host with the most gold',
                 course_first_agent:finds_gold).
course:criterion(richest, 'leaves the gold where it is',
                 course_first_agent:leaves_gold).

finds_gold(File) :-
    forall(member(Gold, [[3, 9, 4, 1], [9, 3, 4, 1], [1, 2, 3, 4]]),
           in_network(mesh(4), [], finds(File, Gold))).

finds(File, Gold, Hosts) :-
    Hosts = [Home|_],
    maplist(put_gold, Hosts, Gold),
    on_host(File, Home, Agent),
    ended(Agent, Result),
    max_list(Gold, Most),
    nth1(N, Gold, Most),
    nth1(N, Hosts, Host),
    expect('the result', Result, richest(Host, Most)).

leaves_gold(File) :-
    in_network(mesh(3), [], gold_stays(File)).

gold_stays(File, Hosts) :-
    Hosts = [Home|_],
    maplist(put_gold, Hosts, [1, 2, 3]),
    on_host(File, Home, Agent),
    ended(Agent, _),
    maplist(gold, Hosts, Gold),
    expect('what lies on the hosts', Gold, [[gold(1)], [gold(2)], [gold(3)]]).

put_gold(Host, N) :-
    remote(Host, leave(gold(N))).

gold(Host, Facts) :-
    facts_on(Host, gold(_), Facts).

                /*******************************
                *             TALLY            *
                *******************************/

course:criterion(tally, 'answers with the sum of what it was sent',
                 course_first_agent:adds).
course:criterion(tally, 'moves to where it is sent, and knows its sum there',
                 course_first_agent:adds_elsewhere).

adds(File) :-
    in_network(line(2), [], tally(File, [add(2), add(3), add(-1)], 4, n1)).

adds_elsewhere(File) :-
    in_network(line(2), [], tally(File, [add(2), go(n2), add(5)], 7, n2)).

tally(File, Messages, Sum, Place, [Home|_]) :-
    on_host(File, Home, Tally),
    asker(Tally, Messages, Asker),
    agent_create(clauses(Asker), Agent, [host(Home)]),
    ended(Agent, Found),
    expect('the sum', Found, Sum),
    agent_property(Tally, host(Host)),
    atomic_list_concat([Name|_], @, Host),
    expect('where it is', Name, Place).

asker(Tally, Messages,
      [ (:- agent(asker, [])),
        (main :- send_all(Messages), send(Tally, total),
                 receive(Tally-total(Sum), 60), result(Sum)),
        send_all([]),
        (send_all([M|Ms]) :- send(Tally, M), send_all(Ms))
      ]).
