:- module(typhon_nxt_old_state,
          [ old_set/3,                  % +Name, +Key, +Value
            old_value/4,                % +Name, +Key, +Default, -Value
            old_clear/2                 % +Name, ?Key
          ]).

/** <module> What the interface of SWI-PRO-NXT remembers of a brick

Speeds, accelerations, lamps, offsets, and replies not yet read.

*Threading*: any thread.
*/

:- dynamic
    value/3.                    % Name, Key, Value

%!  old_set(+Name, +Key, +Value) is det.
%!  old_value(+Name, +Key, +Default, -Value) is det.
%!  old_clear(+Name, ?Key) is det.

old_set(Name, Key, Value) :-
    with_mutex(typhon_nxt_old,
               ( retractall(value(Name, Key, _)),
                 assertz(value(Name, Key, Value)) )).

old_value(Name, Key, Default, Value) :-
    (   value(Name, Key, Value0)
    ->  Value = Value0
    ;   Value = Default
    ).

old_clear(Name, Key) :-
    retractall(value(Name, Key, _)).
