:- module(typhon_helper_process,
          [ process_begin/5,            % +Command, +Owner, +Role, :Heard,
                                        % -Process
            process_write/2,            % +Process, +Line
            process_end/1,              % +Process
            process_release/1,          % +Process
            process_kill_of/1,          % +Owner
            process_pid/2,              % ?Owner, ?Pid
            helper_file/2,              % +Relative, -File
            helper_python/2             % +Options, -Program
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(option), [option/2]).
:- use_module(library(process), [process_kill/2, process_wait/3]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../json', [json_dict/2]).
:- use_module('../../kernel/base/server', [server_cast/2]).
:- use_module('../../kernel/base/prolog_faults', [spawn/3]).

/** <module> The process of a helper

The process reads lines from its standard input, and writes lines to its
standard output.  It ends when its standard input ends, so it never outlives
this process.  It leads its own session, so the interrupt key of a terminal does
not reach it.

*Threading*: a process belongs to a server.  Its own thread reads its output,
waits for its end, and sends ended(Status) to the owner.  Any thread may call
process_kill_of/1.
*/

:- meta_predicate process_begin(+, +, +, 1, -).

:- dynamic
    process_pid/2,              % Owner: a server, Pid
    bridges/1.                  % Directory

:- module_property(typhon_helper_process, file(Source)),
   file_directory_name(Source, Dir),
   absolute_file_name('../../../../bridges', Bridges, [relative_to(Dir)]),
   retractall(bridges(_)),
   assertz(bridges(Bridges)).

end_seconds(2).                 % between the end of its output and its exit

%!  helper_file(+Relative, -File) is det.
%
%   File is the absolute path of the file Relative in the folder `bridges`.

helper_file(Relative, File) :-
    bridges(Bridges),
    atomic_list_concat([Bridges, Relative], /, File).

%!  process_begin(+Command, +Owner, +Role, :Heard, -Process) is det.
%
%   Start a process.  Command is command(Program, Args), for process_create/3.
%   For each line that is a JSON object the reading thread, whose alias contains
%   Role, runs call(Heard, Dict); it reads the next line after that.
%
%   @error existence_error(python, Program)

process_begin(command(Program, Args), Owner, Role, Heard,
              process(In, Reader)) :-
    start(Program, Args, In, Out, Pid),
    with_mutex(typhon_helper_pid, assertz(process_pid(Owner, Pid))),
    flag(typhon_helper_reader, N, N+1),
    atomic_list_concat([typhon, Role, reader, N], '_', ReaderAlias),
    thread_create(follow(Owner, Pid, Out, Heard), Reader,
                  [alias(ReaderAlias)]).

start(Program, Args, In, Out, Pid) :-
    catch(spawn(Program, Args,
                [ stdin(pipe(In, [encoding(utf8)])),
                  stdout(pipe(Out, [encoding(utf8)])),
                  process(Pid), detached(true)
                ]),
          error(Formal, _),
          no_program(Formal, Program)).

no_program(Formal, Program) :-
    format(atom(Text), '~p', [Formal]),
    throw(error(existence_error(python, Program), context(_, Text))).

%!  process_write(+Process, +Line) is det.
%
%   Write Line to the process, which may block if the process does not read.  If
%   the process has ended nothing is written, and the owner will get
%   ended(Status).

process_write(process(In, _), Line) :-
    catch(( write(In, Line), nl(In), flush_output(In) ),
          error(Formal, _),
          debug(typhon(helper), 'writing to a helper: ~p', [Formal])).

%!  process_end(+Process) is det.
%
%   Order the process to end.  The owner will get ended(Status).

process_end(process(In, _)) :-
    catch(close(In, [force(true)]), error(_, _), true).

%!  process_release(+Process) is det.

process_release(process(In, Reader)) :-
    process_end(process(In, Reader)),
    thread_join(Reader, _).

%!  process_kill_of(+Owner) is det.
%!  process_pid(?Owner, ?Pid) is nondet.
%
%   Kill the process of Owner at once, if there is one; Pid is a running process
%   of Owner.

process_kill_of(Owner) :-
    with_mutex(typhon_helper_pid,
               forall(process_pid(Owner, Pid), kill(Pid))).

kill(Pid) :-
    catch(process_kill(Pid, kill), error(_, _), true).

                /*******************************
                *           FOLLOWING          *
                *******************************/

follow(Owner, Pid, Out, Heard) :-
    catch(lines(Out, Heard), error(Formal, _),
          debug(typhon(helper), 'reading from a helper: ~p', [Formal])),
    close(Out, [force(true)]),
    end_seconds(Seconds),
    deadline(Seconds, Deadline),
    wait(Owner, Pid, Deadline, Status),
    ignore(server_cast(Owner, ended(Status))).

lines(Out, Heard) :-
    read_line_to_string(Out, Line),
    (   Line == end_of_file
    ->  true
    ;   line(Line, Heard),
        lines(Out, Heard)
    ).

line(Line, Heard) :-
    catch(json_dict(Line, Dict), error(_, _), fail),
    is_dict(Dict),
    !,
    catch(ignore(call(Heard, Dict)), error(Formal, Context),
          print_error(error, error(Formal, Context))).
line(Line, _) :-
    debug(typhon(helper), 'a helper has printed ~s', [Line]).

%   The process is reaped, and its fact retracted, in one critical section.
%   Otherwise process_kill_of/1 could kill a new process with the same number.

wait(Owner, Pid, _, Status) :-
    with_mutex(typhon_helper_pid, ended(Owner, Pid, Status)),
    !.
wait(Owner, Pid, Deadline, Status) :-
    monotonic_time(Now),
    (   Now > Deadline
    ->  kill(Pid)
    ;   true
    ),
    sleep(0.005),
    wait(Owner, Pid, Deadline, Status).

ended(Owner, Pid, Status) :-
    catch(process_wait(Pid, Status, [timeout(0)]), error(_, _),
          Status = unknown),
    Status \== timeout,
    retractall(process_pid(Owner, Pid)).

                /*******************************
                *            PYTHON            *
                *******************************/

:- setting(python, atom, '',
           "The Python of helpers; '' for that of the system").

%!  helper_python(+Options, -Program) is det.
%
%   Program, for process_create/3, is the Python of python(Name) in Options,
%   that of the setting, or that of the system.  The python3 in PATH is not
%   preferred: it may be a front end that hides the modules of the system, and
%   is slow to start.

helper_python(Options, Python) :-
    (   option(python(Name), Options)
    ->  true
    ;   setting(python, Name)
    ),
    program(Name, Python).

program('', Python) :-
    !,
    (   exists_file('/usr/bin/python3')
    ->  Python = '/usr/bin/python3'
    ;   Python = path(python3)
    ).
program(Name, Name) :-
    is_absolute_file_name(Name),
    !.
program(Name, path(Name)).
