:- module(typhon_payloads,
          [ agent_attach/2,             % +Id, +Payload
            agent_detach/2,             % +Id, +Name
            agent_payload/3,            % +Id, +Name, -Payload
            not_carried/2,              % +Name, +Payloads
            payload_marks/2,            % +Payload, -Marks
            result_put/2,               % +Module, +Term
            cloned_put/2,               % +Module, +Endpoint
            result_facts/2,             % +Module, -Items
            no_result_facts/2,          % +State0, -State
            is_result_fact/1            % @Item
          ]).
:- use_module(library(apply), [exclude/3, maplist/2]).
:- use_module(library(error),
              [existence_error/2, permission_error/3, resource_error/1]).
:- use_module(library(lists), [member/2, selectchk/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../host', [host_address/2, parts/3]).
:- use_module(agents,
              [ agent/5, agent_put_life/2, life_payloads/2,
                set_payloads_of_life/3 ]).
:- use_module(identity, [with_agent/2]).
:- use_module(agent_module,
              [ agent_add/2, agent_clauses/3, agent_code/2, agent_declare/2,
                agent_variant/2 ]).

/** <module> Payloads and results of agents

A payload is payload(Name, PIs, Clauses).  Its clauses are part of the agent's
state, its name and predicates are noted in the agent's life.  Options may mark
it by facts in the state.  Parts of the host, see typhon_host_parts, may refuse
a payload when it is attached or delivered; they are called with From, Payload,
Host, -Reason: From is `new`, or module(Module) if the agent has it already.

Results are facts '$legacy'(Item) in the state of an agent, so they travel with
it.  An item is

  - result(Term): the last result that the agent has given
  - cloned(Endpoint): the agent was cloned in that process

A clone starts without these facts.

*Threading*: the worker that runs the agent adds; the rest as typhon_agents.
*/

:- multifile
    mark/2,                     % Payload, Mark: a fact that goes with Payload
    unmarked/2.                 % Module, Name: remove the marks of a payload
                                % that is detached

%!  payload_marks(+Payload, -Marks:list) is det.
%
%   Marks are the facts in the state of an agent that go with Payload.

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

%!  not_carried(+Name, +Payloads:list) is det.
%
%   No payload among Payloads, as in life_payloads/2, has this Name.
%
%   @error permission_error(attach, payload, Name)

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

                /*******************************
                *           RESULTS            *
                *******************************/

:- multifile prolog:error_message//1.

:- setting(result_bytes, positive_integer, 1000000,
           "The longest result of an agent, in bytes").

%!  result_put(+Module, +Term) is det.
%
%   Term, which is mobile, replaces the result of the agent.
%
%   @error resource_error(result_bytes)

result_put(Module, Term) :-
    setting(result_bytes, Most),
    fast_term_serialized(Term, Bytes),
    string_length(Bytes, Length),
    (   Length =< Most
    ->  dynamic(Module:'$legacy'/1),
        put_result(Module, Term)
    ;   resource_error(result_bytes)
    ).

%   Adds the new result before it removes the old one: readers always find one.

put_result(Module, Term) :-
    Module:'$legacy'(result(_)),
    !,
    assertz(Module:'$legacy'(result(Term))),
    once(retract(Module:'$legacy'(result(_)))).
put_result(Module, Term) :-
    assertz(Module:'$legacy'(result(Term))).

%!  cloned_put(+Module, +Endpoint) is det.

cloned_put(Module, Endpoint) :-
    dynamic(Module:'$legacy'/1),
    (   Module:'$legacy'(cloned(Endpoint))
    ->  true
    ;   assertz(Module:'$legacy'(cloned(Endpoint)))
    ).

%!  result_facts(+Module, -Items:list) is det.

result_facts(Module, Items) :-
    (   '$c_current_predicate'(_, Module:'$legacy'(_))
    ->  findall(Item, Module:'$legacy'(Item), Items)
    ;   Items = []
    ).

%!  no_result_facts(+State0, -State) is det.
%
%   State, as in agent_state/2, is State0 without results.

no_result_facts(state(Empty, Clauses0), state(Empty, Clauses)) :-
    exclude(of_result, Clauses0, Clauses).

of_result('$legacy'(_)).

%!  is_result_fact(@Item) is semidet.
%
%   Item has the form of a result; it may come from a peer.

is_result_fact(Item) :-
    subsumes_term(result(_), Item),
    !.
is_result_fact(Item) :-
    subsumes_term(cloned(_), Item),
    arg(1, Item, Endpoint),
    atom(Endpoint).

prolog:error_message(resource_error(result_bytes)) -->
    { setting(result_bytes, Most) },
    [ 'A result may have ~D bytes at most (setting typhon_payloads:result_bytes)'-
      [Most] ].
