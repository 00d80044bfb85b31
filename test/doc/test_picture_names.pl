:- module(test_picture_names, []).

% Pictures of the documents are made by doc/pictures.pl.

:- use_module('../../doc/pictures/studies', [study_picture/3]).
:- use_module('../lib/common').
:- use_module('../lib/documents', [document/1, prose/2]).
:- use_module('../../doc/site/markdown', [link_target/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).

is_made('layers.svg').
is_made('spacetime.svg').
is_made(Picture) :-
    member(Kind, ['page-', 'application-']),
    atom_concat(Kind, _, Picture).
is_made(Picture) :-
    study_picture(Picture, _, _).

scouts_made(Text, Dir) :-
    project_file('doc/pictures.pl', Script),
    run_swipl([Script, '--', Dir, spacetime], [], exit(0), _, _),
    directory_file_path(Dir, 'spacetime.svg', File),
    read_file_to_string(File, Text, []).

:- begin_tests(picture_names).

% The pictures of layers and of virtual time are reproducible, but the former
% changes with each module.

test(all_pictures_are_made_by_one_command, Missing == []) :-
    findall(Picture,
            ( document(File),
              prose(File, Text),
              link_target(Text, Link),
              file_directory_name(Link, Dir),
              file_base_name(Dir, img),
              file_base_name(Link, Picture),
              \+ is_made(Picture) ),
            Missing).
test(picture_of_scouts_is_up_to_date, Shown == Made) :-
    with_tmp_dir(scouts_made(Made)),
    project_file('doc/img/spacetime.svg', File),
    read_file_to_string(File, Shown, []).

:- end_tests(picture_names).
