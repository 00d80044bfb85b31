:- module(typhon_chunk_faults, []).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../../kernel/program', [place_left/4]).

/** <module> Which goal of a chunk raised an error

This is read from the instructions of the virtual machine and from the frame of
the clause, see typhon_chunk_compiler.

*Threading*: any thread.
*/

:- multifile typhon_faults:chunk_goal/4.

%   In the clause, each goal is followed by the call that notes its failure,
%   which has the place as a number.  The other arguments of that call are read
%   from the frame.

typhon_faults:chunk_goal(Frame, PC, Goal, Goals) :-
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
