:- module(test_learning_maze, []).
:- use_module('../../lib/common').
:- use_module(library(plunit)).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(assoc),
              [assoc_to_keys/2, empty_assoc/1, get_assoc/3, put_assoc/4]).
:- use_module(library(lists), [append/3, max_member/2, member/2, nth0/3]).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(typhon), []).

:- discontiguous payload/2.
payload(_, _).
:- include('../../../payloads/learning/maze').
:- include('../../../payloads/learning/greedy').

/** <module> The maze of section 4.3, and the algorithm of section 4.3.5

Mazes here are 5 by 5: from (5,0) to the light at (0,5).
*/

:- dynamic setting/2.

%   maze(+Settings): set the maze of the goals that follow.

maze(Settings) :-
    retractall(setting(_, _)),
    assertz(setting(size, 5)),
    forall(member(Name-Value, Settings), assertz(setting(Name, Value))).

no_settings :-
    retractall(setting(_, _)).

%   sees(+State, -Light, -Obstacle)

sees(State, Light, Obstacle) :-
    sensed(State, sv(Light, Obstacle, _, _)).

close_to(X, Y) :-
    abs(X - Y) < 1.0e-6.

%   does(+Actions, +State0, -State)

does(Actions, State0, State) :-
    foldl(act, Actions, State0, State).

%   units(+Actions, +State0, -Units): the shareable units of Actions.

units(Actions, State0, Units) :-
    steps(Actions, State0, Steps),
    shareable(Steps, Units).

steps([], _, []).
steps([Action|Actions], State0, [step(Vector0, Action, Vector, W)|Steps]) :-
    act(Action, State0, State),
    sensed(State0, Vector0),
    sensed(State, Vector),
    weight(Vector0, Vector, W),
    steps(Actions, State, Steps).

%   shared(Name, Walk, From, Actions): the actions of the units of Walk.

shared(only_gains, [forward, backward, forward], at(5, 0, up),
       [[forward], [forward]]).
shared(consecutive_turns_are_merged, Walk, at(3, 1, left), [Shared]) :-
    member(Walk-Shared,
           [ [turn_left,turn_left,turn_left,forward]-[turn_right,forward],
             [turn_left,turn_left,backward]-[turn_back,backward],
             [turn_back,turn_left,turn_left,forward]-[forward] ]).
shared(turns_before_a_loss_are_forgotten, [turn_right, forward, backward],
       at(3, 2, up), [[backward]]).
shared(turns_before_a_bump_are_forgotten, [turn_left, backward, forward],
       at(5, 2, up), [[forward]]).
shared(turning_away_from_a_wall_is_a_gain, [turn_left], at(5, 0, right),
       [[turn_left]]).

:- begin_tests(maze, [setup(maze([])), cleanup(maze([]))]).

test(start, State == at(5, 0, up)) :-
    start(none, State).
test(size_used_in_the_thesis,
     [ setup(no_settings), cleanup(maze([])), State == at(50, 0, up) ]) :-
    start(none, State).
test(goal, [ forall(member(Heading, [up, left, down, right])) ]) :-
    reached(at(0, 5, Heading)),
    \+ reached(at(5, 0, Heading)).
test(five_actions, Count == 5) :-
    actions(Actions),
    sort(Actions, Set),
    length(Set, Count).
test(moves,
     [ forall(member(Action-Heading-To,     % the first two: the thesis
                     [ forward-up-at(2,4,up), backward-left-at(3,3,left),
                       forward-left-at(1,3,left), forward-down-at(2,2,down),
                       forward-right-at(3,3,right), backward-up-at(2,2,up),
                       backward-down-at(2,4,down),
                       backward-right-at(1,3,right) ])),
       State == To ]) :-
    act(Action, at(2, 3, Heading), State).
test(turns,
     [ forall(member(Heading-Turned,
                     [ up-[left,right,down], left-[down,up,right],
                       down-[right,left,up], right-[up,down,left] ])),
       Found == Turned ]) :-
    findall(New,
            ( member(Turn, [turn_left, turn_right, turn_back]),
              act(Turn, at(2, 3, Heading), at(2, 3, New)) ),
            Found).
test(actions_are_det, [ forall(( actions(As), member(Action, As) )) ]) :-
    act(Action, at(2, 3, down), _).
test(boundary,
     [ forall(member(Action-State0,
                     [ forward-at(5,0,right), forward-at(5,0,down),
                       backward-at(5,0,up), backward-at(5,0,left),
                       forward-at(0,5,up), forward-at(0,5,left) ])),
       State == State0 ]) :-
    act(Action, State0, State).
test(obstacle,
     [ setup(maze([obstacles-[(4,0)-(4,3)]])), cleanup(maze([])),
       Ends == [at(5,0,left), at(4,4,left), at(3,2,right)] ]) :-
    does([turn_left, forward], at(5, 0, up), End1),
    does([forward, turn_left, forward], at(5, 3, up), End2),
    act(backward, at(3, 2, right), at(2, 2, right)),
    act(forward, at(3, 2, right), End3),
    Ends = [End1, End2, End3].
test(light,
     [ forall(member(State-L, [ at(0,4,right)-50, at(3,1,up)-16.6666667,
                                at(0,5,right)-100, at(5,0,up)-12.3899343 ])),
       true(close_to(Light, L)) ]) :-
    sees(State, Light, 0).
test(dark_before_a_wall,
     [ forall(member(State, [at(5,0,right), at(0,5,up), at(0,2,left)])),
       Light-Obstacle == 0.0-1 ]) :-
    sees(State, Light, Obstacle).
test(dark_before_an_obstacle,
     [ setup(maze([obstacles-[(4,0)-(4,3)]])), cleanup(maze([])),
       Seen == [0.0-1, 0.0-1, 12.3899343] ]) :-
    sees(at(5, 3, left), L1, O1),
    sees(at(3, 0, right), L2, O2),
    sees(at(5, 0, up), L3, 0),
    L4 is round(L3*1.0e7)/1.0e7,
    Seen = [L1-O1, L2-O2, L4].
test(cells_differ, Count == 144) :-     % 36 cells, 4 headings
    findall(V,
            ( between(0, 5, X), between(0, 5, Y),
              member(Heading, [up, left, down, right]),
              sensed(at(X, Y, Heading), V) ),
            Vectors),
    sort(Vectors, Set),
    length(Set, Count).
test(cells_of_equal_light_need_a_signature,
     [ setup(maze([signature-false])), cleanup(maze([])) ]) :-
    sensed(at(1, 2, up), sv(Light, 0, up, 0)),
    sensed(at(3, 4, up), sv(Light, 0, up, 0)).
test(equation_4_7,                      % of the light
     true(close_to(Weight, 25))) :-
    sensed(at(0, 2, up), Vector0),
    sensed(at(0, 4, right), Vector),
    weight(Vector0, Vector, Weight).
test(units_of_a_walk_are_shared, [forall(shared(_, Walk, From, Expected)),
                                  Actions == Expected]) :-
    units(Walk, From, Units),
    findall(A, member(unit(_, A, _)-_, Units), Actions).
test(content_of_shared_units, Unit-Weight == unit(V0, [forward], V)-W) :-
    units([forward], at(5, 0, up), [Unit-Weight]),
    sensed(at(5, 0, up), V0),
    sensed(at(5, 1, up), V),
    weight(V0, V, W).
test(turns_are_shared_with_the_next_move,
     Unit == unit(V0, [turn_left,forward], V)) :-
    units([turn_left, forward], at(5, 0, up), [Unit-_]),
    sensed(at(5, 0, up), V0),
    sensed(at(4, 0, left), V).
test(shared_units_can_be_repeated, Bad == []) :-
    findall(Unit,
            ( between(1, 200, _),
              random_walk(30, Walk),
              units(Walk, at(5, 0, up), Units),
              member(Unit-_, Units),
              \+ repeats(Unit) ),
            Bad).

random_walk(Length, Walk) :-
    actions(Actions),
    findall(Action, ( between(1, Length, _), random_member(Action, Actions) ),
            Walk).

%   The path leads from the state of its first vector to that of its last.

repeats(unit(V0, Actions, V)) :-
    V0 = sv(_, _, Heading, Cell),
    X is Cell mod 6,
    Y is Cell // 6,
    does(Actions, at(X, Y, Heading), State),
    sensed(State, V).

:- end_tests(maze).

                /*******************************
                *            GREEDY            *
                *******************************/

%   A vector of Light, straight up; unit(L0, Actions, L) between two.

vector(Light, sv(Light, 0, up, Light)).

link(L0-Actions-L, unit(V0, Actions, V)-W) :-
    vector(L0, V0),
    vector(L, V),
    W is L - L0.

plans(Links, Plan) :-
    vector(1, Start),
    findall(Unit, ( member(Link, Links), link(Link, Unit) ), Units0),
    sort(Units0, Units),
    plan(Start, Units, Plan).

%   greedy(Name, Links, Plan)

greedy(one_link, [1-[a]-2], [a]).
greedy(links_in_a_row, [3-[c]-9, 1-[a]-2, 2-[b,b]-3], [a, b, b, c]).
greedy(the_longest_branch, [1-[x]-9, 1-[a]-2, 2-[b]-3, 3-[c]-4], [a, b, c]).
greedy(length_is_counted_in_links, [1-[x,x,x]-9, 1-[a]-2, 2-[b]-3], [a, b]).
greedy(heaviest_of_the_longest_branches,
       [1-[a]-4, 4-[b]-5, 1-[c]-3, 3-[d]-6], [c, d]).
greedy(branch_with_fewest_actions_breaks_the_tie,
       [1-[a,a]-4, 4-[b]-6, 1-[c]-3, 3-[d]-6], [c, d]).
greedy(branch_that_does_not_begin_at_the_start,
       [1-[a]-2, 3-[b]-4, 4-[c]-5, 5-[d]-6], [a]).

:- begin_tests(greedy).

test(plan_is_the_best_branch, [ forall(greedy(_, Links, Expected)),
                                Plan == Expected ]) :-
    plans(Links, Plan).
test(without_a_branch_at_the_start_the_most_similar_is_used, Plan == [b]) :-
    sensed(at(2, 2, up), Start),
    Near = sv(L, 0, up, n),
    arg(1, Start, L0),
    L is L0 + 0.1,
    Far = sv(L, 1, right, f),
    plan(Start, [ unit(Far, [a], sv(90, 0, up, x))-1,
                  unit(Near, [b], sv(91, 0, up, y))-1 ], Plan).
test(cosine, [ forall(member(A-B-C, [ sv(3,0,up,_)-sv(9,0,up,_)-1.0,
                                      sv(0,1,up,_)-sv(3,0,up,_)-0.0,
                                      sv(3,0,up,_)-sv(3,1,left,_)-
                                          0.9045340337,
                                      sv(0,0,up,_)-sv(3,0,up,_)-0.0 ])),
               true(close_to(Cosine, C)) ]) :-
    cosine(A, B, Cosine).
test(shorter_is_better) :-
    better([a], [b, c]),
    \+ better([a], [b]),
    \+ better([b, c], [a]).
test(same_result_as_exhaustive_search, Bad == []) :-
    findall(Links-Plan,
            ( between(1, 400, _),
              random_links(Links),
              plans(Links, Plan),
              \+ best_branch(Links, Plan) ),
            Bad).
test(many_units_are_searched_quickly) :-        % 2^40 branches
    findall(L-[A]-L1,
            ( between(1, 40, L), L1 is L + 1, member(A, [a, b]) ), Links),
    plans(Links, Plan),
    length(Plan, 40).

%   Eight vectors, of which two may have the same light.

random_links(Links) :-
    random_between(1, 14, Count),
    findall(L0-Actions-L,
            ( between(1, Count, _),
              random_between(1, 7, L0),
              Above is L0 + 1,
              random_between(Above, 8, L),
              random_between(1, 2, Length),
              findall(A, ( between(1, Length, _),
                           random_member(A, [a, b, c]) ), Actions) ),
            Links0),
    Links = [1-[a]-2|Links0].

%   Plan belongs to a branch that is at least as good as all others.

best_branch(Links, Plan) :-
    findall(key(Length, Light, Saving),
            branch_of(Links, 1, 0, 0, [], _, key(Length, Light, Saving)),
            Keys),
    max_member(Best, Keys),
    branch_of(Links, 1, 0, 0, [], Plan, Best),
    !.

branch_of(_, Light, Length, Saving, Plan, Plan,
          key(Length, Light, Saving)).
branch_of(Links, L0, Length0, Saving0, Plan0, Plan, Key) :-
    member(L0-Actions-L, Links),
    length(Actions, Count),
    Length is Length0 + 1,
    Saving is Saving0 - Count,
    append(Plan0, Actions, Plan1),
    branch_of(Links, L, Length, Saving, Plan1, Plan, Key).

:- end_tests(greedy).
