:- module(typhon_payloads,
          [ agent_attach/2,             % +Id, +Payload
            agent_detach/2,             % +Id, +Name
            agent_payload/3             % +Id, +Name, -Payload
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [member/2, selectchk/3]).
:- use_module(agents, [agent/5, agent_put_life/2]).
:- use_module(agent_lock, [with_agent/2]).
:- use_module(agent_module, [attach_clauses/3, detach_clauses/2]).
:- use_module('../host', [host_address/2]).
:- use_module(signed_payloads,
              [ payload_admitted/3, payload_mark/2, payload_marked/2,
                payload_marks/2, payload_unmarked/2 ]).
:- use_module(life, [life_payloads/2, set_payloads_of_life/3]).

/** <module> The payloads of agents

A payload is payload(Name, PIs, Clauses).  Its clauses are part of the
agent's state, its name and predicates are noted in its life.

*Threading*: the worker that has the agent.
*/

%!  agent_attach(+Id, +Payload) is det.
%
%   @error permission_error(attach, procedure, PI)
%   @error move_refused(Address, unsigned) its host does not want it

agent_attach(Id, Payload) :-
    Payload = payload(Name, PIs, _),
    agent(Id, Host, Module, Hash, Life),
    ( payload_mark(Payload, Mark) -> Marks = [Mark] ; Marks = [] ),
    must_be_admitted(Host, Payload, Marks),
    attach_clauses(Module, Hash, Payload),
    payload_marked(Module, Marks),
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
        payload_unmarked(Module, Name),
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
%   @error move_refused(Address, unsigned) its host does not want it

agent_payload(Id, Name, Payload) :-
    agent(Id, Host, Module, _, Life),
    life_payloads(Life, Payloads),
    (   memberchk(Name-PIs, Payloads)
    ->  findall(Clause, payload_clause(Module, PIs, Clause), Clauses)
    ;   existence_error(payload, Name)
    ),
    Payload = payload(Name, PIs, Clauses),
    payload_marks(Module, Marks),
    must_be_admitted(Host, Payload, Marks).

must_be_admitted(Host, Payload, Marks) :-
    (   payload_admitted(Host, Payload, Marks)
    ->  true
    ;   host_address(Host, Address),
        throw(error(move_refused(Address, unsigned), _))
    ).

payload_clause(Module, PIs, (Head:-Body)) :-
    member(Name/Arity, PIs),
    functor(Head, Name, Arity),
    clause(Module:Head, Body).
