:- module(doc_pictures, []).

/** <module> All pictures of README and doc

    swipl doc/pictures.pl -- doc/img                    `make pictures`
    swipl doc/pictures.pl -- doc/img page spacetime     only these kinds

Kinds are `layers`, `spacetime`, `page`, `applications` and `studies`; the last
makes ten runs of each study shown, or RUNS, which takes many minutes.  All are
made from networks that are started for them.

*Threading*: the main thread.
*/

:- use_module('../app/typhon/arguments', [arguments/3]).
:- use_module(pictures/applications, [application_pictures/1]).
:- use_module(pictures/layers, [layers_picture/1]).
:- use_module(pictures/page, [page_pictures/1]).
:- use_module(pictures/spacetime, [spacetime_picture/1]).
:- use_module(pictures/studies, [study_pictures/1]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(filesex), [make_directory_path/1]).
:- use_module(library(main), [main/0]).

:- initialization(main, main).

:- public main/1.

main(Argv) :-
    arguments(Argv, Words, []),
    pictures(Words).

pictures([Directory]) :-
    !,
    pictures([Directory, layers, spacetime, page, applications, studies]).
pictures([Directory|Kinds]) :-
    must_be(list(oneof([ layers, spacetime, page, applications, studies ])),
            Kinds),
    make_directory_path(Directory),
    maplist(make(Directory), Kinds).

make(Directory, layers) :- layers_picture(Directory).
make(Directory, spacetime) :- spacetime_picture(Directory).
make(Directory, page) :- page_pictures(Directory).
make(Directory, applications) :- application_pictures(Directory).
make(Directory, studies) :- study_pictures(Directory).
