:- module(course_ants, []).

% Lesson 5: ants find the cheapest way.

:- use_module(course).
:- use_module('../../../prolog/typhon').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2, memberchk/2]).

:- multifile course:criterion/3.

%   Four ways from nest to food: b is the cheapest (6), then c (9).

roads([ nest-a-cost(2), a-food-cost(10), nest-b-cost(3), b-food-cost(3),
        nest-c-cost(4), c-food-cost(5), a-b-cost(9), b-c-cost(9) ]).

                /*******************************
                *             ANT              *
                *******************************/

course:criterion(ant, 'every ant comes home',
                 course_ants:ants_come_home).
course:criterion(ant, 'the strongest trail is the cheapest way, mostly',
                 course_ants:ants_find_way).

ants_come_home(File) :-
    roads(Roads),
    in_network(edges(Roads), [], five_come_home(File)).

five_come_home(File, Hosts) :-
    member(Nest, Hosts),
    is_named(nest, Nest),
    !,
    put_food(Hosts),
    ants(5, File, Nest, Ants),
    maplist(ant_ends, Ants).

ant_ends(Ant) :-
    ended(Ant, Result),
    (   Result = way(Cost),
        number(Cost)
    ->  true
    ;   expect('the result', Result, way(cost))
    ).

%   In four of five colonies.

ants_find_way(File) :-
    roads(Roads),
    aggregate_all(count,
                  ( member(Seed, [1, 2, 3, 4, 5]),
                    in_network(edges(Roads), [seed(Seed)],
                               colony(File, 40, 6)) ),
                  Count),
    at_least('colonies of five that find it', Count, 4).

at_least(_, Count, Least) :-
    Count >= Least,
    !.
at_least(What, Count, Least) :-
    expect(What, Count, at_least(Least)).

%   Ants leave one after the other.

colony(File, Count, Cheapest, Hosts) :-
    member(Nest, Hosts),
    is_named(nest, Nest),
    !,
    put_food(Hosts),
    ants(Count, File, Nest, Ants),
    maplist(ant_ends, Ants),
    strongest(Nest, Hosts, 0, Cheapest).

put_food(Hosts) :-
    member(Host, Hosts),
    is_named(food, Host),
    !,
    remote(Host, leave(food)).

ants(0, _, _, []) :-
    !.
ants(N, File, Nest, [Ant|Ants]) :-
    on_host(File, Nest, Ant),
    time_passes(Nest, 2),
    N1 is N-1,
    ants(N1, File, Nest, Ants).

is_named(Name, Host) :-
    atomic_list_concat([Name|_], @, Host).

%   strongest(+Host, +Left, +Cost0, -Cost): Cost of the way from Host that
%   follows the strongest trails through hosts that are Left.

strongest(Host, _, Cost, Cost) :-
    is_named(food, Host),
    !.
strongest(Host, Left0, Cost0, Cost) :-
    exclude_one(Host, Left0, Left),
    facts_on(Host, trail(_, _), Trails),
    aggregate_all(max(Strength, Next),
                  ( member(trail(Next, Strength), Trails),
                    memberchk(Next, Left) ),
                  max(_, Next)),
    remote(Host, neighbour(Next, Step)),
    Cost1 is Cost0+Step,
    strongest(Next, Left, Cost1, Cost).

exclude_one(Host, Hosts0, Hosts) :-
    findall(Other, ( member(Other, Hosts0), Other \== Host ), Hosts).

                /*******************************
                *            PARCEL            *
                *******************************/

course:criterion(parcel, 'follows the strongest trail to the food',
                 course_ants:parcel_follows).
course:criterion(parcel, 'does not run in circles',
                 course_ants:parcel_ends).

parcel_follows(File) :-
    parcel(File, [nest-a-1, nest-c-5, nest-b-2, c-food-3, c-b-2],
           way(9, [nest, c, food])).

parcel_ends(File) :-
    parcel(File, [nest-b-5, b-nest-9, b-a-7, a-b-8, a-food-2],
           way(22, [nest, b, a, food])).

parcel(File, Trails, Expected) :-
    roads(Roads),
    in_network(edges(Roads), [], parcel_goes(File, Trails, Expected)).

parcel_goes(File, Trails, way(Cost, Names), Hosts) :-
    put_food(Hosts),
    forall(member(From-To-Strength, Trails),
           ( named(From, Hosts, A),
             named(To, Hosts, B),
             remote(A, leave(trail(B, Strength))) )),
    named(nest, Hosts, Nest),
    on_host(File, Nest, Parcel),
    ended(Parcel, Result),
    findall(Host, ( member(Name, Names), named(Name, Hosts, Host) ), Way),
    expect('the result', Result, way(Cost, Way)).

named(Name, Hosts, Host) :-
    member(Host, Hosts),
    is_named(Name, Host),
    !.

                /*******************************
                *          FADING ANT          *
                *******************************/

course:criterion(fading_ant, 'the strongest trail is the cheapest way, mostly',
                 course_ants:ants_find_way).
course:criterion(fading_ant, 'the colony finds another way when costs change',
                 course_ants:ants_adapt).

ants_adapt(File) :-
    roads(Roads),
    aggregate_all(count,
                  ( member(Seed, [1, 2, 3, 4, 5]),
                    in_network(edges(Roads), [seed(Seed)], adapts(File)) ),
                  Count),
    at_least('colonies of five that find it', Count, 4).

%   The road from b to food is blocked by a flood, almost.

adapts(File, Hosts) :-
    colony(File, 40, _, Hosts),
    named(b, Hosts, B),
    named(food, Hosts, Food),
    link(B, Food, [cost(60)]),
    named(nest, Hosts, Nest),
    ants(60, File, Nest, Ants),
    maplist(ant_ends, Ants),
    strongest(Nest, Hosts, 0, 9).
