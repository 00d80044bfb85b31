%   Robots that are out of reach at times, and agents that work on them.

:- use_module('../../prolog/typhon',
              [ agent_create/3, fleet_join/2, fleet_leave/1, host_change/2,
                network_advance/2, network_at/3, network_property/2 ]).
:- use_module('../../prolog/typhon/kernel/base/prng',
              [chance_float/3, chance_hash/2, chance_sample/5, chance_seed/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, memberchk/2, sum_list/2]).

study(away, "Agents that work on robots which are away at times").
text("A base is always in reach, twenty robots are away for 30 % of their time: \c
out of reach for each other and the base. Periods are drawn from exponential \c
distributions. The base sends forty agents, one after the other, each of which \c
works on four robots drawn for it and returns, within two hours. If a robot \c
cannot be reached an agent tries it again (again), tries the others of its tour \c
first (others), or waits in the engine of a fleet (wait, both). The fleet, with \c
a lease of ten seconds, is modelled.").

%   Without a fleet: again, others.  In a fleet: wait, and both, which waits where
%   none of the other robots can be reached.

vary(way, [again, others, wait, both]).
vary(period, [60, 600, 1800]).
fixed(share, 0.3, assumed("of its time a robot is away")).
fixed(robots, 20, assumed("a laboratory")).
fixed(agents, 40, assumed("one each half a minute, for twenty minutes")).
fixed(visits, 4, assumed("robots of an agent")).
fixed(work, 20, assumed("seconds on a robot")).
fixed(between, 30, assumed("seconds between the starts of agents")).
fixed(pause, 30, assumed("seconds until an agent tries again")).
fixed(limit, 7200, assumed("seconds that an agent has")).
fixed(hop_time, 0.3-0.6, assumed("as in chapter 5")).

network(Case, star(Hosts), Options) :-
    Hosts is Case.robots+1,
    Min-Max = Case.hop_time,
    Options0 = [hop_time(uniform(Min, Max))],
    (   uses_fleet(Case)
    ->  fleet_join(lab, [engine(modelled), lease(10), report(10)]),
        Options = [fleet(lab)|Options0]
    ;   Options = Options0
    ).

uses_fleet(Case) :-
    memberchk(Case.way, [wait, both]).

run(Case, Network) :-
    call_cleanup(made(Case, Network),
                 ( uses_fleet(Case) -> fleet_leave(lab) ; true )).

made(Case, Network) :-
    network_property(Network, hosts([Base|Robots])),
    End is Case.agents*Case.between + Case.limit,
    forall(member(Robot, Robots), goes_away(Case, Network, Robot, End)),
    forall(between(1, Case.agents, N),
           starts(Case, Network, Base, Robots, N)),
    network_advance(Network, End).

%   Away and in reach by turns, so that the share of the time is that of the case
%   from the beginning.

goes_away(Case, Network, Robot, End) :-
    chance_hash(away(Case.seed, Robot), Seed),
    chance_seed(Seed, Chance0),
    chance_float(Float, Chance0, Chance),
    ( Float < Case.share -> Away = true ; Away = false ),
    turns(0, Away, Case, Network, Robot, End, Chance).

turns(Time, Away, Case, Network, Robot, End, Chance0) :-
    (   Time > End
    ->  true
    ;   network_at(Network, Time, host_change(Robot, away(Away))),
        mean(Away, Case, Mean),
        chance_float(Float, Chance0, Chance),
        Next is Time - Mean*log(1-Float),
        ( Away == true -> Then = false ; Then = true ),
        turns(Next, Then, Case, Network, Robot, End, Chance)
    ).

mean(true, Case, Case.period).
mean(false, Case, Mean) :-
    Mean is Case.period*(1-Case.share)/Case.share.

starts(Case, Network, Base, Robots, N) :-
    chance_hash(tour(Case.seed, N), Seed),
    chance_seed(Seed, Chance),
    chance_sample(Case.visits, Robots, Tour, Chance, _),
    Time is (N-1)*Case.between,
    Facts = [ way(Case.way), robots(Tour), base(Base), work(Case.work),
              pause(Case.pause), longest(Case.limit) ],
    network_at(Network, Time,
               agent_create(agents(tour), _, [host(Base), facts(Facts)])).

label(done, "Agents of forty that are back in two hours").
label(time, "Seconds until an agent is back, two hours if it is not").
label(tries, "Moves that an agent begins").
label(twice, "Robots on which an agent began its work twice").

view(Log, view{times:Times, events:Log.events, agents:Log.case.agents,
               limit:Limit}) :-
    Limit = Log.case.limit,
    findall(Time,
            ( member(event(From, _, Agent, sent), Log.events),
              (   member(event(To, _, Agent, delivered), Log.events)
              ->  Time is min(Limit, To-From)
              ;   Time = Limit
              ) ),
            Times).

measure(done, View, Count) :-
    Limit = View.limit,
    aggregate_all(count, ( member(Time, View.times), Time < Limit ), Count).
measure(time, View, Mean) :-
    sum_list(View.times, Sum),
    length(View.times, Count),
    Mean is Sum/Count.
measure(tries, View, Mean) :-
    aggregate_all(count, member(event(_, _, _, tries), View.events), Count),
    Mean is Count/View.agents.
measure(twice, View, Count) :-
    findall(Agent-Host, member(event(_, Host, Agent, begins), View.events),
            All),
    sort(All, Once),
    length(All, N),
    length(Once, M),
    Count is N-M.

claim("no agent works on a robot twice", [], twice =:= 0).
claim("agents that wait do not finish later than those that try again", [],
      at([way=wait], time) =< at([way=again], time)).
claim("agents that wait begin less than half of the moves, if a period takes \c
ten minutes", [],
      at([period=600], at([way=wait], tries) < 0.5*at([way=again], tries))).
claim("trying other robots first finishes sooner than waiting in order", [],
      at([way=others], time) < at([way=wait], time)).
claim("waiting where no other robot can be reached finishes no later than \c
trying others again", [],
      at([way=both], time) =< at([way=others], time)).
claim("waiting where no other robot can be reached begins fewer moves than \c
trying others again", [],
      at([way=both], tries) < at([way=others], tries)).
claim("of the agents that wait no fewer are back in two hours", [],
      at([way=wait], done) >= at([way=again], done)).

plot(away, "Agents that work on robots which are away for 30 % of their time",
     lines([x(period), y([done, time, tries]), line(way),
            xlabel("Mean of the periods away (s)")])).
