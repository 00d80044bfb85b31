:- module(typhon_app_serving,
          [ run_until_stopped/3,        % :Start, :Report, :Stop
            run_until_stopped/4,        % :Start, :Report, :Stop, +Seconds
            and_then/2                  % :Goal, :Finally
          ]).

/** <module> Commands that run until they are stopped

*Threading*: the main thread only; it waits for a message, which the handlers
of signals send.
*/

:- use_module('../../prolog/typhon/kernel/base/process_setup',
              [on_stop_signals/1]).

:- use_module(library(process), [process_kill/2]).

:- multifile prolog:message//1.

:- meta_predicate
    run_until_stopped(0, 0, 0),
    run_until_stopped(0, 0, 0, +),
    and_then(0, 0).

:- public stop_requested/1.

%!  run_until_stopped(:Start, :Report, :Stop) is semidet.
%!  run_until_stopped(:Start, :Report, :Stop, +Seconds) is semidet.
%
%   Calls Start and Report, waits for SIGTERM, SIGINT or SIGHUP, and
%   calls Stop.  If that takes longer than Seconds the process kills itself: the
%   end of Prolog would wait for the threads that hang.
%
%   All calls are in a thread of its own: Prolog loses a signal that reaches a
%   thread which has just begun. Threads that the main thread has not created
%   block SIGINT from the first, but no other signal.

run_until_stopped(Start, Report, Stop) :-
    run_until_stopped(Start, Report, Stop, inf).

run_until_stopped(Start, Report, Stop, Seconds) :-
    on_stop_signals(stop_requested),
    thread_create(serve(Start, Report, Stop), Server),
    thread_send_message(Server, start),
    thread_get_message(serving(Event)),
    (   Event == stop_requested
    ->  limit(Seconds),
        thread_send_message(Server, stop)
    ;   true
    ),
    thread_join(Server, Status),
    (   Status = exception(Error)
    ->  throw(Error)
    ;   Status == true
    ).

limit(inf) :-
    !.
limit(Seconds) :-
    thread_create(( sleep(Seconds), killed(Seconds) ), _, [detached(true)]).

killed(Seconds) :-
    print_message(error, typhon(not_stopped(Seconds))),
    current_prolog_flag(pid, Pid),
    process_kill(Pid, kill).

prolog:message(typhon(not_stopped(Seconds))) -->
    [ 'The host has not stopped within ~w seconds: the process is killed'-
      [Seconds] ].

stop_requested(_Signal) :-
    thread_send_message(main, serving(stop_requested)).

serve(Start, Report, Stop) :-
    call_cleanup(( thread_get_message(start),
                   call(Start),
                   and_then(( once(Report),
                              thread_get_message(stop)
                            ), Stop)
                 ),
                 thread_send_message(main, serving(ended))).

%!  and_then(:Goal, :Finally) is semidet.
%
%   Calls Goal once and, however that ends, Finally.
%
%   setup_call_cleanup/3 is not suitable: a wait with a deadline never ends
%   in its cleanup handler when a signal is pending.

and_then(Goal, Finally) :-
    catch(( call(Goal) -> Result = true ; Result = fail ),
          error(Formal, Context),
          Result = throw(error(Formal, Context))),
    call(Finally),
    call(Result).
