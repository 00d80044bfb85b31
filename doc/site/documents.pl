:- module(site_documents,
          [ document/2                  % +Root, -Path
          ]).

/** <module> The documents

*Threading*: any thread.
*/

:- use_module(library(filesex),
              [directory_file_path/3, relative_file_name/3]).
:- use_module(library(lists), [member/2]).

%!  document(+Root, -Path) is nondet.
%
%   Path, from the directory Root of the project on, is a document: it is a page
%   of the site, what it shows is tried, and its links lead somewhere.

document(Root, Path) :-
    folder(Folder),
    directory_file_path(Root, Folder, Pattern),
    expand_file_name(Pattern, Files),
    directory_file_path(Root, file, Beside),
    member(File, Files),
    relative_file_name(File, Beside, Path).

folder('*.md').
folder('doc/*.md').
folder('doc/course/*.md').
folder('doc/decisions/*.md').
folder('doc/fidelity/*.md').
