:- module(test_authority,
          [ with_authority/3,           % +Hosts, +Authors, :Goal
            with_authority/4,           % +Hosts, +Authors, -Dir, :Goal
            authority_begin/2,          % +Hosts, +Authors
            authority_end/0,
            authority_keys/2,           % +Name, -Dir
            keys_of/3,                  % +Name, +Authority, -Dir
            verdict/3,                  % +Trail, -Signed, -Verdict
            expired_host/2,             % +Authority, +Name
            self_made_host/2,           % +Authority, +Name
            birth_signed/4              % +Peer, +Id, +Hash, -Birth
          ]).

/** <module> Keys for tests

*Threading*: for the main thread of a test.
*/

:- use_module(common, [make_tmp_dir/1, with_tmp_dir/1]).
:- use_module(made_once, [made_once/3]).
:- use_module(peers, [peer_do/2]).
:- use_module(library(filesex),
              [delete_directory_and_contents/1, directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, subset/2]).
:- use_module(library(process), [process_create/3]).

:- prolog_load_context(directory, Dir),
   atom_concat(Dir, '/../../app/typhon/keys', Keys),
   use_module(Keys, [keys_init/1, keys_issue/4]).

:- meta_predicate
    with_authority(+, +, 1),
    with_authority(+, +, -, 0).

:- dynamic directory/1.                % of the unit of tests

%!  with_authority(+Hosts, +Authors, :Goal) is semidet.
%!  with_authority(+Hosts, +Authors, -Dir, :Goal) is semidet.
%
%   Call Goal, once, with the directory Dir of an authority for Hosts and
%   Authors, see app/typhon/keys.pl. The directory is removed afterwards.

with_authority(Hosts, Authors, Goal) :-
    with_tmp_dir(authority(Hosts, Authors, Goal)).

with_authority(Hosts, Authors, Dir, Goal) :-
    with_authority(Hosts, Authors, test_authority:called_with(Dir, Goal)).

called_with(Dir, Goal, Dir) :-
    once(Goal).

authority(Hosts, Authors, Goal, Tmp) :-
    directory_file_path(Tmp, keys, Dir),
    copied(Hosts, Authors, Dir),
    call(Goal, Dir).

%   Keys take a third of a second each: suites share authorities, and copy them.

copied(Hosts0, Authors0, Dir) :-
    larger(Hosts0, Authors0, Hosts, Authors),
    append(Hosts, [authors|Authors], Names),
    atomic_list_concat(Names, '_', Name),
    made_once(Name, keys_made(Hosts, Authors), Made),
    atom_concat(Made, '/.', Content),
    process_create(path(cp), ['-Rp', Content, Dir], []).

keys_made(Hosts, Authors, Dir) :-
    keys_init(Dir),
    forall(member(Host, Hosts), keys_issue(host, Host, 30, Dir)),
    forall(member(Author, Authors), keys_issue(author, Author, 30, Dir)).

%   larger(+Hosts0, +Authors0, -Hosts, -Authors): most goals need some of these.

larger(Hosts0, Authors0, Hosts, Authors) :-
    Hosts = [alpha, beta, gamma, delta, mallory],
    Authors = [alice, bob],
    subset(Hosts0, Hosts),
    subset(Authors0, Authors),
    !.
larger(Hosts, Authors, Hosts, Authors).

%!  authority_begin(+Hosts, +Authors) is det.
%!  authority_end is det.
%!  authority_keys(+Name, -Dir) is det.
%
%   The authority of a unit of tests: set-up, clean-up, and the directory of the
%   keys of Name.

authority_begin(Hosts, Authors) :-
    make_tmp_dir(Dir),
    copied(Hosts, Authors, Dir),
    assertz(directory(Dir)).

authority_end :-
    forall(retract(directory(Dir)), delete_directory_and_contents(Dir)).

authority_keys(Name, Keys) :-
    directory(Dir),
    keys_of(Name, Dir, Keys).

%!  keys_of(+Name, +Authority, -Dir) is det.
%
%   The directory of the keys of Name.

keys_of(Name, Authority, Dir) :-
    directory_file_path(Authority, Name, Dir).

%!  verdict(+Trail, -Signed, -Verdict) is det.
%
%   The signers and what happened, as Name-handed; and the verdict, see
%   agent_trail/2.

verdict(trail(Steps, Verdict), Signed, Verdict) :-
    findall(Name-What, ( member(step(_, Name, Event), Steps),
                         functor(Event, What, _) ), Signed).

%!  expired_host(+Authority, +Name) is det.
%!  self_made_host(+Authority, +Name) is det.
%
%   Name, which has keys, gets a certificate that expired long ago; one that
%   it has signed itself.

expired_host(Dir, Name) :-
    path(Name, 'key.pem', Key),
    path(Name, 'cert.pem', Certificate),
    path(Name, 'new.pem', Request),
    atom_concat('/OU=host/CN=', Name, Subject),
    openssl(Dir, [ req, '-new', '-config', 'openssl.cnf', '-key', Key,
                   '-out', Request, '-subj', Subject ]),
    openssl(Dir, [ ca, '-config', 'openssl.cnf', '-revoke', Certificate ]),
    openssl(Dir, [ ca, '-batch', '-config', 'openssl.cnf', '-notext',
                   '-extensions', host, '-startdate', '20200101000000Z',
                   '-enddate', '20200201000000Z',
                   '-in', Request, '-out', Certificate ]).

self_made_host(Dir, Name) :-
    path(Name, 'key.pem', Key),
    path(Name, 'cert.pem', Certificate),
    atom_concat('/CN=', Name, Subject),
    openssl(Dir, [ req, '-x509', '-config', 'openssl.cnf', '-extensions',
                   host, '-key', Key, '-out', Certificate, '-days', '30',
                   '-subj', Subject ]).

path(Name, File, Path) :-
    atomic_list_concat([Name, /, File], Path).

openssl(Dir, Args) :-
    process_create(path(openssl), Args,
                   [ cwd(Dir), stdin(null), stdout(null), stderr(null) ]).

%!  birth_signed(+Peer, +Id, +Hash, -Birth) is det.
%
%   The process Peer signs that it has created the agent Id of a program.

birth_signed(Peer, Id, Hash, birth(Id, Hash, Certificate, Hex)) :-
    format(string(Text), 'typhon birth ~w ~w', [Id, Hash]),
    peer_do(Peer, ( typhon_keys:own_keys(Keys),
                    typhon_keys:keys_sign(Keys, Text,
                                          signature(Pem, Hex)) )),
    atom_string(Certificate, Pem).
