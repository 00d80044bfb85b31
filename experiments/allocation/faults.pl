:- module(allocation_faults,
          [ no_reservation_faults/1     % +Events
          ]).
:- use_module('../../agents/allocation/reservations', [reservation_faults/2]).

/** <module> Runs with reservation faults are rejected

*Threading*: pure.
*/

:- multifile
    prolog:error_message//1.

%!  no_reservation_faults(+Events) is det.
%
%   Events are those of a run in which all is over.
%
%   @error reservation_faults(Faults) if a robot was reserved twice, or is
%   still held in the end

no_reservation_faults(Events) :-
    reservation_faults(Events, Faults),
    (   Faults == []
    ->  true
    ;   throw(error(reservation_faults(Faults), _))
    ).

prolog:error_message(reservation_faults(Faults)) -->
    [ 'Robots were reserved twice, or left reserved: ~p'-[Faults] ].
