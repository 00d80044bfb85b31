%   Up to seven robots push boxes: section 7.7.

:- include(ground).
:- use_module('../../agents/allocation/reservations', [reservation_faults/2]).
:- use_module('../allocation/metrics', [from_first/2]).
:- use_module(boxes_metrics).
:- use_module(boxes_play, [boxes_play/4, robot_name/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [max_list/2, member/2, memberchk/2, nth1/3]).
:- use_module(library(solution_sequences), [distinct/2]).

study(boxes, "Robots push boxes").
text("Boxes appear in pairs; each box needs several robots to be moved. An \c
allocator is released for each box, finds robots, and has them drive along \c
lines to the box, push it, and drive back. While the second box of a pair is \c
being pushed, robots join.").

fixed(robots, 5, printed("section 7.7")).
fixed(hosts, 7, printed("section 7.7: seven robots in the end")).
fixed(script, [ phase([job(box1, 1, 3), job(box2, 2, 3)], 1),
                phase([job(box3, 1, 3), job(box4, 2, 4)], 1),
                phase([job(box5, 1, 2), job(box6, 2, 5)], 0) ],
      printed("section 7.7: boxes, their locations, and how many robots each \c
needs; how many join")).
fixed(every, 0.2, assumed("often enough for a moving picture")).

%   A ring of hosts, which have the names of their robots.

network(Case, edges(Ring), Options) :-
    Count = Case.hosts,
    findall(A-B, ( between(1, Count, I),
                   J is I mod Count + 1,
                   atom_concat(r, I, A),
                   atom_concat(r, J, B) ),
            Ring),
    robot_options(Case, Options).

run(Case, Network) :-
    host_rate(Case, Rate),
    in_arena(Case, Network, boxes, boxes_play(Case.put(rate, Rate), Network)).

real([], [clock=5, processes=7]).

                /*******************************
                *           MEASURES           *
                *******************************/

%   Time begins with the first allocator.  A robot that is reserved by two
%   tasks at a time, or left reserved, is an error.

view(Log, view{ case:(Log.case), hosts:(Log.hosts), terms:Terms, jobs:Jobs,
                holdings:Holdings, joined:Joined, end:End }) :-
    sort(1, @=<, Log.events, Sorted),
    reservation_faults(Sorted, []),
    from_first(Sorted, Events),
    jobs(Events, Jobs),
    holdings(Events, Holdings),
    joined(Events, Joined),
    findall(To, member(holding(_, _, _, _, To), Holdings), Times),
    max_list([0|Times], End),
    arena_terms(Log, Terms).

label(pushed, "Boxes at their destination").
label(completed, "Jobs that were completed").
label(backoffs, "Back-offs").
label(rested, "Total time of back-offs (s)").
label(yielded, "Pairs with too few robots, one box waited").
label(together, "Pairs with enough robots, pushed at the same time").
label(newcomers_used, "Robots that joined, and pushed").
label(from_dock, "Greatest distance of a robot from its place at the end (m)").
label(end, "Time until the last robot is free (s)").

measure(boxes, View, Count) :-
    aggregate_all(count, ( member(phase(Jobs, _), View.case.script),
                           member(_, Jobs) ), Count).
measure(pushed, View, Count) :-
    aggregate_all(count, member(event(_, arrived(_)), View.terms), Count).
measure(completed, View, Count) :-
    aggregate_all(count, ( member(job(_, _, _, End, _, _), View.jobs),
                           number(End) ), Count).
measure(backoffs, View, Count) :-
    aggregate_all(count, rest(View, _), Count).
measure(rested, View, Seconds) :-
    aggregate_all(sum(S), rest(View, [_, _, S]), Seconds).
measure(contending, View, Count) :-
    aggregate_all(count, pair(View, _, false), Count).
measure(yielded, View, Count) :-
    aggregate_all(count, ( pair(View, Names, false),
                           yields(View.jobs, Names) ), Count).
measure(enough, View, Count) :-
    aggregate_all(count, pair(View, _, true), Count).
measure(together, View, Count) :-
    aggregate_all(count, ( pair(View, Names, true),
                           together(View.jobs, Names) ), Count).
measure(newcomers, View, Count) :-
    aggregate_all(count, newcomer(View, _), Count).
measure(newcomers_used, View, Count) :-
    aggregate_all(count, distinct(Host, pushing_newcomer(View, Host)), Count).
measure(from_dock, View, Metres) :-
    from_dock(View.terms, Metres).
measure(end, View, View.end).

pair(View, Names, Enough) :-
    pair(View.case.script, View.case.robots, Names, Enough).

newcomer(View, Host) :-
    nth1(I, View.hosts, Host),
    I > View.case.robots.

pushing_newcomer(View, Host) :-
    newcomer(View, Host),
    member(holding(Host, _, _, Start, _), View.holdings),
    number(Start).

%   Rows for the picture, and for readers.  jobs: box, its name, robots, begun,
%   allocated, completed, back-offs, seconds of back-off, team; rests: box,
%   start and length of a back-off; holdings: robot, box, reserved, execution
%   begun, released; robots: robot, its name, when it joined.

measure(jobs, View, Rows) :-
    findall(Row, job_row(View, Row), Rows).
measure(rests, View, Rows) :-
    findall(Row, rest(View, Row), Rows).
measure(holdings, View, Rows) :-
    findall([I, J, From, Start, To],
            ( member(holding(Host, Box, From, Start, To), View.holdings),
              nth1(I, View.hosts, Host),
              nth1(J, View.jobs, job(Box, _, _, _, _, _)) ),
            Rows).
measure(robots, View, Rows) :-
    findall([I, Name, Time], ( nth1(I, View.hosts, Host),
                               memberchk(Host-Time, View.joined),
                               robot_name(Host, Name) ), Rows).

job_row(View, [I, Box, Count, Begun, Allocated, End, Backoffs, Rested, Team]) :-
    nth1(I, View.jobs, job(Box, Begun, Allocated, End, Hosts, Rests)),
    length(Hosts, Count),
    length(Rests, Backoffs),
    aggregate_all(sum(S), member(_-S, Rests), Rested),
    findall(Name, ( member(Host, Hosts), robot_name(Host, Name) ), Names0),
    msort(Names0, Names),
    atomic_list_concat(Names, ' ', Text),
    atom_string(Text, Team).

rest(View, [I, From, Seconds]) :-
    nth1(I, View.jobs, job(_, _, _, _, _, Rests)),
    member(From-Seconds, Rests).

claim("every box is pushed to its destination", [line(5073)],
      pushed =:= boxes).
claim("every job is completed", [line(5073)],
      completed =:= boxes).
claim("of two competing jobs one backs off, and waits", [line(5071)],
      yielded =:= contending).
claim("two jobs with enough robots are executed at the same time", [ours],
      together =:= enough).
claim("robots that join while others push are used", [line(5074)],
      newcomers_used =:= newcomers).
claim("at the end all robots are in the dock (within 10 cm)", [line(5065)],
      from_dock < 0.1).

plot(boxes, "Robots push boxes",
     script('boxes.gp',
            [ robots-rows(robots), reservations-rows(holdings),
              jobs-rows(jobs), rests-rows(rests) ],
            [seed(first), size(1200, 760), variables(variables)])).
plot(arena, "The run", file('arena.svg', [])).

rows(Measure, [run(_, _, Measures)|_], Measures.Measure).

variables([run(Case, Seed, Measures)|_],
          [ 'SUBTITLE'-Text, 'END'-(Measures.end), robots-Robots,
            jobs-Jobs ]) :-
    about(Case, Seed, Text),
    length(Measures.robots, Robots),
    length(Measures.jobs, Jobs).
