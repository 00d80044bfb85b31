:- module(study_sources,
          [ study_sources/2,            % +Study, -Files
            sources_hash/2              % +Study, -Hash
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [append/2, append/3, member/2, memberchk/2]).
:- use_module(library(prolog_source),
              [prolog_close_source/1, prolog_open_source/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).

/** <module> What a run is made by

The sources of a study are its own file and what that names in directives,
and what these name; the platform and the engine as a whole.  Agents are
clause files that hosts read when they create one: those beside the study
count, and all in directories of `agents` that something else is named in,
in `agents/lib` and `payloads`.

*Threading*: no state; any thread.
*/

:- dynamic project/1.

:- prolog_load_context(directory, Engine),
   file_directory_name(Engine, Experiments),
   file_directory_name(Experiments, Root),
   retractall(project(_)),
   assertz(project(Root)).

%!  study_sources(+Study, -Files:list(atom)) is det.
%
%   Absolute names, sorted.  Study is the name of its file.

study_sources(Study, Files) :-
    findall(Program, program_beside(Study, Program), Programs),
    named_from([Study|Programs], [], Named),
    findall(File, ( of_agents(Named, Directory),
                    below_directory(Directory, [pl], File) ), Agents),
    findall(File, common(File), Common),
    append([Named, Agents, Common], All),
    sort(All, Files).

%   program_beside(+Study, -File): an agent program, or a payload.

program_beside(Study, File) :-
    file_directory_name(Study, Directory),
    directory_member(Directory, File, [extensions([pl])]),
    first_term(File, (:- Declaration)),
    nonvar(Declaration),
    functor(Declaration, Kind, _),
    memberchk(Kind, [agent, payload]).

of_agents(Named, Directory) :-
    below(agents, Agents),
    findall(D, ( member(File, Named), file_directory_name(File, D),
                 atom_concat(Agents, _, D) ), Directories),
    sort(Directories, Distinct),
    member(Directory, Distinct).
of_agents(_, Directory) :-
    member(Name, ['agents/lib', payloads]),
    below(Name, Directory).

common(File) :-
    member(Name, [prolog, 'experiments/engine']),
    below(Name, Directory),
    below_directory(Directory, [pl], File).

below_directory(Directory, Extensions, File) :-
    exists_directory(Directory),
    directory_member(Directory, File,
                     [recursive(true), extensions(Extensions)]).

below(Name, Path) :-
    project(Root),
    directory_file_path(Root, Name, Path).

%   named_from(+Files, +Seen, -Named): what comes with Prolog, and the
%   platform, are not followed.

named_from([], Named, Named).
named_from([File|Files], Seen, Named) :-
    memberchk(File, Seen),
    !,
    named_from(Files, Seen, Named).
named_from([File|Files], Seen, Named) :-
    findall(Next, ( names(File, Next), followed(Next) ), Nexts),
    append(Nexts, Files, Files1),
    named_from(Files1, [File|Seen], Named).

followed(File) :-
    below(prolog, Platform),
    \+ atom_concat(Platform, _, File),
    current_prolog_flag(home, Home),
    \+ atom_concat(Home, _, File).

names(File, Named) :-
    source_term(File, (:- Directive)),
    file_of(Directive, Spec),
    absolute_file_name(Spec, Named,
                       [ file_type(prolog), access(read),
                         relative_to(File), file_errors(fail) ]).

first_term(File, Term) :-
    once(source_term(File, First)),
    First = Term.

source_term(File, Term) :-
    setup_call_cleanup(
        prolog_open_source(File, In),
        ( repeat,
          read_term(In, Term0, []),
          ( Term0 == end_of_file -> !, fail ; true ),
          Term = Term0 ),
        prolog_close_source(In)).

file_of(Directive, File) :-
    compound(Directive),
    functor(Directive, Name, _),
    memberchk(Name, [use_module, reexport, ensure_loaded, include, consult]),
    arg(1, Directive, Files),
    (   is_list(Files)
    ->  member(File, Files)
    ;   File = Files
    ).

%!  sources_hash(+Study, -Hash:atom) is det.
%
%   Of the names and the contents of the sources.  What Study itself says
%   of cases, which runs are known by, and of what is shown of them, does not
%   count: it may change, and the runs stay.

sources_hash(Study, Hash) :-
    study_sources(Study, Files),
    maplist(file_hash(Study), Files, Hashes),
    format(string(Text), '~w', [Hashes]),
    text_hash(Text, Hash).

file_hash(Study, Study, study-Hash) :-
    !,
    findall(Text,
            ( source_term(Study, Term),
              \+ of_no_run(Term),
              format(string(Text), '~k', [Term]) ),
            Texts),
    atomic_list_concat(Texts, '\n', All),
    text_hash(All, Hash).
file_hash(_, File, Name-Hash) :-
    file_base_name(File, Name),
    read_file_to_string(File, Text, [encoding(utf8)]),
    text_hash(Text, Hash).

of_no_run(Term) :-
    ( Term = (Head :- _) -> true ; Head = Term ),
    callable(Head),
    functor(Head, Name, Arity),
    memberchk(Name/Arity,
              [ study/2, text/1, vary/2, fixed/3, derive/3, skip/1, label/2,
                printed/3, claim/3, plot/3, progress/3 ]).

text_hash(Text, Hash) :-
    sha_hash(Text, Bytes, [encoding(utf8)]),
    hash_atom(Bytes, Hash).
