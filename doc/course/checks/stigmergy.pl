:- module(course_stigmergy, []).

% Lesson 2: agents that cooperate by facts and pheromones on hosts.

:- use_module(course).
:- use_module('../../../prolog/typhon').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), 
              [ append/2, last/2, member/2, nth1/3, numlist/3, sum_list/2 ]).

:- multifile course:criterion/3.

                /*******************************
                *             CLAIM            *
                *******************************/

course:criterion(claim, 'each agent has a host of its own',
                 course_stigmergy:claims_apart).
course:criterion(claim, 'the first agent claims the host it begins on',
                 course_stigmergy:claims_at_once).

claims_apart(File) :-
    forall(member(Seed, [1, 2, 3]),
           in_network(grid(3, 3), [seed(Seed)], nine_claim(File))).

nine_claim(File, Hosts) :-
    Hosts = [Home|_],
    findall(Agent, ( member(_, Hosts), on_host(File, Home, Agent) ), Agents),
    maplist(ended, Agents, Claimed),
    msort(Claimed, Sorted),
    msort(Hosts, All),
    expect('the list of results', Sorted, All),
    forall(nth1(N, Agents, Agent),
           ( nth1(N, Claimed, Host),
             facts_on(Host, owner(_), Owners),
             expect('the owner of a host', Owners, [owner(Agent)]) )).

claims_at_once(File) :-
    in_network(grid(3, 3), [], one_claims(File)).

one_claims(File, [_, Home|_]) :-
    on_host(File, Home, Agent),
    ended(Agent, Host),
    expect('what it claims', Host, Home).

                /*******************************
                *            FORAGER           *
                *******************************/

course:criterion(forager, 'all food comes to the nest, each piece once',
                 course_stigmergy:food_comes_home).
course:criterion(forager, 'an ant that finds nothing gives up',
                 course_stigmergy:ant_gives_up).

food_comes_home(File) :-
    forall(member(Seed, [1, 2, 3]),
           in_network(grid(3, 4), [seed(Seed)], ants_forage(File))).

ants_forage(File, Hosts) :-
    Hosts = [Nest|_],
    numlist(1, 8, Pieces),
    forall(nth1(N, Pieces, Piece),
           ( At is 2 + N,
             nth1(At, Hosts, Host),
             remote(Host, leave(food(Piece))) )),
    findall(Ant, ( between(1, 5, _), on_host(File, Nest, Ant) ), Ants),
    maplist(ended, Ants, Brought),
    sum_list(Brought, Sum),
    expect('what the ants say they brought', Sum, 8),
    facts_on(Nest, stored(_), Stored),
    findall(stored(N), member(N, Pieces), All),
    expect('what is in the nest', Stored, All),
    maplist(food, Hosts, Lists),
    append(Lists, Left),
    expect('what is left outside', Left, []).

food(Host, Food) :-
    facts_on(Host, food(_), Food).

ant_gives_up(File) :-
    in_network(ring(4), [], nothing_there(File)).

nothing_there(File, [Nest|Hosts]) :-
    on_host(File, Nest, Ant),
    ended(Ant, Brought),
    expect('what it says it brought', Brought, 0),
    maplist(arrived, [Nest|Hosts], Counts),
    sum_list(Counts, Count),
    (   Count >= 60,
        Count =< 62
    ->  true
    ;   expect('the number of hosts without food', Count, 60)
    ).

                /*******************************
                *            BRIGADE           *
                *******************************/

course:criterion(brigade, 'puts the fire out',
                 course_stigmergy:fire_is_out).
course:criterion(brigade, 'goes straight to it',
                 course_stigmergy:goes_straight).
course:criterion(brigade, 'withdraws the call for water',
                 course_stigmergy:call_is_withdrawn).

fire_is_out(File) :-
    burning(File, fire_gone).

fire_gone(_, Hosts, _) :-
    nth1(5, Hosts, Host),
    facts_on(Host, fire, Fires),
    expect('what burns', Fires, []).

goes_straight(File) :-
    burning(File, three_hops).

three_hops(_, _, Result) :-
    expect('the result', Result, hops(3)).

call_is_withdrawn(File) :-
    burning(File, no_pheromone).

no_pheromone(_, Hosts, _) :-
    Hosts = [Host|_],
    time_passes(Host, 2),               % the withdrawal spreads as well
    last(Hosts, Last),
    remote(Last, findall(P, pheromone(P, _, _), Left)),
    expect('the list of remaining pheromones', Left, []).

%   The agent arrives before the fire begins.

:- meta_predicate burning(+, 3).

burning(File, Goal) :-
    in_network(line(7), [], fire_on_fifth(File, Goal)).

fire_on_fifth(File, Goal, Hosts) :-
    nth1(2, Hosts, Start),
    nth1(5, Hosts, Place),
    on_host(File, Start, Agent),
    agent_create(clauses([ (:- agent(match, [])),
                           (main :- sleep(5), leave(fire),
                                    emit(need(water))) ]),
                 _, [host(Place)]),
    ended(Agent, Result),
    call(Goal, File, Hosts, Result).
