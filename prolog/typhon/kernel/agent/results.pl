:- module(typhon_results,
          [ result_put/2,               % +Module, +Term
            cloned_put/2,               % +Module, +Endpoint
            result_facts/2,             % +Module, -Items
            no_result_facts/2,          % +State0, -State
            is_result_fact/1            % @Item
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [resource_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> Results of agents

Results are facts '$legacy'(Item) in the state of an agent, so they travel with
it.  An item is

  - result(Term): the last result that the agent has given
  - cloned(Endpoint): the agent was cloned in that process

A clone starts without these facts.

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
