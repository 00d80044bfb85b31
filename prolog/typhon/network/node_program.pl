:- module(typhon_node_program,
          [ node_program/2,             % -Program, -Args
            node_file/1,                % -File
            node_flags/1,               % -Flags
            node_programs/1             % +Count
          ]).
:- use_module(library(lists), [append/3]).
:- autoload(library(process), [process_wait/2]).
:- use_module('../kernel/base/prolog_faults', [installed_swipl/2, spawn/3]).

/** <module> What the child processes of a network run

A child runs node_process.pl. To load it takes 0.2 seconds of a processor; from
a saved state a child starts in 0.03 seconds. So this process makes a saved
state before it starts many children. That is a temporary file, which Prolog
deletes when it halts. Children run the source if there is no state, or a source
file has changed since the state was made.

*Threading*: any thread.
*/

:- dynamic
    node_file/1,                % File
    state/2.                    % File, Made: a time

:- module_property(typhon_node_program, file(Source)),
   file_directory_name(Source, Dir),
   atom_concat(Dir, '/node_process.pl', File),
   retractall(node_file(_)),
   assertz(node_file(File)).

%   To make a state takes as long as so many children take to load the source.

dear(4).

%!  node_file(-File) is det.
%!  node_flags(-Flags:list) is det.
%
%   Where it is not in a saved state a child is `swipl Flags File`.

%!  node_program(-Program, -Args:list) is det.
%
%   A child on this machine runs Program with Args.

node_program(Program, Args) :-
    swipl(Program),
    node_flags(Flags),
    (   fresh(State)
    ->  Args = ['-x', State|Flags]
    ;   node_file(File),
        append(Flags, [File], Args)
    ).

node_flags(['-q', '-f', none, '-g', Main, '-t', 'halt(1)']) :-
    term_to_atom(typhon_node_process:node_main, Main).

%   swipl(-Program): Program is not a stand-alone saved state. That would run
%   its own goal, which starts processes, and so on without end.

swipl(Swipl) :-
    current_prolog_flag(executable, Executable),
    (   stands_alone(Executable)
    ->  current_prolog_flag(home, Home),
        ( installed_swipl(Home, Swipl0) -> Swipl = Swipl0 ; Swipl = path(swipl) )
    ;   Swipl = Executable
    ).

stands_alone(Executable) :-
    current_prolog_flag(resource_database, State),
    same_file(State, Executable).

                /*******************************
                *          SAVED STATE         *
                *******************************/

%!  node_programs(+Count) is det.
%
%   About Count children will start soon: make a saved state if that pays.

node_programs(Count) :-
    (   dear(Few),
        Count > Few,
        \+ fresh(_),
        current_prolog_flag(executable, Executable),
        \+ stands_alone(Executable)     % its library may be another
    ->  catch(ignore(make_state), error(_, _), true)
    ;   true
    ).

make_state :-
    swipl(Swipl),
    node_file(File),
    library_path(Library),
    atom_concat(Library, '.pl', Typhon),
    tmp_file_stream(State, Stream, [encoding(octet)]),
    close(Stream),
    time_file(State, Made),
    spawn(Swipl, [ '-q', '-f', none, '--on-error=print', '-o', State,
                   '--class=development', '--autoload=false', '-c', File,
                   Typhon ],
          [stdin(null), stdout(null), stderr(null), process(Pid)]),
    process_wait(Pid, exit(0)),
    retractall(state(_, _)),
    assertz(state(State, Made)).

fresh(State) :-
    state(State, Made),
    exists_file(State),
    library_path(Library),
    \+ ( source_file(File),
         sub_atom(File, 0, _, _, Library),
         time_file(File, Time),
         Time > Made ),
    !.

library_path(Library) :-
    node_file(File),
    file_directory_name(File, Network),
    file_directory_name(Network, Library).
