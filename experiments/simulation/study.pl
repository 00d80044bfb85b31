:- module(simulation_study,
          [ study/2,                    % ?Name, -What
            study_point/2,              % +Name, -Given
            study_chart/3               % +Name, +Rows, -Chart
          ]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> What is varied in a study

A study is a set of points, each a list of options that take the place of
the defaults of a simulation. The first of them name the columns of its
table.

*Threading*: pure.
*/

%!  study(?Name, -What) is nondet.
%
%   What is a line of text.

study(topologies, 'the four static networks, each with its delta').
study(onset,      'delta, topology, task time against hop time').
study(spread,     'how much the hop time varies').
study(readings,   'other readings of equation 5.2').
study(service,    'Algorithm 2 as printed: no rule for hosts that execute').
study(order,      'where agents start, and whether chance leads them').
study(agents,     'number of agents').
study(hosts,      'number of hosts').
study(tasks,      'task times, constant and of Table 5.2').
study(dynamic,    'dynamic networks, by interval and number of agents').
study(healing,    'failures, as in Figures 5.11 and 5.12').

%!  study_point(+Name, -Given:list) is nondet.
%
%   Given are options Name(Value), in the same order for each point.

study_point(topologies, [topology(Topology), delta(Delta)]) :-
    static(_, Topology, Delta).
study_point(onset, [topology(Topology), task_time(Time), delta(Delta)]) :-
    static(_, Topology, _),
    member(Time, [0.25, 1, 4]),
    delta(Delta).
study_point(spread, [topology(Topology), delta(Delta), hop_time(Hop)]) :-
    static(_, Topology, Delta),
    member(Hop, [0.45-0.45, 0.3-0.6, 0.01-0.89]).
study_point(readings, [reading(Reading), topology(Topology), delta(Delta)]) :-
    member(Reading, [ chosen, over_window, inside(0.5), inside(10), signed ]),
    member(Name, ['star-bus', grid]),
    static(Name, Topology, _),
    member(Delta, [0.2, 1.0]).
study_point(service, [service(Service), topology(Topology), delta(Delta)]) :-
    member(Service, [exclusive, printed]),
    static(_, Topology, Delta).
study_point(order, [ starts(Starts), strategy(Strategy), topology(Topology),
                     delta(Delta) ]) :-
    member(Starts, [drawn, even]),
    member(Strategy, [conscientious, orderly]),
    (   static(_, Topology, Delta)
    ;   Topology-Delta = ring(60)-1.0
    ).
study_point(agents, [topology(Topology), delta(Delta), agents(Agents)]) :-
    static(_, Topology, Delta),
    member(Agents, [5, 10, 15, 20]).
study_point(hosts, [topology(Topology), delta(Delta), agents(10)]) :-
    static(Name, _, Delta),
    member(Tens, [3, 4, 5, 6]),
    sized(Name, Tens, Topology).
study_point(tasks, [topology(grid(6, 10)), delta(Delta), task_time(Times)]) :-
    member(Delta, [0.2, 0.3, 0.5]),
    member(Times, [1, 5, 20, table_5_2]).
study_point(dynamic, [ dynamic(Links), agents(Agents),
                       topology(grid(6, 10)), delta(0.2) ]) :-
    member(Interval, [uniform(1, 2), uniform(10, 20), uniform(40, 80)]),
    member(Links, [ toggle(Interval, 0.5, 0.7), links(Interval, 0.5, 0.7) ]),
    member(Agents, [5, 10, 20]).
study_point(healing, [ failure(Failure), dynamic(Dynamic),
                       topology(Topology), delta(Delta) ]) :-
    (   Failure = atomic(2, 20, 5),
        Dynamic = none,
        static(_, Topology, Delta)
    ;   Failure = cascaded(2, 60, 5),
        Topology = grid(6, 10),
        member(Dynamic-Delta, [none-0.5, dynamic_2-0.2])
    ).

delta(Delta) :-
    member(Delta, [0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0]).

%   Of 60 hosts, with the delta that thesis section 5.6.1 gives.

static('star-bus', star_bus(6, 10), 0.2).
static(ring,       ring(60),        0.8).
static(tree,       tree(60),        0.2).
static(grid,       grid(6, 10),     0.5).

sized('star-bus', Tens, star_bus(Tens, 10)).
sized(ring, Tens, ring(N)) :-
    N is 10 * Tens.
sized(tree, Tens, tree(N)) :-
    N is 10 * Tens.
sized(grid, Tens, grid(Tens, 10)).

                /*******************************
                *            FIGURE            *
                *******************************/

%!  study_chart(+Name, +Rows, -Chart) is semidet.
%
%   Chart is for draw_chart/3. Rows is a list of Given-Values, Values being
%   pairs Column-Number. Only the study `onset` has a figure.

study_chart(onset, Rows, [ title('Onset of overlapped executions'),
                           subtitle(Subtitle),
                           x('penalty bias {/Symbol d}'),
                           panels(Panels)
                         ]) :-
    Subtitle = 'simulated: 60 hosts, 10 agents, 6 tasks, hops 0.3 to 0.6 s',
    findall(panel(Title, '%', Series),
            ( member(Time, [0.25, 1, 4]),
              format(atom(Title),
                     'Runs with an overlapped execution, tasks of ~w s',
                     [Time]),
              overlap_series(Time, Rows, Series)
            ),
            Shares),
    idle_series(Rows, Idle),
    Panel = panel('Idle time, tasks of 1 s: median, 5 to 95 % of the runs',
                  's', Idle),
    append(Shares, [Panel], Panels).

overlap_series(Time, Rows, Series) :-
    series(Time, Rows, simulation_study:percent, Series).

idle_series(Rows, Series) :-
    series(1, Rows, simulation_study:idle, Series).

series(Time, Rows, Value, Series) :-
    pairs_keys_values(Indices, [0, 1, 2, 3],
                      ['star-bus', ring, tree, grid]),
    findall(series(Name, Index, Points, Delta),
            ( member(Index-Name, Indices),
              static(Name, Topology, Delta),
              findall(D-Values,
                      ( member(Given-Numbers, Rows),
                        Given = [ topology(Topology), task_time(Time),
                                  delta(D) ],
                        call(Value, Numbers, Values)
                      ),
                      Points)
            ),
            Series).

percent(Numbers, [Percent]) :-
    memberchk(share_overlap-Share, Numbers),
    Percent is 100 * Share.

idle(Numbers, [Low, Median, High]) :-
    memberchk(idle_q05-Low, Numbers),
    memberchk(idle_median-Median, Numbers),
    memberchk(idle_q95-High, Numbers).
