%   Learning beyond the thesis: other problems, other algorithms.
%
%   Expects of the study that includes this: the parameters `problem`, a
%   payload of learning; `algorithms`, assigned to the agents in turn;
%   `agents`; `limit`, host seconds after which the run ends; `settings`.  It
%   may have `sharing`, `cloning`, and `exchange`, at(Time, Old, New): at Time
%   the first agent replaces Old by New.  Gives: network/3, run/2,
%   view/2, and the measures of one run.

:- use_module('../../agents/learning/operator',
              [learning_exchange/3, learning_start/5]).
:- use_module('../../prolog/typhon',
              [agent_join/3, network_advance/2, network_property/2,
               remote/2]).
:- use_module(library(lists),
              [append/3, max_list/2, member/2, memberchk/2]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module(metrics, [algorithms_result/3, result_number/3]).
:- use_module(printers, [shortfalls/3]).

fixed(hosts, 10, assumed("all pairs linked")).
fixed(queue, 5, assumed("agents that a host admits beside its own")).
fixed(hop_time, 0.27-0.53, assumed("as in chapter 5")).
fixed(rho_max, 4, assumed("agents make few hops between executions")).

label(reached, "Agents that have reached the goal (%)").
label(mean, "Executions of an agent").
label(executions, "Executions of all agents").
label(pages, "Pages printed until the last agent has reached the goal").
label(most, "Greatest number of agents").
label(most_short, "Greatest shortfall of the settings found").

network(Case, mesh(Case.hosts),
        [hop_time(uniform(Min, Max)), hosts([capacity(Capacity)])]) :-
    Min-Max = Case.hop_time,
    Capacity is Case.queue + 1.         % and the trainer

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    findall(payloads(learning/Name), member(Name, Case.algorithms),
            Algorithms),
    findall(Setting, setting(Case, Setting), More),
    append(More, Case.settings, Settings),
    learning_start(Hosts, payloads(learning/Case.problem), Algorithms,
                   [ agents(Case.agents), seed(Case.seed),
                     settings(Settings) ], Agents),
    exchange(Case, Network, Agents),
    Hosts = [Host|_],
    forall(member(Agent, Agents), joined(Host, Case.limit, Agent)).

%   The seed determines the properties of the printers.

setting(Case, printers-Seed) :-
    get_dict(seed, Case, Seed).
setting(Case, Name-Value) :-
    member(Name, [rho_max, sharing, cloning]),
    get_dict(Name, Case, Value).

%   The first agent may have converged and ended before.

exchange(Case, Network, [First|_]) :-
    get_dict(exchange, Case, at(Time, Old, New)),
    !,
    network_advance(Network, Time),
    catch(learning_exchange([First], Old, payloads(learning/New)),
          error(existence_error(agent, _), _),
          true).
exchange(_, _, _).

joined(Host, Limit, Agent) :-
    remote(Host, now(Now)),
    Left is max(0, Limit - Now),
    agent_join(Agent, _, Left).

view(Log, view{case:Log.case, result:Result}) :-
    findall(Agent,
            limit(Log.case.agents,
                  ( member(event(_, _, Agent, created), Log.events),
                    sub_atom(Agent, 0, _, _, learner) )),
            Agents),
    algorithms_result(Log.events, Agents, Result).

%   Units of a maze are not pages.

measure(Name, View, Number) :-
    result_number(Name, View.result, Number),
    \+ ( Name == pages, View.case.problem == maze ).
measure(most_short, View, Most) :-
    short(View, Shortfalls),
    max_list(Shortfalls, Most).

short(View, Shortfalls) :-
    View.case.problem == settings,
    memberchk(solutions(Solutions), View.result),
    shortfalls(View.case.seed, Solutions, Shortfalls).

%   Settings of a maze with the light behind a corner.

trap(size-16).
trap(obstacles-[(6,6)-(6,11),(6,11)-(12,11)]).
