:- module(study_store,
          [ run_directory/5,            % +Root, +Study, +Case, +Seed, -Directory
            run_done/4,                 % +Root, +Study, +Case, +Seed
            run_result/5,               % +Root, +Study, +Case, +Seed, -Measures
            run_facts/2,                % +Directory, -Facts
            result_save/2,              % +Directory, +Facts
            text_digest/2               % +Term, -Digest
          ]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module(sources, [sources_hash/2]).
:- use_module(studies, [study_title/3, case_name/3]).

/** <module> Where runs are kept

A run is a directory below Root/STUDY, whose name tells people the case and
the seed, and has a hash of all parameters and one of all sources. What was
made from other sources is not found, and so never mixed in.

*Threading*: hashes of sources are found once in a process.
*/

:- dynamic hash_known/2.        % Study, Hash

%!  run_directory(+Root, +Study, +Case, +Seed, -Directory) is det.

run_directory(Root, Study, Case, Seed, Directory) :-
    study_title(Study, Name, _),
    case_name(Study, Case, CaseName),
    dict_pairs(Case, _, Pairs),
    text_digest(Pairs-Seed, Parameters),
    study_hash(Study, Sources),
    format(atom(Below), '~w/~w,seed=~w-~w-~w',
           [Name, CaseName, Seed, Parameters, Sources]),
    directory_file_path(Root, Below, Directory).

study_hash(Study, Hash) :-
    hash_known(Study, Hash),
    !.
study_hash(Study, Hash) :-
    sources_hash(Study, Long),
    sub_atom(Long, 0, 8, _, Hash),
    assertz(hash_known(Study, Hash)).

%!  text_digest(+Term, -Digest:atom) is det.
%
%   Eight hexadecimal digits of a hash of Term as text.

text_digest(Term, Digest) :-
    format(string(Text), '~q', [Term]),
    sha_hash(Text, Bytes, [encoding(utf8)]),
    hash_atom(Bytes, Hex),
    sub_atom(Hex, 0, 8, _, Digest).

%!  run_done(+Root, +Study, +Case, +Seed) is semidet.

run_done(Root, Study, Case, Seed) :-
    run_directory(Root, Study, Case, Seed, Directory),
    exists_directory(Directory).

%!  run_result(+Root, +Study, +Case, +Seed, -Measures:dict) is semidet.
%
%   What was measured, and the `directory` of the run; fails if it is not
%   there.

run_result(Root, Study, Case, Seed, Measures) :-
    run_directory(Root, Study, Case, Seed, Directory),
    exists_directory(Directory),
    run_facts(Directory, Facts),
    findall(Name-Value, member(measure(Name, Value), Facts), Pairs),
    dict_create(Measures, measures, [directory-Directory|Pairs]).

%!  run_facts(+Directory, -Facts:list) is det.
%!  result_save(+Directory, +Facts:list) is det.
%
%   Facts are parameter(Name, Value), seed(Seed), measure(Name, Value) and
%   what describes the machine.

run_facts(Directory, Facts) :-
    directory_file_path(Directory, 'result.pl', File),
    read_file_to_terms(File, Facts, [encoding(utf8)]).

result_save(Directory, Facts) :-
    directory_file_path(Directory, 'result.pl', File),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        forall(member(Fact, Facts), format(Out, '~q.~n', [Fact])),
        close(Out)).
