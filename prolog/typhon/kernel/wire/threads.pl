:- module(typhon_threads,
          [ wire_thread_create/3,       % :Goal, +Name, -Thread
            wire_thread_create/4,       % :Goal, +Name, -Thread, :Before
            wire_thread_running/1,      % +Thread
            wire_thread_end/2,          % +Thread, +Why
            wire_thread_signal/2,       % +Thread, +Why
            wire_thread_obey/1,         % +Why
            wire_thread_leaves/1,       % +Thread
            wire_thread_join/1,         % +Thread
            wire_threads_end/0,
            in_background/2,            % :Goal, +Name
            manager_start/2,            % :Handle, +State
            manager_stop/0,
            manager_notify/1,           % +Message
            in_manager/0
          ]).

/** <module> The threads of an endpoint, and their messages to the manager

Every thread of an endpoint is made here and is joined when it ends, so
that none outlives the endpoint. The alias of a thread names its role and its
peer, and has a unique number: so a signal or message for one thread never
reaches its successor. All threads report events, among them their ends, to
the connection manager, a server that exists while the endpoint runs.

*Threading*: wire_thread_join/1 is for the connection manager, any thread may
call the rest. The caller serializes start and stop of the manager.
*/

:- use_module('../base/error_text', [error_lines/3]).
:- use_module('../base/server',
              [server_cast/2, server_self/1, server_start/4, server_stop/1]).

:- meta_predicate
    wire_thread_create(0, +, -),
    wire_thread_create(0, +, -, 0),
    in_background(0, +),
    manager_start(3, +).

:- multifile
    typhon_reports:wakes/1,
    not_now/1,                          % Why: this thread will end later
    overdue/1.                          % Thread: release it, if it is lent

:- dynamic wire_thread/1.       % Thread

%!  wire_thread_create(:Goal, +Name, -Thread) is det.
%
%   As wire_thread_create/4, without Before.

wire_thread_create(Goal, Name, Thread) :-
    wire_thread_create(Goal, Name, Thread, true).

%!  wire_thread_create(:Goal, +Name, -Thread, :Before) is det.
%
%   Run Goal in a new thread; Name, `Role` or Role-Whom, goes into its
%   alias. Goal reports its own errors; the exception wire_thread_end(Why)
%   ends it quietly. Before is called in the present thread, when Thread exists
%   but has not begun.

wire_thread_create(Goal, Name, Thread, Before) :-
    thread_alias(Name, Alias),
    sig_atomic(create(Goal, Alias, Thread, Before)).

thread_alias(Role-Whom, Alias) :-
    !,
    flag(typhon_wire_thread, Number, Number+1),
    atomic_list_concat([typhon, Role, Whom, Number], '_', Alias).
thread_alias(Role, Alias) :-
    flag(typhon_wire_thread, Number, Number+1),
    atomic_list_concat([typhon, Role, Number], '_', Alias).

create(Goal, Alias, Thread, Before) :-
    thread_create(typhon_threads:work(Goal), Thread, [alias(Alias)]),
    assertz(wire_thread(Thread)),
    call(Before),
    thread_send_message(Thread, wire_thread_begin).

work(Goal) :-
    setup_call_cleanup(
        true,
        catch(( thread_get_message(wire_thread_begin),
                ignore(Goal) ),
              wire_thread_end(_),
              true),
        ended).

ended :-
    thread_self(Me),
    ignore(manager_notify(ended(Me))).

%!  in_background(:Goal, +Name) is det.
%
%   Run Goal in a new thread or, if none can be made, in the present one.

in_background(Goal, Name) :-
    catch(wire_thread_create(Goal, Name, _), error(_, _), ignore(Goal)).

%!  wire_thread_running(+Thread) is semidet.
%
%   Thread exists and has not ended.

wire_thread_running(Thread) :-
    catch(thread_property(Thread, status(running)),
          error(existence_error(_, _), _),
          fail).

%!  wire_thread_end(+Thread, +Why) is det.
%
%   Throw wire_thread_end(Why) in Thread, unless it has ended, and wait for
%   its end.

wire_thread_end(Thread, Why) :-
    insist(Thread, Why, 0.001),
    wire_thread_join(Thread).

%   A signal that comes just before the thread blocks in a system call does
%   not wake it: repeat the signal.

insist(Thread, Why, Wait) :-
    (   wire_thread(Thread),
        wire_thread_running(Thread)
    ->  wire_thread_signal(Thread, Why),
        sleep(Wait),
        (   Wait < 0.1
        ->  true
        ;   ignore(overdue(Thread))
        ),
        Wait1 is min(0.1, 2*Wait),
        insist(Thread, Why, Wait1)
    ;   true
    ).

%!  wire_thread_leaves(+Thread) is det.
%
%   Remove Thread from the endpoint, which will not end or join it.

wire_thread_leaves(Thread) :-
    retractall(wire_thread(Thread)).

%!  wire_thread_signal(+Thread, +Why) is det.
%
%   Throw wire_thread_end(Why) in Thread, unless it has ended or was signalled
%   before: a second exception would break off the clean-up after the first.

wire_thread_signal(Thread, Why) :-
    catch(thread_signal(Thread, typhon_threads:end_once(Why)),
          error(existence_error(_, _), _),
          true).

end_once(Why) :-
    (   nb_current(typhon_ending, true)
    ->  true
    ;   not_now(Why)
    ->  true
    ;   wire_thread_obey(Why)
    ).

%!  wire_thread_obey(+Why).
%
%   End this thread.

wire_thread_obey(Why) :-
    nb_setval(typhon_ending, true),
    throw(wire_thread_end(Why)).

%!  wire_thread_join(+Thread) is det.
%
%   Wait for the end of Thread.

wire_thread_join(Thread) :-
    (   retract(wire_thread(Thread))
    ->  catch(thread_join(Thread, Status),
              error(existence_error(thread, _), _),
              Status = true),           % Prolog halts, and has joined it
        report(Status)
    ;   true
    ).

report(exception(Error)) :-
    Error \= wire_thread_end(_),
    !,
    print_message(error, typhon(endpoint, thread_died(Error))).
report(_).

%!  wire_threads_end is det.
%
%   End and join all threads, whatever they do.

wire_threads_end :-
    forall(wire_thread(Thread), wire_thread_end(Thread, stopped)),
    (   wire_thread(_)
    ->  wire_threads_end
    ;   true
    ).

		 /*******************************
		 *          THE MANAGER         *
		 *******************************/

:- dynamic
    manager/1.                          % Server

%!  manager_start(:Handle, +State) is det.
%
%   Start the server of the manager, see typhon_server.

manager_start(Handle, State) :-
    server_start(connection_manager, Handle, State, Server),
    assertz(manager(Server)).

%!  manager_stop is det.
%
%   Stop the manager.  Messages that it has not handled are dropped.

manager_stop :-
    retract(manager(Server)),
    server_stop(Server).

%!  manager_notify(+Message) is semidet.
%
%   Send Message to the connection manager; fails if there is none.

manager_notify(Message) :-
    manager(Server),
    server_cast(Server, Message).

typhon_reports:wakes(Stamp) :-
    manager_notify(later(Stamp, typhon_reports:reports_due)).

%!  in_manager is semidet.
%
%   This is the thread of the connection manager, which must not wait.

in_manager :-
    server_self(Server),
    manager(Server).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, thread_died(Error))) -->
    [ 'Endpoint: a thread ended with an error: ' ],
    error_lines(Error).
