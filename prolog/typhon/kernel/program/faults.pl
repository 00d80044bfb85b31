:- module(typhon_faults,
          [ fails/2,                    % +Goal, +Goals
            fails_inside/2,             % +Frame, +Goals
            fault/3,                    % +Outcome, +Goals0, -Fault
            fault_noted/1,              % -Note
            fault_note/1                % +Note
          ]).
:- use_module(bodies, [goals_body/2, plain_goals/2]).

/** <module> Where a run of the machine came to its end

When a goal fails, the machine notes it, and when an error is about to
leave the run, the goals that it leaves are read from the frames of the
machine, which are still there then.  What is noted last is what ended the
run: a fault

    fault(Goal, Goals, natives(Raising, Clauses))

of the goal that failed or raised, the goals that were left to run from it
on, the goal that raised the error natively and references to the clauses in
which that was, the innermost first.

Nothing of this costs an agent anything that neither fails nor raises, and
one that catches its errors half a microsecond.

*Threading*: a global variable, so local to each thread.
*/

:- multifile
    user:prolog_exception_hook/4,
    prolog:prolog_exception_hook/5.
:- dynamic
    user:prolog_exception_hook/4,
    prolog:prolog_exception_hook/5.

%   What is noted is copied.  More cells than these only when the run will
%   end with this failure.

most_cells(400).

%!  fails(+Goal, +Goals) is failure.
%
%   Goal has failed, Goals would have come next.

fails(Goal, Goals) :-
    prolog_current_choice(Choice),
    (   may_be_noted(Goal-Goals, Choice)
    ->  note(failed, Goal, [Goal|Goals])
    ;   functor(Goal, Name, Arity),
        functor(General, Name, Arity),
        note(failed, General, unknown)
    ),
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

%   Nothing is left to be tried in this run.

final(Choice) :-
    prolog_choice_attribute(Choice, frame, Frame),
    frame_of(Frame, first_outcome/3),
    !.
final(Choice) :-
    prolog_choice_attribute(Choice, type, catch),
    prolog_choice_attribute(Choice, parent, Parent),
    final(Parent).

%!  fails_inside(+Frame, +Goals) is failure.
%
%   What was noted has failed in a part of a construct, which Frame, that is
%   Left-Framed, continues.

fails_inside(Left-Framed, Goals) :-
    nb_getval(typhon_fault, failed-fault(Goal, Sub, _)),
    Sub \== unknown,
    goals_body(Sub, Left),
    note(failed, Goal, [Framed|Goals]),
    fail.

                /*******************************
                *            ERRORS            *
                *******************************/

user:prolog_exception_hook(_, _, Frame, Catcher) :-
    integer(Catcher),
    frame_of(Catcher, machine_run/3),
    note_raised(Frame),
    fail.
prolog:prolog_exception_hook(_, _, Frame, Catcher, _) :-
    integer(Catcher),
    frame_of(Catcher, machine_run/3),
    note_raised(Frame),
    fail.

%   Names are qualified as seen from where the hook runs.

frame_of(Frame, PI) :-
    prolog_frame_attribute(Frame, predicate_indicator, PI0),
    ( PI0 = PI ; PI0 = typhon_machine:PI ),
    !.

%   What a hook binds is undone when it fails.

note_raised(Frame) :-
    native_goal(Frame, Raising),
    native_clauses(100, Frame, Clauses),
    raising(Frame, Goal, Goals, Outer),
    framed(Outer, [Goal|Goals], Left),
    note(raised, Goal, Left, natives(Raising, Clauses)).

raising(Frame, Control, Goals, Outer) :-
    prolog_frame_attribute(Frame, parent, Outer),
    frame_of(Outer, raises/3),
    !,
    prolog_frame_attribute(Outer, argument(2), Control),
    prolog_frame_attribute(Outer, argument(3), Goals).
raising(Frame, Goal, Goals, Outer) :-
    outer(Frame, called(Goal, Goals, _, _, _), Outer).

%   Goals are looked up in the module that asks.

outer(Frame, Goal, Outer) :-
    @(prolog_frame_attribute(Frame, parent_goal(Outer), Goal),
      typhon_machine).

%   framed(+Frame, +Goals0, -Goals): what of constructs is outside.

framed(Frame, Goals0, Goals) :-
    (   outer(Frame, inside(_, Sub-Framed, Goals1, _, _), Outer)
    ->  goals_body(Goals0, Sub),
        framed(Outer, [Framed|Goals1], Goals)
    ;   Goals = Goals0
    ).

%   What raised the error itself is mostly no more than this.

native_goal(Frame, Goal) :-
    prolog_frame_attribute(Frame, goal, Goal0),
    strip_module(Goal0, _, Goal),
    '$term_size'(Goal, 1000, _),
    !.
native_goal(_, none).

%   The clauses of up to Most frames.

native_clauses(0, _, []) :-
    !.
native_clauses(_, Frame, []) :-
    ( frame_of(Frame, called/5) ; frame_of(Frame, raises/3) ),
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
%   What ended the last run of this thread, which began with Goals0 and had
%   that Outcome, `failed` or raised(_).

fault(Outcome, Goals0, fault(Goal, Goals, Clauses)) :-
    functor(Outcome, How, _),
    (   nb_current(typhon_fault, How-fault(Goal0, Goals1, Clauses))
    ->  true
    ;   Goals0 = [Goal0|_],             % too little memory to note anything
        Goals1 = unknown,
        Clauses = natives(none, [])
    ),
    nb_setval(typhon_fault, none),
    ( Goals1 == unknown -> Goals2 = Goals0 ; Goals2 = Goals1 ),
    plain_goals([Goal0|Goals2], [Goal|Goals]).

%!  fault_noted(-Note) is det.
%!  fault_note(+Note) is det.
%
%   What this thread, or engine, has noted; note it in another.

fault_noted(Note) :-
    (   nb_current(typhon_fault, Note0)
    ->  Note = Note0
    ;   Note = none
    ).

fault_note(Note) :-
    nb_setval(typhon_fault, Note).
