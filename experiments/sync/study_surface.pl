%   Beyond the thesis (section 8.2): search for the best potential.

:- include(ground).
:- include('../../agents/sync/potential').

study(surface, "Initial potential, θ(0), ω and δ together").
text("A latin hypercube samples the four parameters, for networks of four \c
topologies and two sizes. N is the number of successive penalties after which \c
a potential is zero: it follows from the four parameters by the recurrence of \c
equations 5.1 and 5.2, and is their only effect.").

vary(topology, [star_bus, ring, tree, grid]).
vary(hosts, [30, 60]).
sample(maximum, loguniform(25, 200)).
sample(theta, loguniform(4, 60)).
sample(window, integer(1, 40)).
sample(delta, loguniform(0.05, 1)).
design(latin_hypercube(40)).
derive(agents, Case, Count) :- Count is Case.hosts // 6.
derive(visits, Case, Visits) :-
    falls(drive(Case.maximum, [Case.theta]), Case, 0, Visits).
fixed(tasks, 3, assumed("enough for two steps from a task to the next")).

falls(drive(Potential, _), _, Visits, Visits) :-
    Potential =:= 0,
    !.
falls(Drive0, Case, Visits0, Visits) :-
    penalised(Drive0, Case.maximum, Case.window, Case.delta, _, Drive),
    Visits1 is Visits0 + 1,
    falls(Drive, Case, Visits1, Visits).

label(maximum, "initial potential P(0)").
label(theta, "θ(0)").
label(window, "window ω").
label(visits, "N, visits until a potential is zero").
label(second, "The second task begins (s)").
label(spread, "The first task has begun everywhere (s)").

measure(second, View, Time) :-
    memberchk(task(2, Time, _, _, _, _), View.rows).
measure(spread, View, Time) :-
    memberchk(task(1, _, Time, _, _, _), View.rows).

                /*******************************
                *            CLAIMS            *
                *******************************/

claim("the start of the second task correlates with N", [ours],
      correlation(second, visits) > 0.95).
claim(Text, [ours],
      at([topology=Topology, hosts=60], correlation(total, visits) > 0.95)) :-
    on(Topology, "the time for all tasks correlates with N", Text).
claim(Text, [ours],
      at([topology=Topology, hosts=60], correlation(overlaps, visits) < -0.5)) :-
    on(Topology, "fewer executions overlap with greater N", Text),
    Topology \== ring.
claim(Text, [ours],
      abs(correlation(total, Name)) < correlation(total, visits)) :-
    member(Name, [maximum, theta, window, delta]),
    label(Name, Title),
    format(string(Text), "~w alone correlates less with the time than N",
           [Title]).
claim("Ring: no executions overlap",
      [ours], at([topology=ring], overlaps =:= 0)).
claim("no executions overlap where the second task is due, by N, when the first is \c
begun everywhere", [ours],
      holds(none_when_due)).

on(Topology, Said, Text) :-
    best_delta(Topology, _),
    label(Topology, Title),
    format(string(Text), "~w: ~w", [Title, Said]).

none_when_due(Points) :-
    forall(( member(Case-Ms, Points), Case.visits*0.4 > Ms.spread ),
           Ms.overlaps =:= 0).

                /*******************************
                *            PICTURE           *
                *******************************/

plot(surface, "Time for all tasks and overlaps, by initial potential and δ",
     script('surface.gp', [points-points_rows], [size(1400, 820)])).
plot(surface_visits, "N is the only effect of four parameters",
     lines([x(visits), y([second, total, overlaps]), line(topology),
            where([hosts=60])])).

%   A block for each topology, as a number from 1, and size.

points_rows(Runs, Rows) :-
    findall([Block, [gap, gap]],
            ( nth1(T, [star_bus, ring, tree, grid], Topology),
              member(Hosts, [30, 60]),
              findall(Row, ( member(run(Case, _, Ms), Runs),
                             point(Case, Ms, Topology, T, Hosts, Row) ),
                      Block) ),
            Blocks),
    append(Blocks, Lists),
    append(Lists, Rows).

point(Case, Ms, Topology, T, Hosts,
      [T, Hosts, Delta, Maximum, Visits, Total, Overlaps]) :-
    _{ topology:Topology, hosts:Hosts, delta:Delta, maximum:Maximum,
       visits:Visits } :< Case,
    _{total:Total, overlaps:Overlaps} :< Ms.
