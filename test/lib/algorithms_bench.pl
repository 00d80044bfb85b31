:- module(test_algorithms_bench,
          [ problem/2,                  % +Payload, +Facts
            algorithm/3,                % +Module, +Payload, +Facts
            at_host/1,                  % +Host
            execution/3,                % +Plan, -Units, -Outcome
            group/5                     % +Seed, +Modules, +Hosts, +Most,
                                        % -Reached
          ]).
:- use_module(common).
:- use_module(fake_agent).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists), [append/3, member/2, nth0/3, numlist/3]).
:- use_module(library(ordsets), [ord_union/3]).
:- use_module(library(typhon/kernel/base/prng)).
:- use_module(library(typhon/kernel/program), [payload_load/2]).

/** <module> Learning without a network: for tests of problems and algorithms

The trainer is the real one, on a host that consists of a few facts. Each
algorithm has its own module. Seeds determine everything, so runs are
repeatable.

*Threading*: one thread at a time.
*/

%!  problem(+Payload, +Facts) is det.
%
%   A trainer carries Payload and knows Facts.

problem(Payload, Facts) :-
    fake_agent('agents/learning/trainer.pl', Facts, []),
    carry(fake_agent, Payload),
    seeded(1).

seeded(Seed) :-
    chance_seed(Seed, Chance),
    retractall(fake_agent:chance(_)),
    assertz(fake_agent:chance(Chance)).

%!  algorithm(+Module, +Payload, +Facts) is det.

algorithm(Module, Payload, Facts) :-
    forall(( current_predicate(Module:Name/Arity),
             functor(Head, Name, Arity),
             \+ predicate_property(Module:Head, imported_from(_)) ),
           retractall(Module:Head)),
    dynamic(Module:setting/2),
    forall(member(Fact, Facts), assertz(Module:Fact)),
    carry(Module, Payload).

carry(Module, Payload) :-
    payload_load(Payload, payload(_, PIs, Clauses)),
    forall(member(PI, PIs), dynamic(Module:PI)),
    forall(member(Clause, Clauses), assertz(Module:Clause)).

%!  at_host(+Host) is det.

at_host(Host) :-
    retractall(fake_host:did(_)),
    assertz(fake_host:did(move(Host))).

%!  execution(+Plan, -Units, -Outcome) is det.
%
%   What the trainer answers, its units in order.

execution(Plan, Units, Outcome) :-
    execution(Plan, _, Units, Outcome).

execution(Plan, Start, Units, Outcome) :-
    length(Plan, Length),
    Xi is Length + 3,
    fake_agent:on_message(me, execute(Plan, Xi)),
    retract(fake_host:did(send(me, feedback(Start, Units0, Outcome)))),
    !,
    sort(Units0, Units).

%!  group(+Seed, +Modules, +Hosts, +Most, -Reached) is det.
%
%   An agent for each of Modules; they execute in turn, at Hosts in turn, at
%   most Most times each.  Before its plan each gets, with probability 0.6,
%   all units that another agent has by its own executions. Reached has
%   Count-Pages for each agent that has reached the goal, after Count
%   executions with so many units.

group(Seed, Modules, Hosts, Most, Reached) :-
    seeded(Seed),
    chance_seed(Seed, Chance),
    findall(agent(Module, [], none), member(Module, Modules), Agents),
    numlist(1, Most, Rounds),
    foldl(round(Hosts), Rounds, state(Agents, Chance), state(End, _)),
    findall(Count-Pages,
            ( member(agent(_, Own, reached(Count)), End),
              length(Own, Pages) ),
            Reached).

round(Hosts, Round, state(Agents0, Chance0), state(Agents, Chance)) :-
    length(Agents0, Count),
    Last is Count - 1,
    numlist(0, Last, Indices),
    foldl(turn(Hosts, Round), Indices, state(Agents0, Chance0),
          state(Agents, Chance)).

turn(_, _, Index, state(Agents, Chance), state(Agents, Chance)) :-
    nth0(Index, Agents, agent(_, _, reached(_))),
    !.
turn(Hosts, Round, Index, state(Agents0, Chance0), state(Agents, Chance)) :-
    length(Hosts, HostCount),
    Where is (Round + Index) mod HostCount,
    nth0(Where, Hosts, Host),
    at_host(Host),
    length(Front, Index),
    append(Front, [agent(Module, Own0, Start0)|Back], Agents0),
    met(Agents0, Own0, Units, Chance0, Chance),
    planned(Module, Start0, Units, Plan),
    execution(Plan, Start, New, Outcome),
    ord_union(Own0, New, Own),
    after(Outcome, Round, Start, State),
    append(Front, [agent(Module, Own, State)|Back], Agents).

met(Agents, Own, Units, Chance0, Chance) :-
    chance_true(0.6, Meets, Chance0, Chance1),
    chance_member(agent(_, Others, _), Agents, Chance1, Chance),
    (   Meets == true
    ->  ord_union(Own, Others, Units)
    ;   Units = Own
    ).

planned(_, _, [], []) :-
    !.
planned(_, none, _, []) :-
    !.
planned(Module, begins(Start), Units, Plan) :-
    Module:plan(Start, Units, Plan),
    !.

after(reached(_), Round, _, reached(Round)).
after(unreached, _, Start, begins(Start)).
