:- module(typhon_bodies,
          [ body_goals/4,               % +Body, ?Barrier, -Goals, ?Rest
            plain_goal/2,               % +Goal0, -Goal
            goals_body/2,               % +Goals, -Body
            clause_parts/3,             % +Clause, -Head, -Body
            indicator_in/2,             % +PIs, ?PI
            called_goal/2,              % +Goal, -Called
            control/1,                  % ?Head
            control_use/2,              % ?Head, ?Use
            control_written/2,          % ?Head, -Written
            control_of_system/1,        % ?Head
            special/2,                  % ?Head, ?Kind
            waiting_service/3,          % ?Head, -Begin, -Body
            named/4                     % +Prefix, +Goal, +More, -Named
          ]).
:- use_module(library(lists), [append/3, member/2]).

/** <module> Clause bodies as lists of goals, and back

The machine runs lists of goals; programs consist of clause bodies.  In a list
that is being run, `'$cut'(Barrier)` stands for a cut of the clause from which
the goals come.

*Threading*: pure.
*/

%!  body_goals(+Body, ?Barrier, -Goals, ?Rest) is det.
%
%   Goals is the clause body Body as a list that ends in Rest.  Cuts that
%   belong to the clause become '$cut'(Barrier).

body_goals(Body, _, [Body|Rest], Rest) :-
    var(Body),
    !.
body_goals((A,B), Barrier, Goals, Rest) :-
    !,
    body_goals(A, Barrier, Goals, Goals1),
    body_goals(B, Barrier, Goals1, Rest).
body_goals(true, _, Rest, Rest) :-
    !.
body_goals(Body, Barrier, [Goal|Rest], Rest) :-
    mark_cuts(Body, '$cut'(Barrier), Goal).

%   mark_cuts(+Body0, +Mark, -Body): replace the cuts of the clause.

mark_cuts(Body, _, Body) :-
    var(Body),
    !.
mark_cuts(!, Mark, Mark) :-
    !.
mark_cuts((A0,B0), Mark, (A,B)) :-
    !,
    mark_cuts(A0, Mark, A),
    mark_cuts(B0, Mark, B).
mark_cuts((A0;B0), Mark, (A;B)) :-
    !,
    mark_cuts(A0, Mark, A),
    mark_cuts(B0, Mark, B).
mark_cuts((If->A0), Mark, (If->A)) :-
    !,
    mark_cuts(A0, Mark, A).
mark_cuts((If*->A0), Mark, (If*->A)) :-
    !,
    mark_cuts(A0, Mark, A).
mark_cuts(Body, _, Body).

%!  plain_goal(+Goal0, -Goal) is det.
%
%   Replace `'$cut'(_)`, which only goals that are being run have, by `!`.

plain_goal(Goal, Goal) :-
    var(Goal),
    !.
plain_goal('$cut'(_), !) :-
    !.
plain_goal((A0,B0), (A,B)) :-
    !,
    plain_goal(A0, A),
    plain_goal(B0, B).
plain_goal((A0;B0), (A;B)) :-
    !,
    plain_goal(A0, A),
    plain_goal(B0, B).
plain_goal((A0->B0), (A->B)) :-
    !,
    plain_goal(A0, A),
    plain_goal(B0, B).
plain_goal((A0*->B0), (A*->B)) :-
    !,
    plain_goal(A0, A),
    plain_goal(B0, B).
plain_goal(catch(A0,C,R), catch(A,C,R)) :-
    !,
    plain_goal(A0, A).
plain_goal(Goal, Goal).

%!  goals_body(+Goals, -Body) is det.
%
%   The inverse of body_goals/4, for Goals without cuts.

goals_body([], true).
goals_body([Goal|Goals], Body) :-
    (   Goals == []
    ->  Body = Goal
    ;   Body = (Goal,Rest),
        goals_body(Goals, Rest)
    ).

%!  called_goal(+Goal, -Called) is semidet.
%
%   Called is the goal that Goal, call/N with N > 1, calls.  Fails if the
%   closure cannot be called.

called_goal(Goal, Called) :-
    Goal =.. [_,Closure|Extra],
    callable(Closure),
    extend(Closure, Extra, Called).

extend(Module:Closure, Extra, Module:Called) :-
    !,
    extend(Closure, Extra, Called).
extend(Closure, Extra, Called) :-
    Closure =.. List0,
    append(List0, Extra, List),
    Called =.. List.

%!  named(+Prefix, +Goal, +More, -Named) is det.
%
%   Named has the name of Goal with Prefix, and More arguments.

named(Prefix, Goal, More, Named) :-
    Goal =.. [Name|Args],
    atom_concat(Prefix, Name, NewName),
    append(Args, More, NewArgs),
    Named =.. [NewName|NewArgs].

                /*******************************
                *           CONTROL            *
                *******************************/

%!  control(?Head) is nondet.
%
%   Head is the head of a control predicate: the machine stops at it.

control(Head) :-
    special(Head, control).

%!  control_use(?Head, ?Use) is nondet.
%
%   The control predicates.  Use is
%
%   | called(Det)           | programs call it; Det is `det` or `semidet`      |
%   | waits(Written, Until) | Written becomes it while the agent waits, until  |
%   |                       | the host time Until                              |
%   | restored(Written)     | the same, in old restore points                  |
%   | kernel                | the kernel alone makes it                        |

control_use(move(_), called(det)).
control_use(move(_, _), called(det)).
control_use(clone(_), called(det)).
control_use(clone(_, _), called(det)).
control_use(sleep(_), called(det)).
control_use(receive(_), called(det)).
control_use(receive(_, _), called(semidet)).
control_use(dispose, called(det)).
control_use(sleep_until(Until), waits(sleep(_), Until)).
control_use(receive_until(Message, Until, _),
            waits(receive(Message, _), Until)).
control_use(receive_until(Message, _), restored(receive(Message, _))).
control_use('$fault'(_), kernel).       % stays in place: see typhon_ending

%!  control_written(?Head, -Written) is nondet.
%
%   Head is the form that Written, a control predicate, has while the agent
%   waits.

control_written(Head, Written) :-
    control_use(Head, Use),
    ( Use = waits(Written, _) ; Use = restored(Written) ).

%!  control_of_system(?Head) is nondet.
%
%   Prolog has a predicate of this name, too, which occupies the thread.

control_of_system(Head) :-
    control_use(Head, called(_)),
    '$c_current_predicate'(_, system:Head).

%!  waiting_service(?Head, -Begin, -Body) is nondet.
%
%   A predicate of a place runs to its end.  So where a place has Begin, the
%   machine unfolds a goal Head to Body, which begins with Begin and then waits.

waiting_service(ask(Question, Answer), Begin,
                (Begin, receive(people-answer(Number, Given)),
                 Given = given(Answer))) :-
    Begin = person_ask(Question, text, Number).
waiting_service(choose(Question, Choices, Choice), Begin,
                (Begin, receive(people-answer(Number, Given)),
                 Given = given(Choice))) :-
    Begin = person_ask(Question, choice(Choices), Number).

%!  special(?Head, ?Kind) is nondet.
%
%   Kind is `control`, `call` (call/N), or `checked` (see typhon_checked).

term_expansion(specials, Specials) :-
    findall(special(Goal, Kind), special_goal(Kind, Goal), Specials).

special_goal(control, Goal) :-
    control_use(Goal, _).
special_goal(Kind, Goal) :-
    member(Kind-Name, [call-call, checked-'$checked']),
    between(1, 16, Arity),
    functor(Goal, Name, Arity).

specials.

%!  clause_parts(+Clause, -Head, -Body) is det.
%
%   Body is `true` if Clause is a fact.

clause_parts(Var, Var, true) :-
    var(Var),
    !.
clause_parts((Head:-Body), Head, Body) :-
    !.
clause_parts(Head, Head, true).

%!  indicator_in(+PIs, ?PI) is nondet.
%
%   PI is one of PIs, in the form of the argument of dynamic/1.

indicator_in(Var, _) :- var(Var), !, fail.
indicator_in([A|B], PI) :- !, ( indicator_in(A, PI) ; indicator_in(B, PI) ).
indicator_in((A,B), PI) :- !, ( indicator_in(A, PI) ; indicator_in(B, PI) ).
indicator_in(Name/Arity, Name/Arity) :- atom(Name), integer(Arity).
