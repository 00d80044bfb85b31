:- module(typhon_signatures,
          [ program_signature/2,        % ?Hash, -Signature
            signature_keep/2,           % +Hash, +Signature
            signature_read/2,           % +File, +Hash
            program_sign/2,             % +Spec, +Keys
            program_author/3            % +Keys, +Hash, -Author
          ]).

/** <module> Who has signed a program

What an author signs is the hash by which a program travels. The signature
stands in a file beside that of the program, `visitor.pl.sig`, and goes along
with the code. Whether it is good is seen when somebody asks.

*Threading*: any thread; a mutex makes those who keep one come one by one.
*/

:- use_module('../base/keys', [keys_sign/3, keys_verify/4]).
:- use_module(paths, [program_file/2]).
:- use_module(programs, [program_hash/2, program_read/7]).

:- dynamic
    signature/2.                        % Hash, Signature: the oldest first

most_signatures(1024).

%!  program_signature(?Hash, -Signature) is semidet.
%!  signature_keep(+Hash, +Signature) is det.
%
%   Signature is said to be one of the program of that Hash. Who comes later
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

%!  program_sign(+Spec, +Keys) is det.
%
%   Write the signature of a program file, with the keys in that directory.
%
%   @error what program_read/7 throws

program_sign(Spec, Keys) :-
    program_file(Spec, File),
    program_read(File, Program, _, _, _, _, _),
    program_hash(Program, Hash),
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
%
%   Author has signed the program, as far as the keys in that directory tell.

program_author(Keys, Hash, Author) :-
    signature(Hash, Signature),
    signed_text(Hash, Text),
    keys_verify(Keys, Text, Signature, author(Author)).
