:- module(typhon_nxt_helper,
          [ nxt_python/2,               % +Options, -Program
            nxt_command_line/3          % +Port, +Options, -Command
          ]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../helper', [helper_file/2, helper_pid/2, helper_python/2]).

/** <module> The helper that holds the serial line of a brick

It is `python3 bridges/nxt/bridge.py PORT`, see there for the lines that it
reads and writes.

*Threading*: no state.
*/

:- setting(python, atom, '',
           "The Python of the helpers of bricks; '' for that of all helpers").

%!  nxt_python(+Options, -Program) is det.
%
%   As helper_python/2, where there may be a setting for bricks.

nxt_python(Options, Python) :-
    (   option(python(_), Options)
    ->  helper_python(Options, Python)
    ;   setting(python, Name),
        Name \== ''
    ->  helper_python([python(Name)], Python)
    ;   helper_python([], Python)
    ).

%!  nxt_command_line(+Port, +Options, -Command) is det.
%
%   Command is for helper_open/3.  Options: python(Program), baudrate(N).

nxt_command_line(Port, Options,
                 command(Python,
                         ['-u', File, '--baudrate', Baud, '--', Port])) :-
    nxt_python(Options, Python),
    helper_file('nxt/bridge.py', File),
    option(baudrate(Baud), Options, 115200).

%   running(?Brick, ?Pid): for queries from the top level.

:- public running/2.

running(Brick, Pid) :-
    helper_pid(nxt(Brick), Pid).
