:- module(test_playground, []).
:- use_module('../lib/common').
:- use_module('../lib/documents',
              [block_write/2, blocks/2, document/1]).
:- use_module('../lib/texts', [write_file/3]).
:- use_module('../lib/transcript', [session_steps/2]).
:- use_module(library(apply), [include/3, maplist/2]).
:- use_module(library(filesex),
              [ copy_file/2, delete_directory_and_contents/1,
                directory_file_path/3, make_directory_path/1 ]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

:- needs([wasm]).

/** <module> Programs in virtual time give the same logs in WebAssembly

The sessions of each document that uses virtual time, and one of each mechanism,
are played twice, by this Prolog and by one from the saved state of the
playground, see lib/wasm/play.pl.  Answers and logs are compared byte by byte.

*Threading*: the main thread.
*/

:- dynamic state/1.                     % Directory with the file `state`

save_state :-
    tmp_file(playground, Dir),
    make_directory_path(Dir),
    directory_file_path(Dir, state, State),
    project_file('app/playground/state.js', Script),
    node([Script, State]),
    assertz(state(Dir)).

drop_state :-
    forall(retract(state(Dir)), delete_directory_and_contents(Dir)).

:- begin_tests(playground, [setup(save_state), cleanup(drop_state)]).

test(same_bytes, [forall(virtual_document(File, Blocks)),
                  Different-File == []-File]) :-
    in_both(document(Blocks), Different).
test(same_mechanism, [forall(member(Name, [ synchronisation, population,
                                            allocation, learning,
                                            hierarchy ])),
                      Different-Name == []-Name]) :-
    in_both(mechanism(Name), Different).

:- end_tests(playground).

%   Some block of the document is about virtual time.

virtual_document(Path, Blocks) :-
    document(Path),
    blocks(Path, Blocks),
    once(( member(block(_, _, Lines), Blocks),
           member(Line, Lines),
           sub_string(Line, _, _, _, "clock(virtual)") )),
    memberchk(block("prolog-session", _, _), Blocks).

in_both(What, Different) :-
    state(Root),
    with_tmp_dir(Dir, played(Dir, Root, What, Different)).

%   Both play in a folder of the same name, as logs hold names of files.

played(Dir, Root, What, Different) :-
    directory_file_path(Dir, native, Native),
    directory_file_path(Dir, fresh, Fresh),
    directory_file_path(Dir, wasm, Wasm),
    prepare(What, Native),
    prepare(What, Fresh),
    play_here(Native),
    directory_file_path(Root, state, State),
    project_file('test/lib/wasm/play.js', Script),
    node([Script, State, Fresh, Native, Wasm]),
    different(Native, Wasm, Different).

prepare(mechanism(Name), Dir) :-
    make_directory_path(Dir),
    atomic_list_concat(['test/lib/wasm/mechanisms/', Name, '.pl'], Path),
    project_file(Path, File),
    directory_file_path(Dir, 'session.pl', Session),
    copy_file(File, Session).
prepare(document(Blocks), Dir) :-
    make_directory_path(Dir),
    maplist(block_write(Dir), Blocks),
    findall(Goal,
            ( member(block("prolog-session", _, Lines), Blocks),
              session_steps(Lines, Steps),
              member(step(Goal, _), Steps) ),
            Goals),
    directory_file_path(Dir, 'session.pl', Session),
    write_file(Session, '~@',
               [forall(member(Goal, Goals), format('?- ~w~n', [Goal]))]).

play_here(Dir) :-
    project_file('test/lib/wasm/play.pl', Play),
    project_file(prolog, Library),
    atom_concat('library=', Library, Path),
    current_prolog_flag(executable, Swipl),
    run(Swipl, [ '-p', Path, '-g', 'play(\'session.pl\')', '-t', halt, Play ],
        [cwd(Dir)], exit(0)).

%   Optimising WebAssembly takes longer than it saves in a short run.

node(Args) :-
    run(path(node), ['--liftoff-only'|Args], [], exit(0)).

run(Program, Args, Options, Status) :-
    process_create(Program, Args,
                   [ stdin(null), stdout(null), stderr(null), process(Pid)
                   | Options ]),
    process_wait(Pid, Status).

%   Different are the names of files that only one has, and of answers and logs
%   that are not the same.

different(Native, Wasm, Different) :-
    directory_files(Native, Names1),
    directory_files(Wasm, Names2),
    append(Names1, Names2, All),
    sort(All, Names),
    include(differs(Native, Wasm), Names, Different).

differs(Dir1, Dir2, Name) :-
    \+ ( content(Dir1, Name, Content),
         content(Dir2, Name, Content) ).

%   Saved agents and networks have the version of Prolog, and names of variables.

content(Dir, Name, Content) :-
    directory_file_path(Dir, Name, File),
    (   exists_file(File)
    ->  read_file_to_string(File, Text, [encoding(utf8)]),
        (   saved(Begin),
            sub_string(Text, 0, _, _, Begin)
        ->  Content = saved
        ;   Content = Text
        )
    ;   exists_directory(File),
        Content = directory
    ).

saved("typhon_saved(").
saved("restore_point(").
