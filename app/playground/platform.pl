:- module(typhon_platform,
          [ platform_save/1,            % +State
            platform_boot/0
          ]).
:- use_module(twister, []).
:- use_module(library(filesex), [directory_member/3, make_directory_path/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(qsave), [qsave_program/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(zip),
              [ with_zipper/2, zip_close/1, zip_open/4, zipper_members/2 ]).
:- use_module('../../prolog/typhon', []).
:- use_module(library(aggregate), []).
:- use_module(library(assoc), []).
:- use_module(library(dcg/basics), []).
:- use_module(library(dcg/high_order), []).
:- use_module(library(dicts), []).
:- use_module(library(gensym), []).
:- use_module(library(heaps), []).
:- use_module(library(nb_set), []).
:- use_module(library(occurs), []).
:- use_module(library(ordsets), []).
:- use_module(library(pairs), []).
:- use_module(library(prolog_debug), []).        % spy/1
:- use_module(library(random), []).
:- use_module(library(rbtrees), []).
:- use_module(library(solution_sequences), []).
:- use_module(library(strings), []).
:- use_module(library(terms), []).
:- use_module(library(ugraphs), []).
:- use_module(library(varnumbers), []).
:- use_module(library(yall), []).

/** <module> A saved state of the platform for WebAssembly

The state holds what the platform loads on demand elsewhere, but for parts that
need sockets, processes or threads, and the libraries that programs may load.
Booting it loads nothing; no file has to be there.

*Threading*: one thread.
*/

:- dynamic
    kept/2.                     % File, Text: of a loaded file, or of an index of
                                % libraries

%!  platform_save(+State) is det.
%
%   Write a saved state into the file State.

platform_save(State) :-
    load_parts,
    load_libraries,
    forall(source_file(File), keep_head(File)),
    forall(absolute_file_name(library('INDEX.pl'), File,
                              [solutions(all), access(read)]),
           keep_index(File)),
    atom_concat(State, '.zip', Packed),
    qsave_program(Packed, [ stand_alone(false), autoload(false),
                            foreign(no_save) ]),
    store(Packed, State).

%   The whole is compressed on its way, which makes less of it than compressing
%   its parts here does.

store(Packed, State) :-
    setup_call_cleanup(
        zip_open(Packed, read, From, []),
        setup_call_cleanup(
            zip_open(State, write, To, []),
            ( zipper_members(From, Names),
              forall(member(Name, Names), store_member(From, Name, To)) ),
            zip_close(To)),
        zip_close(From)).

store_member(From, Name, To) :-
    with_zipper(From,
                ( zipper_goto(From, file(Name)),
                  copy_member(From, Name, To) )).

copy_member(From, Name, To) :-
    setup_call_cleanup(
        zipper_open_current(From, In, [type(binary), release(false)]),
        setup_call_cleanup(
            zipper_open_new_file_in_zip(To, Name, Out, [method(store)]),
            copy_stream_data(In, Out),
            close(Out)),
        close(In)).

load_parts :-
    forall(( directory_member('/typhon/prolog/typhon', File,
                              [extensions([pl]), recursive(true)]),
             \+ ( left_out(Part), sub_atom(File, _, _, _, Part) ) ),
           use_module(File, [])).

left_out('/typhon/bridges').
left_out(Interface) :-                  % of a bridge
    directory_files('/typhon/prolog/typhon/bridges', Names),
    member(Name, Names),
    format(atom(Interface), '/typhon/~w.pl', [Name]).
left_out('/options/cell').
left_out('/options/fleet').
left_out('/options/journal').
left_out('/options/people').
left_out('/options/tls').
left_out('/tools/page').

%   Load the libraries of Prolog that modules load when they use them, but not
%   those that this Prolog lacks, such as library(process).

load_libraries :-
    findall(Spec, later_library(Spec), Specs0),
    sort(Specs0, Specs),
    (   Specs == []
    ->  true
    ;   forall(member(Spec, Specs), use_module(Spec, [])),
        load_libraries
    ).

later_library(Spec) :-
    current_module(Module),
    current_predicate(Module:'$autoload'/3),
    Module:'$autoload'(Spec, _, _),
    Spec = library(_),
    absolute_file_name(Spec, File,
                       [file_type(prolog), access(read), file_errors(fail)]),
    file_name_extension(Base, _, File),     % it may be compiled
    file_name_extension(Base, pl, Source),
    \+ source_file(Source),
    file_base_name(Base, Name),
    \+ developers_library(Name).

%   Tools for programmers, which others load; no program of an agent uses them.

developers_library(check).
developers_library(predicate_options).
developers_library(prolog_autoload).
developers_library(prolog_codewalk).

%   Prolog looks for the exports of a module in its file also if that is loaded.

keep_head(File) :-
    (   module_property(Module, file(File))
    ->  module_property(Module, exports(Exports)),
        keep(File, [(:- module(Module, Exports))])
    ;   keep(File, [])
    ).

%   Only libraries that are loaded can be loaded by Prolog itself.

keep_index(File) :-
    file_directory_name(File, Directory),
    read_file_to_terms(File, All, []),
    findall(Term,
            ( member(Term, All),
              functor(Term, index, Arity),
              arg(Arity, Term, Library),
              atomic_list_concat([Directory, /, Library, '.pl'], Source),
              source_file(Source) ),
            Terms),
    keep(File, Terms).

keep(File, Terms) :-
    with_output_to(string(Text),
                   forall(member(Term, Terms), format('~q.~n', [Term]))),
    assertz(kept(File, Text)).

%!  platform_boot is det.
%
%   Begin in a process that was started from the state.

platform_boot :-
    set_prolog_flag(autoload, true),
    create_prolog_flag(home, '/swipl', []),
    forall(kept(File, Text), write_file(File, Text)),
    reload_library_index.

write_file(File, Text) :-
    file_directory_name(File, Directory),
    make_directory_path(Directory),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        write(Out, Text),
        close(Out)).
