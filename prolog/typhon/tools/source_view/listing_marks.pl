:- module(typhon_listing_marks,
          [ stands_in/3                 % +Clauses, +Goals, -Places
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [append/3, member/2, nth1/3]).
:- use_module('../../kernel/program',
              [body_goals/4, clause_parts/3, control/1, plain_goals/2]).

/** <module> In which clause an agent stands

The goals that an agent has left do not say which clauses they came from.  But
those at the front are the end of the body of the clause in which it stands,
which can be found again.

*Threading*: pure.
*/

%!  stands_in(+Clauses, +Goals, -Places:list) is det.
%
%   Places are N-I: the goals that are left go on with the I-th goal of the
%   N-th clause.  There are several where clauses end alike, and none where no
%   clause does, as with what was called by call/1.

stands_in(Clauses, Goals, Places) :-
    (   found(Clauses, Goals, near, Places0)
    ->  Places = Places0
    ;   inner(Goals, Inner),
        stands_in(Clauses, Inner, Places0),
        Places0 \== []
    ->  Places = Places0
    ;   found(Clauses, Goals, far, Places0)
    ->  Places = Places0
    ;   Places = []
    ).

%   found(+Clauses, +Goals, +How, -Places): How is `near` if the agent stands
%   at one of the Places itself, `far` if in something called from a condition,
%   or from what is caught, there.

found(Clauses, Goals, How, Places) :-
    findall(Length-(N-I), ends_so(Goals, Clauses, How, N, I, Length), Found),
    aggregate_all(max(Length), member(Length-_, Found), Longest),
    findall(Place, member(Longest-Place, Found), Places).

ends_so(Goals, Clauses, How, N, I, Length) :-
    nth1(N, Clauses, Clause),
    clause_parts(Clause, _, Body),
    goals(Body, All),
    append(Before, End, All),
    End = [First|_],
    length(End, Length),
    length(Left, Length),
    append(Left, _, Goals),
    goes_on(Left, First, How, Pattern),
    End = [_|After],
    subsumes_term([Pattern|After], Left),
    length(Before, Done),
    I is Done+1.

%   goes_on(+Left, +First, +How, -Pattern): the first of the goals Left is what
%   First has become.

goes_on([Goal|_], First, How, Pattern) :-
    goes_on_as(Goal, First, How, Pattern).

goes_on_as(Hole, First, _, _) :-
    var(Hole),
    !,
    nonvar(First),
    control(First).
goes_on_as(sleep_until(_), First, _, Pattern) :-
    !,
    subsumes_term(sleep(_), First),
    Pattern = sleep_until(_).
goes_on_as(receive_until(_, _), First, _, Pattern) :-
    !,
    subsumes_term(receive(_, _), First),
    First = receive(Message, _),
    Pattern = receive_until(Message, _).
goes_on_as(receive_until(_, _, _), First, _, Pattern) :-
    !,
    subsumes_term(receive(_, _), First),
    First = receive(Message, _),
    Pattern = receive_until(Message, _, _).
goes_on_as(Goal, First, How, Pattern) :-
    begins(Goal, Now, _),
    nonvar(First),
    begins(First, Before, Pattern0),
    goals(Now, Left),
    goals(Before, All),
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
goes_on_as(_, First, _, First).

%   inner(+Goals, -Inner): in the middle of a condition, or of what is caught.

inner([Goal|_], Inner) :-
    nonvar(Goal),
    begins(Goal, Body, _),
    goals(Body, Inner).

%   begins(+Goal, -Body, -Pattern): Goal begins with Body; Pattern is what it
%   is like when it has begun.

begins((If->Then;Else), If, (_->Then;Else)).
begins((If*->Then;Else), If, (_*->Then;Else)).
begins((If->Then), If, (_->Then)).
begins((If*->Then), If, (_*->Then)).
begins(catch(Goal, Catcher, Recovery), Goal, catch(_, Catcher, Recovery)).

goals(Body, Goals) :-
    body_goals(Body, _, Marked, []),
    plain_goals(Marked, Goals).
