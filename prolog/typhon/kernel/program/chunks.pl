:- module(typhon_chunks,
          [ chunks_ready/1,             % +Module
            plain_goals/2,              % +Goals0, -Goals
            goals_without/3,            % +Goals0, +Frames, -Goals
            frame_goals/4,              % +Place, +Vars, -Goals, ?Rest
            place_left/4,               % +Place, +Vars, -Goal, -Goals
            place_marked/3              % +Place, +Vars, -Left
          ]).
:- use_module(library(lists), [append/3]).
:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module(bodies, [plain_goal/2]).

/** <module> Programs that run in chunks, from stop to stop

The machine (typhon_machine) defines the meaning of a program.  Usually
compiled code runs instead: each clause of a predicate in which an agent may
stop is compiled to native clauses when an agent first runs the program.  The
compiler, typhon_chunk_compiler, is loaded then; without it the machine runs
programs.

    'run p'(A1, ..., AN, K, X, Base, Out)

runs a call of p/N and then the goals K; the last three arguments are those of
run/4 of the machine.  Where the clause calls another such predicate, the rest
of the clause is put before K as a frame

    '$k'(Place, 'program 7'(V1, ..., VM))

that names the place in the clause, and has the values of its variables.  The name of the second term is the module of the
program.  These tables are in that module:

    '$k'(Place, Vars, K, X, Base, Out)  runs a frame, and then K
    '$run'(Head, Run, K, X, Base, Out, Condition)  how to call a predicate
    '$goals'(Place, Vars, Goals, Rest)  the goals that a frame stands for
    '$frame'(First, Goals, Base, Frame, Rest)  the frame for goals

Frames have a meaning only in this process, and only where the program runs
compiled.  Goals that are sent to another process, noted, shown, or run in
another way are converted to the goals that the frames stand for
(plain_goals/2), and a frame is made of these again if that saves time.  The
last two tables hold only places that were asked for.

*Threading*: any thread reads the tables.
*/

:- multifile
    compiled/1,                 % +Module: compile the program in Module
    place_plain/4,              % +Place, +Vars, -Goals, ?Rest: as
                                % frame_goals/4, from the clause
    place_left/4.               % see below

%!  chunks_ready(+Module) is semidet.
%
%   The program in Module is compiled; compile it now if it was not.  Fails if
%   compiling has run out of memory; the machine runs the program then.

chunks_ready(Module) :-
    '$get_predicate_attribute'(Module:'$goals'(_, _, _, _), defined, 1),
    !.
chunks_ready(Module) :-
    on_demand_load(program, runs),
    compiled(Module),
    !.

                /*******************************
                *            GOALS             *
                *******************************/

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
