:- module(typhon_paths,
          [ program_file/2,             % +Spec, -File
            included_file/3,            % +Spec, +Includer, -File
            files_beside/3,             % +File, +Dir, -Files
            path_below/1                % @Path
          ]).

/** <module> Where agent programs and payloads are found

Defines the file search paths `agents` and `payloads`. agents(census) is
agents/census.pl in the working directory, else in the directory of this pack.
More directories are declared as for any search path, by clauses for
user:file_search_path/2.  Where library(typhon) is not that of an installed
pack, `library` also finds the one that is loaded.

*Threading*: any thread.
*/

:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- autoload(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2]).

:- dynamic root/1.

%   The root of the pack is four folders up, whatever their names.

:- module_property(typhon_paths, file(Source)),
   file_directory_name(Source, Dir),
   absolute_file_name('../../../..', Root,
                      [relative_to(Dir), file_type(directory)]),
   retractall(root(_)),
   assertz(root(Root)).

:- multifile
    typhon_names:known/2,
    user:file_search_path/2.
:- dynamic user:file_search_path/2.

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

program_directory(Kind, Dir) :-
    (   working_directory(Parent, Parent)
    ;   root(Parent)
    ),
    directory_file_path(Parent, Kind, Dir).

%!  program_file(+Spec, -File) is det.
%!  included_file(+Spec, +Includer, -File) is det.
%
%   File is the absolute name of the clause file Spec: a term such as
%   agents(census), or a file name, relative to the working directory or to
%   that of the file Includer.  The extension `.pl` may be left out.
%
%   @error existence_error(source_sink, Spec), or permission_error(open,
%   source_sink, File) if it exists, and may not be read

program_file(Text, File) :-
    string(Text),
    !,
    atom_string(Spec, Text),
    program_file(Spec, File).
program_file(Spec, File) :-
    must_be(callable, Spec),
    clause_file(Spec, [], File).

included_file(Spec, Includer, File) :-
    file_directory_name(Includer, Dir),
    clause_file(Spec, [relative_to(Dir)], File).

clause_file(Spec, Options0, File) :-
    Options = [extensions(['',pl])|Options0],
    catch(absolute_file_name(Spec, File, [access(read)|Options]),
          error(existence_error(_, _), _),
          not_to_be_read(Spec, Options)).

not_to_be_read(Spec, Options) :-
    absolute_file_name(Spec, File,
                       [access(exist), file_errors(fail)|Options]),
    exists_file(File),
    !,
    permission_error(open, source_sink, File).
not_to_be_read(Spec, _) :-
    existence_error(source_sink, Spec).

%!  files_beside(+File:atom, +Dir, -Files:list) is semidet.
%
%   Files are names, relative to Dir, that the user may have meant by File, a
%   clause file that does not exist.

files_beside(File, Dir, Files) :-
    file_directory_name(File, Folder),
    absolute_file_name(Folder, Path, [relative_to(Dir)]),
    catch(directory_files(Path, Entries), error(_, _), fail),
    findall(Name,
            ( member(Entry, Entries),
              file_name_extension(Base, pl, Entry),
              ( file_name_extension(_, pl, File) -> Named = Entry
              ; Named = Base
              ),
              in_folder(Folder, Named, Name) ),
            Files).

in_folder('.', Base, Base) :-
    !.
in_folder(Folder, Base, Name) :-
    directory_file_path(Folder, Base, Name).

%   Names as in agents(Name), also of programs in folders, but not of the files
%   that these include.

typhon_names:known(Alias, Name) :-
    member(Alias-Kind, [agents-agent, payloads-payload]),
    Spec =.. [Alias, '.'],
    absolute_file_name(Spec, Dir,
                       [ file_type(directory), solutions(all),
                         file_errors(fail)
                       ]),
    catch(program_in(Dir, Kind, Name), error(_, _), fail).

program_in(Dir, Kind, Name) :-
    directory_member(Dir, File, [extensions([pl]), recursive(true)]),
    exists_file(File),
    catch(begins_with(File, Kind), error(_, _), fail),
    directory_file_path(Dir, Relative, File),
    file_name_extension(Name, pl, Relative).

begins_with(File, Kind) :-
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        read_term(In, (:- Declaration), []),
        close(In)),
    functor(Declaration, Kind, _).
