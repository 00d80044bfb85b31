:- module(typhon_fipa_limit,
          [ within/2                    % +Seconds, :Goal
          ]).
:- use_module('../../kernel/host', [alarm_in/3]).

/** <module> Time limits

Like call_with_time_limit/2, whose library may keep 9.0.4 from halting once it
is loaded.  This uses the alarms of hosts.

*Threading*: any thread, while a host runs.  The timer signals it.
*/

:- multifile
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

:- meta_predicate within(+, 0).

:- dynamic busy/2.                      % Key, Thread

%!  within(+Seconds, :Goal) is semidet.
%
%   Run Goal once.
%
%   @throws time_limit_exceeded

within(Seconds, Goal) :-
    flag(typhon_fipa_limit, Number, Number+1),
    atom_concat('fipa ', Number, Key),
    thread_self(Me),
    setup_call_cleanup(
        assertz(busy(Key, Me)),
        ( alarm_in(Seconds, Key, fipa_late),
          once(Goal) ),
        retractall(busy(Key, _))).

%   A signal that comes just before a thread blocks does not wake it.

typhon_scheduler:fire(Key, fipa_late) :-
    !,
    (   busy(Key, Thread)
    ->  catch(thread_signal(Thread, typhon_fipa_limit:late(Key)),
              error(_, _), true),
        alarm_in(0.5, Key, fipa_late)
    ;   true
    ).

typhon_scheduler:over(Key, fipa_late) :-
    \+ busy(Key, _).

late(Key) :-
    (   retract(busy(Key, _))
    ->  throw(time_limit_exceeded)
    ;   true
    ).
