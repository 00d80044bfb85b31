:- module(typhon_chunk_faults, []).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../../kernel/program',
              [ fault_note/1, frame_of/2, goals_body/2, place_left/4,
                plain_goals/2 ]).

/** <module> Which goal of a run raised an error

When an error is about to leave a run, the hook reads the goals that the error
abandons from the frames of the machine, which still exist then, and notes them
as typhon_faults does.  In a chunk they are read from the instructions of the
virtual machine and from the frame of the clause, see typhon_chunk_compiler.

*Threading*: any thread.
*/

:- multifile
    user:prolog_exception_hook/4,
    prolog:prolog_exception_hook/5.
:- dynamic
    user:prolog_exception_hook/4,
    prolog:prolog_exception_hook/5.

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
    fault_note(raised-fault(Goal, Left, natives(Raising, Clauses))),
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
                *            CHUNKS            *
                *******************************/

%   In the clause, each goal is followed by the call that notes its failure,
%   which has the place as a number.  The other arguments of that call are read
%   from the frame.

chunk_goal(Frame, PC, Goal, Goals) :-
    chunk_place(Frame, PC, Place, Vars, Rest),
    place_left(Place, Vars, Goal, Left),
    append(Left, Rest, Goals).

chunk_place(Frame, PC, Place, Vars, Goals) :-
    prolog_frame_attribute(Frame, clause, Clause),
    number_after(Clause, PC, call, Place),
    '$clause'(_, Body, Clause, Slots),
    noted_in(Body, Place, Vars, Goals),
    term_variables(Vars-Goals, Variables),
    maplist(from_frame(Frame, Slots), Variables).

number_after(Clause, PC, State0, Place) :-
    '$fetch_vm'(Clause, PC, Next, Instruction),
    (   Instruction = c_softcut(_)
    ->  State = cut
    ;   State = State0
    ),
    (   State == cut,
        Instruction = b_smallint(Place0)
    ->  Place = Place0
    ;   number_after(Clause, Next, State, Place)
    ).

noted_in(Term, Place, Vars, Goals) :-
    compound(Term),
    (   ( Term = fails_at(Place0, Vars0, Goals0)
        ; Term = test_fails(Place0, Vars0, Goals0)
        ),
        Place0 == Place
    ->  Vars = Vars0,
        Goals = Goals0
    ;   arg(_, Term, Part),
        noted_in(Part, Place, Vars, Goals)
    ),
    !.

from_frame(Frame, Slots, Variable) :-
    member(Slot=Variable0, Slots),
    Variable0 == Variable,
    !,
    Argument is Slot+1,
    prolog_frame_attribute(Frame, argument(Argument), Variable).
from_frame(_, _, _).

                /*******************************
                *             HOOKS            *
                *******************************/

%   At the end of the file, as threads run while it is loaded.

user:prolog_exception_hook(_, _, Frame, Catcher) :-
    note_raised(Frame, Catcher).
prolog:prolog_exception_hook(_, _, Frame, Catcher, _) :-
    note_raised(Frame, Catcher).
