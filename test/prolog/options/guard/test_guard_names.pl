:- module(test_guard_names, []).
:- use_module('../../../lib/allowed_goals').
:- use_module('../../../lib/common').
:- use_module('../../../lib/compiled_calls').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, member/2, numlist/3]).
:- use_module(library(random), [random_member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/guard), []).

/** <module> What the guard accepts is what the compiled clause calls

Goals of all names that the system and the libraries of agents define, or that
are operators, are guarded and compiled.  Each call in the code must be on the
list of the policy, be checked when it runs, or lead to no predicate at all.

*Threading*: one test at a time.
*/

%   named(-Name): a name that Prolog may treat in its own way.

named(Name) :-
    nameable(Head),
    functor(Head, Name, _).
named(Name) :-
    current_op(_, _, system:Name).
named(Name) :-
    member(Name, [{}, '[|]', dict, '.', call]).

names(Names) :-
    findall(Name, ( named(Name), atom(Name) ), Names0),
    sort(Names0, Names).

%   goal(+Name, -Goal): Goal has up to eight arguments, which are goals, or for
%   what may call them also closures, that an agent must not call.

goal(Name, Goal) :-
    between(0, 8, Arity),
    argument(Name, Arity, Arg),
    filled(Name, Arity, Arg, Goal).

argument(Name, Arity, Arg) :-
    functor(Head, Name, Arity),
    (   calls_arguments(Head)
    ->  member(Arg, [shell(id), shell, halt])
    ;   Arg = shell(id)
    ).

calls_arguments(Head) :-
    (   typhon_bodies:control(Head)
    ;   typhon_allowed:allowed(guarded, Head, runs(_))
    ;   predicate_property(typhon_vocabulary:Head, defined),
        predicate_property(typhon_vocabulary:Head, meta_predicate(_))
    ).

%   filled(+Name, +Arity, +Arg, -Term): each argument of Term is Arg.

filled(Name, Arity, Arg, Term) :-
    length(Args, Arity),
    maplist(=(Arg), Args),
    Term =.. [Name|Args].

                /*******************************
                *           ACCEPTED           *
                *******************************/

%   accepted(+Way, +Goal, -Body): the guard accepts Goal, and Body is what
%   runs.

accepted(Way, Goal, Body) :-
    catch(guarded(Way, Goal, Body0), error(_, _), fail),
    Body = Body0.

guarded(written, Goal, Body) :-
    typhon_guard_clauses:guard_program(
        guarded, program(x, [], [], [(main :- Goal)]),
        program(_, _, _, [(main :- Body)])).
guarded(asserted, Goal, Body) :-
    typhon_guard_calls:guard_call(guarded, none, assertz((p :- Goal)), [],
                                  assertz((p :- Body))).
guarded(called, Goal, Body) :-
    typhon_guard_calls:guard_call(guarded, none, Goal, [], Body).

%   unguarded(+Body, -Call): the code of Body has Call, which it must not have.

unguarded(Body, Call) :-
    within(Body, Part),
    \+ Part = '$checked'(_),
    compiled_calls(Part, Calls),
    member(Call, Calls),
    \+ may_call(Call).

%   within(+Body, -Part): Part is a goal of Body, or one that a predicate calls
%   which Body calls.

within(Body, Part) :-
    (   member(Body, [(A,B), (A;B), (A->B), (A*->B)])
    ->  ( within(A, Part) ; within(B, Part) )
    ;   member(Body, [\+Part0, call(Part0)])
    ->  within(Part0, Part)
    ;   compound(Body),
        compound_name_arguments(Body, call, [Closure|Extra])
    ->  closure(Closure, Extra, Part0),
        within(Part0, Part)
    ;   Part = Body
    ).
within(Body, Part) :-
    called_part(Body, Part0),
    within(Part0, Part).

called_part(Body, Part) :-
    callable(Body),
    functor(Body, Name, Arity),
    functor(Head, Name, Arity),
    typhon_allowed:allowed(guarded, Head, runs(Spec)),
    arg(I, Spec, Mode),
    arg(I, Body, Arg),
    (   integer(Mode), Mode > 0
    ->  length(Extra, Mode),
        closure(Arg, Extra, Part)
    ;   memberchk(Mode, [0,^])
    ->  below(Arg, Part)
    ;   fail
    ).

below(Arg, Part) :-
    (   nonvar(Arg),
        Arg = _^Arg1
    ->  below(Arg1, Part)
    ;   Part = Arg
    ).

closure('$checked'(_), _, '$checked'(_)) :-
    !.
closure(_/Lambda, Extra, Goal) :-
    !,
    closure(Lambda, Extra, Goal).
closure([_]>>Body, [_], Body) :-
    !.
closure(Closure, Extra, Goal) :-
    Closure =.. List0,
    append(List0, Extra, List),
    Goal =.. List.

may_call(Name/Arity) :-
    functor(Head, Name, Arity),
    (   typhon_allowed:allowed(guarded, Head, _)
    ->  true
    ;   memberchk(Name/Arity, [catch/3,once/1,ignore/1])
    ->  true
    ;   typhon_bodies:control(Head)
    ->  true
    ;   memberchk(Name, ['$checked','$uncaught'])
    ->  true
    ;   \+ predicate_property(typhon_vocabulary:Head, visible)
    ).

                /*******************************
                *         META-CALLS           *
                *******************************/

%   around(+Goal, -Whole): Whole calls Goal.

around(Goal, Whole) :-
    allowed_goal(_, runs(Spec)),
    Spec =.. [Name|Modes],
    append(Before, [Mode|After], Modes),
    ( Mode == 0 ; Mode == (^) ; integer(Mode), Mode > 0 ),
    (   integer(Mode), Mode > 0
    ->  length(Extra, Mode),
        callable(Goal),
        Goal =.. List,
        append(List0, Extra, List),
        List0 = [_|_],
        Arg =.. List0
    ;   Arg = Goal
    ),
    other_modes(Before, Before1),
    other_modes(After, After1),
    append(Before1, [Arg|After1], Args),
    Whole =.. [Name|Args].
around(Goal, Whole) :-
    member(Whole, [ (true,Goal), (Goal,true), (Goal;true), (true;Goal),
                    (Goal->true), (true->Goal;true), (Goal*->true;true),
                    (true*->Goal), \+ Goal, call(Goal), once(Goal),
                    ignore(Goal), catch(Goal, _, true), catch(true, _, Goal),
                    maplist([_]>>Goal, [1]), maplist(/(_, [_]>>Goal), [1]),
                    findall(x, (true;Goal), _) ]).
around(Goal, Whole) :-
    callable(Goal),
    Goal =.. List,
    append(List0, Extra, List),
    List0 = [_|_],
    Extra = [_|_],
    Closure =.. List0,
    Whole =.. [call,Closure|Extra].

other_modes([], []).
other_modes([Mode|Modes], [Arg|Args]) :-
    ( memberchk(Mode, [?,-,+]) -> Arg = [] ; Arg = true ),
    other_modes(Modes, Args).

%   suspects(-Names): names that are no words, and some others.

suspects(Names) :-
    names(All),
    findall(Name, ( member(Name, All), \+ is_word(Name) ), Names0),
    numlist(1, 30, Numbers),
    findall(Name, ( member(_, Numbers), random_member(Name, All) ),
            Names1),
    append(Names0, [call,not,phrase|Names1], Names2),
    sort(Names2, Names).

%   arity(+Name, -Arity): names with $ are those of predicates of the system.

arity(Name, Arity) :-
    (   sub_atom(Name, 0, 1, After, $),
        After > 0
    ->  current_predicate(Name, system:Head),
        functor(Head, _, Arity)
    ;   member(Arity, [0,1,2,3,5])
    ).

is_word(Name) :-
    sub_atom(Name, 0, 1, _, Char),
    char_type(Char, csymf).

                /*******************************
                *         OWN NAMES            *
                *******************************/

%   own(+Kind, +Head): the guard accepts that an agent has a predicate with
%   this head, and SWI-Prolog lets it.

own(Kind, Head) :-
    functor(Head, Name, Arity),
    catch(own_program(Kind, Head, Name/Arity), error(_, _), fail),
    Module = 'test own names',
    catch(assertz(Module:Head), error(_, _), fail),
    abolish(Module:Name/Arity).

own_program(static, Head, _) :-
    typhon_guard_clauses:guard_program(
        guarded, program(x, [], [], [Head,(main :- Head)]),
        program(_, _, _, [_,(main :- Body)])),
    Body == Head.
own_program(state, _, PI) :-
    typhon_guard_clauses:guard_program(guarded, program(x, [PI], [], []), _).

head(Name, Head) :-
    between(0, 8, Arity),
    filled(Name, Arity, a, Head).

:- begin_tests(guard_names).

test(compiled_code_calls_what_was_checked,
     [forall(member(Way, [written,asserted,called])), true(Found == [])]) :-
    names(Names),
    findall(Goal-Call,
            ( member(Name, Names),
              goal(Name, Goal),
              accepted(Way, Goal, Body),
              unguarded(Body, Call) ),
            Found).
test(arguments_of_meta_predicates_are_what_was_checked,
     [forall(member(Way, [written,called])), true(Found == [])]) :-
    suspects(Names),
    findall(Whole-Call,
            ( member(Name, Names),
              arity(Name, Arity),
              filled(Name, Arity, shell(id), Goal),
              around(Goal, Whole),
              accepted(Way, Whole, Body),
              unguarded(Body, Call) ),
            Found).
test(goal_with_a_name_of_an_agent_calls_its_predicate,
     [forall(member(Kind, [static,state])), true(Found == [])]) :-
    names(Names),
    findall(Head-Calls,
            ( member(Name, Names),
              head(Name, Head),
              own(Kind, Head),
              compiled_calls(Head, Calls),
              functor(Head, Name, Arity),
              Calls \== [Name/Arity] ),
            Found).

:- end_tests(guard_names).
