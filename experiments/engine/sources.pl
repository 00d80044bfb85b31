:- module(study_sources,
          [ sources_hash/2,             % +Study, -Hash
            sources_changed/2,          % +Study, -File
            text_hash/2                 % +Text, -Hash
          ]).
:- use_module(library(apply), [include/3, partition/4]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, subtract/3]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(prolog_source),
              [prolog_close_source/1, prolog_open_source/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module(library(terms), [mapargs/3]).
:- use_module(studies, [study_at_work/1]).

/** <module> The sources that determine a run

Of a study and the files that it includes, the hash covers the clauses of
network/3, run/2, view/2 and measure/3, and of the predicates these mention.  It
covers all of the other files that are named, by use_module/2 and the like or as
agents(_) or payloads(_), unless no imported predicate is mentioned.  It covers
the agents in the directory of a study, in the directory of a covered agent, in
`agents/lib` and in `payloads`; the platform as a whole; and the part of the
engine that makes a run.

It does not cover the definitions of cases, which identify runs, nor those of
claims, plots and labels: these may change without repeating runs.

*Threading*: one thread.
*/

:- dynamic
    project/1,
    all_common/1,               % Files: see common/1
    hashed/3,                   % Study, Hash, Times
    read_before/3.              % File, Time, Kept: what was kept of File

:- prolog_load_context(directory, Engine),
   file_directory_name(Engine, Experiments),
   file_directory_name(Experiments, Root),
   retractall(project(_)),
   assertz(project(Root)).

%!  sources_hash(+Study, -Hash:atom) is det.
%
%   Hash has eight hexadecimal digits, and is computed once in a process.  Study
%   is the name of its file.

sources_hash(Study, Hash) :-
    hashed(Study, Hash, _),
    !.
sources_hash(Study, Hash) :-
    sources(Study, Terms, Named, Files),
    findall(File-Time, ( member(File, Files), time_file(File, Time) ),
            Times),
    findall(Base-Digest,
            ( member(File, Named), file_digest(File, Base, Digest) ),
            Digests0),
    msort(Digests0, Digests),
    plain(Terms, Plain),
    format(string(Text), '~k', [Plain-Digests]),
    text_hash(Text, Hash),
    assertz(hashed(Study, Hash, Times)).

%   plain(+Term, -Plain): replaces dicts, because processes write their keys in
%   different orders.

plain(Term, dict(Tag, Plain)) :-
    is_dict(Term),
    !,
    dict_pairs(Term, Tag, Pairs),
    plain(Pairs, Plain).
plain(Term, Plain) :-
    compound(Term),
    !,
    mapargs(plain, Term, Plain).
plain(Term, Term).

file_digest(File, Base, Digest) :-
    file_base_name(File, Base),
    of_file(File, digest(Digest)).

%   of_file(+File, ?What): studies share most files, so each is read once for
%   its digest(_), and once for its terms(_), as long as it does not change.

of_file(File, What) :-
    time_file(File, Time),
    functor(What, Kind, 1),
    functor(Kept, Kind, 1),
    (   read_before(File, Time, Kept)
    ->  true
    ;   read_now(Kept, File),
        assertz(read_before(File, Time, Kept))
    ),
    What = Kept.

read_now(digest(Digest), File) :-
    read_file_to_string(File, Text, [encoding(utf8)]),
    text_hash(Text, Digest).
read_now(terms(Terms), File) :-
    findall(Term, term_read(File, Term), Terms).

%!  text_hash(+Text, -Hash:atom) is det.

text_hash(Text, Hash) :-
    sha_hash(Text, Bytes, [encoding(utf8)]),
    hash_atom(Bytes, Hex),
    sub_atom(Hex, 0, 8, _, Hash).

%!  sources_changed(+Study, -File) is nondet.
%
%   The hash of Study covers File, which has changed since it was computed.

sources_changed(Study, File) :-
    hashed(Study, _, Times),
    member(File-Time, Times),
    \+ ( exists_file(File), time_file(File, Time) ).

                /*******************************
                *            FILES             *
                *******************************/

%   sources(+Study, -Terms, -Named, -Files): Terms are the covered terms of the
%   study and its included files, Named the other files, Files all files.

sources(Study, Terms, Named, Files) :-
    study_at_work(Study),
    included([Study], [], Included),
    findall(Term, ( member(File, Included), source_term(File, Term) ), All),
    of_run(All, Terms),
    findall(File, named_by(Study, Included, Terms, File), First),
    common_files(Common),
    append(First, Common, Begin),
    followed(Begin, [], Followed),
    sort(Followed, Named),
    append(Included, Named, Files).

included([], Seen, Seen).
included([File|Files], Seen, All) :-
    (   memberchk(File, Seen)
    ->  included(Files, Seen, All)
    ;   findall(Next, ( source_term(File, (:- include(Spec))),
                        source_file_of(Spec, File, Next) ), Nexts),
        append(Nexts, Files, Files1),
        append(Seen, [File], Seen1),
        included(Files1, Seen1, All)
    ).

named_by(_, Included, Terms, File) :-
    member(From, Included),
    member(Term, Terms),
    names(Term, Spec),
    source_file_of(Spec, From, File),
    \+ memberchk(File, Included).
named_by(Study, _, _, File) :-
    file_directory_name(Study, Directory),
    directory_member(Directory, File, [extensions([pl])]),
    once(source_term(File, First)),
    nonvar(First),
    First = (:- Declaration),
    compound(Declaration),
    functor(Declaration, Kind, _),
    memberchk(Kind, [agent, payload]).

common_files(Files) :-
    all_common(Files),
    !.
common_files(Files) :-
    findall(File, common(File), Files),
    assertz(all_common(Files)).

common(File) :-
    member(Name, [prolog, 'agents/lib', payloads]),
    project(Root),
    directory_file_path(Root, Name, Directory),
    exists_directory(Directory),
    directory_member(Directory, File, [recursive(true), extensions([pl])]).
common(File) :-
    module_property(study_sources, file(Here)),
    source_file_of(run, Here, File).

%   followed(+Files, +Seen, -All): does not follow files of Prolog and of the
%   platform.

followed([], All, All).
followed([File|Files], Seen, All) :-
    (   memberchk(File, Seen)
    ->  followed(Files, Seen, All)
    ;   findall(Next, named_in(File, Next), Nexts),
        append(Nexts, Files, Files1),
        followed(Files1, [File|Seen], All)
    ).

named_in(File, _) :-
    in_platform(File),
    !,
    fail.
named_in(File, Next) :-
    source_term(File, Term),
    names(Term, Spec),
    source_file_of(Spec, File, Next).
named_in(File, Next) :-
    project(Root),
    directory_file_path(Root, agents, Agents),
    atom_concat(Agents, _, File),
    file_directory_name(File, Directory),
    directory_member(Directory, Next, [extensions([pl])]).

in_platform(File) :-
    project(Root),
    member(Name, [prolog, experiments/engine]),
    format(atom(Start), '~w/~w/', [Root, Name]),
    atom_concat(Start, _, File).

source_file_of(Spec, From, File) :-
    absolute_file_name(Spec, File,
                       [ file_type(prolog), access(read),
                         relative_to(From), file_errors(fail) ]),
    current_prolog_flag(home, Home),
    \+ atom_concat(Home, _, File).

%   names(+Term, -Spec): Term names the file Spec.

names((:- Directive), Spec) :-
    compound(Directive),
    functor(Directive, Name, _),
    memberchk(Name, [use_module, reexport, ensure_loaded, include, consult]),
    !,
    arg(1, Directive, Files),
    (   is_list(Files)
    ->  member(Spec, Files)
    ;   Spec = Files
    ),
    ground(Spec).
names(Term, Spec) :-
    sub_term(Spec, Term),
    compound(Spec),
    ( Spec = agents(_) ; Spec = payloads(_) ),
    ground(Spec).

                /*******************************
                *            TERMS             *
                *******************************/

source_term(File, Term) :-
    of_file(File, terms(Terms)),
    member(Term, Terms).

term_read(File, Term) :-
    setup_call_cleanup(
        prolog_open_source(File, In),
        ( set_stream(In, encoding(utf8)),
          repeat,
          read_term(In, Term0, [syntax_errors(quiet)]),
          ( Term0 == end_of_file -> !, fail ; true ),
          Term = Term0 ),
        prolog_close_source(In)).

%   of_run(+Terms, -OfRun): keeps directives, except imports that no clause
%   mentions, and the mentioned clauses: by name, whatever their arity.

of_run(Terms, OfRun) :-
    partition(is_directive, Terms, Directives, Clauses),
    reached([network, run, view, measure], Clauses, [], Mentioned, Used),
    include(imports_any(Mentioned), Directives, Kept),
    append(Kept, Used, OfRun).

is_directive((:- _)).

imports_any(Mentioned, (:- Directive)) :-
    (   Directive = use_module(_, Imports),
        is_list(Imports)
    ->  member(PI, Imports),
        ( PI = (Name/_ as _) ; PI = Name/_ ; PI = Name//_ ),
        memberchk(Name, Mentioned)
    ;   true
    ),
    !.

reached([], _, Seen, Seen, []).
reached(Names, Clauses, Seen0, Seen, Used) :-
    Names = [_|_],
    partition(defines(Names), Clauses, Now, Later),
    append(Names, Seen0, Seen1),
    findall(Name, ( member(Clause, Now), mentions(Clause, Name) ), All0),
    sort(All0, All),
    subtract(All, Seen1, Next),
    reached(Next, Later, Seen1, Seen, Used0),
    append(Now, Used0, Used).

defines(Names, Clause) :-
    head(Clause, Head),
    callable(Head),
    functor(Head, Name, _),
    memberchk(Name, Names).

head((Head :- _), Head) :- !.
head((Head --> _), Head) :- !.
head((Head => _), Head) :- !.
head(Head, Head).

mentions(Term, Name) :-
    sub_term(Sub, Term),
    callable(Sub),
    functor(Sub, Name, _).
