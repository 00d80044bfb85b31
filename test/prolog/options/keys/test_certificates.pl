:- module(test_certificates, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/authority').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex),
              [delete_directory_and_contents/1, directory_file_path/3]).
:- use_module(library(lists), [member/2, subtract/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module('../../../../app/typhon/keys',
              [keys_init/1, keys_issue/4, keys_revoke/2]).
:- use_module('../../../../prolog/typhon/options/keys',
              [ keys_certificate/2, keys_holder/3, keys_seal/4, keys_sign/3,
                keys_unseal/3, keys_verify/4 ]).

:- needs([openssl]).

/** <module> Whose signature is valid, and what a seal keeps

One authority for all tests, with hosts and authors some of whose certificates
are not valid, and another authority with a host `alpha`.

*Threading*: one test at a time.
*/

:- dynamic directory/1.

made :-
    make_tmp_dir(Dir),
    assertz(directory(Dir)),
    maplist(directory_file_path(Dir), [own,other], [Own,Other]),
    keys_init(Own),
    keys_init(Other),
    forall(member(Name, [alpha,beta,gone,old,young,own]),
           keys_issue(host, Name, 30, Own)),
    keys_issue(author, alice, 30, Own),
    keys_issue(host, alpha, 30, Other),
    expired_host(Own, old),
    young_host(Own),
    self_made_host(Own, own).

removed :-
    forall(retract(directory(Dir)), delete_directory_and_contents(Dir)).

%   Its certificate becomes valid in a hundred years.

young_host(Dir) :-
    test_authority:openssl(Dir,
        [ req, '-new', '-config', 'openssl.cnf', '-key', 'young/key.pem',
          '-out', 'young/new.pem', '-subj', '/OU=host/CN=young' ]),
    test_authority:openssl(Dir,
        [ ca, '-config', 'openssl.cnf', '-revoke', 'young/cert.pem' ]),
    test_authority:openssl(Dir,
        [ ca, '-batch', '-config', 'openssl.cnf', '-notext', '-extensions',
          host, '-startdate', '21200101000000Z', '-enddate', '21300101000000Z',
          '-in', 'young/new.pem', '-out', 'young/cert.pem' ]).

keys(Name, Keys) :-
    keys(own, Name, Keys).

keys(Authority, Name, Keys) :-
    directory(Dir),
    atomic_list_concat([Dir,Authority,Name], /, Keys).

signed(Name, Text, Signature) :-
    keys(Name, Keys),
    keys_sign(Keys, Text, Signature).

%   holder(+Text, +Signature, -Holder): as beta sees it.

holder(Text, Signature, Holder) :-
    keys(beta, Keys),
    (   keys_verify(Keys, Text, Signature, Holder0)
    ->  Holder = Holder0
    ;   Holder = none
    ).

of_certificate(Pem, Holder) :-
    keys(beta, Keys),
    ( keys_holder(Keys, Pem, Holder0) -> Holder = Holder0 ; Holder = none ).

:- begin_tests(certificates, [setup(made), cleanup(removed)]).

test(signers_are_known_by_their_certificates,
     [forall(member(Name-Holder,
                    [ alpha-host(alpha), alice-author(alice), old-none,
                      young-none, own-none ])), Got == Holder]) :-
    signed(Name, "text", Signature),
    holder("text", Signature, Got).
test(certificates_have_holders,
     [forall(member(Name-Holder,
                    [ alpha-host(alpha), alice-author(alice), old-none,
                      young-none, own-none ])), Got == Holder]) :-
    keys(Name, Keys),
    keys_certificate(Keys, Pem),
    of_certificate(Pem, Got).
test(certificate_of_another_authority_is_none, Holders == [none,none]) :-
    keys(other, alpha, Keys),
    keys_certificate(Keys, Pem),
    of_certificate(Pem, H1),
    keys_sign(Keys, "text", Signature),
    holder("text", Signature, H2),
    Holders = [H1,H2].
test(other_text_is_not_signed, Holder == none) :-
    signed(alpha, "text", Signature),
    holder("texu", Signature, Holder).
test(signature_of_another_is_none, Holder == none) :-
    signed(alpha, "text", signature(_, Hex)),
    signed(beta, "text", signature(Pem, _)),
    holder("text", signature(Pem, Hex), Holder).
test(changed_signature_is_none, Holders == [none,none,none,none]) :-
    signed(alpha, "text", signature(Pem, Hex)),
    findall(H, ( changed_hex(Hex, Other),
                 holder("text", signature(Pem, Other), H) ), Holders).
test(term_that_is_no_signature_is_none,
     [forall(member(Term, [ _, x, signature(x), signature(_, _),
                            signature("x", "00"), signature("x", 1) ])),
      Holder == none]) :-
    holder("text", Term, Holder).
test(text_that_is_no_certificate_is_none,
     [forall(member(Pem, ["", "x", x, _, 1])), Holder == none]) :-
    of_certificate(Pem, Holder).
test(certificates_are_short, Holders == [host(alpha),none]) :-
    keys(alpha, Keys),
    keys_certificate(Keys, Pem),
    string_length(Pem, Length),
    findall(H, ( member(Size, [16 384,16 385]),
                 Blanks is Size-Length,
                 format(string(Long), '~s~*c', [Pem, Blanks, 0'\n]),
                 of_certificate(Long, H) ), Holders).
test(revoked_certificate_is_none, Holders == [host(gone),none]) :-
    signed(gone, "text", Signature),
    holder("text", Signature, H1),
    keys(alpha, Alpha),
    directory_file_path(Dir, alpha, Alpha),
    keys_revoke(gone, Dir),
    holder("text", Signature, H2),
    Holders = [H1,H2].
test(revocation_is_written_to_all_directories, Lists = [_]) :-
    findall(Text, ( member(Name, [alpha,beta,alice]),
                    keys(Name, Keys),
                    directory_file_path(Keys, 'crl.pem', File),
                    read_file_to_string(File, Text, []) ), Texts),
    sort(Texts, Lists).
test(directory_has_four_files,
     Files == ['ca.pem','cert.pem','crl.pem','key.pem']) :-
    keys(alpha, Keys),
    directory_files(Keys, Files0),
    subtract(Files0, ['.','..'], Files1),
    sort(Files1, Files).
test(private_keys_are_for_their_user_alone,
     Modes == ["-rw-------","-rw-------","drwx------","drwx------"]) :-
    keys(alpha, Keys),
    maplist(directory_file_path(Keys), ['key.pem','../ca.key','..'],
            [Key,Authority,Dir]),
    maplist(mode, [Key,Authority,Keys,Dir], Modes).
test(names_and_keys_are_checked,
     [forall(member(Kind-Name-Formal,
                    [ host-alpha-permission_error(create, key, alpha),
                      author-alpha-permission_error(create, key, alpha),
                      host-'a/b'-domain_error(key_name, 'a/b'),
                      host-'..'-domain_error(key_name, '..'),
                      bogus-x-type_error(_, bogus) ])),
      error(Formal)]) :-
    keys(alpha, Keys),
    directory_file_path(Dir, alpha, Keys),
    keys_issue(Kind, Name, 30, Dir).
test(authority_is_not_made_again,
     error(permission_error(create, directory, _))) :-
    keys(alpha, Keys),
    directory_file_path(Dir, alpha, Keys),
    keys_init(Dir).
test(sealed_text_is_read_by_its_receiver_alone, Texts == ["text ä",none]) :-
    sealed(beta, Sealed),
    findall(T, ( member(Name, [beta,alpha]), unsealed(Name, Sealed, T) ),
            Texts).
test(equal_texts_are_sealed_differently, [Same == []]) :-
    sealed(beta, sealed(K1, N1, _, C1)),
    sealed(beta, sealed(K2, N2, _, C2)),
    findall(X, member(X-X, [K1-K2,N1-N2,C1-C2]), Same).
test(seal_that_was_changed_is_not_read, Read == []) :-
    sealed(beta, Sealed),
    findall(T, ( changed_seal(Sealed, Other), unsealed(beta, Other, T),
                 T \== none ), Read).
test(term_that_is_no_seal_is_an_error,
     [forall(member(Term, [_, x, sealed(a, b, c), sealed("", [], [], "")])),
      error(permission_error(unseal, term, _))]) :-
    keys(beta, Keys),
    keys_unseal(Keys, Term, _).

:- end_tests(certificates).

changed_hex(Hex, Other) :-
    string_codes(Hex, [C|Cs]),
    ( C =:= 0'0 -> D = 0'1 ; D = 0'0 ),
    string_codes(Other, [D|Cs]).
changed_hex(Hex, Other) :-
    sub_string(Hex, 2, _, 0, Other).
changed_hex(Hex, Other) :-
    string_concat(Hex, "00", Other).
changed_hex(_, "no digits").

mode(File, Mode) :-
    format(atom(Command), 'ls -ld ~w', [File]),
    setup_call_cleanup(open(pipe(Command), read, Out),
                       read_string(Out, _, Text), close(Out)),
    sub_string(Text, 0, 10, _, Mode).

sealed(Name, Sealed) :-
    keys(alpha, Alpha),
    keys(Name, Keys),
    keys_certificate(Keys, Pem),
    keys_seal(Alpha, "text ä", Pem, Sealed).

unsealed(Name, Sealed, Text) :-
    keys(Name, Keys),
    catch(keys_unseal(Keys, Sealed, Text), error(permission_error(_, _, _), _),
          Text = none).

%   A tag of fewer bytes would prove less.

changed_seal(sealed(K, N, T, C), sealed(K1, N, T, C)) :-
    once(changed_hex(K, K1)).
changed_seal(sealed(K, [N|Ns], T, C), sealed(K, [N1|Ns], T, C)) :-
    N1 is N xor 1.
changed_seal(sealed(K, N, [T|Ts], C), sealed(K, N, [T1|Ts], C)) :-
    T1 is T xor 1.
changed_seal(sealed(K, N, [A,B,C1,D|_], C), sealed(K, N, [A,B,C1,D], C)).
changed_seal(sealed(K, N, T, C), sealed(K, N, T, C1)) :-
    once(changed_hex(C, C1)).
changed_seal(sealed(K, N, T, C), sealed(K, N, T, C1)) :-
    sub_string(C, 0, _, 2, C1).
