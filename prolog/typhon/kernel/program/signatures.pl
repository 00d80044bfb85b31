:- module(typhon_signatures,
          [ program_signature/2,        % ?Hash, -Signature
            signature_keep/2,           % +Hash, +Signature
            signature_read/2,           % +File, +Hash
            signature_make/3,           % +File, +Hash, +Keys
            signature_author/4,         % +Keys, +Hash, +Signature, -Author
            program_author/3            % +Keys, +Hash, -Author
          ]).

/** <module> Signatures of programs and payloads

What an author signs is the hash by which a program travels. The signature
stands in a file beside it, `visitor.pl.sig`, and goes along
with the code. It is verified on the first request.

*Threading*: any thread; a mutex serialises writers.
*/

:- use_module('../base/keys', [keys_sign/3, keys_verify/4]).

:- dynamic
    signature/2.                        % Hash, Signature: the oldest first

most_signatures(1024).

%!  program_signature(?Hash, -Signature) is semidet.
%!  signature_keep(+Hash, +Signature) is det.
%
%   Signature is said to be one of the program of that Hash. The last one
%   counts: a bad one cannot stand in the way of a good one for long.

program_signature(Hash, Signature) :-
    signature(Hash, Signature).

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
%   Keep the signature beside File, if there is one, and it is of this Hash.

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

%!  signature_make(+File, +Hash, +Keys) is det.
%
%   Write the signature of what is in File, of that Hash, beside it, with the
%   keys in that directory.

signature_make(File, Hash, Keys) :-
    signed_text(Hash, Text),
    keys_sign(Keys, Text, Signature),
    atom_concat(File, '.sig', Beside),
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
%   Author has signed the program, as far as the keys in that directory tell;
%   this Signature is his. Signature may be anything.

program_author(Keys, Hash, Author) :-
    signature(Hash, Signature),
    signature_author(Keys, Hash, Signature, Author).

signature_author(Keys, Hash, Signature, Author) :-
    signed_text(Hash, Text),
    keys_verify(Keys, Text, Signature, author(Author)).
