:- module(test_playground, []).
:- use_module('../../app/packaging/parts', [installed/1]).
:- use_module('../lib/common').
:- use_module('../lib/virtual_documents').
:- use_module(library(apply), [include/3, maplist/2, maplist/3]).
:- use_module(library(filesex),
              [ copy_file/2, delete_directory_and_contents/1,
                directory_file_path/3, make_directory_path/1 ]).
:- use_module(library(lists), [append/3, member/2, subtract/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

:- needs([wasm]).

/** <module> Programs in virtual time give the same logs in WebAssembly

The sessions of each document that uses virtual time, one of each mechanism, and
runs of the studies that the site offers, are played twice, one after the other,
by this Prolog and by one from the saved state of the playground, see
lib/wasm/play.pl.  Answers and logs are compared byte by byte.

*Threading*: the main thread.
*/

:- dynamic folder/1.                    % with the folders `native` and `wasm`

drop_folder :-
    forall(retract(folder(Dir)), delete_directory_and_contents(Dir)).

:- begin_tests(playground, [setup(play_all), cleanup(drop_folder)]).

test(same_bytes, [forall(played(_, File)), Different-File == []-File]) :-
    different(File, Different).
test(all_studies_of_the_site, [condition(installed(studies)),
                                Played == Offered]) :-
    studies_in('test/lib/wasm/sessions/studies.pl', Played),
    studies_in('app/playground/build.js', Offered).

:- end_tests(playground).

%   Both play in folders of the same names, as logs hold names of files.

play_all :-
    make_tmp_dir(Dir),
    assertz(folder(Dir)),
    maplist(directory_file_path(Dir), [native, fresh, wasm, state],
            [Native, Fresh, Wasm, State]),
    maplist(make_directory_path, [Native, Fresh]),
    forall(( member(Top, [Native, Fresh]), played(What, File) ),
           ( file_base_name(File, Base),
             directory_file_path(Top, Base, Folder),
             prepare(What, Folder) )),
    play_here(Native),
    project_file('app/playground/state.js', Saves),
    project_file('test/lib/wasm/play.js', Plays),
    node([Saves, State]),
    node([Plays, State, Fresh, Native, Wasm]).

played(document(Blocks), File) :-
    virtual_document(File, Blocks).
played(session(File), File) :-
    project_file('test/lib/wasm/sessions/*.pl', Pattern),
    expand_file_name(Pattern, Files),
    member(File, Files),
    \+ ( file_base_name(File, 'studies.pl'), \+ installed(studies) ).

%   studies_in(+Path, -Studies): that the file names in quotes.

studies_in(Path, Studies) :-
    project_file(Path, File),
    read_file_to_string(File, Text, []),
    split_string(Text, "'", "", Words),
    include(is_study, Words, Studies0),
    sort(Studies0, Studies).

is_study(Word) :-
    sub_string(Word, 0, _, _, "ex"),    % examples, experiments
    sub_string(Word, _, _, 0, ".pl").

prepare(session(File), Dir) :-
    make_directory_path(Dir),
    directory_file_path(Dir, 'session.pl', Session),
    copy_file(File, Session).
prepare(document(Blocks), Dir) :-
    make_directory_path(Dir),
    session_write(Blocks, Dir).

play_here(Dir) :-
    project_file('test/lib/wasm/play.pl', Play),
    project_file(prolog, Library),
    atom_concat('library=', Library, Path),
    directory_files(Dir, Names0),
    subtract(Names0, ['.', '..'], Names1),
    sort(Names1, Names),
    findall(Arg, ( member(Name, Names),
                   format(atom(Goal), 'play(\'~w/~w\')', [Dir, Name]),
                   member(Arg, ['-g', Goal]) ),
            Goals),
    append(['-p', Path|Goals], ['-t', halt, Play], Args),
    current_prolog_flag(executable, Swipl),
    run(Swipl, Args).

%   Optimising WebAssembly takes longer than it saves in a short run.

node(Args) :-
    run(path(node), ['--liftoff-only'|Args]).

run(Program, Args) :-
    process_create(Program, Args,
                   [stdin(null), stdout(null), stderr(null), process(Pid)]),
    process_wait(Pid, exit(0)).

%   Different are the names of files that only one has, and of answers and logs
%   that are not the same.

different(File, Different) :-
    folder(Dir),
    file_base_name(File, Base),
    findall(Contents,
            ( member(Player, [native, wasm]),
              atomic_list_concat([Dir, Player, Base], /, Folder),
              folder_contents(Folder, Contents) ),
            Folders),
    contents_differ(Folders, Different).
