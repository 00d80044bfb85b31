:- use_module('../common').
:- use_module(library(typhon)).
:- use_module(library(lists), [member/2]).

/*  Typhon's agents for bench/peers.pl.

    swipl agents.pl -- start | idle | messages | walks

    The other process runs a host with agents that send each message back. */

:- initialization(main, main).

main([walks]) :-
    !,
    network_start(grid(5, 6), Network, [clock(virtual), seed(1)]),
    network_property(Network, hosts([Home|_])),
    walks(1, 2000, Home),               % warm up
    measured(walks(one), 20000, walks(1, 20000, Home)),
    measured(walks(ten), 20000, walks(10, 20000, Home)),
    network_stop(Network).
main([Part]) :-
    host_start(here),
    part(Part),
    host_stop(here).

part(start) :-
    answers(1),
    told(done(start, 1)),
    current_prolog_flag(version_data, swi(Major, Minor, Patch, _)),
    format(atom(Version), 'Typhon, SWI-Prolog ~w.~w.~w',
           [Major, Minor, Patch]),
    told(version(Version)).
part(idle) :-
    mute(Program),
    measured(memory, 10000,
             forall(between(1, 10000, _), agent_create(Program, _))).
part(messages) :-
    answers(500),                       % warm up
    measured(answers, 5000, answers(5000)),
    pairs(local, here),
    with_peer([env], pairs(remote)).

                /*******************************
                *            AGENTS            *
                *******************************/

mute(clauses([ (:- agent(mute, [state([fact/2])])), on_message(_, _)
             | Facts ])) :-
    findall(fact(I, value(I)), between(1, 10, I), Facts).

%   An agent creates others, one after the other, each for one question.

answers(Count) :-
    text(Text),
    Answerer = clauses([ (:- agent(answerer, [])),
                         (main :- receive(From-Question),
                                  send(From, Question)) ]),
    create([ (:- agent(asker, [state([left/1])])),
             (main :- left(Count0), ask(Count0)),
             (ask(0) :- !),
             (ask(N) :- create(Answerer, Agent, []), send(Agent, Text),
                        receive(Agent-_), N1 is N-1, ask(N1)) ],
           [facts([left(Count)])], Asker),
    agent_join(Asker, done, 60).

create(Clauses, Options, Agent) :-
    agent_create(clauses(Clauses), Agent, Options).

text("0123456789012345678901234567890123456789\c
      0123456789012345678901234567890123456789\c
      01234567890123456789").

%   A pair sends each message back; a round trip is two messages.

pairs(Where, Host) :-
    paired(1, 1000, Host),              % warm up
    forall(member(pairs(Many, Pairs, Messages),
                  [pairs(one, 1, 20000), pairs(ten, 10, 40000)]),
           ( Measure =.. [Where,Many],
             measured(Measure, Messages, paired(Pairs, Messages, Host)) )).

paired(Pairs, Messages, Host) :-
    Rounds is Messages//(2*Pairs),
    findall(A-B, ( between(1, Pairs, _), pair(Rounds, Host, A, B) ), All),
    forall(member(A-_, All), agent_join(A, done, 60)),
    forall(member(_-B, All), agent_dispose(B)).

pair(Rounds, Host, A, B) :-
    text(Text),
    create([ (:- agent(pong, [])),
             (on_message(From, Message) :- send(From, Message)) ],
           [host(Host)], B),
    create([ (:- agent(ping, [state([pong/1,left/1])])),
             (main :- pong(Pong), left(N), ping(N, Pong)),
             (ping(0, _) :- !),
             (ping(N, Pong) :- send(Pong, Text), receive(Pong-_),
                               N1 is N-1, ping(N1, Pong)) ],
           [facts([pong(B), left(Rounds)])], A).

%   Agents that move to a random neighbour on 30 hosts, in virtual time.

walks(Agents, Hops, Home) :-
    Each is Hops//Agents,
    findall(Agent, ( between(1, Agents, _), walker(Each, Home, Agent) ), All),
    forall(member(Agent, All), agent_join(Agent, done, inf)).

walker(Hops, Home, Agent) :-
    create([ (:- agent(walker, [state([left/1])])),
             (main :- left(N), walk(N)),
             (walk(0) :- !),
             (walk(N) :- neighbours(Hosts), random_member(Host, Hosts),
                         move(Host), N1 is N-1, walk(N1)) ],
           [host(Home), facts([left(Hops)])], Agent).
