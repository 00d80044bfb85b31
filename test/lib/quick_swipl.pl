:- module(test_quick_swipl,
          [ quick_swipl/2,              % +Dir, -Program
            quick_swipl/3               % +Start, +Dir, -Program
          ]).

/** <module> A Prolog with a saved state of library(typhon)

Loading the library takes 0.3 seconds, and suites start thousands of processes
that load it. So test/run.pl makes a saved state with the library, see
quick_start, and runs the suites with it. The `executable` of a suite's
process is this program, too; otherwise it behaves as `swipl`.

*Threading*: any thread.
*/

:- use_module(common, [project_file/2]).
:- use_module(library(filesex), [chmod/2, directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(zip),
              [ zip_close/1, zip_open/4, zipper_goto/2, zipper_members/2,
                zipper_open_current/3 ]).

%!  quick_swipl(+Dir, -Program) is det.
%!  quick_swipl(+Start, +Dir, -Program) is det.
%
%   Program is a file in Dir; or the `swipl` that runs this, if the file does
%   not run: some find their libraries of C only from where they are. Start is
%   the file that is loaded, or its name in this folder: quick_start, or
%   quick_system, which is no part of this tree.

quick_swipl(Dir, Program) :-
    quick_swipl(quick_start, Dir, Program).

quick_swipl(Name, Dir, Program) :-
    current_prolog_flag(executable, Swipl),
    directory_file_path(Dir, swipl, Quick),
    start_file(Name, Start),
    (   succeeds(Swipl, [ '-f', none, '-o', Quick, '-c', Start,
                          '--class=development', '--stand-alone=true',
                          '--autoload=false', '--on-error=print' ]),
        runs(Quick)
    ->  Program = Quick,
        uncompress(Quick)
    ;   Program = Swipl
    ).

start_file(Start, Start) :-
    is_absolute_file_name(Start),
    !.
start_file(Name, Start) :-
    format(atom(File), 'test/lib/~w.pl', [Name]),
    project_file(File, Start).

runs(Program) :-
    succeeds(Program, ['-g', true, '-t', halt]).

succeeds(Program, Args) :-
    process_create(Program, Args,
                   [ stdin(null), stdout(null), stderr(null),
                     process(Pid) ]),
    process_wait(Pid, exit(0)).

%   uncompress(+Program) is det: so it starts in five sixths of the time. If this
%   does not work here, Program is as before.

uncompress(Program) :-
    atom_concat(Program, '.stored', Stored),
    (   catch(store(Program, Stored), error(_, _), fail),
        chmod(Stored, +x),
        runs(Stored)
    ->  rename_file(Stored, Program)
    ;   true
    ).

%   A state is the program of Prolog, and then a zip file.

store(Program, Stored) :-
    read_file_to_string(Program, Bytes, [encoding(octet)]),
    once(sub_string(Bytes, Size, _, _, "PK\x03\\x04\")),
    sub_string(Bytes, 0, Size, _, Head),
    setup_call_cleanup(
        open(Stored, write, Out, [type(binary)]),
        ( write(Out, Head),
          setup_call_cleanup(
              zip_open_stream(Out, To, []),
              store_members(Program, To),
              zip_close(To)) ),
        close(Out)).

store_members(Program, To) :-
    setup_call_cleanup(
        zip_open(Program, read, From, []),
        ( zipper_members(From, Names),
          forall(member(Name, Names), store_member(From, To, Name)) ),
        zip_close(From)).

store_member(From, To, Name) :-
    zipper_goto(From, file(Name)),
    setup_call_cleanup(
        zipper_open_current(From, In, [type(binary)]),
        setup_call_cleanup(
            zipper_open_new_file_in_zip(To, Name, Out,
                                        [method(store), zip64(true)]),
            copy_stream_data(In, Out),
            close(Out)),
        close(In)).
