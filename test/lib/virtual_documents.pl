:- module(test_virtual_documents,
          [ virtual_document/2,         % -File, -Blocks
            session_write/2,            % +Blocks, +Dir
            folder_contents/2,          % +Dir, -Contents
            contents_differ/2           % +Folders, -Names
          ]).

/** <module> Documents about virtual time, and what their sessions write

Their sessions are played in several Prologs, see wasm/play.pl.

*Threading*: one thread.
*/

:- use_module(documents, [block_write/2, blocks/2, document/1]).
:- use_module(texts, [write_file/3]).
:- use_module(transcript, [session_steps/2]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/2, member/2, memberchk/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

%!  virtual_document(-File, -Blocks) is nondet.
%
%   Some block of File is about virtual time.

virtual_document(File, Blocks) :-
    document(File),
    blocks(File, Blocks),
    once(( member(block(_, _, Lines), Blocks),
           member(Line, Lines),
           sub_string(Line, _, _, _, "clock(virtual)") )),
    memberchk(block("prolog-session", _, _), Blocks).

%!  session_write(+Blocks, +Dir) is det.
%
%   Dir gets the files in Blocks, and `session.pl` with their queries.

session_write(Blocks, Dir) :-
    maplist(block_write(Dir), Blocks),
    findall(Goal,
            ( member(block("prolog-session", _, Lines), Blocks),
              session_steps(Lines, Steps),
              member(step(Goal, _), Steps) ),
            Goals),
    directory_file_path(Dir, 'session.pl', Session),
    write_file(Session, '~@',
               [forall(member(Goal, Goals), format('?- ~w~n', [Goal]))]).

%!  folder_contents(+Dir, -Contents:list(pair)) is det.
%
%   Contents are Name-Text, or Name-directory.  Saved agents and networks are
%   `saved`, as they have the version of Prolog, and names of variables.

folder_contents(Dir, Contents) :-
    directory_files(Dir, Names),
    findall(Name-Content, ( member(Name, Names),
                            content(Dir, Name, Content) ), Contents0),
    sort(Contents0, Contents).

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

%!  contents_differ(+Folders:list, -Names) is det.
%
%   Names are those of files that some of the Folders lack or have otherwise.

contents_differ(Folders, Names) :-
    append(Folders, All),
    findall(Name, ( member(Name-Content, All),
                    member(Folder, Folders),
                    \+ memberchk(Name-Content, Folder) ), Names0),
    sort(Names0, Names).
