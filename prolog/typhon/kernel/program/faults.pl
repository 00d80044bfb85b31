:- module(typhon_faults,
          [ fails/2,                    % +Goal, +Goals
            fails_at/3,                 % +Place, +Vars, +Goals
            test_fails/3,               % +Place, +Vars, +Goals
            fails_inside/2,             % +Frame, +Goals
            fault/3,                    % +Outcome, +Goals0, -Fault
            fault_noted/1,              % -Note
            fault_note/1,               % +Note
            frame_of/2                  % +Frame, ?PI
          ]).
:- use_module(library(lists), [memberchk/2]).
:- use_module(bodies, [goals_body/2]).
:- use_module(chunks, [place_left/4, plain_goals/2]).

/** <module> Where a run of the machine ended

When a goal fails, the machine notes it.  When an error is about to leave the
run, module `typhon_chunk_faults` notes the goals that the error abandons.  The
last note is what ended the run: a fault

    fault(Goal, Goals, natives(Raising, Clauses))

with the goal that failed or raised an error, the goals that were left to run,
that goal first, the goal that raised the error natively, and references to the
clauses that were running then, innermost first.

Agents that neither fail nor raise errors pay nothing for this, and agents that
catch their errors half a microsecond.

*Threading*: a global variable, so local to each thread.
*/

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
    nb_setval(typhon_fault, How-fault(Goal, Goals, natives(none, []))).

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

%!  frame_of(+Frame, ?PI) is semidet.
%
%   Frame runs PI, a predicate of the machine.  A hook sees names qualified from
%   its own module.

frame_of(Frame, PI) :-
    prolog_frame_attribute(Frame, predicate_indicator, PI0),
    ( PI0 = PI ; PI0 = typhon_machine:PI ),
    !.

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
