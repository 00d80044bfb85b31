%   Programs in the sieve: the surviving ones, and their quality.

:- include(ground).
:- use_module('../../prolog/typhon/kernel/program/paths', []).
:- use_module('../../prolog/typhon/language/programs', [payload_load/2]).
:- use_module(pictures, [curve_points/3]).
:- use_module(rounds, [population/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, nth1/3, sum_list/2]).

study(programs, "Programs that steer a robot round obstacles, as antibodies").
text("Antibodies are small programs, drawn at random. Three obstacles attack \c
in each of 12 rounds. Feedback is 31 less the steps beyond the shortest path, \c
0 for a program that does not reach the goal.").

fixed(application, payloads(sieve/maze), assumed("antibodies are code")).
fixed(topology, random(40, 0.15), assumed("smaller: programs take time")).
fixed(attacked, 5, assumed("the share of hosts is as in Figure 3.3")).

plan(_, [[block(left), corner(right), corridor(left)]-12]).

label(drawn, "Mean feedback of random programs").
label(brought, "Mean feedback of programs of agents, last round").
label(able_first, "Agents with a good program after round 1 (%)").
label(able_last, "Agents with a good program after the last round (%)").

%   The payload has a module of its own, as in an agent.

:- dynamic maze:feedback/3.
:- initialization(load_maze).

load_maze :-
    payload_load(payloads(sieve/maze), payload(_, PIs, Clauses)),
    forall(member(PI, PIs), dynamic(maze:PI)),
    forall(member(Clause, Clauses), assertz(maze:Clause)).

measure(served, Rounds, Curve) :-
    findall(R-Mean, scored(served, Rounds, R, Mean), Curve).
measure(generated, Rounds, Curve) :-
    findall(R-Mean, scored(generated, Rounds, R, Mean), Curve).
measure(able, Rounds, Curve) :-
    findall(R-Share, ( nth1(R, Rounds, _), able(Rounds, R, Share) ), Curve).
measure(drawn, Rounds, Mean) :-
    findall(X, scored(generated, Rounds, _, X), Xs),
    mean(Xs, Mean).
measure(brought, Rounds, Mean) :-
    length(Rounds, Last),
    scored(served, Rounds, Last, Mean).
measure(able_first, Rounds, Share) :-
    able(Rounds, 1, Share).
measure(able_last, Rounds, Share) :-
    length(Rounds, Last),
    able(Rounds, Last, Share).

%   scored(+How, +Rounds, ?R, -Mean): mean feedback of the programs that met the
%   antigens of a round, drawn at random (`generated`) or carried by agents
%   (`served`).

scored(How, Rounds, R, Mean) :-
    nth1(R, Rounds, round(Events)),
    findall(Xi, ( member(Event, Events),
                  Event =.. [How, Antigen, Program, _],
                  maze:feedback(Antigen, Program, Xi) ), Xis),
    mean(Xis, Mean).

mean(Numbers, Mean) :-
    Numbers = [_|_],
    sum_list(Numbers, Sum),
    length(Numbers, Count),
    Mean is Sum/Count.

%   able(+Rounds, +R, -Share): percentage of the agents that carry a program
%   that reaches the goal of some obstacle.

able(Rounds, R, Share) :-
    population(Rounds, R, Population),
    aggregate_all(sum(N), member(N-_, Population), Total),
    Total > 0,
    aggregate_all(sum(N), ( member(N-Program, Population), good(Program) ),
                  Able),
    Share is 100*Able/Total.

good(Program) :-
    plan(_, [Antigens-_|_]),
    member(Antigen, Antigens),
    maze:feedback(Antigen, Program, Xi),
    Xi > 0,
    !.

claim("programs of agents in the last round are better than random ones",
      [ours], brought > drawn).
claim("more agents can pass some obstacle than after round 1", [ours],
      able_last > able_first).

plot(programs, "Programs in the sieve",
     script('rounds.gp', [medians-panel_rows, dots-panel_dots],
            [size(1000, 760), variables(panels)])).

panel(Runs, panel(Title, Series)) :-
    findall(Ms, member(run(_, _, Ms), Runs), All),
    member(Title-Curves,
           [ "Feedback of the programs that met an attack"-
             [ served-"brought by agents", generated-"drawn at random" ],
             "Agents with a program that gets round some obstacle (%)"-
             [ able-"agents" ] ]),
    findall(series(Label, Points),
            ( member(Name-Label, Curves), curve_points(Name, All, Points) ),
            Series).
