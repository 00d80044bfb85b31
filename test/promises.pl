:- module(test_promises,
          [ promise/5,                  % ?Name, ?Document, ?Suites, -File, -Edit
            promise_change/3            % ?Name, -Change, -Suites
          ]).

/** <module> What is promised, the tests that pin it, and what must break them

*Threading*: any thread.
*/

:- use_module(lib/common, [project_file/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
%!  promise(?Name, ?Document, ?Suites, -File, -Edit) is nondet.
%
%   Document promises Name. One of Suites fails if in File the text Old is New;
%   Edit is Old-New.

promise(server_proves_itself, 'doc/wire.md',
        ['test/prolog/kernel/wire/test_auth.pl'],
        'prolog/typhon/kernel/wire/handshake.pl',
        "    check_proof(In, Deadline, Secret, server, Ours, Theirs).\n"-
        "    line_read(In, Deadline, _).\n").
promise(client_proves_itself, 'doc/wire.md',
        ['test/prolog/kernel/wire/test_auth.pl'],
        'prolog/typhon/kernel/wire/handshake.pl',
        "    check_proof(In, Deadline, Secret, client, Theirs, Ours),\n"-
        "    line_read(In, Deadline, _),\n").
promise(proof_names_the_role, 'doc/wire.md',
        ['test/prolog/kernel/wire/test_auth.pl'],
        'prolog/typhon/kernel/wire/handshake.pl',
        "[Role, Client, Server]"-"[proof, Client, Server]").
promise(first_matching_rule_applies, 'doc/security.md',
        ['test/prolog/options/access/test_access.pl',
         'test/prolog/options/access/test_arrivals.pl'],
        'prolog/typhon/options/access.pl',
        "    subsumes_term(Peer, Proof),\n    !,\n"-
        "    subsumes_term(Peer, Proof),\n").
promise(abort_cannot_be_caught, 'doc/security.md',
        ['test/prolog/options/guard/test_guard.pl',
         'test/prolog/options/guard/test_guard_escapes.pl'],
        'prolog/typhon/options/guard/guard_calls.pl',
        "ends_thread('$aborted').\n"-"").
promise(ring_closes, 'doc/networks.md',
        ['test/prolog/network/test_topology.pl'],
        'prolog/typhon/network/topology.pl',
        "    N > 2.\nlinked(star"-"    N > 3.\nlinked(star").

%!  promise_change(?Name, -Change, -Suites:list) is nondet.

promise_change(Name, change(File, Start, End, New, declared, -, Line),
               Suites) :-
    promise(Name, _, Suites, File, Old-New),
    project_file(File, Path),
    read_file_to_string(Path, Text, [encoding(utf8)]),
    once(sub_string(Text, Start, Length, _, Old)),
    End is Start+Length,
    sub_string(Text, 0, Start, _, Before),
    split_string(Before, "\n", "", Lines),
    length(Lines, Line).
