:- module(typhon_yielding,
          [ thread_yields/1,            % +Thread
            thread_yielded/0
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> Threads that let others go first

The system can be told that a thread matters less than others, and not be told
the opposite again.  So a worker that has been made to yield ends when its turn
is over, and another takes its place.  Prolog cannot say this by itself: it is
said by renice(1), on Linux, where it knows of threads.  Elsewhere nobody
yields.

*Threading*: thread_yields/1 in the thread that watches, thread_yielded/0 in
the one that was made to yield.
*/

:- setting(nice, nonneg, 5,
           "Agents that run for long where there are quotas yield to others by \c
            so much, see nice(1); 0: not at all").

:- dynamic
    yields/1,                   % Thread
    cannot/0.                   % there is no such program

%!  thread_yields(+Thread) is det.
%
%   Thread yields to others from now on.

thread_yields(Thread) :-
    (   yields(Thread)
    ->  true
    ;   cannot
    ->  true
    ;   setting(nice, Nice),
        Nice > 0,
        current_prolog_flag(arch, Arch),
        sub_atom(Arch, _, _, _, linux),
        thread_property(Thread, system_thread_id(Tid))
    ->  forget_gone,
        assertz(yields(Thread)),
        renice(Nice, Tid),
        debug(typhon(scheduler), '~w yields to others', [Thread])
    ;   true
    ).

%   One that was no worker ends without saying so.

forget_gone :-
    forall(( yields(Thread), \+ is_thread(Thread) ),
           retractall(yields(Thread))).

renice(Nice, Tid) :-
    catch(( process_create(path(renice), ['-n', Nice, '-p', Tid],
                           [stdout(null), stderr(null), process(Pid)]),
            process_wait(Pid, _) ),
          error(_, _),
          assertz(cannot)).

%!  thread_yielded is semidet.
%
%   This thread was made to yield.

thread_yielded :-
    yields(_),
    thread_self(Me),
    retract(yields(Me)),
    !.
