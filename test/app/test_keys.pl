:- module(test_keys, []).

% Keys from the command line: an authority, and hosts that use it.

:- use_module('../lib/common').
:- use_module('../lib/texts', [write_file/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_line_to_string/2]).

:- needs([openssl]).

typhon(Args, Status, Out, Err) :-
    project_file('app/typhon.pl', App),
    run_swipl([App|Args], [timeout(60)], Status, Out, Err).

with_keys(Goal) :-
    with_tmp_dir(with_keys(Goal)).

:- meta_predicate with_keys(1), with_keys(1, +).

with_keys(Goal, Tmp) :-
    directory_file_path(Tmp, keys, Dir),
    atom_concat('--dir=', Dir, Option),
    forall(member(Args, [[init], [host, alpha], [host, client],
                         [author, alice]]),
           ( append([keys|Args], [Option], All),
             typhon(All, Status, _, Err),
             assertion(Status == exit(0)),
             assertion(Err == "") )),
    call(Goal, Dir).

:- begin_tests(keys_on_the_command_line).

test(a_host_with_keys_answers_clients_with_keys) :-
    with_keys(asked).

test(impossible_orders_print_one_line) :-
    with_keys(refused).

:- end_tests(keys_on_the_command_line).

asked(Dir) :-
    format(atom(Host), '--tls=~w/alpha', [Dir]),
    format(atom(Client), '--tls=~w/client', [Dir]),
    project_file('app/typhon.pl', App),
    with_swipl([App, host, alpha, Host, '--authors=alice'], _, _, Out,
               ( read_line_to_string(Out, Address),
                 asked(Dir, Address, Client) )).

asked(Dir, Address, Client) :-
    atom_concat('--host=', Address, At),
    typhon([hosts, At, Client], Known, Table, _),
    assertion(Known == exit(0)),
    assertion(sub_string(Table, _, _, _, "alpha")),
    typhon([hosts, At], Unknown, _, Why),
    assertion(Unknown == exit(1)),
    assertion(sub_string(Why, _, _, _, "it requires TLS")),
    directory_file_path(Dir, 'p.pl', File),
    write_file(File, ':- agent(p, []).~nmain.~n', []),
    typhon([create, File, At, Client, '--join=10'], Unsigned, _, Refused),
    assertion(Unsigned == exit(1)),
    assertion(sub_string(Refused, _, _, _, "signed")),
    atom_concat('--dir=', Dir, In),
    typhon([sign, File, '--author=alice', In], Signed, _, _),
    assertion(Signed == exit(0)),
    typhon([create, File, At, Client, '--join=10'], Joined, _, _),
    assertion(Joined == exit(0)).

refused(Dir) :-
    atom_concat('--dir=', Dir, In),
    forall(member(Args, [ [keys, init, In], [keys, host, alpha, In],
                          [keys, host, '../x', In], [keys, revoke, zeno, In],
                          [keys, nonsense, In], [keys, host, In],
                          [keys, host, x, '--dir=/nowhere'] ]),
           ( typhon(Args, Status, _, Err),
             assertion(Status == exit(1)),
             split_string(Err, "\n", "", Lines),
             assertion(length(Lines, 2)) )).
