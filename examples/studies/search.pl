% Which parameters matter when several agents search?
%     swipl experiments/study.pl -- examples/studies/search.pl --runs 2

:- use_module(library(typhon)).

study(search, "Several agents see every host of a grid").
text("Of three parameters that all may matter, forty points are drawn.").

sample(agents, integer(1, 12)).
sample(side, integer(3, 8)).
sample(pause, loguniform(0.01, 1)).
design(latin_hypercube(40)).
fixed(hop_time, 0.2-0.4, assumed("as between our robots")).

network(Case, grid(N, N), [hop_time(uniform(Min, Max))]) :-
    N = Case.side,
    Min-Max = Case.hop_time.

run(Case, Network) :-
    network_property(Network, hosts([Corner|_])),
    findall(Agent,
            ( between(1, Case.agents, _),
              agent_create(agents(searcher), Agent,
                           [host(Corner), facts([pause(Case.pause)])]) ),
            Agents),
    forall(member(Agent, Agents), agent_join(Agent, done, 100000)).

%   The time of the first visit to the last host.

measure(time, Log, Time) :-
    findall(Host-Time, member(event(Time, Host, _, here), Log.events), Seen),
    findall(First, ( member(Host, Log.hosts), memberchk(Host-First, Seen) ),
            Firsts),
    length(Log.hosts, Count),
    length(Firsts, Count),
    max_list(Firsts, Time).

label(time, "Host seconds until every host was seen").

claim("larger grids take longer", [], correlation(time, side) > 0.3).
claim("more agents are faster", [], correlation(time, agents) < 0).
claim("pauses matter less than the size of the grid", [],
      correlation(time, pause) < correlation(time, side)).

plot(agents, "Time against the number of agents",
     lines([ x(agents), y(time) ])).
plot(pause, "Time against the pause", lines([ x(pause), y(time) ])).
