:- module(typhon_fault,
          [ agent_fault/5,              % +Id, +Outcome, +Goals0, -Fault, -Goals
            agent_handled/3,            % +Id, +Goal, -Fault
            fault_outcome/2,            % +Fault, -Outcome
            fault_error/2,              % +Fault, -Error
            fault_stamp/2,              % +Fault, -Stamp
            fault_shown/2,              % +Fault, -Shown
            fault_parts/5,              % +Fault, -Goal, -Where, -Address,
                                        % -Hops
            is_faulty/3,                % ?Goals, ?Fault, ?Left
            printable_fallback/2        % +Term, -Portable
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [is_in_itself/1]).
:- use_module('../wire', [mobile_term/1]).
:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module('../program', [fault/3]).
:- use_module('../host', [host/3]).
:- use_module(agents, [agent/5, life_hops/2]).

/** <module> Faults of agents

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

*Threading*: agent_fault/5 in the worker that ran the agent.
*/

:- multifile
    fault_location/4,           % +Hash, +Module, +Fault, -Where
    handled/5,                  % +Hash, +Module, +Goal, +Fault, -Where: of a
                                % Goal that no clause of the program called
    advice/3.                   % +PI, +Hash, -Text: suggests names in place of
                                % PI, a predicate that does not exist

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
