:- module(typhon_guard_calls,
          [ guard_goals/4,              % +Policy, +Program, +Goals0, -Goals
            guard_call/5                % +Policy, +Module, +Closure, +Extra,
                                        % -Goal
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/error_text', [is_tree/2]).
:- use_module('../../kernel/program', [path_below/1]).
:- use_module('../../kernel/host', [context_now/2, parts/3]).
:- use_module('../../kernel/agent', [agent_code/2]).
:- use_module(allowed, [allowed/3, definable/1, own_name/1]).
:- use_module(constructs, [construct/2]).
:- use_module(guard_bodies,
              [ extended/3, guard/3, guard_lambda/4, guard_parts/1,
                is_control/1, is_lambda/1, is_own/2, is_refused/2 ]).
:- use_module(guard_clauses, [allowed_fact/2, guard_clauses/3]).
:- use_module(guard_limits,
              [ clause_cells/1, harmless_format/1, must_be_tree/1,
                readable_text/1, refuse/1, short_text/1 ]).

/** <module> Goals that untrusted agents call

These checks need facts that exist only at run time: the goals with which an
agent arrives, goals that it constructs, and closures with their arguments.

*Threading*: the thread that runs the agent, or installs it; see
typhon_guard_bodies.
*/

:- setting(ball_cells, positive_integer, 10 000,
           "Parts of a term that an untrusted agent throws, at most").

%!  guard_goals(+Policy, +Program, +Goals0, -Goals) is det.
%
%   Goals are the guarded form of Goals0, the goals that an agent still has to
%   run; its program is in the module Program.

guard_goals(Policy, Program, Goals0, Goals) :-
    must_be_tree(Goals0),
    count_parts,
    maplist(guard_left(own(module(Program), Policy)), Goals0, Goals).

%   A suspended list of goals may hold '$fault'(_) besides goals of the program.

guard_left(_, Goal, Goal) :-
    nonvar(Goal),
    Goal = '$fault'(_),
    !.
guard_left(Own, Goal0, Goal) :-
    guard(Goal0, Own, Goal).

%!  guard_call(+Policy, +Module, +Closure, +Extra:list, -Goal) is det.
%
%   Goal is Closure called with Extra, which the agent in Module may call now.
%   If Module is `none` it calls no predicate of the agent's program.
%
%   @error instantiation_error
%   @error permission_error(call, sandboxed, Culprit)

guard_call(Policy, none, Closure, Extra, Goal) :-
    !,
    checked(Extra, own(none, Policy), Closure, Goal).
guard_call(Policy, Module, Closure, Extra, Goal) :-
    agent_code(Module, Program),
    checked(Extra, own(module(Program), Policy), Closure, Goal0),
    own_only(Goal0, Module, Goal).

%   checked(+Extra, +Own, +Closure, -Goal): the body of a lambda expression is
%   guarded because its parameters may be goals.

checked([], Own, Goal0, Goal) :-
    !,
    guard_called(Own, Goal0, Goal).
checked(Extra, Own, Closure, Goal) :-
    is_lambda(Closure),
    !,
    length(Extra, N),
    count_parts,
    guard_lambda(Closure, N, Own, Closure1),
    extended(Closure1, Extra, Goal).
checked(Extra, Own, Closure, Goal) :-
    extended(Closure, Extra, Goal0),
    guard_called(Own, Goal0, Goal).

%   guard_called(+Own, +Goal0, -Goal): Goal may be called now.

guard_called(Own, Goal0, Goal) :-
    (   var(Goal0)
    ->  throw(error(instantiation_error, _))
    ;   acyclic_term(Goal0)
    ->  guard_now(Goal0, Own, Goal)
    ;   refuse_cyclic(Goal0)
    ).

%   A small term with many shared subterms may expand to a huge goal.

count_parts :-
    clause_cells(Max),
    guard_parts(Max).

guard_now(Goal0, Own, Goal) :-
    \+ is_own(Goal0, Own),
    \+ is_refused(Goal0, Own),
    guard_last(Goal0, Own, Goal),
    !.
guard_now(Goal0, Own, Goal) :-
    count_parts,
    guard(Goal0, Own, Goal).

%   guard_last(+Goal0, +Own, -Goal) is semidet: Goal0 runs no other goals.

guard_last(Goal, _, Goal) :-
    is_control(Goal),
    !.
guard_last(Goal0, own(_, Policy), Goal) :-
    \+ construct(Goal0, _),
    allowed(Policy, Goal0, How),
    looked_at(How, Policy, Goal0, Goal).

looked_at(free, _, Goal, Goal).
looked_at(look(Kind), Policy, Goal0, Goal) :-
    check_arguments(Kind, Policy, Goal0, Goal).

refuse_cyclic(Goal) :-
    functor(Goal, Name, Arity),
    refuse(cyclic(Name/Arity)).

%   own_only(+Goal0, +Module, -Goal): an agent may change and read its own
%   state, not the predicates of a place or the clauses of its program.

own_only(Goal0, Module, Goal) :-
    accesses_state(Goal0, Head),
    !,
    ( adds(Goal0, Clause) -> adding(Module, Clause) ; true ),
    (   '$c_current_predicate'(_, Module:Head)
    ->  (   '$get_predicate_attribute'(Module:Head, imported, _)
        ->  permission_error(call, sandboxed, Goal0)
        ;   Goal = Goal0
        )
    ;   Goal0 = clause(_, _)
    ->  Goal = fail
    ;   Goal = Goal0
    ).
own_only(Goal, _, Goal).

accesses_state(Goal, Head) :- adds(Goal, Clause), clause_of(Clause, Head).
accesses_state(retract(Clause), Head) :- clause_of(Clause, Head).
accesses_state(retractall(Head), Head).
accesses_state(clause(Head, _), Head).

adds(assert(Clause), Clause).
adds(asserta(Clause), Clause).
adds(assertz(Clause), Clause).

clause_of((Head:-_), Head) :- !.
clause_of(Head, Head).

%   adding(+Module, +Clause): tell options of the host, such as quotas, that the
%   agent adds Clause to its state.

adding(Module, Clause) :-
    (   context_now(Host, Agent),
        Agent \== none,
        parts(adds_clause, Host, Closures)
    ->  forall(member(Closure, Closures), call(Closure, Module, Clause))
    ;   true
    ).

                /*******************************
                *          ARGUMENTS           *
                *******************************/

%   check_arguments(+Kind, +Policy, +Goal0, -Goal): check the arguments of a
%   goal, now that they are known: clauses to add or remove, balls to throw, and
%   texts. Kind is as of allowed/3.
%
%   @error permission_error(call, sandboxed, Culprit)

check_arguments(clause, _, Goal, Goal) :-
    arg(1, Goal, Fact),
    clause_cells(Max),
    allowed_fact(Fact, Max),
    !.
check_arguments(clause, Policy, Goal0, Goal) :-
    Goal0 =.. [Name,Clause0],
    must_be_tree(Clause0),
    nonvar(Clause0),
    \+ ( Clause0 = (Head:-_), \+ callable(Head) ),
    !,
    guard_clauses(Policy, [Clause0], [Clause]),
    Goal =.. [Name,Clause].
check_arguments(pattern, _, Goal, Goal) :-
    Goal = retract(Clause),
    nonvar(Clause),
    ( Clause = (Head:-_) -> true ; Head = Clause ),
    unqualified(Head),
    !.
check_arguments(head, _, Goal, Goal) :-
    arg(1, Goal, Head),
    unqualified(Head),
    own_name(Head),
    !.
check_arguments(ball, _, throw(Ball), throw(Ball)) :-
    nonvar(Ball),
    \+ ends_thread(Ball),
    setting(ball_cells, Max),
    is_tree(Ball, Max),
    !.
check_arguments(format, _, Goal, Goal) :-
    Goal = format(Sink, Format, Args),
    nonvar(Sink),
    sink(Sink),
    must_be_tree(Format-Args),
    harmless_format(Format),
    !.
check_arguments(text, _, Goal, Goal) :-
    short_text(Goal),
    !.
check_arguments(term_text, _, Goal, Goal) :-
    must_be_tree(Goal),
    readable_text(Goal),
    !.
check_arguments(size(I), _, Goal, Goal) :-
    arg(I, Goal, Size),
    \+ too_many(Size),
    !.
check_arguments(payload, _, attach(Spec), attach(Spec)) :-
    nonvar(Spec),
    Spec = payloads(Path),
    path_below(Path),
    !.
check_arguments(_, _, Goal, _) :-
    refuse(Goal).

unqualified(Head) :-
    callable(Head),
    definable(Head).

%   SWI-Prolog crashes if the size of a term overflows.

too_many(Size) :-
    integer(Size),
    Size > 100 000 000.

%   Balls that end a thread, or stop a measurement.

ends_thread('$aborted').
ends_thread(unwind(_)).
ends_thread(inference_limit_exceeded(_)).
ends_thread(depth_limit_exceeded).
ends_thread(time_limit_exceeded).
ends_thread(time_limit_exceeded(_)).

sink(string(_)).
sink(codes(_)).
sink(chars(_)).
