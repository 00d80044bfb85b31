:- module(typhon_own_thread,
          [ in_own_thread/1,            % :Goal
            uncounted/1,                % :Goal
            own_thread_start/0,
            own_thread_stop/0,
            stop_steps/1,                       % :Steps
            stop_thread/1,                      % +Thread
            abort_quietly/0,
            aborted_quietly/0
          ]).

/** <module> How modules and threads are stopped

In SWI-Prolog 9.0.4 a thread that runs a cleanup handler, sig_atomic/1 or a
directive leaves its signals pending, also those of garbage collection. If one
is pending, a wait with a deadline that expires does not end: it spins for ever,
even with timeout(0). Programs often stop hosts in cleanup handlers, and
stopping has to wait. So code that stops something does it in a thread of its
own.

Stopping must also be possible when no more threads can be created: so a helper
thread is ready while hosts run.

*Threading*: any thread. thread_join/2 and waits without a deadline are safe in
all of them. Goals in a thread of their own, or in the helper, call nested
goals directly: so the helper never waits for itself.
*/

:- use_module(server,
              [ server_answer/2, server_call/4, server_leave/1, server_start/4,
                server_stop/1 ]).

:- use_module(library(lists), [member/2]).
:- use_module(error_text, [print_error/2]).

:- meta_predicate
    in_own_thread(0),
    uncounted(0),
    stop_steps(:).

:- dynamic
    helper/1,                   % Server
    asked/1.                    % Server: a goal was given to it

%!  in_own_thread(:Goal) is semidet.
%
%   As once(Goal), in a thread of its own. No bindings come back. If the
%   caller is interrupted while waiting, Goal runs on.

in_own_thread(Goal) :-
    in_place,
    !,
    once(Goal).
in_own_thread(Goal) :-
    flag(typhon_own_thread, N, N+1),    % one that is about to end has its alias
    atom_concat(typhon_stopper_, N, Alias),
    catch(thread_create(typhon_own_thread:alone(Goal), Thread,
                        [alias(Alias)]),
          error(_, _), fail),           % too many, or the process ends
    !,
    catch(thread_join(Thread, Status), Interrupt,
          ( thread_detach(Thread),
            throw(Interrupt) )),
    conclude(Status).
in_own_thread(Goal) :-
    ask_helper(Goal, Result),
    !,
    Result == true.
in_own_thread(Goal) :-
    once(Goal).

%   in_place is semidet: called from such a thread, or there are no threads.

in_place :-
    nb_current(typhon_own_thread, true),
    !.
in_place :-
    current_prolog_flag(threads, false).

alone(Goal) :-
    nb_setval(typhon_own_thread, true),
    call(Goal).

%!  uncounted(:Goal) is semidet.
%
%   As in_own_thread/1, and the inferences of Goal do not count for the limit of
%   the caller, unless that is the main thread: from version 10, thread_join/2
%   adds those of the thread.  So the thread is not joined, and may exist a little
%   longer than Goal runs; cells cannot begin then, see set_prolog_flag/2, threads.

uncounted(Goal) :-
    (   in_place
    ;   thread_self(main)
    ),
    !,
    in_own_thread(Goal).
uncounted(Goal) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        ( ask_thread(Goal, Queue),
          thread_get_message(Queue, Answer) ),
        message_queue_destroy(Queue)),
    conclude(Answer).

ask_thread(Goal, Queue) :-
    Died = exception(error(system_error('a thread died'), _)),
    catch(thread_create(typhon_own_thread:answered(alone(Goal), Queue), _,
                        [ detached(true),
                          at_exit(typhon_own_thread:say(Queue, Died)) ]),
          error(_, _), fail),
    !.
ask_thread(Goal, Queue) :-
    answered(Goal, Queue).

answered(Goal, Queue) :-
    (   catch(Goal, Error, true)
    ->  ( var(Error) -> Answer = true ; Answer = exception(Error) )
    ;   Answer = false
    ),
    say(Queue, Answer).

%   The first answer counts.  When the thread ends, the last one is sent, which
%   matters only if there was no other.

say(Queue, Answer) :-
    catch(thread_send_message(Queue, Answer), error(_, _), true).

conclude(Status) :-
    (   Status = exception(Error)
    ->  throw(Error)
    ;   Status == true
    ).

                /*******************************
                *           THE HELPER         *
                *******************************/

%!  own_thread_start is det.

own_thread_start :-
    current_prolog_flag(threads, false),
    !.
own_thread_start :-
    server_start(helper, typhon_own_thread:help, idle, Helper),
    assertz(helper(Helper)).

%!  own_thread_stop is det.
%
%   Stop the helper after the goal that it runs. That goal may be this call, or
%   may wait for the thread that calls this: so this does not wait for the
%   helper if a goal was ever given to it.

own_thread_stop :-
    (   with_mutex(typhon_own_thread, retract(helper(Helper)))
    ->  (   retract(asked(Helper))
        ->  server_leave(Helper)
        ;   server_stop(Helper)
        )
    ;   true
    ).

%   ask_helper(:Goal, -Result): fails if there is no helper.

ask_helper(Goal, Result) :-
    with_mutex(typhon_own_thread,
               ( helper(Helper),
                 retractall(asked(Helper)),
                 assertz(asked(Helper)) )),
    server_call(Helper, Goal, inf, Result).

:- public help/3.

help(begin, State, State) :-
    nb_setval(typhon_own_thread, true).
help(call(Goal, Caller), State, State) :-
    (   call(Goal)
    ->  Result = true
    ;   Result = false
    ),
    server_answer(Caller, Result).

                /*******************************
                *             STEPS            *
                *******************************/

%!  stop_steps(:Steps:list) is det.
%
%   Do all Steps, in this order, whatever they raise: nothing must be left half
%   stopped.  A step is a goal, or each(Hook): every clause of Hook is a step.
%   Errors are printed.

stop_steps(Module:Steps) :-
    forall(member(Step, Steps), stop_step(Step, Module)).

stop_step(each(Hook), Module) :-
    !,
    forall(clause(Module:Hook, Body), stop_step(Body, Module)).
stop_step(Goal, Module) :-
    catch(forall(Module:Goal, true), error(Formal, Context),
          print_error(error, error(Formal, Context))).

                /*******************************
                *       THREADS THAT END       *
                *******************************/

%!  stop_thread(+Thread) is det.
%
%   Join Thread, which was asked to end. If it has not ended after a second, it
%   is aborted in the middle of its goal, repeatedly. After another second this
%   prints a warning and detaches the thread.

stop_thread(Thread) :-
    stop_thread(1000, Thread).

stop_thread(_, Thread) :-
    \+ thread_property(Thread, status(running)),
    !,
    thread_join(Thread, _).
stop_thread(0, Thread) :-
    !,
    print_message(warning, typhon(stuck_worker(Thread))),
    thread_detach(Thread).
stop_thread(Tries, Thread) :-
    sleep(0.002),
    interrupt(Tries, Thread),
    Tries1 is Tries-1,
    stop_thread(Tries1, Thread).

interrupt(Tries, Thread) :-
    (   Tries =< 500,
        Tries mod 50 =:= 0
    ->  catch(thread_signal(Thread,
                            typhon_own_thread:abort_quietly), error(_, _), true)
    ;   true
    ).

%!  abort_quietly
%
%   As abort/0, which no goal can catch for good, but keeps input that was typed
%   ahead. From 9.3 until 10 the exception depends on the version, so abort/0
%   raises it.

abort_quietly :-
    nb_setval(typhon_aborted, true),
    current_prolog_flag(version, Version),
    (   Version < 90300
    ->  throw('$aborted')
    ;   Version >= 100000
    ->  throw(unwind(abort))
    ;   abort
    ).

%!  aborted_quietly is semidet.
%
%   abort_quietly/0 has aborted what this thread did; true once.

aborted_quietly :-
    nb_current(typhon_aborted, true),
    nb_setval(typhon_aborted, false).
