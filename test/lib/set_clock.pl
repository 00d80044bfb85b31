:- module(set_clock,
          [ with_settable_clock/2,      % -Environment, :Goal
            clock_is_settable/0,
            clock_set/1,                % +Seconds
            seconds_of/2                % :Goal, -Seconds
          ]).

/** <module> Processes whose time of day tests can set

A library, compiled from `set_clock.c` and preloaded, adds the contents of a
file to the time of day of a process and of its children.  Waits until a time of
day follow it, as those of the system follow its clock.

*Threading*: the main thread sets up; any thread sets the clock.
*/

:- use_module(common, [project_file/2, with_tmp_dir/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(process), [process_create/3]).
:- use_module(library(readutil), [read_file_to_string/3]).

:- meta_predicate
    with_settable_clock(-, 0),
    seconds_of(0, -).

%!  clock_is_settable is semidet.
%
%   There are a compiler, and a C library with the wait that the library needs.

clock_is_settable :-
    catch(with_tmp_dir(set_clock:compiled), error(_, _), fail).

compiled(Dir) :-
    compiled(Dir, _).

compiled(Dir, Library) :-
    project_file('test/lib/set_clock.c', Source),
    directory_file_path(Dir, 'set_clock.so', Library),
    process_create(path(cc), ['-shared', '-fPIC', '-o', Library, Source],
                   [stderr(null)]).

%!  with_settable_clock(-Environment:list, :Goal) is semidet.
%
%   Run once(Goal), which starts processes with Environment.

with_settable_clock(Environment, Goal) :-
    with_tmp_dir(set_clock:settable(Environment, Goal)).

settable(Environment, Goal, Dir) :-
    compiled(Dir, Library),
    directory_file_path(Dir, offset, File),
    setup_call_cleanup(
        open(File, write, Out, [type(binary)]),
        write_offset(Out, 0),
        close(Out)),
    Environment = ['LD_PRELOAD'=Library, 'CLOCK_FILE'=File],
    once(Goal).

%!  clock_set(+Seconds) is det.
%
%   In such a process: from now on the time of day is Seconds later than that
%   of the system.

clock_set(Seconds) :-
    getenv('CLOCK_FILE', File),
    setup_call_cleanup(
        open(File, update, Out, [type(binary)]),
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
