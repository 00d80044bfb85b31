:- module(typhon_cell_functors,
          [ functors_charged/3,         % +Owner, +Text, -Frame
            functors_left/1             % +Owner
          ]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(cell_acts, [cell_violation/1]).
:- use_module(cell_frames, [cell_text_heard/2]).

/** <module> How many functors the owner of a cell brings into this process

A functor is never freed, nor is the atom that is its name: 160 bytes each.  No
quota counts those of frames, so they are charged to the owner of the agents of
the cell, for as long as the process lives.  An owner that has no more left has
no turns in cells any more: one frame can hold some hundred thousand, and is
counted only when it has been read.

Other threads make functors as well.  So those of a frame are looked at if there
are more in the process than before, and each is charged to an owner once.

*Threading*: any thread; a mutex protects the tables.
*/

:- setting(typhon_cells:functors, positive_integer, 20 000,
           "Functors that the cells of an owner may bring into the process").

:- dynamic
    charged/3,                  % Name, Arity, Owner
    count/2.                    % Owner, Count: of functors charged to it

%!  functors_left(+Owner:atom) is semidet.
%
%   Agents of Owner may have turns in cells.

functors_left(Owner) :-
    (   count(Owner, Count)
    ->  setting(typhon_cells:functors, Most),
        Count =< Most
    ;   true
    ).

%!  functors_charged(+Owner:atom, +Text:string, -Frame) is det.
%
%   Frame is that of cell_text_heard/2; its functors are charged to Owner.
%
%   @error cell_violation(functors) they are more than Owner has left

functors_charged(Owner, Text, Frame) :-
    sig_atomic(read_and_charge(Owner, Text, Frame)),
    (   functors_left(Owner)
    ->  true
    ;   cell_violation(functors)
    ).

read_and_charge(Owner, Text, Frame) :-
    statistics(functors, Before),
    catch(cell_text_heard(Text, Frame), Error,
          ( charge_unread(Owner, Before), throw(Error) )),
    statistics(functors, After),
    (   ( After > Before ; declares_predicates(Frame) )
    ->  with_mutex(typhon_cell_functors, charge(Frame, Owner))
    ;   true
    ).

%   What was read before the error is not known.

charge_unread(Owner, Before) :-
    statistics(functors, After),
    New is After-Before,
    with_mutex(typhon_cell_functors, counted(Owner, New)).

%   The functors of a program are made when it is loaded, from Name/Arity too.

declares_predicates(request(_, Goal)) :-
    compound(Goal),
    compound_name_arity(Goal, create, 3).

charge(Term, _) :-
    \+ compound(Term),
    !.
charge(Name/Arity, Owner) :-
    atom(Name),
    integer(Arity),
    !,
    charge(Name, Arity, Owner).
charge(Term, Owner) :-
    compound_name_arity(Term, Name, Arity),
    charge(Name, Arity, Owner),
    charge_arguments(1, Arity, Term, Owner).

%   The tail of a list is its last argument.

charge_arguments(I, Arity, Term, Owner) :-
    I < Arity,
    !,
    arg(I, Term, Arg),
    charge(Arg, Owner),
    I1 is I+1,
    charge_arguments(I1, Arity, Term, Owner).
charge_arguments(Last, Last, Term, Owner) :-
    !,
    arg(Last, Term, Arg),
    charge(Arg, Owner).
charge_arguments(_, _, _, _).

charge(Name, Arity, Owner) :-
    (   charged(Name, Arity, Owner)
    ->  true
    ;   assertz(charged(Name, Arity, Owner)),
        counted(Owner, 1)
    ).

counted(Owner, New) :-
    ( count(Owner, Count0) -> true ; Count0 = 0 ),
    Count is Count0+New,
    assertz(count(Owner, Count)),       % readers hold no mutex: new before old
    ignore(retract(count(Owner, Count0))).
