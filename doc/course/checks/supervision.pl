:- module(course_supervision, []).

% Lesson 7: agents that watch others and start them again.

:- use_module(course).
:- use_module('../../../prolog/typhon').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth1/3]).

:- multifile course:criterion/3.

                /*******************************
                *            WARDEN            *
                *******************************/

course:criterion(warden, 'says how each ends, in the order of their ends',
                 course_supervision:wards([3-raised, 1-done, 2-disposed],
                                          [2, 3, 1])).
course:criterion(warden, 'says how those ended that it finds ended',
                 course_supervision:finds_ended).
course:criterion(warden, 'ends if there is nothing to watch',
                 course_supervision:wards([], [])).

%   wards(+Ends, +Order, +File): Ends are Seconds-How, a ward for each; Order
%   are their places in the order in which they end.

wards(Ends, Order, File) :-
    in_network(star(3), [], warden(File, Ends, Order)).

warden(File, Ends, Order, [Home,Host|_]) :-
    findall(Ward, ( member(End, Ends), ward(End, Host, Ward) ), Wards),
    on_host(File, Home, [wards(Wards)], Warden),
    ended(Warden, Result),
    maplist(expected_end(Ends, Wards), Order, Expected),
    expect('the result', Result, ends(Expected)).

ward(Seconds-How, Host, Ward) :-
    agent_create(clauses([ (:- agent(ward, [state([ends/2])])),
                           (main :- ends(S, H), sleep(S), end(H)),
                           end(done),
                           (end(raised) :- throw(tired)),
                           (end(disposed) :- dispose)
                         ]),
                 Ward, [host(Host), facts([ends(Seconds, How)])]).

expected_end(Ends, Wards, Place, Ward-Outcome) :-
    nth1(Place, Ends, _-How),
    nth1(Place, Wards, Ward),
    outcome(How, Outcome).

outcome(raised, raised(tired)) :-
    !.
outcome(Outcome, Outcome).

finds_ended(File) :-
    in_network(star(3), [], late(File)).

late(File, [Home,Host|_]) :-
    ward(1-disposed, Host, Ward),
    time_passes(Home, 3),
    on_host(File, Home, [wards([Ward])], Warden),
    ended(Warden, Result),
    expect('the result', Result, ends([Ward-disposed])).

                /*******************************
                *            FOREMAN           *
                *******************************/

course:criterion(foreman, 'does not start again what is done',
                 course_supervision:does(1, done(0), 1)).
course:criterion(foreman, 'starts it again until it is done',
                 course_supervision:does(3, done(2), 3)).
course:criterion(foreman, 'starts it again as often as it may',
                 course_supervision:does(4, done(3), 4)).
course:criterion(foreman, 'gives up after that',
                 course_supervision:does(9, gave_up(raised(too_early)), 4)).
course:criterion(foreman, 'takes its worker with it',
                 course_supervision:takes_along).

%   does(+Needed, +Expected, +Starts, +File): the worker is done when it is
%   started for the time Needed.

does(Needed, Expected, Starts, File) :-
    in_network(line(2), [], foreman(File, Needed, Expected, Starts)).

foreman(File, Needed, Expected, Starts, [Home|_]) :-
    job(Needed, Job),
    on_host(File, Home, [job(Job), most(3)], Foreman),
    ended(Foreman, Result),
    expect('the result', Result, Expected),
    facts_on(Home, started, Found),
    length(Found, Count),
    expect('how often the worker was started', Count, Starts).

job(Needed, [ (:- agent(worker, [])),
              (main :- leave(started),
                       sleep(1),
                       findall(x, sense(started), Starts),
                       length(Starts, Count),
                       (   Count < Needed
                       ->  throw(too_early)
                       ;   true
                       ))
            ]).

takes_along(File) :-
    in_network(line(2), [], leaves_nothing(File)).

leaves_nothing(File, [Home|_]) :-
    Job = [ (:- agent(worker, [])),
            (main :- offer(work, []), receive(_-stop)) ],
    on_host(File, Home, [job(Job), most(3)], Foreman),
    time_passes(Home, 1),
    workers(Home, Before),
    expect('the number of workers', Before, 1),
    agent_dispose(Foreman),
    time_passes(Home, 5),
    workers(Home, After),
    expect('the number of workers without a foreman', After, 0).

workers(Host, Count) :-
    remote(Host, find(work, Found, [])),
    length(Found, Count).

                /*******************************
                *           CUSTOMER           *
                *******************************/

course:criterion(customer, 'orders from the nearest',
                 course_supervision:buys([near-sells, far-sells], near)).
course:criterion(customer, 'turns to the next if one ends without an answer',
                 course_supervision:buys([near-fails, far-sells], far)).
course:criterion(customer, 'orders from one at a time',
                 course_supervision:orders([near-sells, far-sells], [near])).
course:criterion(customer, 'waits for one that is slow',
                 course_supervision:orders([near-slow, far-sells], [near])).
course:criterion(customer, 'finds one that is far away',
                 course_supervision:buys([far-sells], far)).
course:criterion(customer, 'ends if none sells',
                 course_supervision:buys([near-fails, far-fails], none)).

buys(Clerks, From, File) :-
    in_network(line(4), [], customer(File, Clerks, From)).

customer(File, Clerks, From, [Home,Near,_,Far]) :-
    Places = [near-Near, far-Far],
    forall(member(Place-How, Clerks),
           ( memberchk(Place-Host, Places), clerk(Host, How) )),
    time_passes(Home, 1),
    on_host(File, Home, [wants(tea)], Customer),
    ended(Customer, Result),
    (   memberchk(From-Host, Places)
    ->  expect('the result', Result, bought(tea_from(Host)))
    ;   expect('the result', Result, none)
    ).

%   orders(+Clerks, +Asked, +File): only the clerks at Asked get an order.

orders(Clerks, Asked, File) :-
    Asked = [From],
    in_network(line(4), [], customer_asks(File, Clerks, From, Asked)).

customer_asks(File, Clerks, From, Asked, Hosts) :-
    customer(File, Clerks, From, Hosts),
    Hosts = [Home,Near,_,Far],
    time_passes(Home, 5),
    findall(Place, ( member(Place-Host, [near-Near, far-Far]),
                     facts_on(Host, ordered, [_|_]) ), Found),
    expect('the places of the agents that got an order', Found, Asked).

clerk(Host, How) :-
    agent_create(clauses([ (:- agent(clerk, [state([how/1])])),
                           (main :- offer(shop(tea), []),
                                    receive(From-order(tea)),
                                    leave(ordered),
                                    sleep(1),
                                    how(How),
                                    answer(How, From)),
                           (answer(sells, From) :-
                                here(Here),
                                send(From, sold(tea_from(Here)))),
                           (answer(slow, From) :-
                                sleep(100),
                                answer(sells, From)),
                           (answer(fails, _) :- dispose)
                         ]),
                 _, [host(Host), facts([how(How)])]).
