:- module(test_plain_client,
          [ greeting/2,                 % +Process, -Line
            client_authenticate/3       % +In, +Out, +Process
          ]).

/** <module> A client that is written from doc/wire.md alone

*Threading*: any thread; the caller owns the streams.
*/

:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(sha), [hash_atom/2, hmac_sha/4]).

%!  greeting(+Process, -Line:string) is det.
%
%   The first line of a client with the id Process, without the end of the
%   line. It announces no byte order, so terms are sent as text.

greeting(Process, Line) :-
    current_prolog_flag(version, Version),
    current_prolog_flag(address_bits, Word),
    format(string(Line),
           "typhon 3 0123456789abcdef0123456789abcdef ~w 1 127.0.0.1:1 ~d ~d none",
           [Process, Version, Word]).

%!  client_authenticate(+In, +Out, +Process) is semidet.
%
%   Both sides prove that they have the cookie. Fails if the other side does
%   not.

client_authenticate(In, Out, Process) :-
    greeting(Process, Client),
    say(Out, Client),
    hear(In, Server),
    proof(client, Client, Server, Ours),
    say(Out, Ours),
    proof(server, Client, Server, Theirs),
    hear(In, Theirs).

say(Out, Line) :-
    format(Out, "~w\n", [Line]),
    flush_output(Out).

hear(In, Line) :-
    read_line_to_string(In, Line).

proof(Role, Client, Server, Proof) :-
    cookie(Cookie),
    format(string(Data), "~w\n~w\n~w", [Role, Client, Server]),
    hmac_sha(Cookie, Data, Hash, [algorithm(sha256), encoding(octet)]),
    hash_atom(Hash, Hex),
    atom_string(Hex, Proof).

cookie(Cookie) :-
    getenv('TYPHON_COOKIE_FILE', File),
    setup_call_cleanup(open(File, read, In),
                       read_line_to_string(In, Cookie),
                       close(In)).
