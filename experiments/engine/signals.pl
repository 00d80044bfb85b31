:- module(study_signals,
          [ stopping_on_signals/1       % :Goal
          ]).

/** <module> Orderly end after Ctrl-C

*Threading*: signals arrive in any thread.  They concern the main thread, which
calls stopping_on_signals/1.
*/

:- meta_predicate
    stopping_on_signals(0).

%!  stopping_on_signals(:Goal) is semidet.
%
%   Calls Goal once.  On Ctrl-C, on SIGTERM and on SIGHUP an exception ends
%   Goal, so that its cleanup handlers run; then the process ends with the
%   status that a shell expects, 128 plus the number of the signal.  Further
%   signals do not interrupt the cleanup.

stopping_on_signals(Goal) :-
    forall(stop_signal(Signal, _),
           on_signal(Signal, _, study_signals:stop)),
    catch(once(Goal), stopped_by(Signal), end_by(Signal)).

stop_signal(int, 130).
stop_signal(term, 143).
stop_signal(hup, 129).

stop(Signal) :-
    forall(stop_signal(Other, _),
           on_signal(Other, _, study_signals:ignore_signal)),
    print_message(informational, format("Stopping on signal ~w", [Signal])),
    thread_self(Me),
    (   Me == main
    ->  throw(stopped_by(Signal))
    ;   thread_signal(main, throw(stopped_by(Signal)))
    ).

ignore_signal(_).

end_by(Signal) :-
    stop_signal(Signal, Status),
    halt(Status).
