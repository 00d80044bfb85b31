:- module(locked_packages, []).

/** <module> What a package-lock.json names, without npm

    swipl locked_packages.pl DIRECTORY

gets the packages of DIRECTORY/package-lock.json from npm's registry, or that
in the environment variable npm_config_registry, sees that each
is the one that is meant, by its SHA-512, and unpacks it to
DIRECTORY/node_modules.

*Threading*: the main thread.
*/

:- use_module(library(base64), [base64/2]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- if(exists_source(library(json))).
:- use_module(library(json), [json_read_dict/3]).
:- else.
:- use_module(library(http/json), [json_read_dict/3]).
:- endif.
:- use_module(library(http/http_open), [http_open/3]).
:- use_module(library(http/http_stream), []).   % else it says HTTP/1.0, which
                                                % registries refuse
:- use_module(library(main), [main/0]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(sha), [sha_hash/3]).

:- initialization(main, main).

:- public main/1.

main([Dir]) :-
    directory_file_path(Dir, 'package-lock.json', Lock),
    setup_call_cleanup(
        open(Lock, read, In),
        json_read_dict(In, Locked, [value_string_as_atom(true)]),
        close(In)),
    forall(( get_dict(Place, Locked.packages, Package), Place \== '' ),
           package(Dir, Place, Package)).

package(Dir, Place, Package) :-
    address(Place, Package, Address),
    setup_call_cleanup(
        http_open(Address, In, [timeout(60)]),
        ( set_stream(In, encoding(octet)),
          read_string(In, 50 000 000, Bytes) ),
        close(In)),
    atom_concat('sha512-', Wanted, Package.integrity),
    sha_hash(Bytes, Hash, [algorithm(sha512), encoding(octet)]),
    string_codes(Text, Hash),
    base64(Text, Found),
    (   atom_string(Wanted, Found)
    ->  unpack(Dir, Place, Bytes)
    ;   throw(error(domain_error(checksum(Wanted), Address), _))
    ).

%   Where the registry has it, whatever mirror the lock was made with.

address(Place, Package, Address) :-
    atom_concat('node_modules/', Name, Place),
    registry(Registry),
    file_base_name(Name, Base),
    format(atom(Address), '~w/~w/-/~w-~w.tgz',
           [Registry, Name, Base, Package.version]).

registry(Registry) :-
    (   getenv(npm_config_registry, Given)
    ->  true
    ;   Given = 'https://registry.npmjs.org'
    ),
    ( atom_concat(Registry, /, Given) -> true ; Registry = Given ).

unpack(Dir, Place, Bytes) :-
    directory_file_path(Dir, Place, To),
    make_directory_path(To),
    process_create(path(tar),
                   ['-xzf', '-', '-C', To, '--strip-components=1'],
                   [stdin(pipe(Tar, [type(binary)])), process(Pid)]),
    set_stream(Tar, encoding(octet)),
    write(Tar, Bytes),
    close(Tar),
    process_wait(Pid, exit(0)).
