:- module(study_catalogue,
          [ catalogue/1,                % -Rows
            studies_named/2             % +Names, -Files
          ]).
:- use_module(library(apply), [convlist/3, maplist/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists),
              [append/2, list_to_set/2, member/2, memberchk/2]).
:- use_module(library(pairs), [map_list_to_pairs/3, pairs_values/2]).
:- use_module('../../prolog/typhon/kernel/base/names', [names_proposed/3]).
:- use_module('../../prolog/typhon/language', [files_beside/3]).
:- use_module(studies, [study_call/2, study_load/2, study_title/3]).

/** <module> The available studies

Files below `experiments`: figure_*.pl and table_*.pl for figures and tables of
the thesis, beyond_*.pl for studies beyond the thesis, and study_*.pl for
background studies: readings of the thesis, values it does not print, demos.

*Threading*: the thread that loads studies.
*/

:- dynamic experiments/1.

:- prolog_load_context(directory, Engine),
   file_directory_name(Engine, Experiments),
   retractall(experiments(_)),
   assertz(experiments(Experiments)).

study_files(Files) :-
    experiments(Directory),
    findall(File, ( directory_member(Directory, File,
                                     [ recursive(true), extensions([pl]) ]),
                    is_study(File) ),
            Files0),
    sort(Files0, Files).

is_study(File) :-
    begins(File, [figure_, table_, beyond_, study_]).

begins(File, Starts) :-
    file_base_name(File, Base),
    member(Start, Starts),
    sub_atom(Base, 0, _, _, Start),
    !.

%   A study that does not load is reported, and does not affect the others.

loads(File, Study) :-
    catch(study_load(File, Study), error(Formal, Context),
          ( print_message(warning, error(Formal, Context)),
            fail )).

%!  catalogue(-Rows:list) is det.
%
%   Rows are [Name, Title], in the order of names: 5.10 after 5.9.

catalogue(Rows) :-
    study_files(Files),
    convlist(loads, Files, Studies),
    findall(Key-[Name, Title],
            ( member(Study, Studies),
              study_title(Study, Name, Title),
              natural_key(Name, Key) ),
            Keyed0),
    keysort(Keyed0, Keyed),
    pairs_values(Keyed, Rows).

natural_key(Name, Key) :-
    atomic_list_concat(Parts, '.', Name),
    maplist(number_or_text, Parts, Key).

number_or_text(Part, Key) :-
    (   atom_number(Part, Number)
    ->  Key = Number
    ;   Key = Part
    ).

%!  studies_named(+Names:list(atom), -Files:list(atom)) is det.
%
%   A name is the name of a file, of a study or of one of its plots, a folder
%   below `experiments`, `thesis`: its figures and tables, or `beyond`: the
%   studies beyond it.
%
%   @error existence_error(study, Name)

studies_named(Names, Files) :-
    maplist(named, Names, Lists),
    append(Lists, All),
    list_to_set(All, Files).

named(Name, [File]) :-
    absolute_file_name(Name, File,
                       [ file_type(prolog), access(read), file_errors(fail) ]),
    !.
named(Name, Files) :-
    kinds(Name, Kinds),
    !,
    study_files(All),
    findall(File, ( member(File, All), begins(File, Kinds) ), Files0),
    in_order(Files0, Files).
named(Name, Files) :-
    study_files(All),
    (   Finder = in_folder
    ;   Finder = by_name
    ;   Finder = goes_by
    ),
    findall(File, ( member(File, All), call(Finder, Name, File) ), Files0),
    Files0 = [_|_],
    !,
    in_order(Files0, Files).
named(Name, _) :-
    existence_error(study, Name).

kinds(thesis, [figure_, table_]).
kinds(beyond, [beyond_]).

:- multifile
    prolog:error_message//1.

prolog:error_message(existence_error(study, Name)) -->
    { catalogue(Rows),
      ( files_beside(Name, '.', Files) -> true ; Files = [] ),
      findall(Known, ( member([Known, _], Rows) ; member(Known, Files) ),
              Names),
      names_proposed(Name, Names, Meant)
    },
    [ 'There is no study ~w~w'-[Name, Meant] ].

%   Figures first, 4.7 before 4.13.

in_order(Files0, Files) :-
    map_list_to_pairs(file_key, Files0, Keyed0),
    keysort(Keyed0, Keyed),
    pairs_values(Keyed, Files).

file_key(File, Rank-Key) :-
    file_base_name(File, Base),
    file_name_extension(Stem, _, Base),
    atomic_list_concat([Kind|Parts], '_', Stem),
    ( memberchk(Kind, [figure, table]) -> Rank = 0 ; Rank = 1 ),
    maplist(number_or_text, Parts, Key).

in_folder(Name, File) :-
    file_directory_name(File, Directory),
    file_base_name(Directory, Name).

%   5.6 is in figure_5_6.pl, solar in study_solar.pl: nothing else needs to be
%   loaded.

by_name(Name, File) :-
    atomic_list_concat(Parts, '.', Name),
    member(Kind, [figure, table, beyond, study]),
    atomic_list_concat([Kind|Parts], '_', Base),
    file_base_name(File, FileBase),
    file_name_extension(Base, pl, FileBase).

goes_by(Name, File) :-
    loads(File, Study),
    (   study_title(Study, Name, _)
    ;   study_call(Study, plot(Name, _, _))
    ),
    !.
