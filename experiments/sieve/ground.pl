%   Chapter 3: antibodies carried by mobile agents, on hosts under attack.
%
%   The study that includes this defines plan(Case, Plan), the antigens of each
%   round: see rounds.pl; and, for its picture, panel(Runs, Panel), one solution
%   for each panel: see pictures.pl.  The view of a run is its rounds.

:- use_module('../../agents/sieve/operator',
              [antigen_attack/2, sieve_start/3]).
:- use_module('../../prolog/typhon',
              [network_advance/2, network_at/3, network_property/2]).
:- use_module('../../prolog/typhon/kernel/base/prng',
              [chance_sample/5, chance_seed/2]).
:- use_module(pictures, [dot_rows/2, median_rows/2, panel_variables/2]).
:- use_module(rounds, [event_rounds/3, plan_rounds/2]).
:- use_module(library(apply), [foldl/5, maplist/3]).
:- use_module(library(lists), [append/3, member/2, nth0/3]).

fixed(application, payloads(sieve/bits), printed("section 3.5.2: five bits")).
fixed(topology, random(100, 0.06),
      assumed("the thesis prints 100 nodes, but not their links")).
fixed(dynamic, links(uniform(4, 8), 0.5, 0.5),
      assumed("the thesis prints dynamic; the number of links is constant")).
fixed(attacked, 10, assumed("hosts for each antigen in a round: several")).
fixed(hop_time, 0.27-0.53, assumed("as in chapter 5")).
fixed(round, 16, tuned("40 hops; see omega")).
fixed(omega, 200,
      tuned("printed: 1000 hops; these are the lives of five rounds")).
fixed(reading, similar,
      tuned("better agent: by feedback for similar antigens")).
fixed(patience, 1.2,
      tuned("until a danger signal has died down: 3 hops, as it spreads")).
fixed(gather, 1.2, assumed("from the first offer to the choice: 3 hops")).
fixed(crowd, 12,
      tuned("agents at a host that prevent clones; not of the thesis")).
fixed(capacity, 40, assumed("of a host; never reached")).

network(Case, Case.topology,
        [ hop_time(uniform(Min, Max)), hosts([capacity(Case.capacity)])
        | Dynamic ]) :-
    Min-Max = Case.hop_time,
    (   get_dict(dynamic, Case, none)
    ->  Dynamic = []
    ;   get_dict(dynamic, Case, Model),
        Dynamic = [dynamic(Model)]
    ).

%   All attacks are scheduled before time begins to advance.

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    findall(Name-Value,
            ( member(Name, [omega, reading, patience, gather, crowd, seed,
                            calls, memory_cells, memory_wins]),
              get_dict(Name, Case, Value) ),
            Settings),
    sieve_start(Hosts, Case.application, [settings(Settings)]),
    rounds_of(Case, Rounds),
    chance_seed(Case.seed, Chance),
    foldl(targets(Hosts, Case.attacked), Rounds, Attacks, Chance, _),
    forall(( nth0(I, Attacks, Attack), Time is I*Case.round ),
           network_at(Network, Time, attack_all(Attack))),
    length(Rounds, Count),
    Seconds is Count*Case.round,
    network_advance(Network, Seconds).

rounds_of(Case, Rounds) :-
    plan(Case, Plan),
    plan_rounds(Plan, Rounds).

%   The hosts attacked in one round are distinct.

targets(Hosts, Each, Antigens, Attacks, Chance0, Chance) :-
    length(Antigens, Kinds),
    Count is Kinds*Each,
    chance_sample(Count, Hosts, Attacked, Chance0, Chance),
    dealt(Antigens, Each, Attacked, Attacks).

dealt([], _, _, []).
dealt([Antigen|Antigens], Each, Hosts0, [Antigen-Own|Attacks]) :-
    length(Own, Each),
    append(Own, Hosts, Hosts0),
    dealt(Antigens, Each, Hosts, Attacks).

attack_all(Attacks) :-
    forall(( member(Antigen-Hosts, Attacks), antigen(Antigen, Term) ),
           antigen_attack(Hosts, Term)).

%   antigen(+Antigen, -Term): here an atom has all bits.

antigen(Antigen, Bits) :-
    atom(Antigen),
    !,
    atom_chars(Antigen, Chars),
    maplist(atom_number, Chars, Bits).
antigen(Antigen, Antigen).

view(Log, Rounds) :-
    rounds_of(Log.case, Planned),
    findall(Start, ( nth0(I, Planned, _), Start is I*Log.case.round ),
            Starts),
    event_rounds(Log.events, Starts, Rounds).

                /*******************************
                *            PICTURE           *
                *******************************/

%   Tables and variables of rounds.gp.

panel_rows(Runs, Rows) :-
    findall(Panel, panel(Runs, Panel), Panels),
    median_rows(Panels, Rows).

panel_dots(Runs, Rows) :-
    findall(Panel, panel(Runs, Panel), Panels),
    dot_rows(Panels, Rows).

panels(Runs, Pairs) :-
    findall(Panel, panel(Runs, Panel), Panels),
    panel_variables(Panels, Pairs).
