:- module(typhon_own_thread,
          [ in_own_thread/1,                    % :Goal
            own_thread_start/0,
            own_thread_stop/0
          ]).

/** <module> What must not be done in a cleanup handler

In SWI-Prolog 9.0.4 a thread that runs a cleanup handler, sig_atomic/1 or a
directive leaves its signals pending. If one is, which garbage collection
alone sees to, then a wait with a deadline that expires does not end: it
spins for ever. Programs like to stop things in cleanup handlers, and
stopping has to wait. So whatever stops something does it in a thread of its
own.

Stopping must also be possible when no more threads can be made: while
hosts run, a helper stands by for that.

*Threading*: any thread. thread_join/2 and waits without a deadline are
sound in all of them. Goals in a thread of its own, or in the helper, need
no other: so the helper never waits for itself.
*/

:- meta_predicate
    in_own_thread(0).

:- dynamic
    helper/2,                   % Thread, Queue
    asked/1.                    % Queue of a helper that was asked for something

%!  in_own_thread(:Goal) is semidet.
%
%   As once(Goal), in a thread of its own. No bindings come back. If the
%   caller is interrupted while waiting, Goal runs on.

in_own_thread(Goal) :-
    nb_current(typhon_own_thread, true),
    !,
    once(Goal).
in_own_thread(Goal) :-
    alias(stopper, Alias),
    catch(thread_create(typhon_own_thread:alone(Goal), Thread,
                        [alias(Alias)]),
          error(resource_error(_), _), fail),
    !,
    catch(thread_join(Thread, Status), Interrupt,
          ( thread_detach(Thread),
            throw(Interrupt) )),
    conclude(Status).
in_own_thread(Goal) :-
    ask_helper(Goal, Status),
    !,
    conclude(Status).
in_own_thread(Goal) :-
    once(Goal).

%   There may be several of a role, and one that is about to end still has its name.

alias(Role, Alias) :-
    flag(typhon_own_thread, N, N+1),
    atomic_list_concat([typhon, Role, N], '_', Alias).

alone(Goal) :-
    nb_setval(typhon_own_thread, true),
    call(Goal).

conclude(Status) :-
    (   Status = exception(Error)
    ->  throw(Error)
    ;   Status == true
    ).

                /*******************************
                *           THE HELPER         *
                *******************************/

%!  own_thread_start is det.
%!  own_thread_stop is det.
%
%   The helper begins; and ends when it has done what it was asked for,
%   which may be this.

own_thread_start :-
    alias(helper, Alias),
    message_queue_create(Queue),
    catch(thread_create(typhon_own_thread:help(Queue), Thread,
                        [ alias(Alias),
                          at_exit(typhon_own_thread:no_help(Queue)) ]),
          error(Formal, Context),
          ( message_queue_destroy(Queue),
            throw(error(Formal, Context)) )),
    assertz(helper(Thread, Queue)).

own_thread_stop :-
    (   with_mutex(typhon_own_thread, retract(helper(Thread, Queue)))
    ->  end_helper(Thread, Queue)
    ;   true
    ).

%   One that is busy may be the thread that runs this, or wait for it.

end_helper(Thread, Queue) :-
    idle(Queue),
    !,
    thread_send_message(Queue, stop),
    thread_join(Thread, _).
end_helper(Thread, Queue) :-
    thread_detach(Thread),
    thread_send_message(Queue, stop).

%   One that has just begun does not wait yet.

idle(Queue) :-
    \+ asked(Queue),
    !.
idle(Queue) :-
    message_queue_property(Queue, waiting(_)),
    message_queue_property(Queue, size(0)).

%   ask_helper(:Goal, -Status) fails if there is none.

ask_helper(Goal, Status) :-
    setup_call_cleanup(
        message_queue_create(Answers),
        ( with_mutex(typhon_own_thread,
                     ( helper(_, Queue),
                       retractall(asked(Queue)),
                       assertz(asked(Queue)),
                       thread_send_message(Queue, do(Goal, Answers)) )),
          thread_get_message(Answers, Status)
        ),
        message_queue_destroy(Answers)).

help(Queue) :-
    nb_setval(typhon_own_thread, true),
    repeat,
    thread_get_message(Queue, Message),
    helped(Message),
    Message == stop,
    !.

helped(stop).
helped(do(Goal, Answers)) :-
    catch(outcome(Goal, Status), Ball, Status = exception(Ball)),
    answer(Answers, Status).

outcome(Goal, Status) :-
    (   call(Goal)
    ->  Status = true
    ;   Status = false
    ).

answer(Answers, Status) :-
    catch(thread_send_message(Answers, Status),
          error(existence_error(_, _), _),
          true).                % no caller waits any more

%   A request to a helper that has ended does not wait for ever.

no_help(Queue) :-
    (   with_mutex(typhon_own_thread, retract(helper(Me, Queue)))
    ->  thread_detach(Me),
        catch(( own_thread_start,
                print_message(warning, typhon(new_helper)) ),
              error(Formal, _),
              no_helper(Formal))
    ;   true
    ),
    forsake(Queue),
    retractall(asked(Queue)),
    message_queue_destroy(Queue).

forsake(Queue) :-
    (   thread_peek_message(Queue, do(_, _))
    ->  thread_get_message(Queue, do(Goal, Answers)),
        answer(Answers,
               exception(error(system_error(not_done(Goal)), _))),
        forsake(Queue)
    ;   true
    ).

no_helper(permission_error(create, thread, _)) :-
    !.                          % Prolog is halting
no_helper(Formal) :-
    print_message(warning, typhon(no_helper(Formal))).

:- multifile prolog:message//1.

prolog:message(typhon(new_helper)) -->
    [ 'The thread that helps to stop hosts has ended; there is another' ].
prolog:message(typhon(no_helper(Formal))) -->
    [ 'The thread that helps to stop hosts has ended (~p)'-[Formal] ].
