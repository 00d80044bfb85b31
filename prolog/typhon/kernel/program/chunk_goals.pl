:- module(typhon_chunk_goals,
          [ plain_goals/2,              % +Goals0, -Goals
            goals_without/3,            % +Goals0, +Frames, -Goals
            frame_goals/4,              % +Place, +Vars, -Goals, ?Rest
            place_left/4,               % +Place, +Vars, -Goal, -Goals
            place_marked/3              % +Place, +Vars, -Left
          ]).
:- use_module(library(apply), [exclude/3, foldl/4, maplist/2]).
:- use_module(library(lists), [append/3, memberchk/2, nth0/3]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(bodies, [plain_goal/2, special/2]).
:- use_module(clause_places, [among/2, clause_places/5]).
:- use_module(code, [code_compiled/2, code_program/2]).
:- use_module(source, [clause_parts/3]).

/** <module> Frames of chunks and the goals that they stand for

A place of a program is (Number*Count+Clause)*2, for the goal of that number in
a clause (see typhon_clause_places), of which there are Count, plus 1 if a cut
of the clause is left there.  The goals that are left at a place are computed
from the clause when they are first asked for.  Then two tables of the
program's module hold them: '$goals'/4, from frames to goals, and, if that
saves time, '$frame'/5, from goals to frames.

*Threading*: any thread; one mutex when a place is added.
*/

%!  plain_goals(+Goals0, -Goals) is det.
%
%   Replace `'$cut'(_)` by `!`, and frames by the goals for which they stand.
%   A suspended agent is shown with these goals.

plain_goals(Goals0, Goals) :-
    goals_without(Goals0, all, Goals).

%!  goals_without(+Goals0, +Frames, -Goals) is det.
%
%   As plain_goals/2, but if Frames is `cuts`, keep frames without a cut.  A cut
%   in a frame would cut to where this run began, and the next run begins
%   elsewhere.

goals_without([], _, []).
goals_without([Goal|Goals0], Frames, [Goal|Goals]) :-
    var(Goal),
    !,
    goals_without(Goals0, Frames, Goals).
goals_without(['$k'(Place, Vars)|Goals0], Frames, Goals) :-
    !,
    (   Frames == cuts,
        Place /\ 1 =:= 0
    ->  Goals = ['$k'(Place, Vars)|Goals1]
    ;   frame_goals(Place, Vars, Goals, Goals1)
    ),
    goals_without(Goals0, Frames, Goals1).
goals_without([Goal0|Goals0], Frames, [Goal|Goals]) :-
    plain_goal(Goal0, Goal),
    goals_without(Goals0, Frames, Goals).

%!  frame_goals(+Place, +Vars, -Goals, ?Rest) is det.
%
%   Goals are those of a frame that holds no cut, followed by Rest.

frame_goals(Place, Vars, Goals, Rest) :-
    functor(Vars, Module, _),
    (   Module:'$goals'(Place, Vars, Goals, Rest)
    ->  true
    ;   place_plain(Place, Vars, Goals, Rest)
    ).

%!  place_left(+Place, +Vars, -Goal, -Goals) is det.
%!  place_marked(+Place, +Vars, -Left) is det.
%
%   Goal is the goal at Place; Goals, or Left = Goals-Rest, are the goals that
%   are left there, with cuts as the machine has them.  Vars is only the name
%   of the module if the variables are not known.

place_marked(Place, Vars, Goals-Rest) :-
    functor(Vars, Module, _),
    (   '$get_predicate_attribute'(Module:'$marked'(_, _, _, _), defined, 1),
        Module:'$marked'(Place, Vars, Goals0, Rest)
    ->  Goals = Goals0
    ;   functor(Vars, _, Arity),
        functor(General, Module, Arity),
        place_left(Place, General, _, Goals1),
        append(Goals1, Rest1, Goals2),
        dynamic(Module:'$marked'/4),
        assertz(Module:'$marked'(Place, General, Goals2, Rest1)),
        place_marked(Place, Vars, Goals-Rest)
    ).

%   The tables '$goals' and '$frame' hold the places that were asked for, the
%   first of them last.  They cannot be rules with `=>`: a call while the first
%   rule is being added finds none and raises an error; with `:-` it fails.

place_plain(Place, Vars, Goals, Rest) :-
    functor(Vars, Module, Arity),
    functor(General, Module, Arity),
    place_left(Place, General, _, Goals0),
    plain_goals(Goals0, Plain),
    append(Plain, Rest0, List),
    with_mutex(typhon_chunks,
               add_place(Module, Place, General, Goals0, Plain, List, Rest0)),
    Vars-Goals-Rest = General-List-Rest0.

add_place(Module, Place, _, _, _, _, _) :-
    clause(Module:'$goals'(Place, _, _, _), true),
    !.
add_place(Module, Place, General, Goals, Plain, List, Rest) :-
    asserta(Module:'$goals'(Place, General, List, Rest)),
    (   \+ \+ clause(Module:'$k'(Place, General, _, _, _, _), _),
        worth(Plain),
        Plain = [First|_]
    ->  functor(First, Name, Arity),
        functor(Head, Name, Arity),
        barrier(Goals, Base),
        term_variables(General, Known),
        term_variables(Plain, Variables),
        exclude(among(Known), Variables, New),
        untouched(New, General-Rest, Untouched),
        asserta(Module:('$frame'(Head, List0, Base, '$k'(Place, General), Rest) :-
                            subsumes_term(List, List0),
                            List = List0,
                            Untouched,
                            !))
    ;   true
    ).

%   untouched(+New, +Others, -Code): a frame does not hold the variables that
%   are New in its goals.  So Code succeeds if these are unbound, without
%   attributes, different from each other, and occur nowhere else, as when the
%   agent stopped at the place.  Code binds them to numbers to check that:
%   term_variables/2 would take twice as long.

untouched([], _, true) :-
    !.
untouched(New, Others, ( Unbound,
                         term_attvars(Variables, []),
                         term_variables(Others, Known),
                         \+ \+ ( Numbered,
                                 term_variables(Known, Left),
                                 Left == Known ) )) :-
    Variables =.. [new|New],
    foldl(unbound, New, true, Unbound),
    foldl(numbered, New, 0-true, _-Numbered).

unbound(Variable, Code, (var(Variable),Code)).

numbered(Variable, N0-Code, N-(Variable=N,Code)) :-
    N is N0+1.

%   worth(+Goals) is semidet: a frame saves time.  Goals begin with three goals
%   that are probably native.

worth([A,B,C|_]) :-
    maplist(plain_goal, [A,B,C]).

plain_goal(Goal) :-
    callable(Goal),
    \+ special(Goal, _).

%   Cuts go to the choice point at which the run began.

barrier(Goals, Barrier) :-
    sub_term(Cut, Goals),
    nonvar(Cut),
    Cut = '$cut'(Barrier),
    !.
barrier(_, _).

place_left(Place, Vars, Goal, Goals) :-
    functor(Vars, Module, _),
    code_compiled(Hash, Module),
    code_program(Hash, program(_, _, _, Clauses)),
    length(Clauses, Count),
    I is Place//2 mod Count,
    N is Place//2//Count,
    nth0(I, Clauses, Clause),
    clause_parts(Clause, Head, Body),
    clause_places(Head, Body, _, _, Places),
    memberchk(place(N, Old, New, Goal, Goals), Places),
    Vars =.. [_|Values],
    append(Old, New, Variables),
    append(Values, _, Variables),
    !.
