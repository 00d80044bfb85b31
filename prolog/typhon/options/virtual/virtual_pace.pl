:- module(typhon_virtual_pace,
          [ pace/1,                     % -Pace
            pace_set/2,                 % +Pace, +Reply
            pace_deadline/4,            % +Next, +Now, -Reached, -Deadline
            pace_slice/1,               % +Seconds
            pace_slice_over/2,          % +Deadline, -When
            pace_slice_end/0
          ]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).

/** <module> The pace of virtual time

Without a pace time jumps to whatever is due next as soon as no agent is ready.
A pace makes it wait before each jump:

  | rate(Speed) | Speed virtual seconds pass in a real second; `inf`: no limit |
  | paused      | until there is another pace                                |
  | step        | jumps once, is then `paused`                               |

Without threads time may also run for a slice of real time, after which the
caller handles other events.

A pace changes neither what is done nor its order.

*Threading*: the thread of virtual time sets it, and reads it with the rest; any
thread may call pace/1.
*/

:- dynamic
    pace/1,                     % Pace: rate(Speed), rate(Speed, Real, Time),
                                % paused(Reply) or step(Reply)
    slice/1.                    % End: a monotonic_time/1

%!  pace(-Pace) is semidet.
%
%   Virtual time has a pace, see the comments of the facts.

%!  pace_set(+Pace, +Reply) is det.
%
%   From now on there is Pace, or none if that is `free`.  The queue Reply gets a
%   message when that is so; for `step` after the step, when no agent is ready.
%   Reply may be `none`.

pace_set(free, Reply) =>
    retractall(pace(_)),
    answer(Reply).
pace_set(rate(Speed), Reply) =>
    becomes(rate(Speed)),
    answer(Reply).
pace_set(paused, Reply) =>
    becomes(paused(none)),
    answer(Reply).
pace_set(step, Reply) =>
    becomes(step(Reply)).

becomes(Pace) :-
    retractall(pace(_)),
    assertz(pace(Pace)).

answer(none) :-
    !.
answer(Reply) :-                        % its owner may have given up
    catch(thread_send_message(Reply, set), error(existence_error(_, _), _),
          true).

%!  pace_deadline(+Next, +Now, -Reached, -Deadline) is semidet.
%
%   Time may not jump from Now to Next, which may be `inf`, before Deadline, a
%   monotonic_time/1 or `inf`; meanwhile it is Reached.  Fails if it may jump.

pace_deadline(_, Now, Now, End) :-
    slice(End),
    monotonic_time(Real),
    Real >= End,
    !.
pace_deadline(Next, Now, Reached, Deadline) :-
    \+ ( number(Next), Next =< Now ),
    pace(Pace),
    waits(Pace, Next, Now, Reached, Deadline).

waits(paused(Reply), _, Now, Now, inf) :-
    rest(Reply).
waits(step(Reply), inf, Now, Now, inf) :-
    !,
    rest(Reply).
waits(step(Reply), _, _, _, _) :-
    becomes(paused(Reply)),
    fail.
waits(rate(_), inf, Now, Now, inf) :-
    !.
waits(rate(inf), _, _, _, _) :-
    !,
    fail.
waits(rate(Speed), Next, Now, Reached, Deadline) :-
    monotonic_time(Real),
    begun(Speed, Real, Now, Next, Reached, Deadline).
waits(rate(_, _, _), inf, Now, Now, inf) :-
    !.
waits(rate(Speed, Real0, Time0), Next, Now, Reached, Deadline) :-
    monotonic_time(Real),
    Due is Real0+(Next-Time0)/Speed,
    (   Real < Due
    ->  Reached is max(Now, Time0+(Real-Real0)*Speed),
        Deadline is min(Due, Real+0.1)
    ;   Real > Due+0.5                  % what was missed is not made up for
    ->  begun(Speed, Real, Now, Next, Reached, Deadline)
    ).

begun(Speed, Real, Now, Next, Now, Deadline) :-
    becomes(rate(Speed, Real, Now)),
    Deadline is min(Real+(Next-Now)/Speed, Real+0.1).

rest(Reply) :-
    becomes(paused(none)),
    answer(Reply).

                /*******************************
                *             SLICES           *
                *******************************/

%!  pace_slice(+Seconds) is det.
%!  pace_slice_end is det.
%
%   Begin a slice of Seconds: when that is over, pace_deadline/4 gives a time that
%   has passed.  There must be a pace.  End it before its time.

pace_slice(Seconds) :-
    monotonic_time(Now),
    End is Now+Seconds,
    assertz(slice(End)).

pace_slice_end :-
    retractall(slice(_)).

%!  pace_slice_over(+Deadline, -When) is semidet.
%
%   Time has to wait until Deadline: end the slice.  When is after(Seconds), or
%   `rests` if Deadline is `inf`.  Fails if there is no slice.

pace_slice_over(Deadline, When) :-
    retract(slice(_)),
    !,
    (   Deadline == inf
    ->  When = rests
    ;   monotonic_time(Now),
        Seconds is max(0, Deadline-Now),
        When = after(Seconds)
    ).
