:- module(algorithms_metrics,
          [ algorithms_result/3,        % +Events, +Agents, -Result
            result_number/3             % ?What, +Result, -Number
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists),
              [last/2, max_list/2, member/2, memberchk/2, sum_list/2]).

/** <module> Measures of a run of learning agents

*Threading*: pure.
*/

%!  algorithms_result(+Events, +Agents, -Result) is det.
%
%   Events are the event(Time, Host, Agent, What) of the log, Agents the
%   agents that were started.  Result is
%
%     - agents(Count)
%     - reached(List): first(Agent, Time, Count) for each of Agents that has
%       reached the goal, by its Count-th execution, in the order of time
%     - executions(Count): of all agents, including clones, until the last of
%       Agents has reached the goal, or until the end if not all have
%     - first(Count): of all agents until the first has reached it; `none`
%     - pages(Count): pages printed in these executions; 0 in a maze
%     - shared(Count): sharing events during these executions
%     - time(Seconds): the end of these executions
%     - clones(Count), most(Count): number of clones made; greatest number of
%       agents at a time
%     - solutions(List): Host-Actions for each agent that has converged: the
%       actions of its last execution, and their host

algorithms_result(Events, Agents,
                  [ agents(Count), reached(Reached), executions(Executions),
                    first(First), pages(Pages), shared(Shared), time(Time),
                    clones(Clones), most(Most), solutions(Solutions) ]) :-
    length(Agents, Count),
    firsts(Events, Agents, Reached),
    until(Reached, Count, Events, Time),
    aggregate_all(count, by(Events, Time, executed(_, _, _, _)), Executions),
    first(Reached, Events, First),
    pages(Events, Time, Pages),
    aggregate_all(count, by(Events, Time, shared(_, _)), Shared),
    aggregate_all(count, by(Events, inf, cloned), Clones),
    most(Events, Count, Most),
    findall(Host-Actions, solution(Events, Host, Actions), Solutions).

solution(Events, Host, Actions) :-
    member(event(_, _, Agent, converged(_, _, Actions)), Events),
    findall(At, member(event(_, At, Agent, executed(_, _, _, reached)),
                       Events), Ats),
    last(Ats, Host).

by(Events, Until, What) :-
    member(event(Time, _, _, What), Events),
    Time =< Until.

firsts(Events, Agents, Reached) :-
    findall(first(Agent, Time, Count),
            ( member(Agent, Agents),
              once(member(event(Time, _, Agent,
                                executed(Count, _, _, reached)), Events)) ),
            Reached0),
    sort(2, @=<, Reached0, Reached).

until(Reached, Count, _, Time) :-
    length(Reached, Count),
    !,
    aggregate_all(max(T), member(first(_, T, _), Reached), Time).
until(_, _, Events, Time) :-
    aggregate_all(max(T), member(event(T, _, _, _), Events), Time).

first([first(_, Time, _)|_], Events, First) :-
    !,
    aggregate_all(count, by(Events, Time, executed(_, _, _, _)), First).
first([], _, none).

%   Each page is a unit; an agent's last execution logs the total number of its
%   units.

pages(Events, Until, Pages) :-
    findall(Agent-Size,
            ( member(event(Time, _, Agent, executed(_, _, Size, _)), Events),
              Time =< Until ),
            Pairs),
    findall(Agent, member(Agent-_, Pairs), Names0),
    sort(Names0, Names),
    findall(Most,
            ( member(Name, Names),
              findall(Size, member(Name-Size, Pairs), Sizes),
              max_list(Sizes, Most) ),
            All),
    sum_list(All, Pages).

%   Adds one for each clone, and subtracts one for each end.

most(Events, Count, Most) :-
    foldl(population, Events, Count-Count, _-Most).

population(event(_, _, _, cloned), Now0-Most0, Now-Most) :-
    !,
    Now is Now0 + 1,
    Most is max(Most0, Now).
population(event(_, _, Agent, ended(_)), Now0-Most, Now-Most) :-
    sub_atom(Agent, 0, _, _, learner),
    !,
    Now is Now0 - 1.
population(_, State, State).

%!  result_number(?What, +Result, -Number) is nondet.
%
%   What is the name of a number in Result, or
%
%     - reached: the share of agents that have reached the goal, in percent
%     - mean: the mean number of executions of the agents that have reached
%       the goal; unknown if none has.

result_number(reached, Result, Percent) :-
    memberchk(reached(Reached), Result),
    memberchk(agents(Count), Result),
    length(Reached, Some),
    Percent is 100*Some/Count.
result_number(mean, Result, Mean) :-
    memberchk(reached(Reached), Result),
    findall(N, member(first(_, _, N), Reached), Ns),
    length(Ns, Count),
    Count > 0,
    sum_list(Ns, Sum),
    Mean is Sum/Count.
result_number(What, Result, Number) :-
    member(Term, Result),
    Term =.. [What, Number],
    number(Number).
