:- module(test_documents,
          [ document/1,                 % -File
            prose/2,                    % +File, -Text
            outside/3                   % +Text, +Mark, -Outside
          ]).
:- use_module(common, [project_file/2]).
:- use_module('../../doc/site/documents', [document/2]).

:- use_module(library(lists), [nth0/3]).
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
