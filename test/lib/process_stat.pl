:- module(test_process_stat,
          [ process_seconds/2,          % +Pid, -Seconds
            children_seconds/1,         % -Seconds
            process_nice/2              % +Pid, -Nice
          ]).
:- use_module(library(lists), [last/2, nth1/3]).
:- use_module(library(readutil), [read_file_to_string/3]).

/** <module> What the kernel of Linux says of a process

Pid may also be `self`.

*Threading*: any thread.
*/

%!  process_seconds(+Pid, -Seconds) is det.
%!  children_seconds(-Seconds) is det.
%
%   The processor time of a process, or of the processes that this one waited for,
%   and of those that they waited for.  0.0 where there is no /proc.

process_seconds(Pid, Seconds) :-
    seconds(Pid, 12, Seconds).

children_seconds(Seconds) :-
    seconds(self, 14, Seconds).

%   The ticks of user and system, from the Nth number on.

seconds(Pid, N, Seconds) :-
    N1 is N+1,
    stat(Pid, N, User),
    stat(Pid, N1, System),
    !,
    Seconds is (User+System)/100.0.
seconds(_, _, 0.0).

%!  process_nice(+Pid, -Nice:integer) is semidet.

process_nice(Pid, Nice) :-
    stat(Pid, 17, Nice).

%   stat(+Pid, +N, -Number) is semidet: after the name of the program, which may
%   hold spaces, and with the state as the first.

stat(Pid, N, Number) :-
    format(atom(File), '/proc/~w/stat', [Pid]),
    catch(read_file_to_string(File, Text, []), error(_, _), fail),
    split_string(Text, ")", " \n", Parts),
    last(Parts, Rest),
    split_string(Rest, " ", "", Words),
    nth1(N, Words, Word),
    number_string(Number, Word).
