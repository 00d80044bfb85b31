:- module(typhon_inside,
          [ self/1,                     % -Id
            here/1,                     % -Host
            home/1,                     % -Host
            parent/1,                   % -Id
            hops/1,                     % -Count
            now/1,                      % -Time
            neighbours/1,               % -Hosts
            host_load/1,                % -Count
            next_host/2,                % +Strategy, -Host
            send/2,                     % +Agent, +Message
            leave/1,                    % +Fact
            sense/1,                    % ?Fact
            take/1,                     % ?Fact
            attach/1,                   % +Payload
            detach/1,                   % +Name
            deliver/1,                  % +Name
            undeliver/1,                % +Name
            emit/1,                     % +Problem
            emit/2,                     % +Problem, +Options
            withdraw/1,                 % +Problem
            pheromone/3,                % ?Problem, -Source, -Strength
            log/1,                      % +What
            message_failed/2,           % +From, +Message
            move/1,                     % +Host
            clone/1,                    % -Who
            clone/2,                    % +Host, -Who
            receive/1,                  % ?Message
            receive/2,                  % ?Message, +Timeout
            dispose/0
          ]).
:- use_module(library(error), [must_be/2, existence_error/2]).
:- use_module(library(lists), [member/2, selectchk/3]).
:- use_module(agent,
              [ agent/5, agent_home/2, agent_name/3, agent_put_life/2,
                with_agent/2, attach_clauses/3, detach_clauses/2 ]).
:- use_module(chance, [chance_hash/2]).
:- use_module(clock, [host_time/2]).
:- use_module(context, [context/3, context_agent/1, context_host/1]).
:- use_module(frame, [mobile_term/1]).
:- use_module(host,
              [ address_parts/3, host/3, host_load/2, host_neighbours/2,
                host_option/2, host_log/3 ]).
:- use_module(place,
              [ tuple_leave/2, tuple_sense/2, tuple_take/2,
                place_deliver/3, place_undeliver/2 ]).
:- use_module(pheromone,
              [ pheromone_emit/3, pheromone_here/4, pheromone_withdraw/2 ]).
:- use_module(post, [post/3]).
:- use_module(program, [payload_load/2]).
:- use_module(strategy, [strategy_memory/2, next_host/6]).

/** <module> What an agent can say

The vocabulary of agents, found through the place of the host on which
they stand.  The control predicates at the end are here only to say that
they were called where an agent cannot stop: the machine takes care of
them everywhere else.

*Threading*: whatever thread runs the agent; see typhon_context.
*/

%!  self(-Id) is det.
%!  here(-Host) is det.
%!  home(-Host) is det.
%!  parent(-Id) is semidet.
%!  hops(-Count) is det.
%!  now(-Time:float) is det.
%
%   The agent, the address of the host on which it stands and of that
%   where it was born, the agent of which it is a clone (fails if it is
%   none), how often it moved, and the time on the clock of the host.

self(Id) :-
    context_agent(Id).

here(Address) :-
    context_host(Host),
    host(Host, Address, _).

home(Address) :-
    context_agent(Id),
    agent_home(Id, Address).

parent(Parent) :-
    life(life(Parent, _, _, _, _, _)),
    Parent \== none.

hops(Count) :-
    life(life(_, Count, _, _, _, _)).

now(Time) :-
    context_host(Host),
    host_time(Host, Time).

life(Life) :-
    context_agent(Id),
    agent(Id, _, _, _, Life).

%!  neighbours(-Hosts:list(atom)) is det.
%!  host_load(-Count:integer) is det.
%
%   The addresses of linked hosts, and how many agents stand here.

neighbours(Hosts) :-
    context_host(Host),
    host_neighbours(Host, Hosts).

host_load(Count) :-
    context_host(Host),
    host_load(Host, Count).

%!  next_host(+Strategy, -Host) is semidet.
%
%   Choose a neighbour, see typhon_strategy.  What the strategy has to
%   remember travels with the agent.  Fails on an isolated host.

next_host(Strategy, Host) :-
    context(Here, Id, Module),
    host(Here, Address, _),
    host_neighbours(Here, Neighbours),
    strategy_memory(Module, Id, Here, Memory0),
    next_host(Strategy, Neighbours, Address, Memory0, Next, Memory),
    retractall(Module:'$memory'(_)),
    assertz(Module:'$memory'(Memory)),
    Host = Next.

strategy_memory(Module, _, _, Memory) :-
    catch(Module:'$memory'(Memory),
          error(existence_error(procedure, _), _), fail),
    !.
strategy_memory(_, Id, Here, Memory) :-
    (   host_option(Here, seed(Seed0))
    ->  true
    ;   Seed0 = random
    ),
    agent_seed(Seed0, Id, Seed),
    strategy_memory(Seed, Memory).

%   With a seed an agent's choices depend on it, on the name and number of
%   the agent, and on the host where it was born.

agent_seed(random, _, Seed) :-
    !,
    Seed is random(1<<30).
agent_seed(Seed0, Id, Seed) :-
    agent_name(Id, Name, Number),
    agent_home(Id, Home),
    address_parts(Home, HomeName, _),
    chance_hash(s(Seed0, Name, Number, HomeName), Seed).

%!  send(+Agent, +Message) is det.
%
%   As agent_send/2; it is from this agent.  If Agent has ended the
%   message is lost with a warning, not an error.  Who asks from outside is
%   `user`, who has no mailbox: answers to him are printed.

send(at(Agent, _), Message) :-
    !,
    send(Agent, Message).
send(Agent, Message) :-
    Agent == user,
    !,
    context_agent(Id),
    print_message(informational, typhon(told(Id, Message))).
send(Agent, Message) :-
    must_be(atom, Agent),
    context_agent(Id),
    catch(post(Agent, Id, Message),
          error(existence_error(agent, Agent), _),
          print_message(warning,
                        typhon(undeliverable(existence_error(agent, Agent),
                                             Agent, Id, Message)))).

%!  leave(+Fact) is det.
%!  sense(?Fact) is nondet.
%!  take(?Fact) is semidet.
%
%   Put a fact in the tuple space of the host, read one, take one away.
%   Of many that take the same fact one gets it.

leave(Fact) :-
    place(Place),
    mobile_term(Fact),
    tuple_leave(Place, Fact).

sense(Fact) :-
    place(Place),
    tuple_sense(Place, Fact).

take(Fact) :-
    place(Place),
    tuple_take(Place, Fact).

place(Place) :-
    context_host(Host),
    host(Host, _, Place).

%!  attach(+Payload) is det.
%!  detach(+Name) is det.
%
%   Take up the clauses of a payload file, or lay them down again.
%
%   @error permission_error(attach, procedure, PI)
%   @error existence_error(payload, Name)

attach(Spec) :-
    payload_load(Spec, Payload),
    context_agent(Id),
    attach_to(Id, Payload).

%   Also for those who give orders from outside.

attach_to(Id, Payload) :-
    Payload = payload(Name, PIs, _),
    agent(Id, _, Module, Hash, Life0),
    Life0 = life(Parent, Hops, Lifetime, Tokens, Payloads, Static),
    attach_clauses(Module, Hash, Payload),
    with_agent(Id, agent_put_life(Id, life(Parent, Hops, Lifetime, Tokens,
                                           [Name-PIs|Payloads], Static))).

detach(Name) :-
    context_agent(Id),
    detach_from(Id, Name).

detach_from(Id, Name) :-
    agent(Id, _, Module, _, Life0),
    Life0 = life(Parent, Hops, Lifetime, Tokens, Payloads0, Static),
    (   selectchk(Name-PIs, Payloads0, Payloads)
    ->  detach_clauses(Module, PIs),
        with_agent(Id, agent_put_life(Id, life(Parent, Hops, Lifetime,
                                               Tokens, Payloads, Static)))
    ;   existence_error(payload, Name)
    ).

%!  deliver(+Name) is det.
%!  undeliver(+Name) is det.
%
%   Install an attached payload in the place of the host, where all agents
%   and services can call it, or remove it.
%
%   @error existence_error(payload, Name)
%   @error permission_error(deliver, procedure, PI)

deliver(Name) :-
    life(life(_, _, _, _, Payloads, _)),
    (   memberchk(Name-PIs, Payloads)
    ->  context(_, _, Module),
        findall(Clause, payload_clause(Module, PIs, Clause), Clauses),
        place(Place),
        place_deliver(Place, payload(Name, PIs, Clauses), _)
    ;   existence_error(payload, Name)
    ).

payload_clause(Module, PIs, (Head:-Body)) :-
    member(Name/Arity, PIs),
    functor(Head, Name, Arity),
    clause(Module:Head, Body).

undeliver(Name) :-
    place(Place),
    place_undeliver(Place, Name).

%!  emit(+Problem) is det.
%!  emit(+Problem, +Options) is det.
%!  withdraw(+Problem) is det.
%!  pheromone(?Problem, -Source, -Strength) is nondet.
%
%   The host calls for someone who can solve Problem, and takes this back;
%   and what pheromones from other hosts are here. See typhon_pheromone,
%   also for the options. Agents follow them by the migration strategy
%   phercon(Problem).

emit(Problem) :-
    emit(Problem, []).

emit(Problem, Options) :-
    context_host(Host),
    pheromone_emit(Host, Problem, Options).

withdraw(Problem) :-
    context_host(Host),
    pheromone_withdraw(Host, Problem).

pheromone(Problem, Source, Strength) :-
    context_host(Host),
    pheromone_here(Host, Problem, Source, Strength).

%!  log(+What) is det.
%
%   An event at the log server of the host; printed if it has none.

log(What) :-
    context_host(Host),
    (   nb_current(typhon_context, context(_, Agent, _))
    ->  true
    ;   Agent = none
    ),
    (   host_option(Host, log(_))
    ->  mobile_term(What),
        host_log(Host, Agent, What)
    ;   print_message(informational, typhon(log(Host, Agent, What)))
    ).

%!  message_failed(+From, +Message) is det.
%
%   on_message/2 has failed; the agent stays.

message_failed(From, Message) :-
    context_agent(Id),
    print_message(warning, typhon(message_failed(Id, From, Message))).

                /*******************************
                *            CONTROL           *
                *******************************/

%!  move(+Host) is det.
%
%   Go to Host and go on there with the next goal; at once if the agent
%   stands there.  Choice points left of it are given up, as they are at
%   all predicates below.
%
%   @error move_refused(Host, Reason): capacity, token or unknown_host
%   @error host_unreachable(Host)
%   @error type_error(mobile_term, Culprit)

move(_) :-
    misplaced(move/1).

%!  clone(-Who) is det.
%!  clone(+Host, -Who) is det.
%
%   The agent goes on with Who = parent(CloneId), a clone of it, here or
%   on Host, with Who = clone(ParentId).

clone(_) :-
    misplaced(clone/1).
clone(_, _) :-
    misplaced(clone/2).

%!  receive(?Message) is det.
%!  receive(?Message, +Timeout) is semidet.
%
%   Take the oldest message From-Term that unifies with Message, or wait
%   for one, for Timeout seconds of host time at the most.  Others wait.

receive(_) :-
    misplaced(receive/1).
receive(_, _) :-
    misplaced(receive/2).

%!  dispose is det.
%
%   The agent ends.

dispose :-
    misplaced(dispose/0).

misplaced(PI) :-
    throw(error(permission_error(call, control_predicate, PI),
                context(PI, 'an agent cannot stop inside a goal that \c
                             Prolog runs to its end'))).
