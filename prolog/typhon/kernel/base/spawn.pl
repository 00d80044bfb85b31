:- module(typhon_spawn,
          [ spawn/3                     % +Program, +Args, +Options
          ]).

/** <module> One process begins after the other

Of the pipes to a process that begins, any other that begins in that moment
gets the ends, too (SWI-Prolog 9.0.4 to 10.1): it holds them open for as long
as it lives, and a reader that waits until a pipe ends waits for both.

*Threading*: any thread may call; one does it at a time.
*/

:- autoload(library(process), [process_create/3]).

%!  spawn(+Program, +Args:list, +Options:list) is det.
%
%   As process_create/3. Its pipes are known to this process and the new one
%   alone, if all that begin here are begun so.
%
%   @error as process_create/3

spawn(Program, Args, Options) :-
    with_mutex(typhon_spawn, process_create(Program, Args, Options)).
