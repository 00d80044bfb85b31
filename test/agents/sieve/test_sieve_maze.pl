:- module(test_sieve_maze, []).

/** <module> Programs round obstacles: payloads(sieve/maze)

The boards against a breadth-first search, the steps of programs counted by
hand, and programs drawn at random.
*/

:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(ordsets), [ord_subtract/3]).
:- use_module(library(plunit)).
:- use_module(library(yall)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/prng)).
:- use_module(library(typhon/kernel/program), [payload_load/2]).

%   The clauses of the payload in a module of their own, as in an agent.

:- initialization(( payload_load(payloads('sieve/maze'),
                                 payload(_, PIs, Clauses)),
                    forall(member(PI, PIs), dynamic(maze:PI)),
                    forall(member(C, Clauses), assertz(maze:C)) )).

%   The first one goes along walls, to its right; the second turns to the
%   goal; the third is for corridors; the others go nowhere.

program(along, [ (right :- free(right), after(forward)),
                 (left :- wall(ahead)) ]).
program(compass, [ (forward :- after(right)),
                   (right :- free(right), goal(right)),
                   (left :- wall(ahead)) ]).
program(bends, [ (left :- wall(ahead), free(left)),
                 (right :- wall(ahead)) ]).
program(spins, [ (left :- free(ahead)), (left :- wall(ahead)) ]).
program(bumps, []).

%   by_hand(Name, Antigen, Xi): Xi is 31 less the steps that the program needs
%   beyond the shortest path, counted by hand.

by_hand(along, block(left), 31).
by_hand(along, box(left), 31).
by_hand(compass, wall(left), 31).
by_hand(compass, block(right), 29).          % 3 left, 2 up, 3 right, 3 turns
by_hand(compass, wall(right), 9).            % all along the border: 31 steps
by_hand(compass, box(left), 0).
by_hand(bends, corridor(left), 31).
by_hand(bends, corridor(right), 31).
by_hand(bends, block(left), 0).
by_hand(spins, wall(left), 0).
by_hand(bumps, corner(left), 0).

xi(Antigen, Xi, Program) :-
    maze:feedback(Antigen, Program, Xi).

psi(Antigen, Psi, Program) :-
    maze:affinity(Antigen, Program, Psi).

                /*******************************
                *           THE WAYS           *
                *******************************/

%   to_goal(+Rows, -Pairs): Robot-Steps for all squares and headings from
%   which the goal can be reached; a robot is at(X, Y, Heading).

to_goal(Rows, Pairs) :-
    once(maze:board_square(Rows, X, Y, g)),
    findall(at(X, Y, H), heading(H), Goals),
    wave(Goals, 0, Rows, Goals, Pairs).

wave([], _, _, _, []).
wave(Wave, Steps, Rows, Seen, Pairs) :-
    Wave = [_|_],
    findall(Robot-Steps, member(Robot, Wave), Pairs, More),
    findall(From, ( member(To, Wave), before(Rows, To, From),
                    \+ memberchk(From, Seen) ), Next0),
    sort(Next0, Next),
    append(Next, Seen, Seen1),
    Steps1 is Steps + 1,
    wave(Next, Steps1, Rows, Seen1, More).

heading(0/(-1)).
heading(0/1).
heading(1/0).
heading(-1/0).

before(Rows, at(X, Y, DX/DY), at(X0, Y0, DX/DY)) :-
    X0 is X - DX,
    Y0 is Y - DY,
    maze:board_free(Rows, X0, Y0).
before(_, at(X, Y, H), at(X, Y, H0)) :-
    heading(H0),
    ( maze:robot_turned(left, H0, H) ; maze:robot_turned(right, H0, H) ).

%   answer(+Sight, -Clause): at a sight, the first of its right actions.

answer(Sight-[Answer|_], (Answer :- Body)) :-
    once(maze:sight(Sight, Readings)),
    reverse(Readings, [Last|Others]),
    foldl([Reading, Rest, (Reading, Rest)]>>true, Others, Last, Body).

%   A step on a shortest way.

on_the_way(Rows, Pairs, Reading, Action) :-
    once(maze:board_square(Rows, GX, GY, g)),
    Reading = [after(Last)|_],
    member(at(X, Y, H)-Steps, Pairs),
    maze:robot_sees(robot(X, Y, H, Last), board(Rows, GX, GY), Seen),
    subset(Reading, Seen),
    maze:robot_does(Action, robot(X, Y, H, Last), Seen,
                    robot(X1, Y1, H1, _)),
    memberchk(at(X1, Y1, H1)-Less, Pairs),
    Less < Steps.

:- begin_tests(sieve_maze_boards).

test(antigens_are_drawn_in_this_order,
     As == [ block(left), block(right), wall(left), wall(right), corner(left),
             corner(right), corridor(left), corridor(right), box(left),
             box(right) ]) :-
    findall(A, maze:antigen(A), As).
test(rows, [ forall(maze:obstacle(_, _, Rows)) ]) :-
    maplist(atom_length, Rows, Lengths),
    sort(Lengths, [_]),
    aggregate_all(count, maze:board_square(Rows, _, _, ^), 1),
    aggregate_all(count, maze:board_square(Rows, _, _, g), 1).
test(shortest, [ forall(maze:obstacle(_, Steps, Rows)),
                 true(Found == Steps) ]) :-
    to_goal(Rows, Pairs),
    once(maze:board_square(Rows, X, Y, ^)),
    memberchk(at(X, Y, 0/(-1))-Found, Pairs).
test(five_sights, [ forall(maze:known_by(_, Sights)), true(N == 5) ]) :-
    length(Sights, N).
test(right_actions_at_all_sights_have_the_full_affinity,
     [ forall(maze:known_by(Kind, Sights)), true(Psi == 5) ]) :-
    maplist(answer, Sights, Program),
    Antigen =.. [Kind,left],
    psi(Antigen, Psi, Program).
test(sights_are_seen, [ forall(maze:obstacle(Kind, _, Rows)),
                        true(Wrong == []) ]) :-
    to_goal(Rows, Pairs),
    maze:known_by(Kind, Sights),
    findall(Sight-Answer,
            ( member(Sight-Answers, Sights),
              maze:sight(Sight, Reading),
              member(Answer, Answers),
              \+ on_the_way(Rows, Pairs, Reading, Answer) ),
            Wrong).
test(unknown, fail) :-
    maze:affinity([0,1,0,1,0], [], _).
test(only_one_path, fail) :-
    maze:feedback(wall(behind), [], _).

:- end_tests(sieve_maze_boards).

                /*******************************
                *        RANDOM PROGRAMS       *
                *******************************/

drawn(Seed, Count, Programs) :-
    chance_seed(Seed, Chance),
    length(Programs, Count),
    foldl(draw, Programs, Chance, _).

draw(Program, Chance0, Chance) :-
    maze:random_antibody(Chance0, Program, Chance).

worth_trying(Antigen, Program) :-
    maze:affinity_threshold(Gamma),
    maze:affinity(Antigen, Program, Psi),
    Psi >= Gamma.

%   The feedback of programs worth trying, and of all others.

tried(Antigen, Programs, Worth, Others) :-
    partition(worth_trying(Antigen), Programs, Ps, Qs),
    maplist(maze:feedback(Antigen), Ps, Worth),
    maplist(maze:feedback(Antigen), Qs, Others).

%   The share of programs that are good enough to last.

share(Xis, Share) :-
    aggregate_all(count, ( member(Xi, Xis), Xi >= 23 ), Good),
    length(Xis, Count),
    Share is Good/Count.

:- begin_tests(sieve_maze_programs).

test(by_hand, [ forall(by_hand(Name, Antigen, Expected)),
                true(Xi == Expected) ]) :-
    program(Name, Program),
    maze:feedback(Antigen, Program, Xi).
test(each_board_is_solvable,
     [ forall(maze:antigen(Antigen)), true(Xi == 31) ]) :-
    program(along, Program),
    (   arg(1, Antigen, left)
    ->  maze:feedback(Antigen, Program, Xi)
    ;   maze:mirrored(Program, Image),
        maze:feedback(Antigen, Image, Xi)
    ).
test(one_program_solves_all_antigens_in_part, true(Least >= 1)) :-
    program(along, Program),
    aggregate_all(min(Xi),
                  ( maze:antigen(A), maze:feedback(A, Program, Xi) ), Least).
test(each_program_suits_some_antigens, Best-Other == 15-3) :-
    program(compass, Compass),
    program(along, Along),
    xi(box(right), Best, Compass),
    xi(box(right), Other, Along).
test(incentive_is_not_feedback, Psi-Xi == 4-0) :-
    program(compass, Program),
    psi(box(left), Psi, Program),
    xi(box(left), Xi, Program).
test(mirror, [ forall(program(_, Program)), true(Lefts == Rights) ]) :-
    maze:mirrored(Program, Image),
    maze:mirrored(Image, Program),
    findall(Xi-Psi, ( maze:obstacle(Kind, _, _), A =.. [Kind,left],
                      xi(A, Xi, Program), psi(A, Psi, Program) ), Lefts),
    findall(Xi-Psi, ( maze:obstacle(Kind, _, _), A =.. [Kind,right],
                      xi(A, Xi, Image), psi(A, Psi, Image) ), Rights).
test(first_clause, Action == left) :-
    maze:program_answer([ (right :- free(left), goal(left)),
                          (left :- free(left)), (right :- free(left)) ],
                        [free(left),goal(right)], Action).
test(no_clause, Action == forward) :-
    maze:program_answer([(right :- wall(left))], [free(left)], Action).
test(a_bump_costs_a_step, [ Robot == robot(1, 1, 1/0, forward), nondet ]) :-
    maze:robot_does(forward, robot(1, 1, 1/0, left), [wall(ahead)], Robot).
test(endless_program_ends_in_time, Result-Xi == (!)-0) :-
    program(spins, Program),
    call_with_inference_limit(maze:feedback(box(left), Program, Xi),
                              20 000, Result).
test(solved_in_the_last_step, Lefts == [0]) :-
    program(compass, Program),
    maze:obstacle(wall, 9, Rows),
    findall(Left, maze:program_solves(Program, Rows, 9, Left), Lefts),
    \+ maze:program_solves(Program, Rows, 8, _).
test(invalid_clauses_are_harmless,
     [ forall(member(P, [ [x, f(y)], [(halt :- true)],
                         [(left :- halt)],
                         [(halt :- free(left))] ])),
       true(Xi == 0) ]) :-
    maze:feedback(block(left), P, Xi).

:- end_tests(sieve_maze_programs).

%   reading(-Reading): see the comment of the payload.

reading(Reading) :-
    member(Sense-Sides, [ free-[ahead,left,right], wall-[ahead,left,right],
                          goal-[ahead,behind,left,right],
                          after-[forward,left,right] ]),
    member(Side, Sides),
    Reading =.. [Sense,Side].

reading((A,B), Reading) =>
    member(Reading, [A,B]).
reading(Body, Reading) =>
    Reading = Body.

senseless(forward, [after(forward),wall(ahead)]).
senseless(left, [after(right),wall(left)]).
senseless(right, [after(left),wall(right)]).

excluded(A-A).
excluded(after(_)-after(_)).
excluded(free(Side)-wall(Side)).
excluded(wall(Side)-free(Side)).

:- begin_tests(sieve_maze_random).

test(repeatable, Programs == Again) :-
    drawn(7, 20, Programs),
    drawn(7, 20, Again).
test(each_action_has_all_readings_that_make_sense,
     [ forall(senseless(Action, Senseless)), Found == Expected ]) :-
    drawn(8, 600, Programs),
    findall(Reading, ( member(P, Programs), member((Action :- Body), P),
                       reading(Body, Reading) ), Found0),
    sort(Found0, Found),
    findall(Reading, reading(Reading), All0),
    sort(All0, All),
    ord_subtract(All, Senseless, Expected).
test(readings_are_drawn_in_this_order,
     [ forall(member(Action-Reading-Order,
                     [ forward-after(left)
                       -[ free(ahead), free(left), free(right), wall(left),
                          wall(right), goal(ahead), goal(behind), goal(left),
                          goal(right) ],
                       left-goal(left)
                       -[ free(ahead), free(left), free(right), wall(ahead),
                          wall(right), goal(ahead), goal(behind), goal(right),
                          after(forward), after(left) ],
                       right-goal(left)
                       -[ free(ahead), free(left), free(right), wall(ahead),
                          wall(left), goal(ahead), goal(behind), goal(right),
                          after(forward), after(right) ] ])),
       Others == Order ]) :-
    findall(Other, maze:other_reading(Action, Reading, Other), Others).
test(two_readings_of_a_clause_can_both_hold, Pairs-Excluded == yes-[]) :-
    drawn(8, 600, Programs),
    findall(A-B, ( member(P, Programs), member((_ :- A, B), P) ), All),
    ( All == [] -> Pairs = no ; Pairs = yes ),
    findall(Pair, ( member(Pair, All), excluded(Pair) ), Excluded).
test(programs_have_three_to_five_clauses, Lengths == [3, 4, 5]) :-
    drawn(8, 100, Programs),
    maplist(length, Programs, Lengths0),
    sort(Lengths0, Lengths).
test(selection, [ forall(member(Antigen, [ block(left), wall(right),
                                           corner(left), corridor(right) ]))
                ]) :-
    drawn(1, 600, Programs),
    tried(Antigen, Programs, Worth, Others),
    max_list(Worth, Best),
    assertion(Best >= 29),
    share(Worth, Good),
    share(Others, Rest),
    assertion(Good > 0.02),
    assertion(Good > 4*Rest).
test(random_programs_in_an_agent, Found == found(Program, Psi, Xi)) :-
    drawn(3, 1, [Program]),
    psi(wall(left), Psi, Program),
    xi(wall(left), Xi, Program),
    chance_seed(3, Chance),
    with_hosts([a],
               ( create([ (main :- r(C),
                                   random_antibody(C, P, _),
                                   affinity(wall(left), P, Y),
                                   feedback(wall(left), P, X),
                                   leave(found(P, Y, X))) ],
                        Agent,
                        [ host(a), facts([r(Chance)]),
                          payloads([payloads('sieve/maze')]) ]),
                 joined(Agent, done),
                 remote(a, sense(Found)) )).

:- end_tests(sieve_maze_random).
