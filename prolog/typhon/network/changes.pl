:- module(typhon_changes,
          [ dynamics_start/4,           % +State, +Clock, :OnChange, -Dynamics
            dynamics_kept/3,            % +Dynamics, +Seconds, -Then
            dynamics_again/5,           % +Name, +Then, +Clock, :OnChange,
                                        % -Dynamics
            dynamics_stop/1             % +Dynamics
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../kernel/base/monotonic', [poll_within/2]).
:- use_module('../kernel/base/error_text', [print_error/2]).
:- use_module('../kernel/host', [alarm_set/3, scheduler_call/1]).
:- use_module(dynamics, [dynamics_event/4]).

/** <module> Links of a network change over time

The decisions of module `dynamics` are pure: in real time, runs differ only by
the delay with which a thread applies the events.

The next event, with the state after it, is the only message of a queue: copying
a term of some thousand cells there is five times as fast as into a clause.

*Threading*: one alarm is set for the next event of a whole network; a worker
applies it, and calls OnChange, which reaches hosts in other processes.
*/

:- meta_predicate
    dynamics_start(+, +, 1, -),
    dynamics_again(+, +, +, 1, -).

:- multifile
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2,
    prolog:message//1.

:- dynamic
    dynamics/3,                 % Dynamics, Clock, OnChange
    due/2,                      % Dynamics, Queue: holds the next event
    changing/2.                 % Dynamics, Thread: is applying changes

%!  dynamics_start(+State, +Clock, :OnChange, -Dynamics) is det.
%
%   Apply the events of State when they are due. Clock is clock(Epoch, Rate),
%   and Epoch is the start of State. OnChange is called with each change. An
%   error in it is printed, and the next change follows. Dynamics is a handle
%   for dynamics_stop/1.

dynamics_start(State, Clock, OnChange, Dynamics) :-
    new_name(Dynamics),
    begin(Dynamics, Clock, OnChange),
    next(Dynamics, State).

new_name(Dynamics) :-
    repeat,
    flag(typhon_dynamics, N, N+1),
    atom_concat(typhon_dynamics_, N, Dynamics),
    \+ dynamics(Dynamics, _, _),
    !.

begin(Dynamics, Clock, OnChange) :-
    message_queue_create(Queue),
    assertz(due(Dynamics, Queue)),
    assertz(dynamics(Dynamics, Clock, OnChange)).

next(Dynamics, State0) :-
    (   dynamics(Dynamics, clock(Epoch, Rate), _),
        dynamics_event(State0, Time, Changes, State)
    ->  due(Dynamics, Queue),
        thread_send_message(Queue, then(Changes, State)),
        Stamp is Epoch+Time/Rate,
        alarm_set(Stamp, Dynamics, links)
    ;   true
    ).

%!  dynamics_kept(+Dynamics, +Seconds, -Then) is semidet.
%
%   Then is the next event. Waits while changes are being applied, and fails if
%   that takes longer than Seconds.

dynamics_kept(Dynamics, Seconds, Then) :-
    await_change(Dynamics, Seconds),
    due(Dynamics, Queue),
    thread_peek_message(Queue, Then).

await_change(Dynamics, Seconds) :-
    poll_within(Seconds, \+ changing(Dynamics, _)).

%!  dynamics_again(+Name, +Then, +Clock, :OnChange, -Dynamics) is det.
%
%   Restore dynamics whose next event is Then, as of dynamics_kept/3. The caller
%   sets the alarm for this event. Dynamics is Name, if no dynamics have that
%   name.

dynamics_again(Name, Then, Clock, OnChange, Dynamics) :-
    (   dynamics(Name, _, _)
    ->  new_name(Dynamics)
    ;   Dynamics = Name
    ),
    begin(Dynamics, Clock, OnChange),
    due(Dynamics, Queue),
    thread_send_message(Queue, Then).

typhon_scheduler:fire(Dynamics, links) :-
    !,
    scheduler_call(typhon_changes:step(Dynamics)).

typhon_scheduler:over(Dynamics, links) :-
    \+ dynamics(Dynamics, _, _).

%   Runs in a worker: changes of hosts in other processes may take long.  The next
%   step may begin in another worker before this one has ended.

step(Dynamics) :-
    thread_self(Me),
    setup_call_cleanup(
        assertz(changing(Dynamics, Me)),
        catch(change_links(Dynamics), stop_changing, true),
        ( nb_setval(typhon_changing, none),
          retractall(changing(Dynamics, Me)) )).

change_links(Dynamics) :-
    nb_setval(typhon_changing, Dynamics),
    (   dynamics(Dynamics, _, OnChange),
        due(Dynamics, Queue),
        thread_get_message(Queue, then(Changes, State), [timeout(0)])
    ->  forall(member(Change, Changes), apply_change(OnChange, Change)),
        next(Dynamics, State)
    ;   true
    ).

apply_change(OnChange, Change) :-
    debug(typhon(network), 'dynamics: ~p', [Change]),
    catch(call(OnChange, Change), error(Formal, Context),
          print_error(warning, error(Formal, Context))),
    !.
apply_change(_, Change) :-
    print_message(warning, typhon(link_not_changed(Change))).

%!  dynamics_stop(+Dynamics) is det.
%
%   Stop Dynamics: no change begins after this. A change that hangs, because a
%   process hangs, is interrupted after a second.

dynamics_stop(Dynamics) :-
    retractall(dynamics(Dynamics, _, _)),
    call_cleanup(end_change(Dynamics), forget(Dynamics)).

forget(Dynamics) :-
    (   retract(due(Dynamics, Queue))
    ->  message_queue_destroy(Queue)
    ;   true
    ).

end_change(Dynamics) :-
    (   await_change(Dynamics, 1)
    ->  true
    ;   forall(changing(Dynamics, Thread),
               catch(thread_signal(Thread, typhon_changes:interrupt(Dynamics)),
                     error(existence_error(_, _), _), true)),
        end_change(Dynamics)
    ).

%   The signal may arrive after the change; then it has no effect.

interrupt(Dynamics) :-
    (   nb_current(typhon_changing, Dynamics)
    ->  nb_setval(typhon_changing, none),
        throw(stop_changing)
    ;   true
    ).

prolog:message(typhon(link_not_changed(Change))) -->
    [ 'The links of the network could not be changed: ~p'-[Change] ].
