:- module(typhon_results,
          [ result_put/2,               % +Module, +Term
            cloned_put/2,               % +Module, +Endpoint
            result_facts/2,             % +Module, -Items
            no_result_facts/2,          % +State0, -State
            is_result_fact/1,           % @Item
            fault_outcome/2,            % +Fault, -Outcome
            fault_error/2,              % +Fault, -Error
            fault_stamp/2,              % +Fault, -Stamp
            fault_shown/2,              % +Fault, -Shown
            fault_parts/5,              % +Fault, -Goal, -Where, -Address,
                                        % -Hops
            is_faulty/3                 % ?Goals, ?Fault, ?Left
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [resource_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> Results and faults of agents

Results are facts '$legacy'(Item) in the state of an agent, so they travel with
it.  An item is

  - result(Term): the last result that the agent has given
  - cloned(Endpoint): the agent was cloned in that process

A clone starts without these facts.

A fault is

    fault(Outcome, Goal, Where, Address, Hops, Stamp)

Outcome is `failed` or raised(Error).  Goal failed, or raised the error.  Where
is its location: a list of up to two lists of places, the possible places of
the goal and the possible places of its caller.  Address is that of the host,
Hops the number of hops made, and Stamp the time.  A place is at(PI, Place): a
clause of the predicate PI, Place being its File:Line, clause(N) for the N-th
clause of PI if the line is not known, or `state` for a rule of the agent's
state.  All parts are mobile terms.  The first goal of a faulty agent is
'$fault'(Fault): the machine stops there, on any host, until the goal is
removed.

*Threading*: the worker that runs the agent.
*/

:- multifile prolog:error_message//1.

:- setting(typhon_payloads:result_bytes, positive_integer, 1000000,
           "The longest result of an agent, in bytes").

%!  result_put(+Module, +Term) is det.
%
%   Term, which is mobile, replaces the result of the agent.
%
%   @error resource_error(result_bytes)

result_put(Module, Term) :-
    setting(typhon_payloads:result_bytes, Most),
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
    { setting(typhon_payloads:result_bytes, Most) },
    [ 'A result may have ~D bytes at most (setting typhon_payloads:result_bytes)'-
      [Most] ].

                /*******************************
                *            FAULTS            *
                *******************************/

%!  fault_outcome(+Fault, -Outcome) is det.
%
%   Outcome is `failed` or raised(Error).

fault_outcome(fault(Outcome, _, _, _, _, _), Outcome).

%!  fault_error(+Fault, -Error) is det.
%
%   Error is `failed` for a goal that failed.

fault_error(Fault, Error) :-
    fault_outcome(Fault, Outcome),
    (   Outcome = raised(Error0)
    ->  Error = Error0
    ;   Error = failed
    ).

%!  fault_stamp(+Fault, -Stamp:float) is det.

fault_stamp(fault(_, _, _, _, _, Stamp), Stamp).

%!  fault_shown(+Fault, -Shown) is det.
%
%   Shown is fault(Error, Goal, Place, Host), Place being File:Line, PI:N for
%   the N-th clause of PI, or `unknown`.

fault_shown(Fault, fault(Error, Goal, Place, Address)) :-
    fault_error(Fault, Error),
    Fault = fault(_, Goal, Where, Address, _, _),
    place_shown(Where, Place).

place_shown([[at(PI, At)|_]|_], Place) =>
    (   At = clause(N)
    ->  Place = PI:N
    ;   At == state
    ->  Place = PI:state
    ;   Place = At
    ).
place_shown(_, Place) =>
    Place = unknown.

%!  fault_parts(+Fault, -Goal, -Where, -Address, -Hops) is det.

fault_parts(fault(_, Goal, Where, Address, Hops, _), Goal, Where, Address,
            Hops).

%!  is_faulty(?Goals, ?Fault, ?Left) is semidet.
%
%   Goals are the goals of an agent that is faulty: Fault, then Left.

is_faulty(['$fault'(Fault)|Left], Fault, Left).
