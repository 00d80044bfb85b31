:- module(allocation_faults,
          [ no_reservation_faults/1     % +Events
          ]).
:- use_module('../../agents/allocation/reservations', [reservation_faults/2]).

/** <module> Rejection of runs with reservation faults

*Threading*: pure.
*/

:- multifile
    prolog:error_message//1.

%!  no_reservation_faults(+Events) is det.
%
%   Events are the events of a run in which all tasks have ended.
%
%   @error reservation_faults(Faults) if a robot was reserved twice, or is
%   still reserved at the end

no_reservation_faults(Events) :-
    reservation_faults(Events, Faults),
    (   Faults == []
    ->  true
    ;   throw(error(reservation_faults(Faults), _))
    ).

prolog:error_message(reservation_faults(Faults)) -->
    [ 'Robots were reserved twice, or left reserved: ~p'-[Faults] ].
