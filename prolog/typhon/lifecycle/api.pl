:- module(typhon_api,
          [ agent_create/2,             % +Program, -Agent
            agent_create/3,             % +Program, -Agent, +Options
            agent_property/2,           % ?Agent, ?Property
            agent_send/2,               % +Agent, +Message
            agent_move/2,               % +Agent, +Host
            agent_clone/2,              % +Agent, -Clone
            agent_dispose/1,            % +Agent
            agent_join/3,               % +Agent, -Outcome, +Timeout
            agent_save/2,               % +Agent, +File
            agent_load/2,               % +File, -Agent
            payload_attach/2,           % +Agent, +Payload
            payload_detach/2            % +Agent, +Name
          ]).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3]).
:- use_module(library(error),
              [ domain_error/2, existence_error/2, must_be/2,
                permission_error/3 ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../program',
              [ clause_parts/3, code_install/2, code_install/3,
                code_program/2, payload_load/2, program_hash/2,
                program_load/5 ]).
:- use_module('../wire', [endpoint_address/1, endpoint_call/5, mobile_term/1]).
:- use_module('../host',
              [address_parts/3, host/3, host_address/2, host_resolve/2]).
:- use_module('../agent', [agent/5, agent_home/2, agent_id/3]).
:- use_module('../travel', [outcome_wait/3, post/3, post_via/4]).
:- use_module(creation, [agent_start/4]).
:- use_module(questions, [agent_ask/4]).
:- use_module(restore, [restore_read/2, restore_write/2]).

/** <module> Agents, as seen from the top level and from programs

Create agents, look at them, write to them and give them orders, wherever
in the network they are.

*Threading*: any thread.
*/

%!  agent_create(+Program, -Agent) is det.
%!  agent_create(+Program, -Agent, +Options) is det.
%
%   Create an agent.  Program is a file specification, as agents(census),
%   or clauses(Terms), the terms as they would stand in a file.  Options:
%
%     - name(+Atom): from which the id is made; default that of the program
%     - host(+Host): where, also in another process; default the first
%       host of this process
%     - tokens(+List): that it shows to hosts that ask for one
%     - payloads(+Specs): attached from the start
%     - facts(+Clauses): added to its initial state
%     - lifetime(+Hops): at the next move after so many it is disposed of
%     - static(+Boolean): whether it may not move
%
%   @error existence_error(host, Host)
%   @error move_refused(Host, Reason), host_unreachable(Host)
%   @error any problem of the program, see typhon_programs

agent_create(Program, Agent) :-
    agent_create(Program, Agent, []).

agent_create(Spec, Agent, Options) :-
    must_be(list, Options),
    maplist(check_option, Options),
    target(Options, Target),
    program_load(Spec, Program, Initial, Hash, Kinds),
    Program = program(Name0, Declared, _, Clauses),
    option(name(Name), Options, Name0),
    birth(Options, Declared, Initial, Clauses, Life, State),
    mobile_term(State),
    start_goals(Clauses, Initial, Goals),
    code_install(Hash, Program, Kinds),
    create(Target, Name, start(Hash, Life, State, Goals, []), Agent).

check_option(Option) :-
    (   option_type(Option, Type, Value)
    ->  must_be(Type, Value)
    ;   domain_error(agent_option, Option)
    ).

option_type(name(X), atom, X).
option_type(host(X), atom, X).
option_type(tokens(X), list, X).
option_type(payloads(X), list, X).
option_type(facts(X), list, X).
option_type(lifetime(X), oneof([inf]), X) :- X == inf, !.
option_type(lifetime(X), nonneg, X).
option_type(static(X), boolean, X).

target(Options, Where) :-
    (   option(host(Host), Options)
    ->  host_resolve(Host, Where)
    ;   host(Name, _, _)
    ->  Where = local(Name)
    ;   throw(error(existence_error(host, here),
                    context(agent_create/3,
                            'start one with host_start/1')))
    ).

birth(Options, Declared, Initial, Clauses, Life,
      state(PIs, StateClauses)) :-
    option(tokens(Tokens), Options, []),
    option(lifetime(Lifetime), Options, inf),
    option(static(Static), Options, false),
    option(facts(Facts), Options, []),
    option(payloads(Specs), Options, []),
    maplist(clash(Clauses), Facts),
    append(Initial, Facts, StateClauses0),
    foldl(add_payload(Clauses), Specs, []-(Declared-StateClauses0),
          Payloads-(PIs-StateClauses)),
    Life = life(none, 0, Lifetime, Tokens, Payloads, Static).

clash(Clauses, Fact) :-
    clause_parts(Fact, Head, _),
    must_be(callable, Head),
    functor(Head, Name, Arity),
    not_static(Clauses, Name/Arity).

not_static(Clauses, Name/Arity) :-
    functor(General, Name, Arity),
    (   member(Clause, Clauses),
        clause_parts(Clause, General, _)
    ->  permission_error(attach, procedure, Name/Arity)
    ;   true
    ).

add_payload(Clauses, Spec, Payloads-(PIs0-State0),
            [Name-New|Payloads]-(PIs-State)) :-
    payload_load(Spec, payload(Name, New, More)),
    maplist(not_static(Clauses), New),
    append(PIs0, New, PIs),
    append(State0, More, State).

start_goals(Clauses, Initial, Goals) :-
    (   ( member(Clause, Clauses) ; member(Clause, Initial) ),
        clause_parts(Clause, Head, _),
        Head == main
    ->  Goals = [main]
    ;   Goals = []
    ).

create(local(Host), Name, Start, Agent) :-
    host(Host, Address, _),
    agent_id(Name, Address, Id),
    agent_start(Id, Host, Start, Answer),
    created(Answer, Address, Id, Agent).
create(remote(Address, HostName, Endpoint), Name, Start, Agent) :-
    Start = start(Hash, _, _, _, _),
    code_program(Hash, Program),
    ask_create(Endpoint, Address, create(HostName, Name, Start, Program),
               Answer),
    created(Answer, Address, none, Agent).

ask_create(Endpoint, Address, Question, Answer) :-
    catch(endpoint_call(Endpoint, agent, Question, answer(Answer), 10),
          error(unreachable(_), _),
          throw(error(host_unreachable(Address), _))).

created(ok, _, Id, Id).
created(created(Id), _, _, Id).
created(refused(unknown_host), Address, _, _) :-
    existence_error(host, Address).
created(refused(Reason), Address, _, _) :-
    throw(error(move_refused(Address, Reason), _)).

                /*******************************
                *          PROPERTIES          *
                *******************************/

%!  agent_property(?Agent, ?Property) is nondet.
%
%   Property is host(Address), program(Name), state(State), hops(N),
%   home(Address), goals(List), facts(Clauses) or payloads(Names).  State
%   is `running`, `sleeping`, `waiting`, `resident`, `in_transit`,
%   `in_doubt` or faulty(Error).  If Agent is unbound, the agents of this
%   process are enumerated.

agent_property(Agent, Property) :-
    var(Agent),
    !,
    agent(Agent, _, _, _, _),
    agent_ask(Agent, properties, 10, answer(Properties)),
    one_of(Property, Properties).
agent_property(Agent, Property) :-
    must_be(atom, Agent),
    agent_home(Agent, _),
    agent_ask(Agent, properties, 10, answer(Properties)),
    one_of(Property, Properties).

%   There is one property of each name: people are not asked for more.

one_of(Property, Properties) :-
    (   var(Property)
    ->  member(Property, Properties)
    ;   memberchk(Property, Properties)
    ).

                /*******************************
                *       MESSAGES, ORDERS       *
                *******************************/

%!  agent_send(+Agent, +Message) is det.
%
%   Send Message to Agent, wherever it is; at(Agent, Host) says where it
%   is believed to be.  Does not wait for it to arrive.  Messages from
%   outside are from `user`.
%
%   @error existence_error(agent, Agent)
%   @error host_unreachable(Host)
%   @error type_error(mobile_term, Culprit)

agent_send(at(Agent, Host), Message) :-
    !,
    must_be(atom, Agent),
    host_address(Host, Address),
    address_parts(Address, _, Endpoint),
    sender(From),
    post_via(Agent, Endpoint, From, Message).
agent_send(Agent, Message) :-
    must_be(atom, Agent),
    sender(From),
    post(Agent, From, Message).

sender(From) :-
    (   nb_current(typhon_context, context(_, From0, _)),
        From0 \== none
    ->  From = From0
    ;   From = user
    ).

%!  agent_move(+Agent, +Host) is det.
%!  agent_clone(+Agent, -Clone) is det.
%!  agent_dispose(+Agent) is det.
%!  payload_attach(+Agent, +Payload) is det.
%!  payload_detach(+Agent, +Name) is det.
%
%   Orders from outside.  An agent that runs takes them at its next effect.
%   agent_move/2 and agent_dispose/1 do not wait for that, the others do,
%   for 10 seconds at the most.  An agent that is refused at Host stays
%   where it is, which is reported there.
%
%   @error existence_error(agent, Agent), existence_error(host, Host)
%   @error timeout_error(order, Agent)

agent_move(Agent, Host) :-
    host_address(Host, Address),
    order(Agent, move(Address), _).

agent_clone(Agent, Clone) :-
    order(Agent, clone, Clone0),
    Clone = Clone0.

agent_dispose(Agent) :-
    order(Agent, dispose, _).

payload_attach(Agent, Spec) :-
    payload_load(Spec, Payload),
    order(Agent, attach(Payload), _).

payload_detach(Agent, Name) :-
    must_be(atom, Name),
    order(Agent, detach(Name), _).

order(Agent, Order, Result) :-
    must_be(atom, Agent),
    (   agent_home(Agent, _),
        agent_ask(Agent, order(Order), 10, Answer)
    ->  ordered(Answer, Result)
    ;   existence_error(agent, Agent)
    ).

ordered(answer(Result), Result).
ordered(error(Formal), _) :-
    throw(error(Formal, _)).

%!  agent_join(+Agent, -Outcome, +Timeout) is det.
%
%   Wait until Agent has ended, wherever it is, for Timeout seconds (a
%   number or `inf`).  Outcome is `done`, `failed`, raised(Error),
%   `disposed` or `timeout`.
%
%   @error existence_error(agent, Agent)
%   @error host_unreachable(Home), connection_lost(Home)

agent_join(Agent, Outcome, Timeout) :-
    must_be(atom, Agent),
    (   Timeout == infinite
    ->  Seconds = inf
    ;   Timeout == inf
    ->  Seconds = inf
    ;   must_be(number, Timeout),
        Seconds is max(0, Timeout)
    ),
    (   agent_home(Agent, Home),
        address_parts(Home, _, Endpoint)
    ->  join(Endpoint, Agent, Seconds, Outcome0)
    ;   Outcome0 = unknown
    ),
    (   Outcome0 == unknown
    ->  existence_error(agent, Agent)
    ;   Outcome = Outcome0
    ).

join(Endpoint, Agent, Seconds, Outcome) :-
    (   endpoint_address(Endpoint)
    ;   typhon_whereabouts:agent_outcome(Agent, _)
    ),
    !,
    setup_call_cleanup(
        message_queue_create(Queue),    % who is interrupted leaves nothing
        ( outcome_wait(Agent, Seconds, queue(Queue, join)),
          thread_get_message(Queue, outcome(join, Outcome))
        ),
        message_queue_destroy(Queue)).
join(Endpoint, Agent, Seconds, Outcome) :-
    (   Seconds == inf
    ->  Limit = 1.0e9
    ;   Limit is Seconds+10
    ),
    catch(endpoint_call(Endpoint, join, join(Agent, Seconds),
                        answer(Outcome), Limit),
          error(unreachable(_), _),
          throw(error(host_unreachable(Endpoint), _))).

                /*******************************
                *        RESTORE POINTS        *
                *******************************/

%!  agent_save(+Agent, +File) is det.
%!  agent_load(+File, -Agent) is det.
%
%   A restore point: what Agent is at its next effect, as text.  The agent
%   that is made of it goes on where the first one was, on the first host
%   of this process, under an id of its own.
%
%   @error type_error(mobile_term, Culprit)
%   @error domain_error(restore_point, File)

agent_save(Agent, File) :-
    order(Agent, image, Image),
    restore_write(File, Image).

agent_load(File, Agent) :-
    target([], local(Host)),
    restore_read(File, image(Name, Program, Life, State, Goals, Mail)),
    program_hash(Program, Hash),
    code_install(Hash, Program),
    create(local(Host), Name, start(Hash, Life, State, Goals, Mail), Agent).
