:- module(typhon_key_files,
          [ keys_file/3,                % +Directory, +Which, -File
            key_loaded/3,               % +Directory, +Which, -Loaded
            key_loaded/4,               % +Directory, +Which, -Loaded, -Stamp
            key_found/4,                % +Pem, +Stamp, :Find, -Found
            pem_certificate/2           % +Pem, -Certificate
          ]).

/** <module> What the files of a directory of keys contain

To read and parse them costs as much as to sign: what was read stays until
the file is another. So does what was found out about a certificate, until the
files that it depends on are.

*Threading*: any thread; a mutex serialises writers.
*/

:- autoload(library(filesex), [directory_file_path/3]).
:- autoload(library(readutil), [read_file_to_string/3]).
:- use_module(library(settings), [setting/4]).
:- use_module('../../kernel/base/bounds', [bounded/2]).

:- autoload(library(ssl),
            [load_certificate/2, load_crl/2, load_private_key/3]).

:- meta_predicate key_found(+, +, 1, -).

:- dynamic
    loaded/3,                           % File, Stamp, Loaded
    found/4.                            % Hash, Pem, Stamp, Found

:- setting(typhon_base_key_files:certificates, positive_integer, 256,
           "Now typhon_key_files:certificates").
:- setting(certificates, positive_integer, 256,
           "Certificates of which it is remembered whose they are").

%!  keys_file(+Directory, +Which, -File) is det.
%
%   Which is `cert`, `key`, `ca` or `crl`.

keys_file(Directory, Which, File) :-
    file_name_extension(Which, pem, Name),
    directory_file_path(Directory, Name, File).

%!  key_loaded(+Directory, +Which, -Loaded) is det.
%!  key_loaded(+Directory, +Which, -Loaded, -Stamp) is det.
%
%   Loaded is what the file contains: of `cert` the text, of the others what
%   library(ssl) makes of them. Stamp is another when the file is.

key_loaded(Directory, Which, Loaded) :-
    key_loaded(Directory, Which, Loaded, _).

key_loaded(Directory, Which, Loaded, Stamp) :-
    keys_file(Directory, Which, File),
    time_file(File, Time),
    size_file(File, Size),
    Stamp = Time-Size,
    (   loaded(File, Stamp, Loaded0)
    ->  Loaded = Loaded0
    ;   load(Which, File, Loaded),
        with_mutex(typhon_key_files,
                   ( retractall(loaded(File, _, _)),
                     assertz(loaded(File, Stamp, Loaded)) ))
    ).

load(cert, File, Pem) :-
    !,
    read_file_to_string(File, Pem, []).
load(Which, File, Loaded) :-
    setup_call_cleanup(
        open(File, read, In),
        load_from(Which, In, Loaded),
        close(In)).

load_from(key, In, Key) :-
    load_private_key(In, "", Key).
load_from(ca, In, Certificate) :-
    load_certificate(In, Certificate).
load_from(crl, In, List) :-
    load_crl(In, List).

%!  key_found(+Pem, +Stamp, :Find, -Found) is semidet.
%
%   Found is what call(Find, Found) finds about the certificate Pem, as long
%   as Stamp is the same.

key_found(Pem, Stamp, Find, Found) :-
    term_hash(Pem, Hash),
    (   found(Hash, Pem, Stamp, Found0)
    ->  Found = Found0
    ;   call(Find, Found),
        with_mutex(typhon_key_files, remember(Hash, Pem, Stamp, Found))
    ).

remember(Hash, Pem, Stamp, Found) :-
    retractall(found(Hash, Pem, _, _)),
    assertz(found(Hash, Pem, Stamp, Found)),
    bounded(found(_, _, _, _), typhon_key_files:certificates).

%!  pem_certificate(+Pem, -Certificate) is semidet.
%
%   Fails if Pem is none.

pem_certificate(Pem, Certificate) :-
    catch(setup_call_cleanup(
              open_string(Pem, In),
              load_certificate(In, Certificate),
              close(In)),
          error(_, _),
          fail).
