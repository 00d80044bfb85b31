:- module(test_documents,
          [ document/1,                 % -File
            prose/2,                    % +File, -Text
            outside/3,                  % +Text, +Mark, -Outside
            blocks/2,                   % +File, -Blocks
            block_file/2,               % +Block, -Name
            block_text/2,               % +Lines, -Text
            block_write/2               % +Directory, +Block
          ]).
:- use_module(common, [project_file/2]).
:- use_module('../../doc/site/documents', [document/2]).

:- use_module(texts, [file_lines/2, write_file/2]).

:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3, memberchk/2, nth0/3]).
:- use_module(library(readutil), [read_file_to_string/3]).

/** <module> The documents of the project

*Threading*: any thread.
*/

%!  document(-File) is nondet.
%
%   File is the absolute name of a document.

document(File) :-
    project_file('.', Root),
    document(Root, Path),
    project_file(Path, File).

%!  prose(+File, -Text:atom) is det.
%
%   Text of a document, without its blocks and what is code in a line.

prose(File, Prose) :-
    read_file_to_string(File, Text, [encoding(utf8)]),
    outside(Text, "```", Lines),
    atomic_list_concat(Lines, Joined),
    outside(Joined, "`", Parts),
    atomic_list_concat(Parts, Prose).

%!  outside(+Text, +Mark, -Outside:list) is det.
%
%   Outside are the parts of Text that are not between two Marks.

outside(Text, Mark, Outside) :-
    atomic_list_concat(Parts, Mark, Text),
    findall(Part, ( nth0(N, Parts, Part), N mod 2 =:= 0 ), Outside).

                /*******************************
                *            BLOCKS            *
                *******************************/

%!  blocks(+File, -Blocks:list) is det.
%
%   Blocks are block(Kind, Line, Lines), Line being where the block begins.

blocks(File, Blocks) :-
    file_lines(File, Lines),
    blocks(Lines, 1, Blocks).

blocks([], _, []).
blocks([Line|Lines], N, Blocks) :-
    string_concat("```", Kind, Line),
    !,
    append(Body, ["```"|Rest], Lines),
    !,
    length(Body, Length),
    N1 is N+Length+2,
    Blocks = [block(Kind, N, Body)|More],
    blocks(Rest, N1, More).
blocks([_|Lines], N, Blocks) :-
    N1 is N+1,
    blocks(Lines, N1, Blocks).

%!  block_file(+Block, -Name) is semidet.
%
%   Block is the file Name, as its first line says.

block_file(block("python", _, [First|_]), Name) :-
    split_string(First, " ", "", ["#", Name]),
    string_concat(_, ".py", Name).
block_file(block(Kind, _, [First|_]), Name) :-
    memberchk(Kind, ["prolog", "text"]),
    split_string(First, " ", ":", ["%", Name|_]),
    string_concat(_, ".pl", Name).

%!  block_text(+Lines, -Text:atom) is det.

block_text(Lines, Text) :-
    atomic_list_concat(Lines, '\n', Text0),
    atom_concat(Text0, '\n', Text).

%!  block_write(+Directory, +Block) is det.
%
%   Write Block into its file below Directory, if it is a file.

block_write(Dir, Block) :-
    (   block_file(Block, Name)
    ->  Block = block(_, _, Lines),
        directory_file_path(Dir, Name, File),
        file_directory_name(File, Parent),
        make_directory_path(Parent),
        block_text(Lines, Text),
        write_file(File, Text)
    ;   true
    ).
