:- module(typhon_result_facts,
          [ result_put/2,               % +Module, +Term
            cloned_put/2,               % +Module, +Endpoint
            result_facts/2,             % +Module, -Items
            no_result_facts/2,          % +State0, -State
            is_result_fact/1            % @Item
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [resource_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> What an agent will leave when it ends

Facts '$legacy'(Item) among the state of an agent, so they travel with it.
An item is

  - result(Term): the result it has given, the last one
  - cloned(Endpoint): it was cloned in that process

They are its own: a clone begins without.

*Threading*: the worker that has the agent adds; the rest as typhon_agents.
*/

:- multifile prolog:error_message//1.

:- setting(result_bytes, positive_integer, 1000000,
           "The result of an agent is no longer than this").

%!  result_put(+Module, +Term) is det.
%!  cloned_put(+Module, +Endpoint) is det.
%
%   The result is now Term, which can travel; it was cloned at Endpoint.
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

%   There is always one.

put_result(Module, Term) :-
    Module:'$legacy'(result(_)),
    !,
    assertz(Module:'$legacy'(result(Term))),
    once(retract(Module:'$legacy'(result(_)))).
put_result(Module, Term) :-
    assertz(Module:'$legacy'(result(Term))).

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
%   State, as of agent_state/2, is State0 without results.

no_result_facts(state(Empty, Clauses0), state(Empty, Clauses)) :-
    exclude(of_result, Clauses0, Clauses).

of_result('$legacy'(_)).

%!  is_result_fact(@Item) is semidet.

is_result_fact(Item) :-
    subsumes_term(result(_), Item),
    !.
is_result_fact(Item) :-
    subsumes_term(cloned(_), Item),
    arg(1, Item, Endpoint),
    atom(Endpoint).

prolog:error_message(resource_error(result_bytes)) -->
    { setting(result_bytes, Most) },
    [ 'A result may have ~D bytes at most (setting typhon_result_facts:result_bytes)'-
      [Most] ].
