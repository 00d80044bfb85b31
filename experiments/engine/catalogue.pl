:- module(study_catalogue,
          [ catalogue/1,                % -Rows
            studies_named/2             % +Names, -Files
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [append/2, member/2]).
:- use_module(studies, [study_call/2, study_load/2, study_title/3]).

/** <module> The studies that are there

Studies of the thesis are the files figure_*.pl below `experiments`.

*Threading*: the thread that loads studies.
*/

:- dynamic experiments/1.

:- prolog_load_context(directory, Engine),
   file_directory_name(Engine, Experiments),
   retractall(experiments(_)),
   assertz(experiments(Experiments)).

study_file(File) :-
    experiments(Directory),
    findall(File, ( directory_member(Directory, File,
                                     [ recursive(true), extensions([pl]) ]),
                    file_base_name(File, Base),
                    ( sub_atom(Base, 0, _, _, figure_)
                    ; sub_atom(Base, 0, _, _, study_) ) ),
            Files0),
    sort(Files0, Files),
    member(File, Files).

%!  catalogue(-Rows:list) is det.
%
%   Rows are [Name, Title], in the order of names.

catalogue(Rows) :-
    findall([Name, Title],
            ( study_file(File),
              study_load(File, Study),
              study_title(Study, Name, Title) ),
            Rows0),
    sort(Rows0, Rows).

%!  studies_named(+Names:list(atom), -Files:list(atom)) is det.
%
%   A name is that of a file, of a study or of one of its plots, `thesis` (all
%   but those that are named real), or a folder below `experiments`.
%
%   @error existence_error(study, Name)

studies_named(Names, Files) :-
    maplist(named, Names, Lists),
    append(Lists, Files).

named(Name, [File]) :-
    absolute_file_name(Name, File,
                       [ file_type(prolog), access(read), file_errors(fail) ]),
    !.
named(Name, Files) :-
    findall(File, ( study_file(File), goes_by(Name, File) ), Files),
    Files = [_|_],
    !.
named(Name, _) :-
    existence_error(study, Name).

goes_by(thesis, _) :-
    !.
goes_by(Name, File) :-
    file_directory_name(File, Directory),
    file_base_name(Directory, Name),
    !.
goes_by(Name, File) :-
    study_load(File, Study),
    (   study_title(Study, Name, _)
    ;   study_call(Study, plot(Name, _, _))
    ),
    !.
