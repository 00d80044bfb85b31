:- module(typhon_variable_names,
          [ clause_bindings/3,          % +Clause, +Names, -Bindings
            goals_bindings/4,           % +Clauses, +Lists, +Goals, -Bindings
            name_goal/4,                % +Clauses, +Lists, +Goal, -Named
            goals_places/3              % +Clauses, +Goals, -Places
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, nth1/3]).
:- use_module('../../kernel/program', [clause_parts/3, control/1, control_written/2]).
:- use_module(clause_location, [body_list/2, point/3]).

/** <module> The clauses of remaining goals, and the names of their variables

Clauses and goals of agents are terms.  The names of the variables of a clause
are stored with its place, see typhon_code; those of remaining goals follow
from the clauses from which the goals come.

Bindings are Name=Variable, as of read_term/2.

The remaining goals of an agent do not record their clauses.  But the first
goals are the end of the body of the clause that the agent runs, so this clause
can be found.

*Threading*: pure.
*/

%!  clause_bindings(+Clause, +Names, -Bindings) is det.
%
%   Names are the names of the variables of Clause, or [].

clause_bindings(Clause, Names, Bindings) :-
    term_variables(Clause, Variables),
    findall(Name-I, ( nth1(I, Names, Name), Name \== '_' ), Known),
    maplist(named_nth(Variables), Known, Bindings).

named_nth(Variables, Name-I, Name=Variable) :-
    nth1(I, Variables, Variable).

%!  goals_bindings(+Clauses, +Lists, +Goals, -Bindings) is det.
%
%   Bindings are the names of variables of Goals, the remaining goals of an
%   agent with Clauses.  Lists has the names of variables of the first clauses,
%   one list for each.  If several clauses give the same name to different
%   variables, all but one of these get a number.

goals_bindings(Clauses, Lists, Goals, Bindings) :-
    goals_bindings(Goals, Clauses, Lists, [], Bindings).

goals_bindings([], _, _, Bindings, Bindings) :-
    !.
goals_bindings(Goals, Clauses, Lists, Bindings0, Bindings) :-
    goals_places(Clauses, Goals, [N-I]),
    sequel(N-I, Clauses, Lists, Names, Variables, Sequel),
    append(Sequel0, Rest, Goals),
    length(Sequel, Length),
    length(Sequel0, Length),
    !,
    maplist(instance, Sequel, Sequel0),
    term_variables(Sequel0, Left),
    add_names(Names, Variables, Left, Bindings0, Bindings1),
    goals_bindings(Rest, Clauses, Lists, Bindings1, Bindings).
goals_bindings([_|Goals], Clauses, Lists, Bindings0, Bindings) :-
    goals_bindings(Goals, Clauses, Lists, Bindings0, Bindings).

%   sequel(+Place, +Clauses, +Lists, -Names, -Variables, -Sequel): Sequel is a
%   copy of the rest of a clause, and Variables are the copies of all its
%   variables.

sequel(N-I, Clauses, Lists, Names, Variables, Sequel) :-
    nth1(N, Clauses, Clause),
    ( nth1(N, Lists, Names) -> true ; Names = [] ),
    copy_term_nat(Clause, Copy),
    term_variables(Copy, Variables),
    clause_parts(Copy, _, Body),
    body_list(Body, Goals),
    Done is I-1,
    length(Before, Done),
    append(Before, Sequel, Goals).

%   A goal that has begun to run may have another form than the goal in the
%   clause.

instance(General, Goal) :-
    (   subsumes_term(General, Goal)
    ->  General = Goal
    ;   true
    ).

%   add_names(+Names, +Values, +Left, +Bindings0, -Bindings): add the names of
%   those Values that are among the variables Left.

add_names([Name|Names], [Value|Values], Left, Bindings0, Bindings) :-
    !,
    (   Name \== '_',
        member(Variable, Left),
        Variable == Value,
        \+ ( member(_=Known, Bindings0), Known == Value )
    ->  free_name(Name, 1, Bindings0, Free),
        Bindings1 = [Free=Value|Bindings0]
    ;   Bindings1 = Bindings0
    ),
    add_names(Names, Values, Left, Bindings1, Bindings).
add_names(_, _, _, Bindings, Bindings).

free_name(Name, N, Bindings, Free) :-
    ( N =:= 1 -> Free0 = Name ; atom_concat(Name, N, Free0) ),
    (   memberchk(Free0=_, Bindings)
    ->  N1 is N+1,
        free_name(Name, N1, Bindings, Free)
    ;   Free = Free0
    ).

%!  name_goal(+Clauses, +Lists, +Goal, -Named) is det.
%
%   Named is Goal with '$VAR'(Name) for variables, if all clauses that could
%   have called Goal agree on their names.

name_goal(Clauses, Lists, Goal, Named) :-
    term_variables(Goal, [_|_]),
    findall(Instance,
            ( nth1(N, Lists, [Name|Names]),
              nth1(N, Clauses, Clause),
              called_in(Clause, [Name|Names], Goal, Instance) ),
            Found0),
    sort(Found0, [Named0]),
    !,
    Named = Named0.
name_goal(_, _, Goal, Goal).

called_in(Clause, Names, Goal, Goal) :-
    copy_term_nat(Clause, Copy),
    term_variables(Copy, Variables),
    clause_parts(Copy, _, Body),
    point(Body, [General|_], _),
    nonvar(General),
    subsumes_term(General, Goal),
    General = Goal,
    maplist(show_name, Names, Variables).

show_name('_', _) :-
    !.
show_name(Name, Variable) :-
    ( var(Variable) -> Variable = '$VAR'(Name) ; true ).

                /*******************************
                *        CURRENT CLAUSE        *
                *******************************/

%!  goals_places(+Clauses, +Goals, -Places:list) is det.
%
%   Places are pairs N-I: the remaining goals continue with the I-th goal of the
%   N-th clause.  Several places are possible if clauses end in the same way,
%   and none if no clause ends so, as for a goal that call/1 has called.

goals_places(Clauses, Goals, Places) :-
    (   found(Clauses, Goals, near, Places0)
    ->  Places = Places0
    ;   inner(Goals, Inner),
        goals_places(Clauses, Inner, Places0),
        Places0 \== []
    ->  Places = Places0
    ;   found(Clauses, Goals, far, Places0)
    ->  Places = Places0
    ;   Places = []
    ).

%   found(+Clauses, +Goals, +How, -Places): How is `near` if the agent runs the
%   clause of one of the Places itself, `far` if it runs a goal that a
%   condition, or catch/3, has called there.

found(Clauses, Goals, How, Places) :-
    findall(Length-(N-I), ends_so(Goals, Clauses, How, N, I, Length), Found),
    aggregate_all(max(Length), member(Length-_, Found), Longest),
    findall(Place, member(Longest-Place, Found), Places).

ends_so(Goals, Clauses, How, N, I, Length) :-
    nth1(N, Clauses, Clause),
    clause_parts(Clause, _, Body),
    body_list(Body, All),
    append(Before, End, All),
    End = [First|_],
    length(End, Length),
    length(Left, Length),
    append(Left, _, Goals),
    current_form(Left, First, How, Pattern),
    End = [_|After],
    subsumes_term([Pattern|After], Left),
    length(Before, Done),
    I is Done+1.

%   current_form(+Left, +First, +How, -Pattern): the first of the goals Left is
%   the form that First has at run time.

current_form([Goal|_], First, How, Pattern) :-
    current_form_as(Goal, First, How, Pattern).

current_form_as(Hole, First, _, _) :-
    var(Hole),
    !,
    nonvar(First),
    control(First).
current_form_as(Goal, First, _, Pattern) :-
    control_written(Goal, _),
    !,
    functor(Goal, Name, Arity),
    functor(Pattern, Name, Arity),
    control_written(Pattern, Written),
    subsumes_term(Written, First),
    Written = First.
current_form_as(Goal, First, How, Pattern) :-
    begins(Goal, Now, _),
    nonvar(First),
    begins(First, Before, Pattern0),
    body_list(Now, Left),
    body_list(Before, All),
    \+ subsumes_term(All, Left),
    !,
    (   How == far
    ->  true
    ;   found([(in:-Before)], Left, near, [_-I|_]),
        length(Left, L),
        length(All, N),
        L =:= N-I+1
    ),
    Pattern = Pattern0.
current_form_as(_, First, _, First).

%   inner(+Goals, -Inner): Inner are the goals inside the condition, or the
%   catch/3, with which Goals begins.

inner([Goal|_], Inner) :-
    nonvar(Goal),
    begins(Goal, Body, _),
    body_list(Body, Inner).

%   begins(+Goal, -Body, -Pattern): Goal begins with Body; Pattern is its form
%   after it has begun.

begins((If->Then;Else), If, (_->Then;Else)).
begins((If*->Then;Else), If, (_*->Then;Else)).
begins((If->Then), If, (_->Then)).
begins((If*->Then), If, (_*->Then)).
begins(catch(Goal, Catcher, Recovery), Goal, catch(_, Catcher, Recovery)).
