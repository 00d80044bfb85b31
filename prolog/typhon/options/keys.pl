:- module(typhon_keys,
          [ own_keys/1,                 % ?Directory
            own_keys_begin/1,           % +Directory
            own_keys_end/0,
            keys_sign/3,                % +Directory, +Text, -Signature
            keys_verify/4,              % +Directory, +Text, +Signature, -Holder
            keys_seal/4,                % +Directory, +Text, +Certificate,
                                        % -Sealed
            keys_unseal/3,              % +Directory, +Sealed, -Text
            keys_certificate/2,         % +Directory, -Certificate
            keys_holder/3,              % +Directory, +Certificate, -Holder
            keys_file/3,                % +Directory, +Which, -File
            key_loaded/3                % +Directory, +Which, -Loaded
          ]).
:- use_module(library(error), [permission_error/3]).
:- autoload(library(crypto),
            [ crypto_data_decrypt/6, crypto_data_encrypt/6, crypto_data_hash/3,
              crypto_n_random_bytes/2, hex_bytes/2, rsa_private_decrypt/4,
              rsa_public_decrypt/4, rsa_public_encrypt/4, rsa_sign/4 ]).
:- autoload(library(ssl),
            [ certificate_field/2, load_certificate/2, load_crl/2,
              load_private_key/3 ]).
:- autoload(library(filesex), [directory_file_path/3]).
:- autoload(library(readutil), [read_file_to_string/3]).
:- use_module(library(settings), [setting/4]).
:- use_module('../kernel/base/on_demand', [on_demand_load/2]).
:- use_module('../kernel/base/bounds', [bounded/3]).

/** <module> Keys: signatures, sealed texts and certificates

`app/typhon.pl keys` makes a directory of keys for a host or an author:
`cert.pem`, `key.pem`, `ca.pem` and `crl.pem`.  A signature is
signature(Certificate, Hex), with the certificate of the signer as PEM.  It is
valid if the authority has signed the certificate, and this has not expired and
is not revoked.  Holder is host(Name) or author(Name).

The keys are RSA: on SWI-Prolog 9.0.4 library(crypto) crashes when it signs with
elliptic-curve keys.  Signatures are compared byte by byte with the expected
content, since rsa_verify/4 prints a message for each invalid signature.

The keys of this process are those with which its endpoint was started.  The
options tls, identity and trail use them.  This is the interface of the layer.

*Threading*: any thread; own keys begin and end under the mutex of the endpoint,
another mutex serialises the cache of files.
*/

:- multifile
    begin/0,                            % the process has keys
    end/0.                              % the process drops its keys

:- dynamic own_keys/1.          % Directory

%!  own_keys(?Directory) is semidet.
%!  own_keys_begin(+Directory) is det.
%!  own_keys_end is det.
%
%   Directory, an absolute path, holds the keys of this process; begin to use
%   these keys; stop using keys.

own_keys_begin(Directory) :-
    assertz(own_keys(Directory)),
    on_demand_load(keys, any),
    forall(begin, true).

own_keys_end :-
    (   retract(own_keys(_))
    ->  forall(end, true)
    ;   true
    ).

%!  keys_certificate(+Directory, -Certificate:string) is det.
%
%   Certificate is the one in Directory, as PEM.

keys_certificate(Directory, Certificate) :-
    key_loaded(Directory, cert, Certificate).

                 /*******************************
                 *           SIGNATURES         *
                 *******************************/

%!  keys_sign(+Directory, +Text, -Signature) is det.
%
%   Signature signs Text with the keys in Directory.

keys_sign(Directory, Text, signature(Certificate, Hex)) :-
    keys_certificate(Directory, Certificate),
    key_loaded(Directory, key, Key),
    digest(Text, Digest),
    rsa_sign(Key, Digest, Hex, [type(sha256), encoding(hex)]).

digest(Text, Digest) :-
    crypto_data_hash(Text, Digest0, [algorithm(sha256), encoding(utf8)]),
    string_lower(Digest0, Digest).

%!  keys_verify(+Directory, +Text, +Signature, -Holder) is semidet.
%
%   Holder has signed Text. Signature may be any term.

keys_verify(Directory, Text, Signature, Holder) :-
    subsumes_term(signature(_, _), Signature),
    Signature = signature(Pem, Hex),
    string(Pem),
    string(Hex),
    known_certificate(Directory, Pem, Certificate, Holder),
    certificate_field(Certificate, public_key(Key)),
    digest(Text, Digest),
    signs(Key, Digest, Hex).

%   signs(+PublicKey, +Digest, +Hex): the constant is the prefix of PKCS #1 for
%   a SHA-256 digest.

signs(Key, Digest, Hex) :-
    string_lower(Hex, Lower),
    catch(( hex_bytes(Lower, Bytes),
            string_codes(Text, Bytes),
            rsa_public_decrypt(Key, Text, Plain,
                               [encoding(octet), padding(pkcs1)]) ),
          error(_, _),
          fail),
    string_codes(Plain, PlainBytes),
    hex_bytes(PlainHex, PlainBytes),
    atom_concat('3031300d060960864801650304020105000420', Digest, Expected),
    atom_string(Expected, PlainText),
    string_lower(PlainHex, PlainText).

%!  keys_holder(+Directory, +Certificate, -Holder) is semidet.
%
%   Certificate is valid, and belongs to Holder.

keys_holder(Directory, Pem, Holder) :-
    string(Pem),
    known_certificate(Directory, Pem, _, Holder).

known_certificate(Directory, Pem, Certificate, Holder) :-
    string_length(Pem, Length),
    Length =< 16384,
    key_loaded(Directory, ca, Authority, Stamp1),
    key_loaded(Directory, crl, List, Stamp2),
    key_found(Pem, Stamp1-Stamp2, certified(Pem, Authority, List),
              Certificate-Holder),
    in_its_time(Certificate).

certified(Pem, Authority, List, Certificate-Holder) :-
    pem_certificate(Pem, Certificate),
    of_authority(Authority, Certificate),
    \+ revoked(List, Certificate),
    certificate_field(Certificate, subject(Subject)),
    memberchk('CN'=Name, Subject),
    memberchk('OU'=Kind, Subject),
    memberchk(Kind, [host, author]),
    Holder =.. [Kind, Name].

of_authority(Authority, Certificate) :-
    certificate_field(Authority, public_key(Key)),
    certificate_field(Certificate, to_be_signed(Hex)),
    certificate_field(Certificate, signature(Signature)),
    string_lower(Hex, Lower),
    hex_bytes(Lower, Bytes),
    string_codes(Signed, Bytes),
    crypto_data_hash(Signed, Digest, [algorithm(sha256), encoding(octet)]),
    string_lower(Digest, DigestLower),
    signs(Key, DigestLower, Signature).

in_its_time(Certificate) :-
    certificate_field(Certificate, not_before(From)),
    certificate_field(Certificate, not_after(To)),
    get_time(Now),
    From =< Now,
    Now =< To.

revoked(List, Certificate) :-
    certificate_field(Certificate, serial(Serial)),
    memberchk(revocations(Revoked), List),
    memberchk(revoked(Serial, _), Revoked).

                 /*******************************
                 *            SEALS             *
                 *******************************/

%!  keys_seal(+Directory, +Text, +Certificate, -Sealed) is det.
%!  keys_unseal(+Directory, +Sealed, -Text) is det.
%
%   Encrypt Text for the holder of Certificate; decrypt it.  Sealed holds a new
%   AES-256 key, encrypted with the public key of Certificate, and Text,
%   encrypted by that AES key with GCM.
%
%   @error permission_error(unseal, term, Sealed) Sealed is for another process,
%   or is damaged

keys_seal(Directory, Text, Pem, sealed(ForUs, Nonce, Tag, Cipher)) :-
    known_certificate(Directory, Pem, Certificate, _),
    certificate_field(Certificate, public_key(Public)),
    crypto_n_random_bytes(32, Key),
    crypto_n_random_bytes(12, Nonce),
    hex_bytes(KeyHex, Key),
    rsa_public_encrypt(Public, KeyHex, ForUs0, [padding(pkcs1_oaep)]),
    octets_hex(ForUs0, ForUs),
    crypto_data_encrypt(Text, 'aes-256-gcm', Key, Nonce, Cipher0, [tag(Tag)]),
    octets_hex(Cipher0, Cipher).

keys_unseal(Directory, Sealed, Text) :-
    (   subsumes_term(sealed(_, _, _, _), Sealed),
        catch(unsealed(Directory, Sealed, Text), error(_, _), fail)
    ->  true
    ;   permission_error(unseal, term, Sealed)
    ).

unsealed(Directory, sealed(ForUs0, Nonce, Tag, Cipher0), Text) :-
    key_loaded(Directory, key, Private),
    hex_octets(ForUs0, ForUs),
    rsa_private_decrypt(Private, ForUs, KeyHex, [padding(pkcs1_oaep)]),
    hex_bytes(KeyHex, Key),
    hex_octets(Cipher0, Cipher),
    crypto_data_decrypt(Cipher, 'aes-256-gcm', Key, Nonce, Text, [tag(Tag)]).

octets_hex(Octets, Hex) :-
    string_codes(Octets, Bytes),
    hex_bytes(Hex0, Bytes),
    atom_string(Hex0, Hex).

hex_octets(Hex, Octets) :-
    hex_bytes(Hex, Bytes),
    string_codes(Octets, Bytes).

                /*******************************
                *        FILES OF KEYS         *
                *******************************/

:- meta_predicate key_found(+, +, 1, -).

:- dynamic
    loaded/3,                           % File, Stamp, Loaded
    found/4.                            % Hash, Pem, Stamp, Found

:- setting(certificates, positive_integer, 256,
           "Certificates whose holder is cached").

%   Reading and parsing a file of keys takes as long as signing.  So the content
%   is cached until the file changes, and the result for a certificate until the
%   files change on which it depends.

%!  keys_file(+Directory, +Which, -File) is det.
%
%   Which is `cert`, `key`, `ca` or `crl`.

keys_file(Directory, Which, File) :-
    file_name_extension(Which, pem, Name),
    directory_file_path(Directory, Name, File).

%!  key_loaded(+Directory, +Which, -Loaded) is det.
%
%   Loaded is the content of the file: a text for `cert`, for the others a term
%   of library(ssl).

key_loaded(Directory, Which, Loaded) :-
    key_loaded(Directory, Which, Loaded, _).

%   Stamp changes when the file changes.

key_loaded(Directory, Which, Loaded, Stamp) :-
    keys_file(Directory, Which, File),
    time_file(File, Time),
    size_file(File, Size),
    Stamp = Time-Size,
    (   loaded(File, Stamp, Loaded0)
    ->  Loaded = Loaded0
    ;   load(Which, File, Loaded),
        with_mutex(typhon_keys,
                   ( retractall(loaded(File, _, _)),
                     assertz(loaded(File, Stamp, Loaded)) ))
    ).

load(cert, File, Pem) :-
    !,
    read_file_to_string(File, Pem, []).
load(Which, File, Loaded) :-
    setup_call_cleanup(
        open(File, read, In, [type(binary)]),
        load_from(Which, In, Loaded),
        close(In)).

load_from(key, In, Key) :-
    load_private_key(In, "", Key).
load_from(ca, In, Certificate) :-
    load_certificate(In, Certificate).
load_from(crl, In, List) :-
    load_crl(In, List).

%   key_found(+Pem, +Stamp, :Find, -Found) is semidet: Found is the result of
%   call(Find, Found) for the certificate Pem; it is cached for this Stamp.

key_found(Pem, Stamp, Find, Found) :-
    term_hash(Pem, Hash),
    (   found(Hash, Pem, Stamp, Found0)
    ->  Found = Found0
    ;   call(Find, Found),
        with_mutex(typhon_keys, remember(Hash, Pem, Stamp, Found))
    ).

remember(Hash, Pem, Stamp, Found) :-
    retractall(found(Hash, Pem, _, _)),
    bounded(found(_, _, _, _), typhon_keys:certificates,
            assertz(found(Hash, Pem, Stamp, Found))).

%   pem_certificate(+Pem, -Certificate) is semidet: fails if Pem is invalid.

pem_certificate(Pem, Certificate) :-
    catch(setup_call_cleanup(
              open_string(Pem, In),
              load_certificate(In, Certificate),
              close(In)),
          error(_, _),
          fail).
