:- module(sieve_simulation,
          [ simulate/2                  % +Options, -Rounds
          ]).
:- use_module('../../prolog/typhon/base/chance',
              [chance_below/4, chance_float/3, chance_seed/2]).
:- use_module('../../prolog/typhon/language/strategy', [strategy_memory/2]).
:- use_module(ground, [ground_links/4, ground_map/4, ground_start/4,
                       ground_step/6]).
:- use_module(rounds, [plan/2, plan_rounds/2]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists),
              [member/2, memberchk/2, nth0/4, numlist/3, reverse/2,
               selectchk/3]).
:- use_module(library(option), [option/2]).
:- use_module(library(pairs), [pairs_values/2]).

/** <module> A quick model of the sieve

What the agents do, without agents: once in a second all that do not wait
make a hop, one after the other.  Equations, parameters and antibodies are
those of the agents, in their own files.  Danger signals are followed by the
distance from their source as the links are.

Runs of figures that take minutes on a network take seconds, so readings
and parameters can be compared over many seeds.  Memory cells there are
none.

*Threading*: any thread; parameters are local to it.
*/

:- thread_local setting/2.
:- discontiguous payload/2.

:- include('../../agents/sieve/parameters').
:- include('../../agents/sieve/idiotypic').

%   What the first line of a payload file says is nothing here.

payload(_, _).

:- include('../../payloads/sieve/bits').

%!  simulate(+Options, -Rounds) is det.
%
%   Rounds is what happened, see sieve_rounds.  Required of Options are
%   topology, dynamic, seed, figure, attacked, round and settings: see
%   sieve_run/3.
%
%   An agent is agent(Id, Kind, Host, Trip, Gamma, Memory, Expiry, Shunned,
%   Waits): Trip is the memory of its strategy, Expiry the second at which
%   it dies, Waits whether it has made an offer.  An attack is attack(Id,
%   Antigen, Host, Begin, First, Offers): First is when the first offer
%   came, or `none`, Offers are pairs Kind-Id.

simulate(Options, Rounds) :-
    option(settings(Settings), Options),
    retractall(setting(_, _)),
    forall(member(Name-Value, Settings), assertz(setting(Name, Value))),
    option(topology(Topology), Options),
    option(dynamic(Model), Options),
    option(seed(Seed), Options),
    ground_start(Topology, Model, Seed, Ground),
    chance_seed(Seed, Chance),
    option(figure(Figure), Options),
    plan(Figure, Plan),
    plan_rounds(Plan, Antigens),
    rounds(Antigens, Options, 0, state([], [], Ground, Chance, 1), Rounds).

rounds([], _, _, _, []).
rounds([Antigens|More], Options, Now, State0, [round(Events)|Rounds]) :-
    option(attacked(Count), Options),
    option(round(Seconds), Options),
    State0 = state(_, _, Ground, _, _),
    arg(1, Ground, N),
    numlist(1, N, Hosts),
    foldl(attacks(Count, Now), Antigens, Hosts-State0, _-State1),
    End is Now + Seconds,
    seconds(Now, End, State1, State, [], Events0),
    reverse(Events0, Events),
    rounds(More, Options, End, State, Rounds).

attacks(0, _, _, State, State) :-
    !.
attacks(Count, Now, Antigen, Hosts0-state(Agents, Open, G, Chance0, Id),
        State) :-
    length(Hosts0, N),
    chance_below(N, Index, Chance0, Chance),
    nth0(Index, Hosts0, Host, Hosts),
    Attack = attack(Id, Antigen, Host, Now, none, []),
    Id1 is Id + 1,
    Count1 is Count - 1,
    attacks(Count1, Now, Antigen,
            Hosts-state(Agents, [Attack|Open], G, Chance, Id1), State).

seconds(End, End, State, State, Events, Events) :-
    !.
seconds(Now, End, state(Agents0, Open0, Ground0, Chance0, Id), State,
        Events0, Events) :-
    ground_links(Now, Ground0, Ground, Links),
    parameter(span, Span),
    findall(trail(AttackId, Antigen, Map),
            ( member(attack(AttackId, Antigen, Host, _, _, _), Open0),
              ground_map(Links, Host, Span, Map) ),
            Trails),
    act(Agents0, now(Now, Links, Trails), Agents1-[],
        turn(Open0, Chance0, Events0), turn(Open1, Chance1, Events1)),
    settle(Open1, Now, state(Agents1, [], Ground, Chance1, Id), State1,
           Events1, Events2),
    Now1 is Now + 1,
    seconds(Now1, End, State1, State, Events2, Events).

                /*******************************
                *            PATROL            *
                *******************************/

act([], _, Agents-Agents, Turn, Turn).
act([Agent|More], World, Agents0-Agents, Turn0, Turn) :-
    one(Agent, World, Agents0-Agents1, Turn0, Turn1),
    act(More, World, Agents1-Agents, Turn1, Turn).

one(Agent, _, [Agent|Rest]-Rest, Turn, Turn) :-
    arg(9, Agent, true),
    !.
one(Agent, World, Agents, turn(Open0, Chance, Events), Turn) :-
    World = now(Now, _, _),
    arg(3, Agent, Host),
    select_attack(Open0, Host, Agent, Attack, Rest),
    !,
    offered(Attack, Now, Agent, Attack1, Agent1),
    (   arg(9, Agent1, true)
    ->  Agents = [Agent1|End]-End,
        Turn = turn([Attack1|Rest], Chance, Events)
    ;   one(Agent1, World, Agents, turn(Open0, Chance, Events), Turn)
    ).
one(Agent, now(Now, _, _), Rest-Rest, turn(Open, Chance, Events0),
    turn(Open, Chance, [died(aged, Kind)|Events0])) :-
    Agent = agent(_, Kind, _, _, _, _, Expiry, _, _),
    integer(Expiry),
    Now >= Expiry,
    !.
one(Agent, now(_, Links, Trails), [Agent1|Rest]-Rest,
    turn(Open, Chance0, Events), turn(Open, Chance, Events)) :-
    Agent = agent(Id, Kind, Host, Trip0, G, M, E, Shunned, W),
    findall(Map, ( member(trail(AttackId, Antigen, Map), Trails),
                   wanted(AttackId, Antigen, Kind, Shunned) ), Maps),
    ground_step(Links, Maps, Host-Trip0, There-Trip, Chance0, Chance),
    Agent1 = agent(Id, Kind, There, Trip, G, M, E, Shunned, W).

select_attack(Open, Host, agent(_, Kind, _, _, _, _, _, Shunned, _), Attack,
              Rest) :-
    member(Attack, Open),
    Attack = attack(Id, Antigen, Host, _, _, _),
    wanted(Id, Antigen, Kind, Shunned),
    !,
    selectchk(Attack, Open, Rest).

wanted(AttackId, Antigen, Kind, Shunned) :-
    \+ memberchk(AttackId, Shunned),
    serviceable(Antigen, Kind).

serviceable(Antigen, Kind) :-
    affinity(Antigen, Kind, Psi),
    affinity_threshold(Threshold),
    Psi >= Threshold.

%   An offer of a kind that is there already is redundant.

offered(Attack, _, Agent0, Attack, Agent) :-
    Attack = attack(Id, _, _, _, _, Offers),
    Agent0 = agent(A, Kind, H, T, G, M, E, Shunned, W),
    memberchk(Kind-_, Offers),
    !,
    Agent = agent(A, Kind, H, T, G, M, E, [Id|Shunned], W).
offered(attack(Id, Antigen, Host, Begin, First0, Offers), Now, Agent0,
        attack(Id, Antigen, Host, Begin, First, [Kind-A|Offers]), Agent) :-
    ( First0 == none -> First = Now ; First = First0 ),
    Agent0 = agent(A, Kind, H, T, G, M, E, Shunned, _),
    Agent = agent(A, Kind, H, T, G, M, E, [Id|Shunned], true).

                /*******************************
                *            SERVICE           *
                *******************************/

settle([], _, State, State, Events, Events).
settle([Attack|More], Now, State0, State, Events0, Events) :-
    Attack = attack(_, _, _, Begin, First, _),
    parameter(gather, Gather),
    parameter(patience, Patience),
    (   First == none,
        Now - Begin >= Patience
    ->  generate(Attack, Now, State0, State1, Events0, Events1)
    ;   First \== none,
        Now - First >= Gather
    ->  serve(Attack, Now, State0, State1, Events0, Events1)
    ;   State0 = state(A, Open, G, C, I),
        State1 = state(A, [Attack|Open], G, C, I),
        Events1 = Events0
    ),
    settle(More, Now, State1, State, Events1, Events).

generate(Attack, Now, state(Agents, Open, Ground, Chance0, Id0),
         state([Agent|Agents], Open, Ground, Chance, Id),
         Events, [born(host, Kind), generated(Antigen, Kind, Wait)|Events]) :-
    Attack = attack(AttackId, Antigen, Host, Begin, _, _),
    suitable(Antigen, Kind, Chance0, Chance),
    feedback(Antigen, Kind, Xi),
    parameter(gamma, Gamma),
    Wait is Now - Begin,
    strategy_memory(Id0, Trip),
    Agent = agent(Id0, Kind, Host, Trip, Gamma, [Antigen-Xi], inf,
                  [AttackId], false),
    Id is Id0 + 1.

suitable(Antigen, Kind, Chance0, Chance) :-
    random_antibody(Chance0, Kind0, Chance1),
    (   serviceable(Antigen, Kind0)
    ->  Kind = Kind0,
        Chance = Chance1
    ;   suitable(Antigen, Kind, Chance1, Chance)
    ).

serve(Attack, Now, state(Agents0, Open, Ground, Chance0, Id0),
      state(Agents, Open, Ground, Chance, Id),
      Events0, Events) :-
    Attack = attack(_, Antigen, _, Begin, _, Offers),
    findall(Psi-(Kind-A),
            ( member(Kind-A, Offers), affinity(Antigen, Kind, Psi) ),
            Weighted),
    chance_float(Turn, Chance0, Chance),
    roulette(Weighted, Turn, Kind-Winner),
    Wait is Now - Begin,
    pairs_values(Offers, Ids),
    present(Ids, Agents0, Present, Absent),
    cells(Present, Winner, Antigen, Cells),
    parameter(reading, Reading),
    parameter(kt, Kt),
    parameter(ku, Ku),
    interaction(Reading, Antigen, Kt-Ku, Cells, Gammas),
    fates(Present, Cells, Gammas, Now, Absent-Id0, Agents-Id,
          [served(Antigen, Kind, Wait)|Events0], Events).

present([], Agents, [], Agents).
present([Id|Ids], Agents0, [Agent|Present], Agents) :-
    functor(Agent, agent, 9),
    arg(1, Agent, Id),
    selectchk(Agent, Agents0, Agents1),
    present(Ids, Agents1, Present, Agents).

cells([], _, _, []).
cells([Agent|Agents], Winner, Antigen, [cell(Id, Gamma, Memory)|Cells]) :-
    Agent = agent(Id, Kind, _, _, Gamma0, Memory0, _, _, _),
    (   Id == Winner
    ->  feedback(Antigen, Kind, Xi),
        parameter(alpha, Alpha),
        parameter(beta, Beta),
        squashed(Xi, Alpha, Beta, Squashed),
        stimulated(Gamma0, Squashed, Gamma),
        learnt(Memory0, Antigen, Xi, Memory)
    ;   Gamma = Gamma0,
        Memory = Memory0
    ),
    cells(Agents, Winner, Antigen, Cells).

fates([], [], [], _, State, State, Events, Events).
fates([Agent|Agents], [cell(_, _, Memory)|Cells], [Gamma|Gammas], Now,
      State0, State, Events0, Events) :-
    parameter(gamma_min, Minimum),
    parameter(gamma_max, Maximum),
    fate(Gamma, Minimum, Maximum, Fate),
    meet(Fate, Agent, Memory, Gamma, Now, State0, State1, Events0, Events1),
    fates(Agents, Cells, Gammas, Now, State1, State, Events1, Events).

meet(die, agent(_, Kind, _, _, _, _, _, _, _), _, _, _, State, State,
     Events, [died(suppressed, Kind)|Events]).
meet(stay, agent(A, K, H, T, _, _, E, S, _), Memory, Gamma, _,
     Agents-Id, [agent(A, K, H, T, Gamma, Memory, E, S, false)|Agents]-Id,
     Events, Events).
meet(clone, agent(A, K, H, T, _, _, E, S, _), Memory, _, Now,
     Agents-Id0, [Parent, Clone|Agents]-Id,
     Events, [born(clone, K)|Events]) :-
    parameter(gamma, Gamma),
    parameter(omega, Omega),
    Expiry is Now + Omega,
    strategy_memory(Id0, Trip),
    Parent = agent(A, K, H, T, Gamma, Memory, E, S, false),
    Clone = agent(Id0, K, H, Trip, Gamma, Memory, Expiry, S, false),
    Id is Id0 + 1.
