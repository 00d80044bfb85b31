%   Figure 5.2: decrease of a potential, computed by the predicates of the
%   agents; there is no network.

:- include('../../agents/sync/potential').
:- use_module(library(aggregate)).
:- use_module(library(lists)).

study('5.2', "Decrease of a potential").
text("The potential of one agent for one task, visit by visit, until it is \c
zero. All claims are about the formula. With δ outside the product, as Figure \c
5.6 requires, the curves of θ remain apart at the end, relative to θ; with δ \c
inside they would meet as section 5.4.1 states for Figure 5.2 b, but no \c
potential would ever reach zero.").

vary(delta, [0.2, 0.3, 0.5, 0.8, 1.0]).
fixed(theta, 15, printed("section 5.4.1")).
fixed(maximum, 100, printed("section 5.5")).
fixed(window, 15, printed("section 5.4.1")).
fixed(rewards, few, assumed("at the visits 1, 2, 3, 5, 8, 13, 21: most at \c
first, as section 5.4.1 says")).

fixed(early, 6, tuned("the visit at which the curves of θ are farthest apart")).
fixed(late, 34, tuned("the last visit at which no potential is zero")).

rewarded_at(few, [1, 2, 3, 5, 8, 13, 21]).

%   A list of step(N, Potential, Theta, Change), N from 0: the potential of an
%   agent after visit N, and its reward or penalty.

view(Log, steps(Log.case, [step(0, Maximum, Theta, 0)|Steps])) :-
    _{theta:Theta, maximum:Maximum} :< Log.case,
    rewarded_at(Log.case.rewards, Rewards),
    steps(1, drive(Maximum, [Theta]), Log.case, Rewards, Steps).

steps(_, drive(Potential, _), _, _, []) :-
    Potential =:= 0,
    !.
steps(N, Drive0, Case, Rewards, [step(N, P, Theta, Change)|Steps]) :-
    Drive0 = drive(P0, _),
    (   memberchk(N, Rewards)
    ->  rewarded(Drive0, Case.maximum, Case.window, Theta, Drive)
    ;   penalised(Drive0, Case.maximum, Case.window, Case.delta, Theta, Drive)
    ),
    Drive = drive(P, _),
    Change is P - P0,
    N1 is N + 1,
    steps(N1, Drive, Case, Rewards, Steps).

measure(visits, steps(_, Steps), Count) :-
    last(Steps, step(Count, _, _, _)).
measure(first_penalty, steps(_, Steps), Theta) :-
    once(( member(step(_, _, Theta, Change), Steps), Change < 0 )).
measure(last_theta, steps(_, Steps), Theta) :-
    last(Steps, step(_, _, Theta, _)).
measure(Name, steps(Case, Steps), Theta) :-
    member(Name, [early, late]),
    memberchk(step(Case.Name, _, Theta, _), Steps).
measure(not_raised, steps(_, Steps), Count) :-      % where a rise is possible
    rewarded_at(few, Rewards),
    aggregate_all(count,
                  ( member(N, Rewards),
                    append(_, [step(_, P, _, _), step(N, _, _, Change)|_],
                           Steps),
                    P < 100, Change =< 0 ),
                  Count).
measure(steps, steps(_, Steps), Steps).

label(visits, "Visits until the potential is zero").
label(first_penalty, "First penalty").
label(last_theta, "Last penalty").

claim("the larger δ, the sooner a potential is zero", [formula, line(3187)],
      falls(visits, along(delta))).
claim("a potential falls fast first, and slowly at the end",
      [formula, line(3182)],
      first_penalty > last_theta).
claim("a reward raises a potential for a while", [formula, line(3189)],
      not_raised =:= 0).
claim("the larger δ, the larger θ at the end", [formula, line(3196)],
      rises(last_theta, along(delta))).
claim("the curves of θ are apart at first, and nearer to each other at the end",
      [formula, line(3193)],
      most(late) - least(late) < most(early) - least(early)).
claim("relative to θ the curves of θ are nearer at the end",
      [ formula, line(3193),
        why("only with δ inside the product; but then Figure 5.6 does not hold") ],
      (most(late) - least(late))/mean(late)
      < (most(early) - least(early))/mean(early)).

plot('5.2', "Decrease of a potential",
     script('potentials.gp', [curves-curves, rewards-rewards],
            [seed(first), size(1000, 870), variables(deltas)])).

curves(Runs, Rows) :-
    findall([Block, [gap, gap]],
            ( member(run(_, _, Ms), Runs),
              findall([N, P, Theta], member(step(N, P, Theta, _), Ms.steps),
                      Block) ),
            Blocks),
    append(Blocks, Lists),
    append(Lists, Rows).

rewards(_, Rows) :-
    rewarded_at(few, Rewards),
    findall([N], member(N, Rewards), Rows).

deltas(Runs, [curves-Count, 'Delta'-Deltas, 'Visits'-Visits]) :-
    length(Runs, Count),
    findall(D-V, ( member(run(Case, _, Ms), Runs), D = Case.delta,
                   V = Ms.visits ), Pairs),
    findall(D, member(D-_, Pairs), Deltas),
    findall(V, member(_-V, Pairs), Visits).
