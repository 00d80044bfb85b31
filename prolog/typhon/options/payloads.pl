:- module(typhon_payloads,
          [ agent_attach/2,             % +Id, +Payload
            agent_detach/2,             % +Id, +Name
            agent_payload/3,            % +Id, +Name, -Payload
            payloads_added/4            % +Specs, +Clauses, +State0, -State
          ]).
:- use_module(library(apply), [foldl/4, maplist/2]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(lists), [append/2, append/3, member/2, selectchk/3]).
:- use_module('../kernel/program', [payload_load/2]).
:- use_module('../kernel/host', [host_address/2, parts/3]).
:- use_module('../kernel/agent',
              [ agent/5, agent_add/2, agent_clauses/3, agent_code/2,
                agent_declare/2, agent_put_life/2, agent_variant/2,
                life_payloads/2, set_payloads_of_life/3, with_agent/2 ]).
:- use_module('../kernel/lifecycle', [not_static/2]).

/** <module> Payloads of agents

A payload is payload(Name, PIs, Clauses).  Its clauses are part of the agent's
state, its name and predicates are noted in the agent's life.  Options may mark
it by facts in the state.  Parts of the host, see typhon_host_parts, may refuse
a payload when it is attached or delivered; they are called with From, Payload,
Host, -Reason: From is `new`, or module(Module) if the agent has it already.

*Threading*: the worker that runs the agent attaches; the rest as typhon_agents.
*/

:- multifile
    typhon_on_demand:joins/2,
    mark/2,                     % Payload, Mark: a fact that goes with Payload
    unmarked/2.                 % Module, Name: remove the marks of a payload
                                % that is detached

typhon_on_demand:joins(payload, any).

%!  payloads_added(+Specs, +Clauses, +State0, -State) is det.
%
%   An agent whose program has these Clauses begins with payloads.  State0 and
%   State are Payloads-(PIs-Facts): its payloads as in life_payloads/2, and the
%   predicates and clauses of its state.
%
%   @error permission_error(attach, procedure, PI)
%   @error permission_error(attach, payload, Name)

payloads_added(Specs, Clauses, State0, State) :-
    foldl(added(Clauses), Specs, State0, State).

added(Clauses, Spec, Payloads-(PIs0-State0),
      [Name-New|Payloads]-(PIs-State)) :-
    payload_load(Spec, Payload),
    Payload = payload(Name, New, More),
    maplist(not_static(Clauses), New),
    maplist(not_among(PIs0), New),
    not_carried(Name, Payloads),
    append(PIs0, New, PIs),
    payload_marks(Payload, Marks),
    append([State0, More, Marks], State).

not_among(PIs, PI) :-
    (   memberchk(PI, PIs)
    ->  permission_error(attach, procedure, PI)
    ;   true
    ).

%   payload_marks(+Payload, -Marks): the facts in the state of an agent that go
%   with Payload.

payload_marks(Payload, Marks) :-
    findall(Mark, mark(Payload, Mark), Marks).

%!  agent_attach(+Id, +Payload) is det.
%
%   @error permission_error(attach, procedure, PI)
%   @error permission_error(attach, payload, Name) if the agent carries another
%          of that name: agent_detach/2 could not tell them apart
%   @error move_refused(Address, Reason) if its host refuses Payload

agent_attach(Id, Payload) :-
    Payload = payload(Name, PIs, _),
    agent(Id, Host, Module, _, Life),
    must_be_admitted(Host, Payload, new),
    agent_code(Module, Program),
    maplist(free(Module, Program), PIs),
    life_payloads(Life, Payloads),
    not_carried(Name, Payloads),
    payload_marks(Payload, Marks),
    attach_clauses(Module, Payload),
    agent_add(Marks, Module),
    put_payloads(Id, Life, [Name-PIs|Payloads]).

free(Module, Program, Name/Arity) :-
    functor(Head, Name, Arity),
    (   (   '$c_current_predicate'(_, Program:Head),
            \+ predicate_property(Program:Head, imported_from(_))
        ;   '$c_current_predicate'(_, Module:Head),
            predicate_property(Module:Head, dynamic),
            \+ predicate_property(Module:Head, imported_from(_))
        )
    ->  permission_error(attach, procedure, Name/Arity)
    ;   true
    ).

attach_clauses(Module, payload(_, PIs, Clauses0)) :-
    maplist(may_have(Module), PIs),
    agent_clauses(Module, Clauses0, Clauses),
    agent_declare(PIs, Module),
    agent_add(Clauses, Module).

may_have(Module, PI) :-
    (   agent_variant(Module, Variant)
    ->  typhon_agent_module:declares(Variant, PI)
    ;   true
    ).

not_carried(Name, Payloads) :-
    (   memberchk(Name-_, Payloads)
    ->  permission_error(attach, payload, Name)
    ;   true
    ).

%!  agent_detach(+Id, +Name) is det.
%
%   @error existence_error(payload, Name)

agent_detach(Id, Name) :-
    agent(Id, _, Module, _, Life),
    life_payloads(Life, Payloads0),
    (   selectchk(Name-PIs, Payloads0, Payloads)
    ->  forall(member(PI, PIs), abolish(Module:PI)),
        forall(unmarked(Module, Name), true),
        put_payloads(Id, Life, Payloads)
    ;   existence_error(payload, Name)
    ).

put_payloads(Id, Life0, Payloads) :-
    set_payloads_of_life(Payloads, Life0, Life),
    with_agent(Id, agent_put_life(Id, Life)).

%!  agent_payload(+Id, +Name, -Payload) is det.
%
%   Payload, with its present clauses, for delivery to the host of the agent.
%
%   @error existence_error(payload, Name)
%   @error move_refused(Address, Reason) if its host refuses Payload

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

payload_clause(Module, PIs, (Head:-Body)) :-
    member(Name/Arity, PIs),
    functor(Head, Name, Arity),
    clause(Module:Head, Body).
