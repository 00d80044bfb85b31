:- module(typhon_faults,
          [ fails/2,                    % +Goal, +Goals
            fails_at/3,                 % +Place, +Vars, +Goals
            test_fails/3,               % +Place, +Vars, +Goals
            fails_inside/2,             % +Frame, +Goals
            fault/3,                    % +Outcome, +Goals0, -Fault
            fault_noted/1,              % -Note
            fault_note/1                % +Note
          ]).
:- use_module(library(lists), [memberchk/2]).
:- use_module(bodies, [goals_body/2]).
:- use_module(chunks, [place_left/4, plain_goals/2]).

/** <module> Where a run of the machine ended

When a goal fails, the machine notes it.  When an error is about to leave the
run, the hook reads the goals that the error abandons from the frames of the
machine, which still exist then.  The last note is what ended the run: a fault

    fault(Goal, Goals, natives(Raising, Clauses))

with the goal that failed or raised an error, the goals that were left to run,
that goal first, the goal that raised the error natively, and references to the
clauses that were running then, innermost first.

Agents that neither fail nor raise errors pay nothing for this, and agents that
catch their errors half a microsecond.

*Threading*: a global variable, so local to each thread.
*/

:- multifile
    chunk_goal/4,               % +Frame, +PC, -Goal, -Goals: the chunk in Frame
                                % has called Goal before PC, and Goals are left
    user:prolog_exception_hook/4,
    prolog:prolog_exception_hook/5.
:- dynamic
    user:prolog_exception_hook/4,
    prolog:prolog_exception_hook/5.

%   A note is copied.  A larger one is made only when the run will end with
%   this failure.

most_cells(400).

%!  fails(+Goal, +Goals) is failure.
%
%   Note that Goal has failed, and that Goals would have come next.

fails(Goal, Goals) :-
    prolog_current_choice(Choice),
    (   may_be_noted(Goal-Goals, Choice)
    ->  note(failed, Goal, [Goal|Goals])
    ;   functor(Goal, Name, Arity),
        functor(General, Name, Arity),
        note(failed, General, unknown)
    ),
    fail.

%!  fails_at(+Place, +Vars, +Goals) is failure.
%
%   Note that in a chunk the goal at Place has failed, see typhon_chunks.  The
%   goal itself is computed only when the fault is asked for.

fails_at(Place, Vars, Goals) :-
    most_cells(Most),
    '$term_size'(Vars-Goals, Most, _),
    nb_setval(typhon_fault,
              failed-fault('$k'(Place, Vars), ['$k'(Place, Vars)|Goals],
                           natives(none, []))),
    !,
    fail.
fails_at(Place, Vars, Goals) :-
    prolog_current_choice(Choice),
    (   final(Choice)
    ->  note(failed, '$k'(Place, Vars), ['$k'(Place, Vars)|Goals])
    ;   functor(Vars, Program, _),
        note(failed, '$k'(Place, Program), unknown)
    ),
    fail.

%!  test_fails(+Place, +Vars, +Goals) is failure.
%
%   A goal of a condition in a chunk has failed.  This notes nothing: the call
%   marks the place of the goal in the clause.

test_fails(_, _, _) :-
    fail.

note(How, Goal, Goals) :-
    note(How, Goal, Goals, natives(none, [])).

note(How, Goal, Goals, Clauses) :-
    nb_setval(typhon_fault, How-fault(Goal, Goals, Clauses)).

may_be_noted(Term, Choice) :-
    (   most_cells(Most),
        '$term_size'(Term, Most, _)
    ->  true
    ;   final(Choice)
    ).

%   No choice point of this run is left.

final(Choice) :-
    prolog_choice_attribute(Choice, frame, Frame),
    frame_of(Frame, first_outcome/3),
    !.
final(Choice) :-
    passes_failure(Choice),
    prolog_choice_attribute(Choice, parent, Parent),
    final(Parent).

%   A choice point of catch/3, after whose failure fails_inside/2 goes on, or
%   one that `*->` has cut.

passes_failure(Choice) :-
    prolog_choice_attribute(Choice, type, Type),
    memberchk(Type, [catch,none]),
    !.
passes_failure(Choice) :-
    prolog_choice_attribute(Choice, frame, Frame),
    frame_of(Frame, catching/7).

%!  fails_inside(+Frame, +Goals) is failure.
%
%   The noted goal has failed in a part of a construct.  Frame is Left-Framed:
%   Framed is the construct in which Left is left to run.  Note that, too.

fails_inside(Left-Framed, Goals) :-
    nb_getval(typhon_fault, failed-fault(Goal, Sub, _)),
    Sub \== unknown,
    plain_goals(Sub, Plain),
    goals_body(Plain, Left),
    note(failed, Goal, [Framed|Goals]),
    fail.

                /*******************************
                *            ERRORS            *
                *******************************/

user:prolog_exception_hook(_, _, Frame, Catcher) :-
    note_raised(Frame, Catcher).
prolog:prolog_exception_hook(_, _, Frame, Catcher, _) :-
    note_raised(Frame, Catcher).

%   The hook sees names qualified from its own module.

frame_of(Frame, PI) :-
    prolog_frame_attribute(Frame, predicate_indicator, PI0),
    ( PI0 = PI ; PI0 = typhon_machine:PI ),
    !.

%   The bindings of a hook that fails are undone, so the note is a global
%   variable.

note_raised(Frame, Catcher) :-
    integer(Catcher),
    frame_of(Catcher, machine_run/3),
    native_goal(Frame, Raising),
    native_clauses(100, Frame, Clauses),
    raising(Frame, Goal, Goals, Outer),
    same_goal(Frame, Raising, Goal),
    framed(Outer, Goals, Left),
    note(raised, Goal, Left, natives(Raising, Clauses)),
    fail.

raising(Frame, Control, [Control|Goals], Outer) :-
    prolog_frame_attribute(Frame, parent, Outer),
    frame_of(Outer, raises/3),
    !,
    prolog_frame_attribute(Outer, argument(2), Control),
    prolog_frame_attribute(Outer, argument(3), Goals).
raising(Frame, Goal, Goals, Outer) :-
    in_chunk(Frame, Outer, PC),
    !,
    chunk_goal(Outer, PC, Goal, Goals).
raising(Frame, Goal, [Goal|Goals], Outer) :-
    outer(Frame, called(Goal, Goals, _, _, _), Outer).

%   same_goal(+Frame, +Raising, ?Goal): in a chunk, a native goal has variables
%   of its own for those that first occur in it.  If Raising, the goal of Frame,
%   is that goal itself, a predicate without clauses, unify it with Goal, which
%   then shows the bindings.

same_goal(Frame, Raising, Goal) :-
    (   \+ prolog_frame_attribute(Frame, clause, _),
        prolog_frame_attribute(Frame, parent, Outer),
        is_chunk(Outer)
    ->  ignore(Goal = Raising)
    ;   true
    ).

%   The attribute `goal` is qualified relative to the calling module.

outer(Frame, Goal, Outer) :-
    @(prolog_frame_attribute(Frame, parent_goal(Outer), Goal),
      typhon_machine).

%   framed(+Frame, +Goals0, -Goals): Goals0 within the constructs around Frame.

framed(Frame, Goals0, Goals) :-
    (   outer(Frame, inside(_, Sub-Framed, Goals1, _, _), Outer)
    ->  plain_goals(Goals0, Plain),
        goals_body(Plain, Sub),
        framed(Outer, [Framed|Goals1], Goals)
    ;   Goals = Goals0
    ).

%   in_chunk(+Frame, -Chunk, -PC) is semidet: Frame is below a goal of the chunk
%   that runs in the frame Chunk, called before PC of its clause.

in_chunk(Frame, Chunk, PC) :-
    prolog_frame_attribute(Frame, parent, Outer),
    (   is_chunk(Outer)
    ->  Chunk = Outer,
        prolog_frame_attribute(Frame, pc, PC)
    ;   \+ frame_of(Outer, called/5),
        in_chunk(Outer, Chunk, PC)
    ).

is_chunk(Frame) :-
    prolog_frame_attribute(Frame, predicate_indicator, Module:Name/_),
    chunk_name(Name),
    '$get_predicate_attribute'(Module:'$goals'(_, _, _, _), defined, 1).

chunk_name('$k') :- !.
chunk_name(Name) :- sub_atom(Name, 0, _, _, 'run '), !.
chunk_name(Name) :- sub_atom(Name, 0, _, _, 'do ').

%   native_goal(+Frame, -Goal): the goal of Frame, which raised the error, or
%   `none` if it is too large.

native_goal(Frame, Goal) :-
    prolog_frame_attribute(Frame, goal, Goal0),
    strip_module(Goal0, _, Goal),
    '$term_size'(Goal, 1000, _),
    !.
native_goal(_, none).

%   native_clauses(+Most, +Frame, -Clauses): the clauses of up to Most frames.

native_clauses(0, _, []) :-
    !.
native_clauses(_, Frame, []) :-
    (   frame_of(Frame, called/5)
    ;   frame_of(Frame, raises/3)
    ;   is_chunk(Frame)
    ),
    !.
native_clauses(Most, Frame, Clauses) :-
    (   prolog_frame_attribute(Frame, clause, Clause)
    ->  Clauses = [Clause|Clauses1]
    ;   Clauses = Clauses1
    ),
    (   prolog_frame_attribute(Frame, parent, Outer)
    ->  Most1 is Most-1,
        native_clauses(Most1, Outer, Clauses1)
    ;   Clauses1 = []
    ).

                /*******************************
                *            FAULTS            *
                *******************************/

%!  fault(+Outcome, +Goals0, -Fault) is det.
%
%   Fault is the end of the last run of this thread, which began with Goals0
%   and had that Outcome, `failed` or raised(_).

fault(Outcome, Goals0, fault(Goal, Goals, Clauses)) :-
    functor(Outcome, How, _),
    (   nb_current(typhon_fault, How-fault(Goal0, Goals1, Clauses))
    ->  true
    ;   Goals0 = [Goal0|_],             % memory was too short for a note
        Goals1 = unknown,
        Clauses = natives(none, [])
    ),
    nb_setval(typhon_fault, none),
    ( Goals1 == unknown -> Goals2 = Goals0 ; Goals2 = Goals1 ),
    noted_goal(Goal0, Goals1, Goal3),
    plain_goals([Goal3|Goals2], [Goal|Goals]).

noted_goal('$k'(Place, Vars), Goals, Goal) :-
    !,
    place_left(Place, Vars, Goal0, _),
    (   Goals == unknown
    ->  functor(Goal0, Name, Arity),
        functor(Goal, Name, Arity)
    ;   Goal = Goal0
    ).
noted_goal(Goal, _, Goal).

%!  fault_noted(-Note) is det.
%
%   Note is the last note of this thread, or engine.

fault_noted(Note) :-
    (   nb_current(typhon_fault, Note0)
    ->  Note = Note0
    ;   Note = none
    ).

%!  fault_note(+Note) is det.
%
%   Set the last note of this thread, or engine.

fault_note(Note) :-
    nb_setval(typhon_fault, Note).
