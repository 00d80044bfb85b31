:- module(typhon_guard_calls,
          [ guard_goals/3,              % +Own, +Goals0, -Goals
            guard_called/3,             % +Own, +Goal0, -Goal
            guard_closure/4             % +Own, +Closure, +Extra, -Goal
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(allowed, [allowed/3]).
:- use_module(guard_arguments, [looked_at/4]).
:- use_module(guard_bodies,
              [ extended/3, guard/3, guard_lambda/4, guard_parts/1,
                is_control/1, is_lambda/1, is_own/2 ]).
:- use_module(refusing, [clause_cells/1, must_be_tree/1, refuse/1]).

/** <module> Goals that untrusted agents call

What is known only at run time: the goals with which an agent comes, those that
it makes up, and closures with the arguments with which they are called.

*Threading*: pure, see typhon_guard_bodies.
*/

%!  guard_goals(+Own, +Goals0, -Goals) is det.
%
%   Goals are what an agent is to do.  Own is own(module(Module), Policy) for
%   one that has the program in Module.

guard_goals(Own, Goals0, Goals) :-
    must_be_tree(Goals0),
    count_parts,
    maplist(guard_left(Own), Goals0, Goals).

%   What stands in a suspended list besides goals of the program.

guard_left(_, Goal, Goal) :-
    nonvar(Goal),
    Goal = '$fault'(_),
    !.
guard_left(Own, Goal0, Goal) :-
    guard(Goal0, Own, Goal).

%!  guard_called(+Own, +Goal0, -Goal) is det.
%
%   Goal may be called now.
%
%   @error instantiation_error
%   @error permission_error(call, sandboxed, Culprit)

guard_called(Own, Goal0, Goal) :-
    (   var(Goal0)
    ->  throw(error(instantiation_error, _))
    ;   acyclic_term(Goal0)
    ->  count_parts,
        guard_now(Goal0, Own, Goal)
    ;   refuse_cyclic(Goal0)
    ).

%   A small term may be a goal without end where it shares much.

count_parts :-
    clause_cells(Max),
    guard_parts(Max).

guard_now(Goal, Own, Goal) :-
    is_control(Goal),
    \+ is_own(Goal, Own),
    !.
guard_now(Goal0, Own, Goal) :-
    plain(Goal0, Own),
    Own = own(_, Policy),
    allowed(Policy, Goal0, look(Kind)),
    !,
    looked_at(Kind, Policy, Goal0, Goal).
guard_now(Goal0, Own, Goal) :-
    guard(Goal0, Own, Goal).

%   plain(+Goal, +Own): Goal is no construct, and not the agent's own.

plain(Goal, Own) :-
    callable(Goal),
    \+ is_own(Goal, Own).

refuse_cyclic(Goal) :-
    functor(Goal, Name, Arity),
    refuse(cyclic(Name/Arity)).

%!  guard_closure(+Own, +Closure, +Extra:list, -Goal) is det.
%
%   Goal is Closure called with Extra.  Of a lambda expression the body is
%   guarded, for its parameters may be goals.

guard_closure(Own, Closure, Extra, Goal) :-
    (   is_lambda(Closure)
    ->  length(Extra, N),
        count_parts,
        guard_lambda(Closure, N, Own, Closure1),
        extended(Closure1, Extra, Goal)
    ;   extended(Closure, Extra, Goal0),
        guard_called(Own, Goal0, Goal)
    ).

