:- module(typhon_nxt_helper,
          [ helper_start/3,             % +Port, +Options, -Helper
            helper_write/2,             % +Helper, +Line
            helper_end/1,               % +Helper
            helper_release/1,           % +Helper
            helper_kill/1,              % +Owner
            helper_python/2             % +Options, -Program
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(json, [atom_json_dict/3]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/3]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> The process that holds the serial line of a brick

A helper is `python3 bridges/nxt/bridge.py PORT`, see there for the lines
that it reads and writes.  It ends when its standard input does, and so
never outlives this process.  It leads a session of its own: the interrupt
key of a terminal is not for it.

*Threading*: a helper belongs to the thread that started it.  A thread of
its own reads its output, waits for its end, and sends heard(Dict) and at
last ended(Status) to the owner.  helper_kill/1 may be called by any thread.
*/

:- setting(python, atom, '',
           "The Python of the helpers; '' for that of the system").

:- dynamic
    running/2,                  % Owner thread, Pid
    bridge_file/1.              % File

:- prolog_load_context(directory, Dir),
   file_directory_name(Dir, Typhon),
   file_directory_name(Typhon, Library),
   file_directory_name(Library, Root),
   atom_concat(Root, '/bridges/nxt/bridge.py', File),
   retractall(bridge_file(_)),
   assertz(bridge_file(File)).

end_seconds(2).                 % between the end of its output and its own

%!  helper_start(+Port, +Options, -Helper) is det.
%
%   Options: python(Program), baudrate(N).
%
%   @error existence_error(python, Program)

helper_start(Port, Options, helper(In, Reader)) :-
    helper_python(Options, Python),
    bridge_file(File),
    option(baudrate(Baud), Options, 115200),
    thread_self(Owner),
    start_process(Python, ['-u', File, '--baudrate', Baud, '--', Port],
                  In, Out, Pid),
    with_mutex(typhon_nxt_pid, assertz(running(Owner, Pid))),
    atom_concat(Owner, '_reader', Alias),
    thread_create(follow(Owner, Pid, Out), Reader, [alias(Alias)]).

start_process(Python, Args, In, Out, Pid) :-
    catch(process_create(Python, Args,
                         [ stdin(pipe(In, [encoding(utf8)])),
                           stdout(pipe(Out, [encoding(utf8)])),
                           process(Pid), detached(true)
                         ]),
          error(Formal, _),
          no_python(Formal, Python)).

no_python(Formal, Python) :-
    format(atom(Text), '~p', [Formal]),
    throw(error(existence_error(python, Python), context(_, Text))).

%!  helper_python(+Options, -Program) is det.
%
%   Program is for process_create/3.  That of the system, if it can be: one
%   in the PATH may be a front that hides the modules of the system, and is
%   slow to start.

helper_python(Options, Python) :-
    (   option(python(Python0), Options)
    ->  true
    ;   setting(python, Python0)
    ),
    (   Python0 \== ''
    ->  program(Python0, Python)
    ;   exists_file('/usr/bin/python3')
    ->  Python = '/usr/bin/python3'
    ;   Python = path(python3)
    ).

program(Name, Python) :-
    (   is_absolute_file_name(Name)
    ->  Python = Name
    ;   Python = path(Name)
    ).

%!  helper_write(+Helper, +Line) is det.
%
%   May wait for a helper that does not read.  If the helper has ended,
%   nothing is written, and ended(Status) is on its way.

helper_write(helper(In, _), Line) :-
    catch(( write(In, Line), nl(In), flush_output(In) ),
          error(Formal, _),
          debug(typhon(nxt), 'writing to a helper: ~p', [Formal])).

%!  helper_end(+Helper) is det.
%
%   The order to end.  ended(Status) will come.

helper_end(helper(In, _)) :-
    catch(close(In, [force(true)]), error(_, _), true).

%!  helper_release(+Helper) is det.
%
%   Gives up what belonged to a helper that has ended.

helper_release(helper(In, Reader)) :-
    helper_end(helper(In, Reader)),
    thread_join(Reader, _).

%!  helper_kill(+Owner) is det.
%
%   Ends the helper of the thread Owner at once, if there is one.

helper_kill(Owner) :-
    with_mutex(typhon_nxt_pid,
               forall(running(Owner, Pid), kill(Pid))).

kill(Pid) :-
    catch(process_kill(Pid, kill), error(_, _), true).

                /*******************************
                *           FOLLOWING          *
                *******************************/

follow(Owner, Pid, Out) :-
    catch(lines(Out, Owner), error(Formal, _),
          debug(typhon(nxt), 'reading from a helper: ~p', [Formal])),
    close(Out, [force(true)]),
    get_time(Now),
    end_seconds(Seconds),
    Deadline is Now+Seconds,
    wait(Owner, Pid, Deadline, Status),
    thread_send_message(Owner, ended(Status)).

lines(Out, Owner) :-
    read_line_to_string(Out, Line),
    (   Line == end_of_file
    ->  true
    ;   line(Line, Owner),
        lines(Out, Owner)
    ).

line(Line, Owner) :-
    catch(atom_json_dict(Line, Dict0, []), error(_, _), fail),
    is_dict(Dict0),
    !,
    atoms(Dict0, Dict),
    thread_send_message(Owner, heard(Dict)).
line(Line, _) :-
    debug(typhon(nxt), 'a helper says ~s', [Line]).

%   Texts are names here, and become atoms.

atoms(Dict0, Dict) :-
    is_dict(Dict0),
    !,
    dict_pairs(Dict0, Tag, Pairs0),
    maplist(atoms_pair, Pairs0, Pairs),
    dict_pairs(Dict, Tag, Pairs).
atoms(Text, Atom) :-
    string(Text),
    !,
    atom_string(Atom, Text).
atoms(Value, Value).

atoms_pair(Key-Value0, Key-Value) :-
    atoms(Value0, Value).

%   Nobody may kill a number that belongs to another process by now, so it
%   is taken off the list when the process is taken off the system's.

wait(Owner, Pid, _, Status) :-
    with_mutex(typhon_nxt_pid, ended(Owner, Pid, Status)),
    !.
wait(Owner, Pid, Deadline, Status) :-
    get_time(Now),
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
    retractall(running(Owner, Pid)).
