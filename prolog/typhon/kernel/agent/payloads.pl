:- module(typhon_payloads,
          [ agent_attach/2,             % +Id, +Payload
            agent_detach/2,             % +Id, +Name
            agent_payload/3,            % +Id, +Name, -Payload
            payload_marks/2             % +Payload, -Marks
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [member/2, selectchk/3]).
:- use_module(agents, [agent/5, agent_put_life/2]).
:- use_module(agent_lock, [with_agent/2]).
:- use_module(agent_module, [attach_clauses/3, detach_clauses/2]).
:- use_module('../host', [host_address/2, parts/3]).
:- use_module(life, [life_payloads/2, set_payloads_of_life/3]).

/** <module> The payloads of agents

A payload is payload(Name, PIs, Clauses).  Its clauses are part of the
agent's state, its name and predicates are noted in its life.  Options may mark
it by facts among the state; and parts of the host, see typhon_host_parts, may
refuse it when it is attached or delivered, called with From, Payload, Host,
-Reason: From is `new`, or module(Module) if it is that of this agent.

*Threading*: the worker that has the agent.
*/

:- multifile
    mark/2,                     % Payload, Mark: goes with it
    unmarked/2.                 % Module, Name: of a payload that is detached

%!  payload_marks(+Payload, -Marks:list) is det.
%
%   The facts that go with Payload among the state of an agent.

payload_marks(Payload, Marks) :-
    findall(Mark, mark(Payload, Mark), Marks).

%!  agent_attach(+Id, +Payload) is det.
%
%   @error permission_error(attach, procedure, PI)
%   @error move_refused(Address, Reason) its host does not want it

agent_attach(Id, Payload) :-
    Payload = payload(Name, PIs, _),
    agent(Id, Host, Module, Hash, Life),
    must_be_admitted(Host, Payload, new),
    payload_marks(Payload, Marks),
    attach_clauses(Module, Hash, Payload),
    forall(member(Mark, Marks), marked(Module, Mark)),
    life_payloads(Life, Payloads),
    put_payloads(Id, Life, [Name-PIs|Payloads]).

%!  agent_detach(+Id, +Name) is det.
%
%   @error existence_error(payload, Name)

agent_detach(Id, Name) :-
    agent(Id, _, Module, _, Life),
    life_payloads(Life, Payloads0),
    (   selectchk(Name-PIs, Payloads0, Payloads)
    ->  detach_clauses(Module, PIs),
        forall(unmarked(Module, Name), true),
        put_payloads(Id, Life, Payloads)
    ;   existence_error(payload, Name)
    ).

put_payloads(Id, Life0, Payloads) :-
    set_payloads_of_life(Payloads, Life0, Life),
    with_agent(Id, agent_put_life(Id, Life)).

%!  agent_payload(+Id, +Name, -Payload) is det.
%
%   As it is now, to be delivered to its host: its clauses may have changed.
%
%   @error existence_error(payload, Name)
%   @error move_refused(Address, Reason) its host does not want it

agent_payload(Id, Name, Payload) :-
    agent(Id, Host, Module, _, Life),
    life_payloads(Life, Payloads),
    (   memberchk(Name-PIs, Payloads)
    ->  findall(Clause, payload_clause(Module, PIs, Clause), Clauses)
    ;   existence_error(payload, Name)
    ),
    Payload = payload(Name, PIs, Clauses),
    must_be_admitted(Host, Payload, module(Module)).

must_be_admitted(Host, Payload, From) :-
    (   parts(payload, Host, Closures),
        member(Closure, Closures),
        call(Closure, From, Payload, Host, Reason)
    ->  host_address(Host, Address),
        throw(error(move_refused(Address, Reason), _))
    ;   true
    ).

marked(Module, Mark) :-
    functor(Mark, Name, Arity),
    dynamic(Module:Name/Arity),
    assertz(Module:Mark).

payload_clause(Module, PIs, (Head:-Body)) :-
    member(Name/Arity, PIs),
    functor(Head, Name, Arity),
    clause(Module:Head, Body).
