:- module(typhon_paths, [path_below/1]).   % @Path
:- autoload(library(filesex), [directory_file_path/3]).

/** <module> Search paths of programs and payloads

The file search paths `agents` and `payloads` are defined here. agents(census) is
agents/census.pl in the working directory, else in the directory of this pack.
More directories are declared as for any search path, by clauses for
user:file_search_path/2.  Where library(typhon) is not that of an installed
pack, `library` also finds the one that is loaded.

*Threading*: any thread.
*/

:- dynamic
    root/1,                             % Directory of the pack
    user:file_search_path/2.

:- multifile user:file_search_path/2.

%   The root of the pack is four folders up, whatever their names.

:- module_property(typhon_paths, file(Source)),
   file_directory_name(Source, Dir),
   absolute_file_name('../../../..', Root,
                      [relative_to(Dir), file_type(directory)]),
   retractall(root(_)),
   assertz(root(Root)).

user:file_search_path(agents, Dir) :-
    program_directory(agents, Dir).
user:file_search_path(payloads, Dir) :-
    program_directory(payloads, Dir).

%   In a clone of the repository library(typhon) belongs to no pack: agents
%   whose programs import it must find the one that is loaded.

:- module_property(typhon_paths, file(Source)),
   file_directory_name(Source, Dir),
   absolute_file_name('../../..', Prolog,
                      [relative_to(Dir), file_type(directory)]),
   (   absolute_file_name(library(typhon), File,
                          [ file_type(prolog), access(read),
                            file_errors(fail) ]),
       file_directory_name(File, Prolog)
   ->  true
   ;   asserta(user:file_search_path(library, Prolog))
   ).

program_directory(Kind, Dir) :-
    (   working_directory(Parent, Parent)
    ;   root(Parent)
    ),
    directory_file_path(Parent, Kind, Dir).

%!  path_below(@Path) is semidet.
%
%   Path, Name or Folder/Name, does not leave the folder in which it is looked
%   for.

path_below(Path) :-
    atomic(Path),
    \+ sub_atom(Path, _, _, _, '..'),
    \+ is_absolute_file_name(Path).
path_below(Path) :-
    compound(Path),
    Path = Folder/Name,
    path_below(Folder),
    path_below(Name).
