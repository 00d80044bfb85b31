:- module(typhon_cell_process,
          [ cell_process_start/1,       % -Process
            cell_process_end/2,         % +Process, -Reason
            cell_filter_forget/0
          ]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- autoload(library(process), [process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_stream_to_codes/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/prolog_faults', [installed_swipl/2, spawn/3]).
:- use_module('../../kernel/program', [vocabulary_word/2]).
:- use_module(cell_frames, [cell_frame_read/2]).

/** <module> The process of a cell

The operating system isolates it: no network, no files but those of SWI-Prolog
and of this library, read-only, and a small /tmp, no other process, no
capabilities, few system calls, and limits of memory, threads and files; see
cell.sh and filter.py.  The cell shares only a pipe for each direction with this
process.

The operating system kills a cell when the thread that has started it ends.

*Threading*: one thread, the server of cells, starts processes; any thread may
end them.
*/

:- setting(typhon_cells:memory, positive_integer, 1 500 000 000,
           "Bytes of address space that a cell may have").

:- setting(typhon_cells:start, number, 120,
           "Seconds in which a cell has to load its program").

:- multifile prolog:error_message//1.

:- dynamic
    filter/1.                   % File: the seccomp filter

%!  cell_process_start(-Process) is det.
%
%   Process is process(Pid, In, Out, Err), a cell that waits for its first
%   frame.
%
%   @error cell_unavailable(Cause) the machine cannot start cells
%   @error timeout_error(start_cell, Seconds) the cell was not ready in time.
%   This is no cell_unavailable(_): a slow machine may start cells later, so its
%   agents must not run without them

cell_process_start(Process) :-
    filter_file(Filter),
    launch(Filter, Process),
    Process = process(_, In, _, _),
    setting(typhon_cells:start, Seconds),
    set_stream(In, timeout(Seconds)),
    catch(cell_frame_read(In, Frame), error(Formal, _), Frame = error(Formal)),
    (   Frame == ready
    ->  set_stream(In, timeout(infinite))
    ;   not_ready(Frame, Process)
    ).

not_ready(error(timeout_error(_, _)), Process) :-
    !,
    cell_process_end(Process, _),
    setting(typhon_cells:start, Seconds),
    throw(error(timeout_error(start_cell, Seconds), _)).
not_ready(_, Process) :-
    Process = process(Pid, _, _, Err),
    kill(Pid),
    read_stream_to_codes(Err, Codes),
    cell_process_end(Process, _),
    failure(Codes, Text),
    unavailable(Text).

%!  cell_process_end(+Process, -Reason) is det.
%
%   Kill Process and wait for its end.  Reason is exit(Status) or
%   killed(Signal).

cell_process_end(process(Pid, In, Out, Err), Reason) :-
    kill(Pid),
    process_wait(Pid, Reason),
    forall(member(Stream, [Out, In, Err]), close(Stream, [force(true)])).

kill(Pid) :-
    catch(process_kill(Pid, kill), error(_, _), true).

failure([], 'it ended without a message') :-
    !.
failure(Codes, Text) :-
    string_codes(Text, Codes).

unavailable(Text) :-
    throw(error(cell_unavailable(Text), _)).

launch(Filter, process(Pid, In, Out, Err)) :-
    source('cell.sh', Script),
    source('../../..', Library0),
    absolute_file_name(Library0, Library),
    current_prolog_flag(home, Home0),
    real_path(Home0, Home),
    swipl(Home, Swipl),
    setting(typhon_cells:memory, Memory),
    flag(typhon_cell_user, User, (User+1) mod 1000),
    Uid is 59 000 + User,
    program(Library, Goal),
    spawn(path(bash),
          [ Script, Library, Filter, Home, Swipl, '-q', '-f', none, '--no-tty',
            '-g', Goal, '-t', 'halt(1)' ],
          [ stdin(pipe(Out)), stdout(pipe(In)), stderr(pipe(Err)), process(Pid),
            environment(['CELL_AS'=Memory, 'CELL_UID'=Uid]) ]),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)),
    set_stream(Out, buffer(full)).

%   The program loads the vocabulary of this process, and the option `identity`
%   to read signed programs.  Without threads these are loaded in place: the end
%   of a thread that has loaded a file cannot be awaited.

program(Library, Goal) :-
    setof(File, vocabulary_file(Library, File), Files),
    format(atom(Goal),
           'set_prolog_flag(gc_thread,false),\c
            use_module(\'/typhon/typhon/options/cell/inside\'),\c
            set_prolog_flag(threads,false),\c
            use_module(\'/typhon/typhon/options/identity\',[]),\c
            forall(lists:member(F,~q),use_module(F,[])),\c
            typhon_cell_inside:cell_main',
           [Files]).

vocabulary_file(Library, File) :-
    vocabulary_word(Module, _),
    module_property(Module, file(Path)),
    atom_concat(Library, Rest, Path),
    atom_concat('/typhon', Rest, File).

%   The executable of this process may be a saved state, which is no SWI-Prolog.

swipl(Home, Swipl) :-
    installed_swipl(Home, Swipl),
    !.
swipl(_, Swipl) :-
    current_prolog_flag(executable, Swipl0),
    real_path(Swipl0, Swipl).

real_path(Path0, Path) :-
    (   read_link(Path0, _, Target)
    ->  Path = Target
    ;   Path = Path0
    ).

source(Name, Path) :-
    module_property(typhon_cell_process, file(File)),
    file_directory_name(File, Directory),
    directory_file_path(Directory, Name, Path).

%   The filter is compiled once.  cell.sh opens its file as the user of this
%   process.

filter_file(File) :-
    filter(File),
    !.
filter_file(File) :-
    must_have(bwrap, 'apt install bubblewrap'),
    must_have(prlimit, 'apt install util-linux'),
    tmp_file_stream(File, Stream, [encoding(octet)]),
    close(Stream),
    source('filter.py', Maker),
    spawn(path(python3), [Maker, File],
          [stdout(null), stderr(pipe(Err)), process(Pid)]),
    read_stream_to_codes(Err, Codes),
    close(Err),
    process_wait(Pid, Status),
    assertz(filter(File)),
    (   Status == exit(0)
    ->  true
    ;   cell_filter_forget,
        string_codes(Text, Codes),
        unavailable(Text)
    ).

must_have(Command, How) :-
    (   absolute_file_name(path(Command), _,
                           [access(execute), file_errors(fail)])
    ->  true
    ;   format(string(Text), 'there is no ~w (~w)', [Command, How]),
        unavailable(Text)
    ).

%!  cell_filter_forget is det.
%
%   Delete the file of the filter; the next cell compiles it again.

cell_filter_forget :-
    forall(retract(filter(File)),
           catch(delete_file(File), error(existence_error(_, _), _), true)).

prolog:error_message(cell_unavailable(Cause)) -->
    [ 'No cell can be started: ~w'-[Cause], nl,
      'A cell needs bubblewrap (apt install bubblewrap) that is not setuid, and \c
       that it may make user namespaces: allow them \c
       (kernel.unprivileged_userns_clone, AppArmor; in podman \c
       --security-opt seccomp=unconfined --security-opt unmask=ALL)'-[], nl,
      'With the option cell(none) untrusted agents run in this process, and \c
       its policy protects against mistakes only'-[] ].
prolog:error_message(timeout_error(start_cell, Seconds)) -->
    [ 'A cell has not loaded its program within ~w seconds: raise the \c
       setting typhon_cells:start on a slow machine'-[Seconds] ].
