:- module(typhon_cell_functors,
          [ functors_charged/3,         % +Owner, +Text, -Frame
            functors_left/1             % +Owner
          ]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(cell_acts, [cell_violation/1]).
:- use_module(cell_frames, [cell_text_term/2]).

/** <module> Limit of the functors that frames of cells create in this process

Prolog never frees a functor, nor the atom that is its name: 160 bytes each.  No
quota counts the functors of frames, so they are charged to the owner of the
agents of the cell, as long as the process lives.  Agents of an owner that has
exceeded the limit get no turns in cells.  One frame can hold some hundred
thousand functors, which are counted only after the frame has been read.

Other threads create functors as well.  So the functors of a frame are counted
if the process has more functors than before, and each is charged to an owner
once.

*Threading*: any thread; a mutex protects the tables.
*/

:- setting(typhon_cells:functors, positive_integer, 20 000,
           "Functors that the cells of an owner may bring into the process").

:- dynamic
    charged/3,                  % Name, Arity, Owner
    count/2.                    % Owner, Count: of functors charged to it

%!  functors_left(+Owner:atom) is semidet.
%
%   Owner has not exceeded the limit: its agents may have turns in cells.

functors_left(Owner) :-
    (   count(Owner, Count)
    ->  setting(typhon_cells:functors, Most),
        Count =< Most
    ;   true
    ).

%!  functors_charged(+Owner:atom, +Text:string, -Frame) is det.
%
%   Frame is the term that cell_text_term/2 reads from Text.  Its functors are
%   charged to Owner.
%
%   @error cell_violation(functors) Owner has exceeded the limit

functors_charged(Owner, Text, Frame) :-
    sig_atomic(read_and_charge(Owner, Text, Frame)),
    (   functors_left(Owner)
    ->  true
    ;   cell_violation(functors)
    ).

read_and_charge(Owner, Text, Frame) :-
    statistics(functors, Before),
    catch(cell_text_term(Text, Frame), Error,
          ( charge_unread(Owner, Before), throw(Error) )),
    statistics(functors, After),
    (   ( After > Before ; declares_predicates(Frame) )
    ->  with_mutex(typhon_cell_functors, charge(Frame, Owner))
    ;   true
    ).

%   After a syntax error the functors read so far are unknown, so all functors
%   that the process has created meanwhile are charged.

charge_unread(Owner, Before) :-
    statistics(functors, After),
    New is After-Before,
    with_mutex(typhon_cell_functors, counted(Owner, New)).

%   Loading the program of create/3 creates its functors, also from Name/Arity.

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

%   The last call is a tail call, so that a long list needs no deep stack.

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
    % functors_left/1 reads without the mutex, so the new fact precedes the old.
    assertz(count(Owner, Count)),
    ignore(retract(count(Owner, Count0))).
