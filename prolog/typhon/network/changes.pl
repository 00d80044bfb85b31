:- module(typhon_changes,
          [ dynamics_start/4,           % +State, +Clock, :OnChange, -Dynamics
            dynamics_kept/3,            % +Dynamics, +Seconds, -Then
            dynamics_again/5,           % +Name, +Then, +Clock, :OnChange,
                                        % -Dynamics
            dynamics_stop/1             % +Dynamics
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../kernel/base/error_text', [print_error/2]).
:- use_module('../kernel/host', [alarm_set/3, scheduler_call/1]).
:- use_module(dynamics, [dynamics_event/4]).

/** <module> Links change when their time has come

The decisions of module `dynamics` are pure: the times of a run differ, in
real time, only by how late the thread is that applies them.

The next event, and the state after it, is the one message of a queue: a term
of some thousand cells is copied there five times as quickly as it would be
into a clause.

*Threading*: the next event of a whole network is an alarm; a worker does
what is due. Hosts in other processes are reached from there by what OnChange
does.
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
    due/2,                      % Dynamics, Queue: of the next event
    changing/2,                 % Dynamics, Thread: makes changes just now
    stopping/2.                 % Dynamics, Queue: hears of the end of that

%!  dynamics_start(+State, +Clock, :OnChange, -Dynamics) is det.
%
%   Carries the events of State out, each when the clock that started with
%   the State says so: Clock is clock(Epoch, Rate), Epoch the beginning.
%   OnChange is called with each change. An error in it is printed, and the
%   next change follows. Dynamics is for dynamics_stop/1.

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
%!  dynamics_again(+Name, +Then, +Clock, :OnChange, -Dynamics) is det.
%
%   What comes next, or `none`: it does so when the alarm goes off, which the
%   caller sets.  Fails if changes are made just now, for longer
%   than Seconds.  Dynamics has that Name, if it is free.

dynamics_kept(Dynamics, Seconds, Then) :-
    setup_call_cleanup(
        ( message_queue_create(Done),
          assertz(stopping(Dynamics, Done)) ),
        (   changing(Dynamics, _)
        ->  thread_get_message(Done, done, [timeout(Seconds)])
        ;   true
        ),
        ( retractall(stopping(Dynamics, Done)),
          message_queue_destroy(Done) )),
    due(Dynamics, Queue),
    (   thread_peek_message(Queue, Then0)
    ->  Then = Then0
    ;   Then = none
    ).

dynamics_again(Name, Then, Clock, OnChange, Dynamics) :-
    (   dynamics(Name, _, _)
    ->  new_name(Dynamics)
    ;   Dynamics = Name
    ),
    begin(Dynamics, Clock, OnChange),
    due(Dynamics, Queue),
    (   Then == none
    ->  true
    ;   thread_send_message(Queue, Then)
    ).

typhon_scheduler:fire(Dynamics, links) :-
    !,
    scheduler_call(typhon_changes:step(Dynamics)).

typhon_scheduler:over(Dynamics, links) :-
    \+ dynamics(Dynamics, _, _).

%   In a worker: what is done for hosts of other processes may take long.

step(Dynamics) :-
    thread_self(Me),
    setup_call_cleanup(
        assertz(changing(Dynamics, Me)),
        catch(change_links(Dynamics), stop_changing, true),
        ( nb_setval(typhon_changing, none),
          retractall(changing(Dynamics, _)),
          forall(stopping(Dynamics, Queue), thread_send_message(Queue, done))
        )).

change_links(Dynamics) :-
    nb_setval(typhon_changing, Dynamics),
    (   dynamics(Dynamics, _, OnChange),
        due(Dynamics, Queue),
        thread_get_message(Queue, then(Changes, State), [timeout(0)])
    ->  forall(member(Change, Changes), make(OnChange, Change)),
        next(Dynamics, State)
    ;   true
    ).

make(OnChange, Change) :-
    debug(typhon(network), 'dynamics: ~p', [Change]),
    catch(call(OnChange, Change), error(Formal, Context),
          print_error(warning, error(Formal, Context))),
    !.
make(_, Change) :-
    print_message(warning, typhon(link_not_changed(Change))).

%!  dynamics_stop(+Dynamics) is det.
%
%   No change begins after this. One that hangs, because a process does, is
%   interrupted after a second.

dynamics_stop(Dynamics) :-
    retractall(dynamics(Dynamics, _, _)),
    setup_call_cleanup(
        ( message_queue_create(Queue),
          assertz(stopping(Dynamics, Queue)) ),
        await_change(Dynamics, Queue),
        ( retractall(stopping(Dynamics, _)),
          message_queue_destroy(Queue),
          forget(Dynamics) )).

forget(Dynamics) :-
    (   retract(due(Dynamics, Queue))
    ->  message_queue_destroy(Queue)
    ;   true
    ).

await_change(Dynamics, Queue) :-
    (   \+ changing(Dynamics, _)
    ->  true
    ;   thread_get_message(Queue, done, [timeout(1)])
    ->  true
    ;   forall(changing(Dynamics, Thread),
               catch(thread_signal(Thread, typhon_changes:interrupt(Dynamics)),
                     error(existence_error(_, _), _), true)),
        await_change(Dynamics, Queue)
    ).

%   The signal may come when the change is over.

interrupt(Dynamics) :-
    (   nb_current(typhon_changing, Dynamics)
    ->  nb_setval(typhon_changing, none),
        throw(stop_changing)
    ;   true
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(link_not_changed(Change))) -->
    [ 'The links of the network could not be changed: ~p'-[Change] ].
