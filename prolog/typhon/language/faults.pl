:- module(typhon_fault,
          [ agent_fault/5,              % +Id, +Outcome, +Goals0, -Fault, -Goals
            agent_handled/3,            % +Id, +Goal, -Fault
            printable_fallback/2        % +Term, -Portable
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../kernel/base/error_text', [is_in_itself/1]).
:- use_module('../kernel/base/on_demand', [on_demand_load/2]).
:- use_module('../kernel/program', [fault/3]).
:- use_module('../kernel/wire', [mobile_term/1]).
:- use_module('../kernel/host', [host/3]).
:- use_module('../kernel/agent', [agent/5, life_hops/2]).

/** <module> Reports of faults of agents

The fault of an agent, see typhon_results, is made when the agent has failed or
raised an error.

*Threading*: agent_fault/5 in the worker that ran the agent.
*/

:- multifile
    typhon_on_demand:joins/2,
    fault_location/4,           % +Hash, +Module, +Fault, -Where
    handled/5,                  % +Hash, +Module, +Goal, +Fault, -Where: of a
                                % Goal that no clause of the program called
    advice/3.                   % +PI, +Hash, -Text: suggests names in place of
                                % PI, a predicate that does not exist

typhon_on_demand:joins(fault, report).

%!  agent_fault(+Id, +Outcome, +Goals0, -Fault, -Goals) is semidet.
%
%   The machine has run Goals0 of Id with that Outcome, `failed` or
%   raised(Error): Goals are the goals that are left, from the faulty one on.
%   Fails if the agent no longer exists.

agent_fault(Id, Outcome0, Goals0,
            fault(Outcome, Goal, Where, Address, Hops, Stamp), Goals) :-
    agent(Id, Host, Module, Hash, Life),
    host(Host, Address, _),
    !,
    fault(Outcome0, Goals0, Fault),
    Fault = fault(Goal0, Left, _),
    can_be_kept(Left, Goals),
    where(Hash, Module, Fault, Where),
    advised(Outcome0, Module, Hash, Outcome1),
    printable_fallback(Outcome1-Goal0, Outcome-Goal),
    life_hops(Life, Hops),
    get_time(Stamp).

%   advised(+Outcome0, +Module, +Hash, -Outcome): add a suggestion of other
%   names to the context of an error that a procedure does not exist.

advised(raised(error(existence_error(procedure, Module:PI), Context0)),
        Module, Hash,
        raised(error(existence_error(procedure, Module:PI),
                     context(In, Text)))) :-
    ground(PI),
    PI = _/_,
    !,
    ( subsumes_term(context(_, _), Context0) -> Context0 = context(In, _)
    ; true
    ),
    on_demand_load(program, read),
    once(advice(PI, Hash, Text)).
advised(Outcome, _, _, Outcome).

%   Goals are stored in clauses, and a clause cannot hold a cyclic term.

can_be_kept(Goals, Goals) :-
    acyclic_term(Goals),
    !.
can_be_kept(Goals0, Goals) :-
    printable_fallback(Goals0, Goals).

%!  agent_handled(+Id, +Goal, -Fault) is semidet.
%
%   Goal, which no clause of the program calls, has just failed in Id.  Fails if
%   there is no clause for it.

agent_handled(Id, Goal0, fault(failed, Goal, Where, Address, Hops, Stamp)) :-
    agent(Id, Host, Module, Hash, Life),
    host(Host, Address, _),
    !,
    fault(failed, [Goal0], Fault),
    Fault = fault(Goal1, _, _),
    on_demand_load(fault, location),
    handled(Hash, Module, Goal0, Fault, Where),
    printable_fallback(Goal1, Goal),
    life_hops(Life, Hops),
    get_time(Stamp).

%   An error while the location is looked up must not cost the agent: the
%   location is reported as unknown.

where(Hash, Module, Fault, Where) :-
    on_demand_load(fault, location),
    catch(fault_location(Hash, Module, Fault, Where0), error(Formal, _),
          debug(typhon(agent), 'place unknown: ~p', [Formal])),
    !,
    ( var(Where0) -> Where = [] ; Where = Where0 ).
where(_, _, _, []).

                /*******************************
                *      PRINTABLE FALLBACK      *
                *******************************/

%!  printable_fallback(+Term, -Portable) is det.
%
%   Portable is Term, with an atom in place of each part that cannot travel.  So
%   an error or a goal keeps its form, and the atom describes the replaced part.

printable_fallback(Term, Portable) :-
    catch(mobile_term(Term), error(_, _), fail),
    !,
    Portable = Term.
printable_fallback(Term, 'a cyclic term') :-
    is_in_itself(Term),
    !.
printable_fallback(Term, Words) :-
    attvar(Term),
    !,
    copy_term(Term, _, Goals),
    attributed(Goals, Words).
printable_fallback(Term, Portable) :-
    compound(Term),
    !,
    compound_name_arguments(Term, Name, Args0),
    maplist(printable_fallback, Args0, Args),
    compound_name_arguments(Portable, Name, Args).
printable_fallback(Term, Words) :-
    blob(Term, Type),
    format(atom(Words), 'a ~w (~w)', [Type, Term]).

attributed(Goals, Words) :-
    member(Goal0, Goals),
    strip_module(Goal0, _, Goal),
    callable(Goal),
    !,
    functor(Goal, Name, Arity),
    format(atom(Words), 'an attributed variable (~q)', [Name/Arity]).
attributed(_, 'an attributed variable').
