:- module(typhon_change,
          [ change_order/2,             % +Change, -Order
            change_made/2,              % +Order, +Id
            undeclared/2,               % +PI, +Declared
            held_put/3,                 % +Id, +State, +Goals
            held_parts/3,               % +Held, -State, -Goals
            held_on/2,                  % +Id, +Held
            held_dropped/1              % +Goals
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [domain_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../program',
              [ clause_parts/3, code_install/3, code_program/2,
                code_receive/2, code_sent/2, code_stands/2, program_load/6 ]).
:- use_module('../wire', [mobile_term/1]).
:- use_module('../host', [host/3, parts/3, schedule/2]).
:- use_module('../agent',
              [ agent/5, agent_add/2, agent_clauses/3, agent_module/5,
                agent_program/4, agent_put/3, agent_state/2, with_agent/2 ]).

/** <module> Agents are changed from outside

A program is read where the order is given, and goes along with it; the
agent gets a module below that of the new program, with the state that it
has.

*Threading*: change_order/2 in any thread, change_made/2 in the worker that
has the agent.
*/

:- multifile typhon_names:known/2.

%!  change_order(+Change, -Order) is det.
%
%   Order is what is sent to an agent that is to Change: facts(Clauses) or
%   program(Hash, Sent).
%
%   @error domain_error(agent_change, Change)

typhon_names:known(agent_change, facts('Clauses')).
typhon_names:known(agent_change, program('Spec')).

change_order(facts(Clauses), facts(Clauses)) :-
    !,
    must_be(list, Clauses),
    maplist(must_be_clause, Clauses),
    mobile_term(Clauses).
change_order(program(Spec), program(Hash, Sent)) :-
    !,
    program_load(Spec, Program, _, Hash, Kinds, Places),
    code_install(Hash, Program, Kinds),
    code_stands(Hash, Places),
    code_sent(Hash, Sent).
change_order(Change, _) :-
    domain_error(agent_change, Change).

must_be_clause(Clause) :-
    clause_parts(Clause, Head, Body),
    must_be(callable, Head),
    must_be(callable, Body).

%!  change_made(+Order, +Id) is det.
%
%   @error permission_error(attach, procedure, PI)
%   @error existence_error(state, PI, Declared)
%   @error permission_error(change, agent_program, Id) a part of its host forbids
%   it: no other host would admit it

change_made(facts(Clauses), Id) :-
    agent(Id, _, Module, Hash, _),
    code_program(Hash, Program),
    maplist(not_static(Program), Clauses),
    maplist(in_state(Program, Module), Clauses),
    agent_clauses(Module, Clauses, Allowed),
    agent_add(Allowed, Module).
change_made(program(Hash, Sent), Id) :-
    may_change(Id, Sent),
    code_receive(Hash, Sent),
    code_program(Hash, Program),
    Program = program(_, PIs, _, _),
    agent(Id, Host, Module0, _, Life),
    host(Host, _, Place),
    agent_state(Module0, state(Empty, Clauses)),
    maplist(not_static(Program), Clauses),
    append(PIs, Empty, Declared),
    agent_module(Id, Place, Hash, state(Declared, Clauses), Module),
    with_agent(Id, agent_program(Id, Hash, Module, Life)).

may_change(Id, Sent) :-
    (   agent(Id, Host, _, _, _),
        parts(new_program, Host, Closures)
    ->  forall(member(Closure, Closures), call(Closure, Host, Id, Sent))
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

%   What the agent has made part of its state itself, or has of a payload, may
%   be added to as well.

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
        undeclared(Name/Arity, PIs)
    ).

has_state(Module, Head) :-
    '$c_current_predicate'(_, Module:Head),
    '$get_predicate_attribute'(Module:Head, (dynamic), 1),
    \+ '$get_predicate_attribute'(Module:Head, imported, _).

state_indicator(Module, Name/Arity) :-
    has_state(Module, Head),
    functor(Head, Name, Arity),
    \+ sub_atom(Name, 0, _, _, $).

%!  undeclared(+PI, +Declared:list)
%
%   @error existence_error(state, PI, Declared)

undeclared(PI, Declared) :-
    throw(error(existence_error(state, PI, Declared), _)).

                /*******************************
                *           ON HOLD            *
                *******************************/

%   Agents that are held in the middle of their goals.
%
%   The engine of a turn, see typhon_turn, may put an agent down before any
%   goal. The agent then has the status `held`, and when it is to go on
%   `resumed`, until a worker has it.  In place of its goals there is
%
%       held(State, Goals)
%
%   State being what the engine needs to go on, and Goals what comes next.  It
%   holds no thread, and is ended as others that rest are.  Orders wait for its
%   next effect.

:- multifile dropped/1.         % State: the agent ends, and goes on no more

%!  held_put(+Id, +State, +Goals:list) is det.
%!  held_parts(+Held, -State, -Goals:list) is semidet.
%!  held_on(+Id, +Held) is det.
%
%   Id, which was running, is held; what Held is; it is to go on.

held_put(Id, State, Goals) :-
    agent_put(Id, held, held(State, Goals)).

held_parts(Held, State, Goals) :-
    nonvar(Held),
    Held = held(State, Goals).

held_on(Id, Held) :-
    agent_put(Id, resumed, Held),
    agent(Id, Host, _, _, _),
    !,
    schedule(Host, Id).

%!  held_dropped(+Goals) is det.
%
%   An agent ends in the place of whose goals there was Goals.

held_dropped(Goals) :-
    (   held_parts(Goals, State, _),
        dropped(State)
    ->  true
    ;   true
    ).
