:- module(typhon_aside,
          [ aside/1                     % :Goal
          ]).

/** <module> What must not be done in a cleanup handler

In SWI-Prolog 9.0.4 a thread that runs a cleanup handler, sig_atomic/1 or a
directive leaves its signals pending. If one is, which garbage collection
alone sees to, then a wait with a deadline that expires does not end: it
spins for ever. Programs like to stop things in cleanup handlers, and
stopping has to wait. So whatever stops something does it aside.

*Threading*: any thread. thread_join/2 waits soundly in all of them.
*/

:- meta_predicate
    aside(0).

%!  aside(:Goal) is semidet.
%
%   As once(Goal), in a thread of its own. No bindings come back. Who is
%   interrupted while waiting leaves Goal to itself.

aside(Goal) :-
    thread_create(Goal, Thread),
    catch(thread_join(Thread, Status), Interrupt,
          ( thread_detach(Thread),
            throw(Interrupt) )),
    (   Status = exception(Error)
    ->  throw(Error)
    ;   Status == true
    ).
