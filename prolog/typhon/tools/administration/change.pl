:- module(typhon_change,
          [ change_agent/2              % +Agent, +Change
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [domain_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../../kernel/program',
              [ clause_parts/3, code_install/3, code_program/2,
                code_receive/2, code_sent/2, code_locate/2, program_load/6 ]).
:- use_module('../../kernel/wire', [mobile_term/1]).
:- use_module('../../kernel/host', [host/3, parts/3]).
:- use_module('../../kernel/agent',
              [ agent/5, agent_add/2, agent_clauses/3, agent_module/5,
                agent_replace/6, agent_state/2, state_destroy/2,
                with_agent/2 ]).
:- use_module('../../kernel/lifecycle', [order_give/3]).

/** <module> Changes of agents by users

The process that gives the order reads a new program and sends it with the
order.  The agent gets a new module that inherits from that of the new program,
with its present state.

*Threading*: any thread that may wait; the worker that runs the agent carries
out the order.
*/

:- multifile
    typhon_names:known/2,
    typhon_orders:carried_out/3.

%!  change_agent(+Agent, +Change) is det.
%
%   As agent_change/2.

change_agent(Agent, Change) :-
    must_be(nonvar, Change),
    once(change_order(Change, Order)),
    order_give(Agent, change(Order), _).

typhon_names:known(agent_change, facts('Clauses')).
typhon_names:known(agent_change, program('Spec')).

%   change_order(+Change, -Order): Order is facts(Clauses) or
%   program(Hash, Sent).

change_order(facts(Clauses), facts(Clauses)) :-
    !,
    must_be(list, Clauses),
    maplist(must_be_clause, Clauses),
    mobile_term(Clauses).
change_order(program(Spec), program(Hash, Sent)) :-
    !,
    program_load(Spec, Program, _, Hash, Kinds, Places),
    code_install(Hash, Program, Kinds),
    code_locate(Hash, Places),
    code_sent(Hash, Sent).
change_order(Change, _) :-
    domain_error(agent_change, Change).

must_be_clause(Clause) :-
    clause_parts(Clause, Head, Body),
    must_be(callable, Head),
    must_be(callable, Body).

typhon_orders:carried_out(change(Change), Id, ok) :-
    change_made(Change, Id).

change_made(facts(Clauses), Id) :-
    agent(Id, _, Module, Hash, _),
    code_program(Hash, Program),
    maplist(not_static(Program), Clauses),
    maplist(in_state(Program, Module), Clauses),
    agent_clauses(Module, Clauses, Allowed),
    agent_add(Allowed, Module).
change_made(program(Hash, Sent), Id) :-
    may_change(Id, Hash-Sent),
    code_receive(Hash, Sent),
    code_program(Hash, Program),
    Program = program(_, PIs, _, _),
    agent(Id, Host, Module0, _, Life),
    host(Host, _, Place),
    agent_state(Module0, state(Empty, Clauses)),
    maplist(not_static(Program), Clauses),
    append(PIs, Empty, Declared),
    agent_module(Id, Place, Hash, state(Declared, Clauses), Module),
    with_agent(Id, ( agent_replace(Id, Host, Module, Hash, Life, 0),
                     state_destroy(Id, Module0) )).

%   A part of the host may forbid the program, as it would for an agent that
%   arrives with it.

may_change(Id, New) :-
    (   agent(Id, Host, _, _, _),
        parts(new_program, Host, Closures)
    ->  forall(member(Closure, Closures), call(Closure, Host, Id, New))
    ;   true
    ).

not_static(program(_, _, _, Static), Clause) :-
    clause_parts(Clause, Head, _),
    functor(Head, Name, Arity),
    functor(General, Name, Arity),
    (   member(Rule, Static),
        clause_parts(Rule, General, _)
    ->  permission_error(attach, procedure, Name/Arity)
    ;   true
    ).

%   The state also includes dynamic predicates that the agent has made itself,
%   or has from a payload.

in_state(Program, Module, Clause) :-
    clause_parts(Clause, Head, _),
    functor(Head, Name, Arity),
    Program = program(_, Declared, _, _),
    (   memberchk(Name/Arity, Declared)
    ->  true
    ;   has_state(Module, Head)
    ->  true
    ;   findall(PI, state_indicator(Module, PI), Own),
        append(Declared, Own, PIs0),
        sort(PIs0, PIs),
        throw(error(existence_error(state, Name/Arity, PIs), _))
    ).

has_state(Module, Head) :-
    '$c_current_predicate'(_, Module:Head),
    '$get_predicate_attribute'(Module:Head, (dynamic), 1),
    \+ '$get_predicate_attribute'(Module:Head, imported, _).

state_indicator(Module, Name/Arity) :-
    has_state(Module, Head),
    functor(Head, Name, Arity),
    \+ sub_atom(Name, 0, _, _, $).
