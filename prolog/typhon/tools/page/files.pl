:- module(typhon_page_files,
          [ page_file/3                 % +Names, -File, -Type
          ]).
:- use_module(library(filesex), [directory_file_path/3]).

/** <module> The files of which the page is made

*Threading*: any thread.
*/

:- dynamic folder/1.

:- prolog_load_context(directory, Dir),
   directory_file_path(Dir, www, Www),
   retractall(folder(_)),
   assertz(folder(Www)).

%!  page_file(+Names:list(atom), -File, -Type) is semidet.
%
%   File is what the last parts of an address mean, and of Type.  No name
%   leads out of the folder, hidden files are not served, and a zero, at which
%   the system would end the name, is in no name.

page_file([''], File, Type) :-
    !,
    page_file(['index.html'], File, Type).
page_file([Name], File, Type) :-
    plain(Name),
    file_name_extension(_, Extension, Name),
    type(Extension, Type),
    folder(Folder),
    directory_file_path(Folder, Name, File),
    exists_file(File).

plain(Name) :-
    \+ sub_atom(Name, 0, _, _, '.'),
    \+ sub_atom(Name, _, _, _, /),
    \+ sub_atom(Name, _, _, _, \),
    \+ sub_atom(Name, _, _, _, '\x00\').

type(html, 'text/html; charset=UTF-8').
type(js, 'text/javascript; charset=UTF-8').
type(css, 'text/css; charset=UTF-8').
type(svg, 'image/svg+xml').
