:- module(typhon_signatures,
          [ file_sign/2,                % +Spec, +Keys
            payload_hash/2,             % +Payload, -Hash
            payload_signature/2,        % +Payload, -Signature
            signature_keep/2,           % +Hash, +Signature
            signature_author/4,         % +Keys, +Hash, +Signature, -Author
            program_author/3            % +Keys, +Hash, -Author
          ]).

/** <module> Signatures of programs and payloads

An author signs the hash that identifies a program on the wire.  The
signature is in a file beside the program, `visitor.pl.sig`, and is sent with
the code.  It is verified when it is first needed.

A payload has no hash on the wire, since its clauses are part of the state of an
agent; its hash is that of a program with the same clauses, whose header no file
can contain.  The hash does not depend on the order of the predicates, but on
that of their clauses, as they are stored, without the goals that a variant has
put into them.

*Threading*: any thread; a mutex serialises writers.
*/

:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- autoload(library(terms), [mapsubterms/3]).
:- autoload('../keys', [keys_sign/3, keys_verify/4]).
:- use_module('../../kernel/base/private', [output_file/2]).
:- use_module('../../kernel/program',
              [ clause_parts/3, payload_file/1, payload_load/2,
                program_file/2, program_hash/2, program_read/7 ]).

:- multifile
    typhon_code:extra/2,
    typhon_code:extra_comes/2,
    typhon_code:wrapped/3,
    typhon_programs:program_used/2,
    typhon_programs:payload_was_read/2.

:- dynamic
    signature/2.                        % Hash, Signature: the oldest first

most_signatures(1024).

%!  signature_keep(+Hash, +Signature) is det.
%
%   Signature is claimed to be that of the program with Hash.  A new signature
%   replaces an earlier one, so that a bad one cannot block a good one for long.

signature_keep(Hash, Signature) :-
    signature(Hash, Signature),
    !.
signature_keep(Hash, Signature) :-
    (   is_signature(Signature)
    ->  with_mutex(typhon_signatures, keep(Hash, Signature))
    ;   true
    ).

is_signature(Signature) :-
    ground(Signature),
    Signature = signature(Certificate, Hex),
    string(Certificate),
    string(Hex),
    string_length(Certificate, Length1),
    string_length(Hex, Length2),
    Length1+Length2 =< 32768.

keep(Hash, Signature) :-
    retractall(signature(Hash, _)),
    assertz(signature(Hash, Signature)),
    predicate_property(signature(_, _), number_of_clauses(Count)),
    most_signatures(Most),
    (   Count > Most
    ->  once(retract(signature(_, _)))
    ;   true
    ).

%!  signature_read(+File, +Hash) is det.
%
%   Keep the signature in the file beside File, if it is for Hash.

signature_read(File, Hash) :-
    atom_concat(File, '.sig', Beside),
    exists_file(Beside),
    catch(setup_call_cleanup(
              open(Beside, read, In, [encoding(utf8)]),
              read_term(In, Term, []),
              close(In)),
          error(_, _),
          fail),
    subsumes_term(signed(Hash, _), Term),
    !,
    Term = signed(_, Signature),
    signature_keep(Hash, Signature).
signature_read(_, _).

:- multifile typhon_private:begins/2.

typhon_private:begins(signature, "signed(").

%!  signature_make(+File, +Hash, +Keys) is det.
%
%   Sign Hash, that of the code in File, with the keys in the directory Keys,
%   and write the signature beside File.

signature_make(File, Hash, Keys) :-
    signed_text(Hash, Text),
    keys_sign(Keys, Text, Signature),
    atom_concat(File, '.sig', Beside),
    output_file(signature, Beside),
    setup_call_cleanup(
        open(Beside, write, Out, [encoding(utf8)]),
        format(Out, '~q.~n', [signed(Hash, Signature)]),
        close(Out)),
    signature_keep(Hash, Signature).

signed_text(Hash, Text) :-
    atom_concat('typhon program ', Hash, Text).

%!  program_author(+Keys, +Hash, -Author) is semidet.
%!  signature_author(+Keys, +Hash, +Signature, -Author) is semidet.
%
%   Author has signed the program with Hash; Signature, which may be any term,
%   is the signature of Author for Hash.  The keys in the directory Keys verify
%   it.

program_author(Keys, Hash, Author) :-
    signature(Hash, Signature),
    signature_author(Keys, Hash, Signature, Author).

signature_author(Keys, Hash, Signature, Author) :-
    signed_text(Hash, Text),
    keys_verify(Keys, Text, Signature, author(Author)).

                /*******************************
                *     PROGRAMS AND PAYLOADS    *
                *******************************/

%   A signature is signed(Program, Signature) where a program is sent, and
%   signature(Signature) in restore points.

typhon_code:wrapped(signed(Sent, Signature), Sent, signature(Signature)).

typhon_code:extra(Hash, signature(Signature)) :-
    signature(Hash, Signature).

typhon_code:extra_comes(signature(Signature), Hash) :-
    signature_keep(Hash, Signature).

typhon_programs:program_used(File, Hash) :-
    signature_read(File, Hash).

typhon_programs:payload_was_read(Spec, Payload) :-
    program_file(Spec, File),
    atom_concat(File, '.sig', Beside),
    exists_file(Beside),
    payload_hash(Payload, Hash),
    signature_read(File, Hash).

%!  file_sign(+Spec, +Keys) is det.
%
%   Sign the program or payload Spec with the keys in the directory Keys, and
%   write the signature beside its file.
%
%   @error the errors of program_read/7 and payload_load/2

file_sign(Spec, Keys) :-
    program_file(Spec, File),
    file_hash(File, Hash),
    signature_make(File, Hash, Keys).

file_hash(File, Hash) :-
    (   payload_file(File)
    ->  payload_load(File, Payload),
        payload_hash(Payload, Hash)
    ;   program_read(File, Program, _, _, _, _, _),
        program_hash(Program, Hash)
    ).

%!  payload_hash(+Payload, -Hash) is det.
%!  payload_signature(+Payload, -Signature) is semidet.
%
%   Hash identifies the clauses of Payload, see above; Signature is the known
%   signature for it.

payload_hash(payload(Name, PIs0, Clauses), Hash) :-
    sort(PIs0, PIs),
    findall((Head:-Body),
            ( member(PI, PIs), clause_of(PI, Clauses, Head, Body) ),
            Sorted),
    flag(typhon_payload_module, N, N+1),
    atom_concat('payload ', N, Module),
    set_module(Module:class(temporary)),
    set_module(Module:base(system)),
    call_cleanup(maplist(stored(Module), Sorted, Stored),
                 '$destroy_module'(Module)),
    program_hash(program(Name, PIs, [payload(Name)], Stored), Hash).

clause_of(Name/Arity, Clauses, Head, Body) :-
    functor(Head, Name, Arity),
    member(Clause, Clauses),
    clause_parts(Clause, Head0, Body),
    Head0 = Head.

%   Storing changes a body, as a variable goal to call/1, so the hash of clauses
%   before and after they are stored would differ.

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
    signature(_, _),                    % there are signatures
    payload_hash(Payload, Hash),
    signature(Hash, Signature),
    !.
