:- module(typhon_stop_thread,
          [ stop_thread/1,              % +Thread
            abort_quietly/0
          ]).

/** <module> The end of threads that run what others wrote

*Threading*: any thread but the one that is to end.
*/

%!  stop_thread(+Thread) is det.
%
%   Join Thread, which has been told to end.  After a second it is aborted,
%   in the middle of whatever it does, again and again; after another one it
%   is left to itself, and a message says so.

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
    thread_self(Me),
    \+ thread_get_message(Me, '$typhon_never', [timeout(0.002)]),
    interrupt(Tries, Thread),
    Tries1 is Tries-1,
    stop_thread(Tries1, Thread).

interrupt(Tries, Thread) :-
    (   Tries =< 500,
        Tries mod 50 =:= 0
    ->  catch(thread_signal(Thread,
                            typhon_stop_thread:abort_quietly), error(_, _), true)
    ;   true
    ).

%!  abort_quietly
%
%   As abort/0, which cannot be caught for good, but input that was typed
%   ahead is not discarded.  Where it is not sure which exception that is,
%   abort/0 raises it.

abort_quietly :-
    current_prolog_flag(version, Version),
    (   Version < 90300
    ->  throw('$aborted')
    ;   Version >= 100000
    ->  throw(unwind(abort))
    ;   abort
    ).
