:- module(set_clock,
          [ with_settable_clock/2,      % -Environment, :Goal
            clock_is_settable/0,
            python_waits/0,
            clock_set/1,                % +Seconds
            seconds_of/2                % :Goal, -Seconds
          ]).

/** <module> Processes whose time of day tests can set

The library `set_clock.c` adds the contents of a file to the time of day of a process and of its children.  Waits until a time of
day follow it, as those of the system follow its clock.

*Threading*: the main thread sets up; any thread sets the clock.
*/

:- use_module('../../app/packaging/parts', [installed/1]).
:- use_module(common, [missing/2]).
:- use_module(preloaded, [can_preload/1, with_preloaded/4]).
:- use_module(library(readutil), [read_file_to_string/3]).

:- meta_predicate
    with_settable_clock(-, 0),
    seconds_of(0, -).

%!  clock_is_settable is semidet.
%
%   There are a compiler, and a C library with the wait that the library needs.

clock_is_settable :-
    can_preload(set_clock).

%!  python_waits is semidet.
%
%   Calls of Python can be among what waits.

python_waits :-
    installed(bridges),
    missing([python3], []).

%!  with_settable_clock(-Environment:list, :Goal) is semidet.
%
%   Run once(Goal), which starts processes with Environment.

with_settable_clock(Environment, Goal) :-
    with_preloaded(set_clock, 'CLOCK_FILE'=File, Environment,
                   ( set_offset(File, write, 0),
                     once(Goal) )).

%!  clock_set(+Seconds) is det.
%
%   In such a process: from now on the time of day is Seconds later than that
%   of the system.

clock_set(Seconds) :-
    getenv('CLOCK_FILE', File),
    set_offset(File, update, Seconds).

set_offset(File, Mode, Seconds) :-
    setup_call_cleanup(
        open(File, Mode, Out, [type(binary)]),
        write_offset(Out, Seconds),
        close(Out)).

write_offset(Out, Seconds) :-
    NanoSeconds is truncate(Seconds*1000000000),
    forall(between(0, 7, I),
           ( Byte is (NanoSeconds >> (8*I)) /\ 255,
             put_byte(Out, Byte) )).

%!  seconds_of(:Goal, -Seconds) is semidet.
%
%   As once(Goal), which takes Seconds by the clock of the system.

seconds_of(Goal, Seconds) :-
    uptime(Start),
    once(Goal),
    uptime(End),
    Seconds is End-Start.

uptime(Seconds) :-
    read_file_to_string('/proc/uptime', Text, []),
    split_string(Text, " ", "", [First|_]),
    number_string(Seconds, First).
