:- module(typhon_crash,
          [ crash_point/1               % +Name
          ]).

/** <module> Steps at which a process may die

What follows when a process is killed at a certain step is tried by tests:
they say with the hook reached/1 what is to happen there.

*Threading*: any thread.
*/

:- multifile reached/1.                 % Name

:- dynamic reached/1.

%!  crash_point(+Name) is det.
%
%   The process, which keeps a journal, has come to the step Name.

crash_point(Name) :-
    forall(reached(Name), true).
