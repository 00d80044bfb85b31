:- module(typhon_monotonic,
          [ monotonic_time/1,           % -Now
            deadline/2,                 % +Seconds, -Deadline
            wait_before/2,              % +Deadline, :Wait
            wait_within/2,              % +Seconds, :Wait
            poll_within/2,              % +Seconds, :Goal
            monotonic_start/0,
            monotonic_stop/0
          ]).

/** <module> Time that setting the clock of the computer does not change

All waits, deadlines and durations of the platform go by monotonic_time/1.
get_time/1 is for dates that people or other programs read, and for files.

SWI-Prolog has no such clock.  The system has one in `/proc/uptime`, but reading
that costs a hundred times as much as get_time/1.  So a time of day is compared
with the uptime, and counts as verified for a tenth of a second: any that is
earlier or later is compared again.  Where there is no such file the clock does
not go back, but goes forward with the time of day.

The waits of Prolog end at a time of day.  If that is set forward they end too
early, and wait_before/2 waits again.  If it is set back they go on for too
long: a thread that sleeps, which goes by the clock of the system, looks four
times a second whether the time of day was set, and then interrupts them.

*Threading*: any thread.  As all waits with a deadline, those of wait_before/2
must not be in a cleanup handler, see typhon_own_thread.
*/

:- meta_predicate
    wait_before(+, 1),
    wait_within(+, 1),
    poll_before(+, 0),
    poll_within(+, 0).

:- dynamic
    verified/2,                 % Middle, Offset: within 50 ms of Middle, time
                                % is the time of day minus Offset
    ahead/1,                    % Seconds from the uptime to the time, or `none`
    ticker/1.                   % Thread

:- set_prolog_flag(optimise, true).     % arithmetic without calls

                /*******************************
                *             TIME             *
                *******************************/

%!  monotonic_time(-Now:float) is det.
%
%   The time of day when this process began, or the first of those that started
%   each other on this computer, plus the seconds since.

monotonic_time(Now) :-
    get_time(Wall),
    verified(Middle, Offset),
    abs(Wall-Middle) =< 0.05,
    !,
    Now is Wall-Offset.
monotonic_time(Now) :-
    with_mutex(typhon_monotonic, verify(Wall, Offset)),
    Now is Wall-Offset.

%!  deadline(+Seconds, -Deadline) is det.
%
%   Deadline is a monotonic_time/1, Seconds from now, or `inf`.

deadline(inf, inf) :-
    !.
deadline(Seconds, Deadline) :-
    monotonic_time(Now),
    Deadline is Now+Seconds.

verify(Wall, Offset) :-
    ( verified(Middle, Offset0) -> true ; Middle = 0, Offset0 = 0 ),
    ( ahead(Ahead) -> true ; choose_ahead(Ahead) ),
    error_now(Ahead, Middle, Offset0, Wall0, Error),
    (   abs(Error) =< 0.03              % the uptime is a multiple of 10 ms
    ->  Wall = Wall0,
        Offset = Offset0
    ;   corrected(Ahead, Wall0-(Offset0+Error), Wall, Offset),
        flag(typhon_clock_set, Times, Times+1)
    ),
    Middle1 is Wall+0.05,
    asserta(verified(Middle1, Offset), New),
    forall(( clause(verified(_, _), true, Old), Old \== New ), erase(Old)).

error_now(Ahead, _, Offset, Wall, Error) :-
    number(Ahead),
    uptime(Wall, Uptime),
    !,
    Error is Wall-Offset-Uptime-Ahead.
error_now(_, Middle, _, Wall, Error) :-
    get_time(Wall),
    Error is min(0, Wall-Middle+0.05).

corrected(Ahead, _, Wall, Offset) :-
    number(Ahead),
    uptime_tick(Wall, Uptime),
    !,
    Offset is Wall-Uptime-Ahead.
corrected(_, Wall-Offset, Wall, Offset).

%   Child processes have the clock of this one.

choose_ahead(Ahead) :-
    (   getenv('TYPHON_CLOCK', Text),
        atom_number(Text, Ahead0)
    ->  Ahead = Ahead0
    ;   uptime_tick(Wall, Uptime)
    ->  Ahead is Wall-Uptime,
        setenv('TYPHON_CLOCK', Ahead)
    ;   Ahead = none
    ),
    assertz(ahead(Ahead)).

%   uptime(-Wall, -Uptime) is semidet.
%
%   The readings are not far apart: the thread can lose the processor, or the
%   clock be set, between two.

uptime(Wall, Uptime) :-
    between(1, 1000, _),
    get_time(Before),
    catch(read_uptime(Text), error(_, _), Text = ""),
    get_time(Wall),
    Wall-Before >= 0,
    Wall-Before < 0.001,
    !,
    number_string(Uptime, Text).

read_uptime(Text) :-
    setup_call_cleanup(open('/proc/uptime', read, In),
                       read_string(In, " ", "", _, Text),
                       close(In)).

%   uptime_tick(-Wall, -Uptime) is semidet.
%
%   The uptime has just changed, so it is exact.  Under load the thread may lose
%   the processor whenever it changes: then the error is up to 10 ms.

uptime_tick(Wall, Uptime) :-
    uptime(Wall0, Uptime0),
    uptime_tick(2000, Wall0, Uptime0, Wall, Uptime).

uptime_tick(Tries, Wall0, Uptime0, Wall, Uptime) :-
    uptime(Wall1, Uptime1),
    (   ( Tries =:= 0
        ; Uptime1 > Uptime0,
          Wall1-Wall0 >= 0,
          Wall1-Wall0 < 0.001
        )
    ->  Wall = Wall1,
        Uptime = Uptime1
    ;   Tries1 is Tries-1,
        uptime_tick(Tries1, Wall1, Uptime1, Wall, Uptime)
    ).

                /*******************************
                *             WAITS            *
                *******************************/

%!  wait_before(+Deadline, :Wait) is semidet.
%!  wait_within(+Seconds, :Wait) is semidet.
%
%   As once(call(Wait, Options)), where Wait is thread_get_message/3 or
%   thread_send_message/3 without its last argument.  Fails at Deadline, a
%   monotonic_time/1 or `inf`.  If Deadline has passed this fails at once; with 0
%   Seconds it takes a message that is there.

wait_before(inf, Wait) :-
    !,
    call(Wait, []),
    !.
wait_before(Deadline, Wait) :-
    monotonic_time(Now),
    Left is Deadline-Now,
    timed(Left, Deadline, Wait).

wait_within(Seconds, Wait) :-
    deadline(Seconds, Deadline),
    (   Deadline == inf
    ->  wait_before(inf, Wait)
    ;   timed(Seconds, Deadline, Wait)
    ).

%   The system may not support very late times.

timed(Left, Deadline, Wait) :-
    Most is min(86400, Left),
    (   catch(call(Wait, [timeout(Most)]), typhon_clock_set, fail)
    ->  true
    ;   current_prolog_flag(threads, true),
        monotonic_time(Now),
        Now < Deadline,
        More is Deadline-Now,
        timed(More, Deadline, Wait)
    ).

%!  poll_within(+Seconds, :Goal) is semidet.
%
%   Call Goal every 10 ms until it succeeds.  Fails if it has not after Seconds.
%   For waits that are rare, and in whose place each change would have to look
%   for a thread that waits.  Signals do not wake thread_wait/2.

poll_within(Seconds, Goal) :-
    deadline(Seconds, Deadline),
    poll_before(Deadline, Goal).

poll_before(Deadline, Goal) :-
    (   call(Goal)
    ->  true
    ;   monotonic_time(Now),
        Now < Deadline,
        sleep(0.01),
        poll_before(Deadline, Goal)
    ).

%   Runs as a signal.  Where Prolog handles it within a predicate that waits,
%   that has taken no message: nothing is lost if it is interrupted.

interrupt_wait :-
    prolog_current_frame(Frame),
    (   ancestor(2, Frame, wait, Waiting),
        ancestor(4, Waiting, restart, _)
    ->  throw(typhon_clock_set)
    ;   true
    ).

%   ancestor(+Depth, +Frame, +Role, -Ancestor): of at most that Depth.

ancestor(Depth0, Frame, Role, Ancestor) :-
    Depth0 > 0,
    prolog_frame_attribute(Frame, parent, Parent),
    prolog_frame_attribute(Parent, predicate_indicator, Name),
    (   role(Name, Role)
    ->  Ancestor = Parent
    ;   Depth is Depth0-1,
        ancestor(Depth, Parent, Role, Ancestor)
    ).

role(system:thread_get_message/3, wait).
role(system:thread_send_message/3, wait).
role(timed/3, restart).

                /*******************************
                *           THE TICKER          *
                *******************************/

%!  monotonic_start is det.
%!  monotonic_stop is det.
%
%   Start and stop the thread that interrupts waits.

monotonic_start :-
    current_prolog_flag(threads, false),
    !.
monotonic_start :-
    flag(typhon_clock, N, N+1),         % one that is about to end has its alias
    atom_concat(typhon_clock_, N, Thread),
    assertz(ticker(Thread)),
    get_flag(typhon_clock_set, Times),
    catch(thread_create(look(Thread, Times), _,
                        [alias(Thread)]), Ball,
          ( retractall(ticker(Thread)), throw(Ball) )).

monotonic_stop :-
    (   retract(ticker(Thread))
    ->  catch(thread_signal(Thread, throw(typhon_clock_end)),
              error(existence_error(_, _), _),
              true),                    % it has seen that, and ended
        thread_join(Thread, _)
    ;   true
    ).

look(Thread, Times) :-
    catch(tick(Thread, Times, Times), typhon_clock_end, true).

%   tick(+Thread, +Before, +Last): how often time was corrected.  A signal that
%   comes just before a thread blocks does not wake it: so there are two.

tick(Thread, Before, Last) :-
    sleep(0.25),
    ticker(Thread),
    !,
    monotonic_time(_),
    get_flag(typhon_clock_set, Times),
    (   Times =:= Before
    ->  true
    ;   forall(( thread_property(Other, status(running)), Other \== Thread ),
               catch(thread_signal(Other, typhon_monotonic:interrupt_wait),
                     error(_, _), true))
    ),
    tick(Thread, Last, Times).
tick(_, _, _).
