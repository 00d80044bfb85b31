:- module(typhon_control,
          [ control/1,                  % ?Head
            special/2                   % ?Head, ?Kind
          ]).

/** <module> Goals that the machine does not look up

*Threading*: pure.
*/

%!  control(?Head) is nondet.
%
%   Head is the head of a control predicate: the machine stops at it.

control(Head) :-
    special(Head, control).

%!  special(?Head, ?Kind) is nondet.
%
%   Kind is `control`, `call` (call/N), or `checked` (see typhon_checked).

term_expansion(special_of(Name, Kind), Specials) :-
    findall(special(Goal, Kind),
            ( between(1, 16, Arity), functor(Goal, Name, Arity) ),
            Specials).

special(move(_), control).
special(clone(_), control).
special(clone(_, _), control).
special(sleep(_), control).
special(receive(_), control).
special(receive(_, _), control).
special(dispose, control).
special(sleep_until(_), control).
special(receive_until(_, _, _), control).
special(receive_until(_, _), control).  % in old restore points
special('$fault'(_), control).          % stays as it was: see typhon_ending
special_of(call, call).                 % with more than one argument
special_of('$checked', checked).        % see typhon_checked
