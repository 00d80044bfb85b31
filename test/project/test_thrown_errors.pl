:- module(test_thrown_errors, []).
:- use_module('../lib/common', [project_file/2]).
:- use_module('../lib/texts', [message_text/2]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(prolog_source),
              [ prolog_close_source/1, prolog_open_source/2,
                prolog_read_source_term/4 ]).
:- use_module(library(terms), [foldsubterms/4]).
:- use_module(library(typhon)).

/** <module> Each error that the programs throw has a message

*Threading*: the main thread.
*/

:- begin_tests(thrown_errors).

test(errors_have_messages, Missing == []) :-
    findall(Formal-File, thrown(File, Formal), Thrown0),
    sort(Thrown0, Thrown),
    assertion(memberchk(host_unreachable(_)-_, Thrown)),
    findall(Formal-File,
            ( member(Formal-File, Thrown),
              load_files(File, [if(not_loaded), imports([])]),
              without_message(Formal) ),
            Missing).

:- end_tests(thrown_errors).

%   The errors that ISO has are not looked for: Prolog has a message of each.

iso(Formal) :-
    member(Name, [ instantiation, type, domain, existence, permission,
                   representation, resource, syntax, timeout, evaluation ]),
    atom_concat(Name, '_error', Functor),
    functor(Formal, Functor, _).

thrown(File, Formal) :-
    member(Dir, [prolog, app, experiments]),
    project_file(Dir, Path),
    directory_member(Path, File, [extensions([pl]), recursive(true)]),
    setup_call_cleanup(prolog_open_source(File, In),
                       findall(Formal, thrown_in(In, Formal), Formals),
                       prolog_close_source(In)),
    member(Formal, Formals).

thrown_in(In, Formal) :-
    repeat,
    prolog_read_source_term(In, Term, _, []),
    (   Term == end_of_file
    ->  !,
        fail
    ;   foldsubterms(throws, Term, Formals, []),
        member(Formal, Formals)
    ).

throws(throw(error(Formal, _)), [Formal|Rest], Rest) :-
    nonvar(Formal),
    \+ iso(Formal).

%   A message may accept only some arguments.

without_message(Formal) :-
    \+ caught(Formal),
    \+ has_message(Formal).

has_message(Formal) :-
    term_variables(Formal, Arguments),
    maplist(argument, Arguments),
    catch(message_text(error(Formal, _), Text), error(_, _), fail),
    \+ sub_string(Text, _, _, _, "Unknown error"),
    !.

argument(x).
argument([x]).
argument(no_network).
argument(shape([], [])).
argument([errors]).

%   caught(?Formal): the module that throws it catches it, or its neighbour.

caught(crowd).
caught(session_closed).
caught(cell_violation(_)).
caught(page_syntax(_, _, _)).
caught(typhon_usage(_)).                % see test_app.pl
