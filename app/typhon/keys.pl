:- module(typhon_app_keys,
          [ keys/3,                     % +What, +Names, +Options
            keys_init/1,                % +Directory
            keys_issue/4,               % +Kind, +Name, +Days, +Directory
            keys_revoke/2,              % +Name, +Directory
            keys_sign_file/3            % +File, +Author, +Directory
          ]).

/** <module> A small authority

Certificates for hosts and authors, made by the `openssl` command. The
authority is a directory:

    ca.pem ca.key crl.pem       its certificate, its key, revoked certificates
    openssl.cnf database ...    state of openssl
    NAME/                       files of the host or author NAME

A directory NAME holds `cert.pem`, `key.pem`, `ca.pem` and `crl.pem`: copy it,
and nothing else, to the machine of NAME. All keys are RSA: library(crypto) of
SWI-Prolog 9.0.4 crashes on keys of elliptic curves. Keys of hosts and authors
have 2048 bits, since each hop takes two signatures.

A certificate is for a host or for an author, not for both: a key stolen from
a host cannot sign programs.

*Threading*: the calling thread; one at a time for each directory.
*/

:- use_module(library(error),
              [ domain_error/2, existence_error/2, must_be/2,
                permission_error/3 ]).
:- use_module(library(filesex),
              [ chmod/2, copy_file/2, delete_directory_and_contents/1,
                directory_file_path/3, make_directory_path/1 ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).

:- use_module('../../prolog/typhon/options/identity', [file_sign/2]).

:- multifile prolog:error_message//1.

%   Days until the certificate of the authority and its revocation list expire.

authority_days(3650).

%!  keys(+What, +Names, +Options) is det.
%
%   Executes the subcommand What of `keys`. Options are dir(Directory) and
%   days(N).
%
%   @error typhon_usage(arguments(keys))

keys(What, Names, Options) :-
    option(dir(Directory), Options, keys),
    option(days(Days), Options, 825),
    (   order(What, Names, Days, Directory, Goal)
    ->  call(Goal)
    ;   throw(error(typhon_usage(arguments(keys)), _))
    ).

order(init, [], _, Directory, keys_init(Directory)).
order(host, [Name], Days, Directory, keys_issue(host, Name, Days, Directory)).
order(author, [Name], Days, Directory,
      keys_issue(author, Name, Days, Directory)).
order(revoke, [Name], _, Directory, keys_revoke(Name, Directory)).

%!  keys_init(+Directory) is det.
%
%   Makes an authority in Directory.
%
%   @error permission_error(create, directory, Directory) it is not empty
%   @error openssl(Text) the message of openssl

keys_init(Directory) :-
    must_be_empty(Directory),
    make_directory_path(Directory),
    chmod(Directory, 0o700),
    write_file(Directory, database, ''),
    write_file(Directory, 'database.attr', 'unique_subject = yes\n'),
    configuration(Directory),
    authority_days(Days),
    openssl(Directory,
            [ req, '-x509', '-config', 'openssl.cnf', '-extensions', authority,
              '-newkey', 'rsa:3072', '-nodes', '-keyout', 'ca.key', '-out', 'ca.pem',
              '-days', Days, '-subj', '/CN=typhon authority' ]),
    private(Directory, 'ca.key'),
    list_revoked(Directory).

%   The configuration of openssl is in the directory of this file.

configuration(Directory) :-
    module_property(typhon_app_keys, file(This)),
    file_directory_name(This, App),
    directory_file_path(App, 'authority.cnf', File),
    directory_file_path(Directory, 'openssl.cnf', Copy),
    copy_file(File, Copy).

must_be_empty(Directory) :-
    exists_directory(Directory),
    directory_files(Directory, Files),
    member(File, Files),
    \+ memberchk(File, ['.', '..']),
    !,
    permission_error(create, directory, Directory).
must_be_empty(_).

%!  keys_issue(+Kind, +Name, +Days, +Directory) is det.
%
%   Makes key and certificate for Name, valid for Days days; Kind is `host` or
%   `author`.
%
%   @error domain_error(key_name, Name)
%   @error permission_error(create, key, Name) Name has a key
%   @error existence_error(authority, Directory)

keys_issue(Kind, Name, Days, Directory) :-
    must_be(oneof([host, author]), Kind),
    must_be_authority(Directory),
    must_be_name(Name),
    directory_file_path(Directory, Name, Own),
    (   exists_directory(Own)
    ->  permission_error(create, key, Name)
    ;   make_directory(Own)
    ),
    catch(issue(Kind, Name, Days, Directory, Own), Ball,
          ( delete_directory_and_contents(Own),
            throw(Ball) )).

issue(Kind, Name, Days, Directory, Own) :-
    chmod(Own, 0o700),
    own(Name, 'key.pem', Key),
    own(Name, 'request.pem', Request),
    own(Name, 'cert.pem', Certificate),
    atomic_list_concat(['/OU=', Kind, '/CN=', Name], Subject),
    openssl(Directory,
            [ req, '-new', '-config', 'openssl.cnf',
              '-newkey', 'rsa:2048', '-nodes', '-keyout', Key,
              '-out', Request, '-subj', Subject ]),
    private(Directory, Key),
    openssl(Directory,
            [ ca, '-batch', '-config', 'openssl.cnf', '-notext',
              '-extensions', Kind, '-days', Days,
              '-in', Request, '-out', Certificate ]),
    directory_file_path(Directory, Request, RequestFile),
    delete_file(RequestFile),
    replace_file(Directory, 'ca.pem', Own),
    replace_file(Directory, 'crl.pem', Own).

own(Name, File, Path) :-
    atomic_list_concat([Name, /, File], Path).

%   Name becomes the name of a directory, and part of a subject.

must_be_name(Name) :-
    (   atom(Name),
        atom_codes(Name, [First|Codes]),
        code_type(First, alnum),
        forall(member(Code, [First|Codes]), name_code(Code)),
        atom_length(Name, Length),
        Length =< 64
    ->  true
    ;   domain_error(key_name, Name)
    ).

name_code(Code) :-
    Code < 128,
    ( code_type(Code, csym) ; memberchk(Code, `-.`) ),
    !.

must_be_authority(Directory) :-
    directory_file_path(Directory, 'ca.key', Key),
    (   exists_file(Key)
    ->  true
    ;   existence_error(authority, Directory)
    ).

%!  keys_revoke(+Name, +Directory) is det.
%
%   A host rejects certificates of Name as soon as it has the new `crl.pem`.
%   The directories under Directory get it at once.
%
%   @error existence_error(key, Name)

keys_revoke(Name, Directory) :-
    must_be_authority(Directory),
    must_be_name(Name),
    own(Name, 'cert.pem', Certificate),
    directory_file_path(Directory, Certificate, File),
    (   exists_file(File)
    ->  openssl(Directory,
                [ ca, '-config', 'openssl.cnf', '-revoke', Certificate ])
    ;   existence_error(key, Name)
    ),
    list_revoked(Directory).

%!  keys_sign_file(+File, +Author, +Directory) is det.
%
%   Writes the signature of an agent program or a payload beside File.
%
%   @error existence_error(key, Author)

keys_sign_file(File, Author, Directory) :-
    must_be_name(Author),
    directory_file_path(Directory, Author, Own),
    directory_file_path(Own, 'key.pem', Key),
    (   exists_file(Key)
    ->  file_sign(File, Own)
    ;   existence_error(key, Author)
    ).

list_revoked(Directory) :-
    authority_days(Days),
    openssl(Directory,
            [ ca, '-config', 'openssl.cnf', '-gencrl', '-crldays', Days,
              '-out', 'crl.pem' ]),
    forall(( directory_member_with_keys(Directory, Own) ),
           replace_file(Directory, 'crl.pem', Own)).

directory_member_with_keys(Directory, Own) :-
    directory_files(Directory, Files),
    member(Name, Files),
    \+ memberchk(Name, ['.', '..']),
    directory_file_path(Directory, Name, Own),
    directory_file_path(Own, 'cert.pem', Certificate),
    exists_file(Certificate).

%   Renaming is atomic: a process that reads the file meanwhile reads the old or
%   the new contents.

replace_file(Directory, Name, Own) :-
    directory_file_path(Directory, Name, From),
    directory_file_path(Own, Name, To),
    atom_concat(To, '.new', New),
    copy_file(From, New),
    rename_file(New, To).

private(Directory, File) :-
    directory_file_path(Directory, File, Path),
    chmod(Path, 0o600).

write_file(Directory, Name, Text) :-
    directory_file_path(Directory, Name, File),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        write(Out, Text),
        close(Out)).

%   openssl(+Directory, +Arguments): output of openssl is shown only if openssl
%   fails.

openssl(Directory, Arguments) :-
    setup_call_cleanup(
        process_create(path(openssl), Arguments,
                       [ cwd(Directory), stdin(null), stdout(null),
                         stderr(pipe(Err)), process(Pid) ]),
        read_string(Err, _, Said),
        ( close(Err), process_wait(Pid, Status) )),
    (   Status == exit(0)
    ->  true
    ;   throw(error(openssl(Said), _))
    ).

prolog:error_message(openssl(Said)) -->
    [ 'openssl: ~w'-[Said] ].
prolog:error_message(permission_error(create, key, Name)) -->
    [ '~w already has a key'-[Name] ].
prolog:error_message(existence_error(key, Name)) -->
    [ '~w has no key'-[Name] ].
prolog:error_message(existence_error(authority, Directory)) -->
    [ 'No authority in ~w: `keys init` makes one'-[Directory] ].
