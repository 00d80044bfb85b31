:- module(test_documents,
          [ document/1                  % -File
          ]).
:- use_module(common, [project_file/2]).
:- use_module('../../doc/site/documents', [document/2]).

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
