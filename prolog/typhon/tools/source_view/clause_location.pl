:- module(typhon_clause_location,
          [ point/3,                    % +Body, -Sequel, -End
            body_list/2                 % +Body, -Goals
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/3, member/2, min_list/2, nth1/3]).
:- use_module('../../kernel/program',
              [ body_goals/4, clause_parts/3, code_compiled/2, code_places/2,
                code_program/2, goals_body/2, place/3, plain_goals/2 ]).

/** <module> The clause from which a goal comes

A goal list does not record the clauses of its goals: such marks would grow with
recursion, and move with the agent.  But a list [Goal|Goals] begins with an
instance of the rest of a clause, followed by the rest of a clause that called
it.  So the clause can be found when it is needed, after a fault.  The machine
takes a clause body apart as it runs it, see typhon_machine, and point/3
enumerates all lists of goals that can remain of a body.

Places are as in typhon_results.

*Threading*: any thread.
*/

:- multifile
    typhon_fault:handled/5,
    typhon_fault:fault_location/4,
    typhon_on_demand:joins/2.

typhon_on_demand:joins(fault, location).

typhon_fault:handled(Hash, Agent, Goal, Fault, Where) :-
    where_handled(Hash, Agent, Goal, Fault, Where).

%   Usually no clause calls main/0.

typhon_fault:fault_location(Hash, Agent, Fault, Where) :-
    Fault = fault(Goal, _, _),
    Goal == main,
    where_handled(Hash, Agent, Goal, Fault, Where),
    !.
typhon_fault:fault_location(Hash, Agent, Fault, Where) :-
    fault_where(Hash, Agent, Fault, Where).

%   fault_where(+Hash, +Agent, +Fault, -Where): Agent is the module of the
%   agent.  Where is [] if more than three places are possible.

fault_where(Hash, Agent, fault(Goal, Goals, Natives), Where) :-
    ignore(code_compiled(Hash, Module)),
    all_clauses(Hash, Agent, All),
    Natives = natives(Raising, References),
    native_places(References, Module, All, Inner0),
    last_called(Inner0, Raising, Goal, All, Inner),
    goal_level(Goal, Goals, Left),
    mobile_places(Inner, All, Left, Found),
    append(Inner, Found, Numbers0),
    first_two(Numbers0, Numbers),
    maplist(maplist(shown(Hash, All)), Numbers, Where).

%   where_handled(+Hash, +Agent, +Goal, +Fault, -Where) is semidet: no clause of
%   the program called Goal, which has failed with Fault.  Fails if no clause
%   has a head for Goal.

where_handled(Hash, Agent, Goal, Fault, Where) :-
    all_clauses(Hash, Agent, All),
    functor(Goal, Name, Arity),
    findall(c(N, Name/Arity), ( member(N-(Head:-_), All), \+ Head \= Goal ),
            Clauses),
    Clauses \== [],
    (   fault_where(Hash, Agent, Fault, Where0),
        Where0 \== []
    ->  Where = Where0
    ;   maplist(shown(Hash, All), Clauses, Places),
        Where = [Places]
    ).

all_clauses(Hash, Agent, All) :-
    code_program(Hash, program(_, _, _, Clauses)),
    numbered(Clauses, 1, Numbered),
    findall(0-Rule, own_rule(Agent, Rule), Own),
    append(Numbered, Own, All).

numbered([], _, []).
numbered([Clause|Clauses], N, [N-(Head:-Body)|Numbered]) :-
    clause_parts(Clause, Head, Body),
    N1 is N+1,
    numbered(Clauses, N1, Numbered).

own_rule(Agent, (Head:-Body)) :-
    '$c_current_predicate'(_, Agent:Head),
    '$get_predicate_attribute'(Agent:Head, number_of_rules, N),
    N > 0,
    '$get_predicate_attribute'(Agent:Head, (dynamic), 1),
    clause(Agent:Head, Body),
    Body \== true.

first_two([A,B|_], [A,B]) :-
    !.
first_two(Few, Few).

%   A clause is c(N, PI): the N-th clause of the program, or, if N is 0, a
%   clause of the agent's state.

shown(_, _, c(0, PI), At) =>
    At = at(PI, state).
shown(Hash, All, c(N, PI), At) =>
    At = at(PI, Place),
    code_places(Hash, Places),
    (   place(Places, N, Place0)
    ->  Place = Place0
    ;   of_predicate(All, PI, Ns),
        nth1(I, Ns, N),
        Place = clause(I)
    ->  true
    ).

%   of_predicate(+All, +PI, -Ns): Ns are the numbers of the clauses of PI.

of_predicate(All, Name/Arity, Ns) :-
    functor(Head, Name, Arity),
    findall(N, ( member(N-(Head:-_), All), N > 0 ), Ns).

                /*******************************
                *        NATIVE CLAUSES        *
                *******************************/

%   native_places(+References, +Module, +All, -Places): of a recursive predicate
%   Places has only the innermost clause.

native_places(References, Module, All, Places) :-
    findall(PI-I, ( member(Reference, References),
                    native_clause(Reference, Module, PI, I)
                  ),
            Pairs),
    once_each(Pairs, none, Places0),
    maplist(native_place(All), Places0, Places).

%   last_called(+Places0, +Raising, +Goal, +All, -Places): a clause whose last
%   goal is Raising has lost its stack frame.  It is the clause that calls
%   Raising, if only one does.

last_called(Places0, Raising, Goal, All, Places) :-
    (   calls_it(Raising, Goal, Places0, All, Clause),
        Places0 \= [[Clause]|_]
    ->  Places = [[Clause]|Places0]
    ;   Places = Places0
    ).

calls_it(Raising, Goal, Places0, All, c(N, Name/Arity)) :-
    callable(Raising),
    Raising \== Goal,
    \+ ( Places0 = [[Inner]|_],
         has_goal(All, Inner, Raising) ),
    findall(Head-N0, has_goal(All, c(N0, Head), Raising), Found),
    sort(2, @<, Found, [Head-N]),
    functor(Head, Name, Arity).

has_goal(All, c(N, Of), Raising) :-
    member(N-(Head:-Body), All),
    of(Of, Head),
    point(Body, [Called|_], _),
    nonvar(Called),
    subsumes_term(Called, Raising).

of(Of, Head) :- var(Of), !, Of = Head.
of(_, _).

native_clause(Reference, Module, PI, I) :-
    catch(( clause_property(Reference, predicate(Home:PI)),
            Home == Module,             % a bound module matches also importers
            nth_clause(_, I, Reference)
          ),
          error(_, _), fail).           % erased

once_each([], _, []).
once_each([PI-I|Pairs], Last, Once) :-
    (   PI == Last
    ->  Once = Once1
    ;   Once = [PI-I|Once1]
    ),
    once_each(Pairs, PI, Once1).

native_place(All, PI-I, [c(N, PI)]) :-
    of_predicate(All, PI, Ns),
    nth1(I, Ns, N),
    !.

                /*******************************
                *        MOBILE CLAUSES        *
                *******************************/

%   mobile_places(+Inner, +All, +Goals, -Places): Places has the clause of the
%   first of Goals, unless Inner has two places already.

mobile_places([_,_|_], _, _, Places) =>
    Places = [].
mobile_places(_, All, Goals0, Places) =>
    goals_normal(Goals0, Goals),
    findall(Left-c(N, PI),
            begins_with_rest(Goals, All, Left, c(N, PI)),
            Found0),
    likely(Found0, All, Found),
    places_of(Found, All, Places).

places_of([Left-Clause], All, Places) =>
    callers(Left, All, Clause, Callers),
    ( Callers = [Caller] -> Places = [[Clause],[Caller]]
    ; Places = [[Clause]]
    ).
places_of(Found, _, Places), Found = [_,_|_] =>
    findall(Clause, member(_-Clause, Found), Clauses0),
    sort(Clauses0, Clauses),
    length(Clauses, Count),
    ( Count =< 3 -> Places = [Clauses] ; Places = [] ).
places_of(_, _, Places) =>
    Places = [].

%   begins_with_rest(+Goals, +All, -Left, -Clause) is nondet: Goals begins with
%   an instance of the rest of Clause from some point on, followed by Left.

begins_with_rest(Goals, All, Left, c(N, Name/Arity)) :-
    member(N-(Head:-Body), All),
    point(Body, Sequel, End),
    after(Sequel, Goals, End, Left),
    functor(Head, Name, Arity).

after(Sequel, Goals, End, Left) :-
    Sequel = [_|_],
    length(Sequel, Count),
    length(Begin, Count),
    append(Begin, Left, Goals),
    subsumes_term(Sequel, Begin),
    ( End == open -> true ; Left == [] ).

%   likely(+Found0, +All, -Found): Found are the entries whose following goals
%   are possible, and among these those with the longest rest of a clause.

likely(Found0, All, Found) :-
    findall(Count-Entry,
            ( member(Entry, Found0),
              Entry = Left-_,
              may_follow(Left, All),
              length(Left, Count)
            ),
            Counted),
    findall(Count, member(Count-_, Counted), Counts),
    (   Counts == []
    ->  Found = []
    ;   min_list(Counts, Least),
        findall(Entry, member(Least-Entry, Counted), Found1),
        sort(Found1, Found)
    ).

may_follow([], _) :-
    !.
may_follow(Goals, All) :-
    returns(Goals, All, _, _),
    !.

%   returns(+Goals, +All, -Call, -Clause) is nondet: Goals begins with the goals
%   after Call in Clause.

returns(Goals, All, Call, c(N, Name/Arity)) :-
    member(N-(Head:-Body), All),
    point(Body, [Call|Sequel], End),
    after(Sequel, Goals, End, _),
    functor(Head, Name, Arity).

%   callers(+Left, +All, +Clause, -Callers): Callers are the callers of Clause;
%   Left are the goals after it.  After a last call Left is empty: then the
%   caller is known only if no other clause calls that predicate.

callers(Left, All, c(_, Name/Arity), Callers) :-
    functor(Head, Name, Arity),
    findall(Caller,
            ( returns(Left, All, Call, Caller),
              nonvar(Call),
              \+ Call \= Head
            ),
            Found),
    (   Left == []
    ->  findall(Caller, calls(All, Head, Caller), Callers0)
    ;   Callers0 = Found
    ),
    sort(Callers0, Callers).

calls(All, General, c(N, Name/Arity)) :-
    member(N-(Head:-Body), All),
    Head \= General,
    point(Body, [Call|_], _),
    nonvar(Call),
    \+ Call \= General,
    functor(Head, Name, Arity).

                /*******************************
                *            POINTS            *
                *******************************/

%   goals_normal(+Goals0, -Goals): Goals are Goals0 in the form of a clause
%   body.

goals_normal(Goals0, Goals) :-
    goals_body(Goals0, Body),
    body_list(Body, Goals).

%!  body_list(+Body, -Goals:list) is det.

body_list(Body, Goals) :-
    body_goals(Body, _, Goals0, []),
    plain_goals(Goals0, Goals).

%!  point(+Body, -Sequel, -End) is nondet.
%
%   Sequel are the goals of Body that remain when the machine has reached the
%   first goal of Sequel.  End is `open` if the goals after the body follow,
%   `closed` inside a condition.

point(Body, Sequel, End) :-
    body_list(Body, Goals),
    point_in(Goals, [], open, Sequel, End).

%   point_in(+Goals, +After, +End0, -Sequel, -End): After follows Goals.

point_in(Goals, After0, End0, Sequel, End) :-
    append(_, [Goal|Goals1], Goals),
    append(Goals1, After0, After),
    (   Sequel = [Goal|After],
        End = End0
    ;   nonvar(Goal),
        part(Goal, Part, How),
        body_list(Part, Goals2),
        part_point(How, Goals2, After, End0, Sequel, End)
    ).

part_point(continued, Goals, After, End0, Sequel, End) :-
    point_in(Goals, After, End0, Sequel, End).
part_point(apart, Goals, _, _, Sequel, End) :-
    point_in(Goals, [], closed, Sequel, End).

%   part(+Goal, -Part, -How) is nondet: How is `continued` if the machine
%   continues in Part, with the goals after Goal, `apart` if it runs Part
%   separately.

part((If->_), If, apart).
part((_->Then), Then, continued).
part((If*->_), If, apart).
part((_*->Then), Then, continued).
part((Or;_), Part, How) :-
    part_of_or(Or, Part, How).
part((_;Else), Else, continued).
part(call(Goal), Goal, continued).
part(once(Goal), Goal, apart).
part(ignore(Goal), Goal, apart).
part(catch(Goal,_,_), Goal, apart).
part(catch(_,_,Recovery), Recovery, continued).
part(\+ Goal, Goal, apart).

part_of_or(Or, Part, How) :-
    (   nonvar(Or),
        ( Or = (_->_) ; Or = (_*->_) )
    ->  part(Or, Part, How)
    ;   Part = Or,
        How = continued
    ).

%   goal_level(+Goal, +Goals, -Left): Left begins with Goal, in Goals or in a
%   part of the first of Goals that runs apart; Left is Goals if Goal is not
%   found.

goal_level(Goal, [First|Goals], Left) :-
    (   First == Goal
    ->  Left = [First|Goals]
    ;   nonvar(First),
        apart(First, Part),
        body_list(Part, Left0),
        goal_level(Goal, Left0, Left)
    ->  true
    ;   Left = [First|Goals]
    ).

apart(Goal, Part) :-
    part(Goal, Part, apart),
    !.
