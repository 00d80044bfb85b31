:- module(chaos_supervised,
          [ supervised/2,               % +Options, -Wrong
            supervised_main/0
          ]).
:- use_module('../../app/typhon/arguments', [arguments/3]).
:- use_module('../lib/common', [wait_until/2]).
:- use_module('../lib/peers').
:- use_module('../../prolog/typhon').
:- use_module(library(apply), [exclude/3, maplist/2]).
:- use_module(library(lists), [append/3, member/2, subtract/3]).
:- use_module(library(option), [option/3]).
:- use_module(library(random), [random_between/3, random_member/2]).

/** <module> Supervised children while processes are killed

    swipl -g supervised_main test/chaos/supervised.pl -- [--seed N]
        [--seconds N] [--rounds N]

Four processes, a supervisor, a standby supervisor, and eight children. In
each round children end and hop, the supervisor hops, and one process is
killed at a random time.  At the end each child must run exactly once, and
both supervisors must exist.

*Threading*: the main thread.
*/

:- public opt_type/3.

opt_type(seed,    seed,    integer).
opt_type(seconds, seconds, number).
opt_type(rounds,  rounds,  integer).

supervised_main :-
    current_prolog_flag(argv, Argv),
    arguments(Argv, [], Options),
    supervised(Options, Wrong),
    (   Wrong == []
    ->  halt(0)
    ;   halt(1)
    ).

%!  supervised(+Options, -Wrong:list) is det.
%
%   Options: seed(Seed), rounds(N), at most, and seconds(N), after which no round
%   begins.  Wrong has round(N, Acts, Names) for the first round after which
%   the agents Names run, if that is wrong.

supervised(Options, Wrong) :-
    option(seed(Seed), Options, 1),
    option(rounds(Rounds), Options, 1 000 000),
    option(seconds(Seconds), Options, 600),
    set_random(seed(Seed)),
    get_time(Now),
    Until is Now+Seconds,
    peers(Peers),
    findall(Peer-[setup(debug(typhon(agent)))], member(Peer, Peers), Specs),
    with_peers(Specs, attacked(1, Rounds, Until, Wrong)).

peers([p1, p2, p3, p4]).

children([c1, c2, c3, c4, c5, c6, c7, c8]).

attacked(First, Last, Until, Wrong) :-
    peers(Peers),
    maplist(linked, Peers),
    begun,
    rests(First, [], Peers, Wrong0),
    rounds(Wrong0, First, Last, Until, Wrong).

linked(Peer) :-
    peers(Peers),
    forall(( member(Other, Peers), Other \== Peer, peer_host(Other, There) ),
           peer_try(Peer, link(Peer, There), _)).

begun :-
    children(Names),
    findall(child(Name, Program, [host(Host), where([same,least_loaded,here])]),
            ( member(Name, Names),
              Program = clauses([ (:- agent(child, [])),
                                  (main :- receive(_-stop)) ]),
              a_peer(Peer),
              peer_host(Peer, Host) ),
            Children),
    peer_host(p2, Standby),
    Facts = [standby(Standby), intensity(1000, 1)|Children],
    peer_do(p1, agent_create(agents(supervisor), _, [facts(Facts)])).

a_peer(Peer) :-
    peers(Peers),
    random_member(Peer, Peers).

                /*******************************
                *            ROUNDS            *
                *******************************/

rounds([], N, Last, Until, Wrong) :-
    get_time(Now),
    N =< Last,
    Now < Until,
    !,
    round(N, Wrong0),
    Next is N+1,
    rounds(Wrong0, Next, Last, Until, Wrong).
rounds(Wrong, N, _, _, Wrong) :-
    Done is N-1,
    format('~D rounds~n', [Done]).

%   The killed process is restarted before the others rest, or afterwards.  An
%   agent that was on its way to it may be under way as long as it is dead.

round(N, Wrong) :-
    a_peer(Killed),
    random_between(0, 8, Before),
    random_between(0, 4, After),
    peers(Peers),
    subtract(Peers, [Killed], Living),
    Kinds = [ends, ends, hops, hops],
    acts(Before, [supervisor_hops|Kinds], Peers, Acts1),
    peer_kill(Killed),
    acts(After, Kinds, Living, Acts2),
    append(Acts1, [kill(Killed)|Acts2], Acts),
    (   random_between(0, 1, 0),
        \+ ( member(_-Act, Acts), memberchk(Act, [hops, supervisor_hops]) )
    ->  rests(N, Acts, Living, Wrong0)
    ;   Wrong0 = []
    ),
    (   Wrong0 == []
    ->  peer_restart(Killed),
        maplist(linked, Peers),
        rests(N, Acts, Peers, Wrong)
    ;   Wrong = Wrong0
    ).

%   In each round one supervisor hops, to a process that is neither the host
%   process nor the home of the other: otherwise one death would end both.

acts(0, _, _, []) :-
    !.
acts(N, Kinds0, Peers, [Peer-Act|Acts]) :-
    random_member(Peer, Peers),
    random_member(Act, Kinds0),
    random_member(To, Peers),
    act(Act, Peer, To),
    exclude(==(supervisor_hops), Kinds0, Kinds1),
    ( Act == supervisor_hops -> Kinds = Kinds1 ; Kinds = Kinds0 ),
    More is N-1,
    acts(More, Kinds, Peers, Acts).

act(ends, Peer, _) :-
    of_one(Peer, Id, child(Id), agent_send(Id, stop)).
act(hops, Peer, To) :-
    peer_host(To, Host),
    of_one(Peer, Id, child(Id), agent_move(Id, Host)).
act(supervisor_hops, Peer, To) :-
    peer_host(To, Host),
    (   peers(Peers),
        member(Place, Peers),
        agents_of(Place, Ids),
        member(Other, Ids),
        \+ child(Other),
        Place \== Peer,
        ( Place == To ; atom_concat(_, Host, Other) )
    ->  true
    ;   of_one(Peer, Id, \+ child(Id), agent_move(Id, Host))
    ).

%   An agent may end or hop while it receives an order.

of_one(Peer, Id, Which, Goal) :-
    agents_of(Peer, Ids),
    findall(Id, ( member(Id, Ids), Which ), Some),
    (   Some == []
    ->  true
    ;   random_member(Id, Some),
        peer_try(Peer, Goal, _)
    ).

child(Id) :-
    name(Id, Name),
    children(Names),
    memberchk(Name, Names).

                /*******************************
                *            VERDICT           *
                *******************************/

%   rests(+Round, +Acts, +Peers, -Wrong): the second check is after the
%   supervisor has handled all earlier messages.

rests(N, Acts, Peers, Wrong) :-
    (   catch(( wait_until(well(Peers), 60), answered(Peers),
                wait_until(well(Peers), 10) ),
              error(timeout_error(_, _), _), fail)
    ->  Wrong = []
    ;   names(Peers, Names),
        Wrong = [round(N, Acts, Names)],
        format(user_error, '~p~n', [Wrong]),
        forall(member(Peer, Peers), evidence(Peer))
    ).

%   The output of a process, and its agents and monitors.

evidence(Peer) :-
    forall(( peer_messages(Peer, Lines), member(Line, Lines) ),
           format(user_error, '~w: ~w~n', [Peer, Line])),
    peer_do(Peer,
            ( findall(Id-State-Facts,
                      ( typhon_agents:agent(Id, _, _, _, _),
                        typhon_agents:agent_status(Id, State, _),
                        agent_property(Id, facts(Facts)) ), Agents),
              findall(monitor(W, A), typhon_monitors:monitor(_, W, A), Ms),
              findall(asked(A, S), typhon_monitors:asked(A, S), As),
              findall(watched(A),
                      typhon_monitored_agents:outcome_request(A, _, _), Ws),
              format(atom(Held), '~q~n~q~n~q~n~q', [Agents, Ms, As, Ws]) )),
    format(user_error, '~w holds ~w~n', [Peer, Held]).

%   There is no standby while the process meant for it is dead.

well(Peers) :-
    names(Peers, Names0),
    exclude(==(supervisor), Names0, Names),
    children(Children),
    msort(Names, Children),
    peers(All),
    subtract(Names0, Names, Supervisors),
    length(Names0, Count),
    length(Names, Of),
    Two is Count-Of,
    Supervisors = [_|_],
    (   Peers == All
    ->  Two =:= 2
    ;   Two =< 2
    ).

names(Peers, Names) :-
    findall(Name,
            ( member(Peer, Peers),
              agents_of(Peer, Ids),
              member(Id, Ids),
              name(Id, Name) ),
            Names).

name(Id, Name) :-
    sub_atom(Id, At, _, _, '.'),
    !,
    sub_atom(Id, 0, At, _, Name).

agents_of(Peer, Ids) :-
    peer_do(Peer, findall(Id,
                          typhon_agents:agent(Id, _, _, _, _), Ids)).

%   The standby does not answer.

answered(Peers) :-
    Asker = clauses([ (:- agent(asker, [state([whom/1])])),
                      (main :- whom(Id), send(Id, children),
                               receive(Id-children(_), 10)) ]),
    forall(( member(Peer, Peers), agents_of(Peer, Ids), member(Id, Ids),
             \+ child(Id) ),
           peer_try(Peer,
                    ( agent_property(Id, facts(Facts)),
                      \+ memberchk(primary(_), Facts),
                      agent_create(Asker, A, [facts([whom(Id)])]),
                      agent_join(A, _, 15) ), _)).
