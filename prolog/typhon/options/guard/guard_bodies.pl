:- module(typhon_guard_bodies,
          [ guard/3,                    % +Body0, +Own, -Body
            guard_parts/1,              % +Most
            guard_lambda/4,             % +Lambda0, +N, +Own, -Lambda
            is_lambda/1,                % @Closure
            is_own/2,                   % +Goal, +Own
            is_refused/2,               % @Goal, +Own
            is_control/1,               % @Goal
            extended/3                  % +Closure, +Extra, -Goal
          ]).
:- use_module(library(apply), [maplist/3, maplist/4]).
:- use_module(library(assoc), [get_assoc/3]).
:- use_module(library(lists), [append/3]).
:- use_module('../../kernel/program', [control_of_system/1, control_use/2]).
:- use_module(allowed, [allowed/3, definable/1, own_name/1, refuses/2]).
:- use_module(constructs, [construct/2]).
:- use_module(guard_limits, [refuse/1]).

/** <module> The goals in clauses of untrusted agents

See typhon_guard_clauses.  Own is own(Heads, Policy).  Heads names the static
predicates of the agent: heads(Assoc), module(Module), or `none`.

The goal that will run is a copy of the goal that is checked here: each
construct, closure and lambda expression in Body is a new term, to which the
agent has no reference by which it could change it afterwards.  Only data are
shared.

*Threading*: pure, but for a global variable of the thread, in which parts are
counted.
*/

%!  guard_parts(+Most) is det.
%
%   Limit the next term that this thread guards to Most goals.  A shared goal
%   counts at each of its occurrences.

guard_parts(Most) :-
    nb_setval(typhon_guard_parts, Most).

part_counted :-
    nb_getval(typhon_guard_parts, Left0),
    Left is Left0-1,
    nb_setval(typhon_guard_parts, Left),
    (   Left >= 0
    ->  true
    ;   throw(error(resource_error(clause_cells), _))
    ).

%!  guard(+Body0, +Own, -Body) is det.
%
%   Body is the guarded form of Body0.
%
%   @error permission_error(call, sandboxed, Culprit)
%   @error resource_error(clause_cells), see guard_parts/1

guard(Body0, Own, Body) :-
    part_counted,
    guarded(Body0, Own, Body).

guarded(Goal, _, '$checked'(Goal)) :-
    var(Goal),
    !.
guarded(Goal, Own, _) :-
    is_refused(Goal, Own),
    !,
    refuse(Goal).
guarded(Goal0, Own, Goal) :-
    construct(Goal0, How),
    !,
    guard_construct(How, Goal0, Own, Goal).
guarded(Goal, _, Goal) :-
    passes(Goal),
    !.
guarded(Goal, Own, Goal) :-
    is_own(Goal, Own),
    !.
guarded(sleep(Seconds), _, '$checked'(sleep(Seconds))) :-
    !.
guarded(Goal0, Own, Goal) :-
    Own = own(_, Policy),
    allowed(Policy, Goal0, How),
    !,
    guard_allowed(How, Goal0, Own, Goal).
guarded(phrase(NT, List), Own, Goal) :-
    !,
    guarded(phrase(NT, List, []), Own, Goal).
guarded(phrase(NT, List, Rest), Own, Goal) :-
    is_non_terminal(NT),
    !,
    guarded(call(NT, List, Rest), Own, Goal).
guarded(Goal, _, Goal) :-
    callable(Goal),
    unknown(Goal),
    !.
guarded(Goal, _, _) :-
    refuse(Goal).

%   phrase/2,3 would run a grammar body, call/N only a non-terminal.

is_non_terminal(NT) :-
    callable(NT),
    definable(NT),
    NT \= {_},
    \+ is_list(NT).

guard_construct(plain, Goal, _, Goal).
guard_construct(parts(Parts0, Goal, Parts), _, Own, Goal) :-
    maplist(guard_part(Own), Parts0, Parts).
guard_construct(catch, catch(Goal0, Ball, Recovery0), Own,
                catch(Goal, Ball, Recovery)) :-
    guard(Goal0, Own, Goal),
    guard_recovery(Recovery0, Ball, Own, Recovery).
guard_construct(closure, Goal0, Own, Goal) :-
    compound_name_arguments(Goal0, call, [Closure0|Extra]),
    length(Extra, N),
    closure(N, Own, Closure0, Closure),
    compound_name_arguments(Goal, call, [Closure|Extra]).
guard_construct(refused, Goal, _, _) :-
    refuse(Goal).

%   Without '$uncaught'(Ball) an exception that interrupts the agent would be
%   raised again only after the recovery goal, which need not end.

guard_recovery(Recovery0, Ball, Own, ('$uncaught'(Ball),Recovery)) :-
    (   nonvar(Recovery0),
        Recovery0 = ('$uncaught'(Ball0),Recovery1),
        Ball0 == Ball
    ->  guard(Recovery1, Own, Recovery)
    ;   guard(Recovery0, Own, Recovery)
    ).

guard_part(Own, Part0, Part) :-
    guard(Part0, Own, Part).

%   Goals that are guarded already, the goal at which a suspended agent
%   continues, and the goals that stop an agent, except those that the system
%   would run instead.

passes(Goal) :-
    compound(Goal),
    compound_name_arity(Goal, '$checked', _).
passes('$uncaught'(_)).
passes('$at'(_, Answer)) :-
    ( Answer == fail ; subsumes_term(throw(error(_, _)), Answer) ).
passes(Goal) :-
    is_control(Goal),
    \+ control_of_system(Goal).

%!  is_control(@Goal) is semidet.
%
%   Goal stops the agent, which continues after it in a later turn.

is_control(Goal) :-
    control_use(Goal, Use),
    Use \== kernel.

%   Only the agent itself, or a service of its place, can define a predicate
%   with the name of an unknown goal.

unknown(Goal) :-
    own_name(Goal).

%!  is_refused(@Goal, +Own) is semidet.
%
%   A rule of the policy refuses Goal, and it calls no predicate of the agent.
%   The machine stops at a control predicate, even if the agent has one of that
%   name.

is_refused(Goal, Own) :-
    Own = own(_, Policy),
    Policy \== guarded,                 % has no rules
    refuses(Policy, Goal),
    ( is_control(Goal) -> true ; \+ is_own(Goal, Own) ).

%!  is_own(+Goal, +Own) is semidet.
%
%   Goal calls a static predicate of the agent, which Own names.

is_own(Goal, own(heads(Own), _)) :-
    callable(Goal),
    functor(Goal, Name, Arity),
    get_assoc(Name/Arity, Own, _).
is_own(Goal, own(module(Module), _)) :-
    callable(Goal),
    Goal \= _:_,
    '$c_current_predicate'(_, Module:Goal),
    '$get_predicate_attribute'(Module:Goal, transparent, 1),
    \+ '$get_predicate_attribute'(Module:Goal, imported, _).

guard_allowed(free, Goal, _, Goal).
guard_allowed(look(_), Goal, _, '$checked'(Goal)).
guard_allowed(runs(Spec), Goal0, Own, Goal) :-
    compound_name_arguments(Goal0, Name, Args0),
    compound_name_arguments(Spec, _, Modes),
    maplist(argument(Own), Modes, Args0, Args),
    compound_name_arguments(Goal, Name, Args).

argument(Own, 0, Goal0, Goal) =>
    below_variables(Goal0, Own, Goal).
argument(Own, ^, Goal0, Goal) =>
    below_variables(Goal0, Own, Goal).
argument(Own, N, Closure0, Closure), integer(N) =>
    closure(N, Own, Closure0, Closure).
argument(_, _, Arg0, Arg) =>
    Arg = Arg0.

%   Some predicates call the goal below V^Goal, whatever their specification
%   says, and whatever ^/2 the agent defines.

below_variables(Goal0, Own, Goal) :-
    nonvar(Goal0),
    Goal0 = V^Below0,
    !,
    Goal = V^Below,
    below_variables(Below0, Own, Below).
below_variables(Goal0, Own, Goal) :-
    guard(Goal0, Own, Goal).

%   closure(+N, +Own, +Closure0, -Closure): Closure is called with N more
%   arguments.  A closure whose guarded goal would differ is checked when it is
%   called.

closure(_, _, Closure, '$checked'(Closure)) :-
    var(Closure),
    !.
closure(_, _, Closure, Closure) :-
    passes(Closure),
    !.
closure(N, Own, Closure0, Closure) :-
    is_lambda(Closure0),
    !,
    guard_lambda(Closure0, N, Own, Closure).
closure(N, Own, Closure0, Closure) :-
    callable(Closure0),
    Closure0 \= _:_,
    !,
    length(Extra, N),
    extended(Closure0, Extra, Goal0),
    guard(Goal0, Own, Goal),
    (   Goal == Goal0
    ->  extended(Closure, Extra, Goal)
    ;   Closure = '$checked'(Closure0)
    ).
closure(_, _, Closure, _) :-
    refuse(Closure).

%!  extended(+Closure, +Extra:list, -Goal) is det.
%!  extended(-Closure, +Extra:list, +Goal) is det.
%
%   Goal is Closure called with Extra.

extended(Closure, Extra, Goal) :-
    nonvar(Goal),
    !,
    Goal =.. List,
    append(List0, Extra, List),
    !,
    Closure =.. List0.
extended(Closure, Extra, Goal) :-
    (   callable(Closure),
        Closure \= _:_
    ->  Closure =.. List0,
        append(List0, Extra, List),
        Goal =.. List
    ;   refuse(Closure)
    ).

%!  is_lambda(@Closure) is semidet.
%!  guard_lambda(+Lambda0, +N, +Own, -Lambda) is det.
%
%   Lambda is Lambda0 with a guarded body, for calls with N arguments.  The body
%   is guarded because arguments may become goals in it.

is_lambda(Closure) :-
    nonvar(Closure),
    ( Closure = _>>_ ; Closure = _/_ ),
    !.

guard_lambda(Free/Lambda0, N, Own, Free/Lambda) :-
    !,
    closure(N, Own, Lambda0, Lambda).
guard_lambda(Parameters0>>Body0, N, Own, Parameters>>Body) :-
    parameters(Parameters0, Parameters, Count),
    !,
    Rest is max(0, N-Count),
    (   Rest =:= 0
    ->  guard(Body0, Own, Body)
    ;   closure(Rest, Own, Body0, Body)
    ).
guard_lambda(Lambda, _, _, _) :-
    refuse(Lambda).

%   parameters(+Parameters0, -Parameters, -Count): Count parameters are bound by
%   the first arguments; the body is called with the others.

parameters(Parameters0, Parameters, Count) :-
    nonvar(Parameters0),
    (   Parameters0 = Free/List0
    ->  Parameters = Free/List
    ;   List0 = Parameters0,
        List = Parameters
    ),
    is_list(List0),
    length(List0, Count),
    append(List0, [], List).
