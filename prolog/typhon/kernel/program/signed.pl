:- module(typhon_signed,
          [ file_sign/2,                % +Spec, +Keys
            payload_load/2,             % +Spec, -Payload
            payload_hash/2,             % +Payload, -Hash
            payload_signature/2         % +Payload, -Signature
          ]).

/** <module> Files that authors sign

Programs and payloads. A payload has no name of its own on the way, since its
clauses are part of the state of an agent; its hash is that of a program with
the same clauses that no file could be. The order of its predicates does not
count, that of their clauses does; and it is that of its clauses as they are
stored, without what a variant has written into them.

*Threading*: any thread; no state.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(terms), [mapsubterms/3]).
:- use_module(paths, [program_file/2]).
:- use_module(programs,
              [ payload_load/2 as payload_read, program_hash/2,
                program_read/7 ]).
:- use_module(python_code, [python_payload/2]).
:- use_module(signatures,
              [program_signature/2, signature_make/3, signature_read/2]).
:- use_module(source, [clause_parts/3, declaration/4, source_terms/5]).

%!  file_sign(+Spec, +Keys) is det.
%
%   Write the signature of a program or payload beside its file, with the keys
%   in that directory.
%
%   @error what program_read/7 and payload_load/2 throw

file_sign(Spec, Keys) :-
    program_file(Spec, File),
    file_hash(File, Hash),
    signature_make(File, Hash, Keys).

file_hash(File, Hash) :-
    holds_payload(File),
    !,
    payload_read(File, Payload),
    payload_hash(Payload, Hash).
file_hash(File, Hash) :-
    program_read(File, Program, _, _, _, _, _),
    program_hash(Program, Hash).

holds_payload(File) :-
    python_payload(File, _),
    !.
holds_payload(File) :-
    source_terms(File, Located, _, _, _),
    member(Term-_, Located),
    declaration(payload, Term, _, _),
    !.

%!  payload_load(+Spec, -Payload) is det.
%
%   As that of typhon_programs; a signature beside the file is kept.

payload_load(Spec, Payload) :-
    payload_read(Spec, Payload),
    (   in_file(Spec),
        program_file(Spec, File),
        atom_concat(File, '.sig', Beside),
        exists_file(Beside)
    ->  payload_hash(Payload, Hash),
        signature_read(File, Hash)
    ;   true
    ).

in_file(Spec) :-
    Spec \= payload(_, _, _),
    Spec \= clauses(_).

%!  payload_hash(+Payload, -Hash) is det.
%!  payload_signature(+Payload, -Signature) is semidet.

payload_hash(payload(Name, PIs0, Clauses), Hash) :-
    sort(PIs0, PIs),
    findall((Head:-Body),
            ( member(PI, PIs), clause_of(PI, Clauses, Head, Body) ),
            Sorted),
    flag(typhon_payload_module, N, N+1),
    atom_concat('payload ', N, Module),
    set_module(Module:class(temporary)),
    call_cleanup(maplist(stored(Module), Sorted, Stored),
                 '$destroy_module'(Module)),
    program_hash(program(Name, PIs, [payload(Name)], Stored), Hash).

clause_of(Name/Arity, Clauses, Head, Body) :-
    functor(Head, Name, Arity),
    member(Clause, Clauses),
    clause_parts(Clause, Head0, Body),
    Head0 = Head.

%   A goal that is a variable is stored as call/1, and the like.

stored(Module, (Head0:-Body0), (Head:-Body)) :-
    mapsubterms(unchecked, Body0, Body1),
    assertz(Module:(Head0:-Body1), Ref),
    clause(Module:Head, Body, Ref).

unchecked(Goal, Plain) :-
    rewritten(Goal, Plain0),
    ( mapsubterms(unchecked, Plain0, Plain) -> true ; Plain = Plain0 ).

rewritten(Goal, Plain) :-
    subsumes_term('$checked'(_), Goal),
    arg(1, Goal, Plain).
rewritten(Goal, Plain) :-
    subsumes_term(('$uncaught'(_),_), Goal),
    arg(2, Goal, Plain).

payload_signature(Payload, Signature) :-
    program_signature(_, _),            % there are signatures
    payload_hash(Payload, Hash),
    program_signature(Hash, Signature),
    !.
