:- module(course_contract_net, []).

% Lesson 4: a contractor for a task is found by offers.

:- use_module(course).
:- use_module('../../../prolog/typhon').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth1/3, sum_list/2]).

:- multifile course:criterion/3.

                /*******************************
                *          CONTRACTOR          *
                *******************************/

course:criterion(contractor, 'offers what its host says the kind costs',
                 course_contract_net:offers).
course:criterion(contractor, 'refuses what its host cannot do',
                 course_contract_net:refuses).
course:criterion(contractor, 'does what it is awarded, and says so',
                 course_contract_net:does).
course:criterion(contractor, 'hears that another has the task',
                 course_contract_net:hears_reject).

offers(File) :-
    answers(File, [announce(t1, paint)], [bid(t1, 7)]).

refuses(File) :-
    answers(File, [announce(t2, weld)], [refuse(t2)]).

does(File) :-
    in_network(line(2), [], at_work(File)).

at_work(File, Hosts) :-
    contracted(File, Hosts, [announce(t1, paint), award(t1)], 2, Answers),
    expect('what it sends', Answers, [bid(t1, 7), finished(t1)]),
    Hosts = [_, Host],
    facts_on(Host, done(_), Done),
    expect('what is done on its host', Done, [done(t1)]).

hears_reject(File) :-
    answers(File, [announce(t1, paint), reject(t1), announce(t3, paint)],
            [bid(t1, 7), bid(t3, 7)]).

answers(File, Messages, Expected) :-
    in_network(line(2), [], answer(File, Messages, Expected)).

answer(File, Messages, Expected, Hosts) :-
    length(Expected, N),
    contracted(File, Hosts, Messages, N, Answers),
    expect('what it sends', Answers, Expected).

%   The contractor is on the second host, where painting costs 7.

contracted(File, [Home, Host], Messages, N, Answers) :-
    remote(Host, leave(cost(paint, 7))),
    on_host(File, Host, Contractor),
    agent_create(clauses([ (:- agent(manager, [])),
                           (main :- tell(Messages), hear(N, Answers),
                                    result(Answers)),
                           tell([]),
                           (tell([M|Ms]) :- send(Contractor, M), tell(Ms)),
                           (hear(0, As) :- !, As = []),
                           (hear(I, As) :-
                                (   receive(Contractor-A, 60)
                                ->  As = [A|More],
                                    J is I-1,
                                    hear(J, More)
                                ;   As = []
                                ))
                         ]),
                 Manager, [host(Home)]),
    ended(Manager, Answers).

                /*******************************
                *            MANAGER           *
                *******************************/

course:criterion(manager, 'awards the task to the lowest offer',
                 course_contract_net:awards_lowest).
course:criterion(manager, 'rejects all other offers',
                 course_contract_net:rejects_others).
course:criterion(manager, 'does not wait for silent contractors',
                 course_contract_net:does_not_wait).
course:criterion(manager, 'waits for the end of the work',
                 course_contract_net:waits_for_work).
course:criterion(manager, 'says so if no offer comes',
                 course_contract_net:no_offer).
course:criterion(manager, 'takes no offer for another task',
                 course_contract_net:not_another_task).

awards_lowest(File) :-
    managed(File, [9, 4, 6], 0-1000, awarded(task7, 2, 4), _).

rejects_others(File) :-
    managed(File, [9, 4, 6], 0-1000, _, Rejected),
    expect('the offers that were rejected', Rejected, [1, 3]).

%   Five seconds for offers, three for the work.

does_not_wait(File) :-
    managed(File, [silent, 5, refuse], 0-10, awarded(task7, 2, 5), _).

waits_for_work(File) :-
    managed(File, [9, 4, 6], 3-1000, _, _).

no_offer(File) :-
    managed(File, [silent, refuse], 0-7, no_offer(task7), _).

not_another_task(File) :-
    managed(File, [stale(1), 5], 0-1000, awarded(task7, 2, 5), _).

%   managed(+File, +Kinds, +Least-Most, ?Expected, -Rejected): the manager ends
%   between these times.

managed(File, Kinds, Times, Expected, Rejected) :-
    in_network(star(4), [], manage(File, Kinds, Times, Expected, Rejected)).

manage(File, Kinds, Least-Most, Expected, Rejected, [Home|Hosts]) :-
    findall(Host-Kind, ( nth1(N, Kinds, Kind), nth1(N, Hosts, Host) ), Pairs),
    maplist(contractor, Pairs, Contractors),
    on_host(File, Home, [contractors(Contractors), task(task7, paint)],
            Manager),
    ended_between(Manager, Home, Least, Most, Result),
    result_names(Expected, Contractors, Named),
    expect('the result', Result, Named),
    time_passes(Home, 2),
    findall(N1, ( nth1(N1, Hosts, Host), nth1(N1, Kinds, _),
                  facts_on(Host, rejected(_), [_|_]) ),
            Rejected).

result_names(Expected, Contractors, awarded(Task, Contractor, Cost)) :-
    nonvar(Expected),
    Expected = awarded(Task, N, Cost),
    !,
    nth1(N, Contractors, Contractor).
result_names(Result, _, Result).

%   Kind is the cost of the task, or another behaviour of its contractor.

contractor(Host-Kind, Agent) :-
    agent_create(clauses([ (:- agent(contractor, [state([kind/1])])),
                           (on_message(From, announce(Task, _)) :-
                                kind(Kind1), offer(Kind1, From, Task)),
                           (on_message(From, award(Task)) :-
                                sleep(3), send(From, finished(Task))),
                           (on_message(_, reject(Task)) :-
                                leave(rejected(Task))),
                           offer(silent, _, _),
                           (offer(refuse, From, Task) :-
                                send(From, refuse(Task))),
                           (offer(stale(Cost), From, _) :-
                                send(From, bid(another, Cost))),
                           (offer(Cost, From, Task) :-
                                number(Cost), send(From, bid(Task, Cost)))
                         ]),
                 Agent, [host(Host), facts([kind(Kind)])]).

                /*******************************
                *            SHOPPER           *
                *******************************/

course:criterion(shopper, 'finds the cheapest host',
                 course_contract_net:shops([9, 4, 6], 3)).
course:criterion(shopper, 'skips hosts that cannot do it',
                 course_contract_net:shops([none, 8, none], 3)).
course:criterion(shopper, 'makes no more than one hop a host, and one more',
                 course_contract_net:shops_quickly).

shops(Costs, N, File) :-
    in_network(mesh(4), [], shop(File, Costs, N, _)).

shop(File, Costs, N, Hosts, [Home|Hosts0]) :-
    Hosts = [Home|Hosts0],
    findall(Host-Cost, ( nth1(I, Costs, Cost), nth1(I, Hosts0, Host),
                         number(Cost) ), Offers),
    forall(member(Host-Cost, Offers), remote(Host, leave(cost(paint, Cost)))),
    on_host(File, Home, [task(task7, paint)], Shopper),
    ended(Shopper, Result),
    nth1(N, Hosts, Best),
    memberchk(Best-Least, Offers),
    expect('the result', Result, bought(task7, Best, Least)),
    facts_on(Best, done(_), Done),
    expect('what is done there', Done, [done(task7)]).

shops_quickly(File) :-
    in_network(mesh(4), [], shop_hops(File)).

shop_hops(File, Hosts) :-
    shop(File, [9, 4, 6], 3, _, Hosts),
    maplist(arrived, Hosts, Counts),
    sum_list(Counts, Hops),
    (   Hops =< 5
    ->  true
    ;   expect('the number of hops', Hops, at_most(5))
    ).
