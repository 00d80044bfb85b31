:- module(typhon_handshake,
          [ hello/4,                    % +Process, +Start, +Address, -Hello
            hello_peer/4,               % +Hello, -Process, -Start, -Address
            hello_to/3,                 % +Proof, +Hello0, -Hello
            hello_line/2,               % +Hello, -Line
            hello_codec/3,              % +Hello, +PeerHello, -Codec
            authenticate/6,             % +Role, +In, +Out, +Hello, :Cookie,
                                        % -PeerHello
            cookie/1,                   % -Cookie
            cookie_given/1,             % +Cookie
            random_hex/2                % +Count, -Hex
          ]).

/** <module> The handshake: peers prove that they know the cookie

Both ends of a connection prove that they know a shared secret, the cookie,
before either decodes a term of the other. Client and server send a greeting
each, then a proof each, see doc/wire.md. These lines have a fixed format and
are read byte by byte with one deadline, never with read/1. A hello is
hello(Process, Start, Address, Version, Word, Order): the random id of the
process, the number of this start of its endpoint, its listening address, its
Prolog version, word size and byte order.

A proof is the HMAC-SHA256 under the cookie of the prover's role and both
first lines: it cannot be replayed, reflected, or moved to other hellos. The
server proves nothing to a client that has not proved itself. A client of
another version of the protocol receives the version of the server, `typhon 3`.

*Threading*: any thread. One thread owns the streams of a connection while
lines are exchanged. The cookie is kept with the time stamp of its file in one
fact; two threads that read it at once store the same.
*/

:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [permission_error/3, syntax_error/1]).
:- use_module(library(lists), [max_list/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(sha), [hash_atom/2, hmac_sha/4]).
:- use_module('../base/private', [private_new/2]).
:- use_module('../base/monotonic', [deadline/2]).
:- use_module('../base/text', [shell_word/2]).
:- use_module(frame, [check_bytes/2]).
:- use_module(transport, [line_read/3, line_write/2]).

:- setting(records, boolean, true,
           "Whether terms may travel as records; else always as text").

%!  hello(+Process, +Start, +Address, -Hello) is det.
%
%   Hello is that of this process. If records are switched off its byte order is
%   `none`, which matches that of no peer.

hello(Process, Start, Address,
      hello(Process, Start, Address, Version, Word, Order)) :-
    current_prolog_flag(version, Version),
    current_prolog_flag(address_bits, Word),
    byte_order(Order).

%   1.5 is 0x3ff8 and zeros, so a record of it shows the byte order. Order also
%   has the check of these bytes, which must match, too.

byte_order(none) :-
    setting(records, false),
    !.
byte_order(Order) :-
    fast_term_serialized(1.5, Bytes),
    check_bytes(Bytes, Check),
    (   sub_string(Bytes, _, _, _, "\xf8\\x3f\")
    ->  End = little
    ;   End = big
    ),
    atomic_list_concat([End, Check], '.', Order).

%!  hello_peer(+Hello, -Process, -Start, -Address) is det.
%
%   Hello is that of Process, in its start number Start, at Address.

hello_peer(hello(Process, Start, Address, _, _, _), Process, Start, Address).

%!  hello_to(+Proof, +Hello0, -Hello) is det.
%
%   Hello is Hello0 as it is sent to a peer with that Proof: without a byte
%   order if no record of such a peer may be decoded, since a record with one
%   wrong byte can end the process.  See the hook text_only/1.

hello_to(Proof, hello(Process, Start, Address, Version, Word, _),
         hello(Process, Start, Address, Version, Word, none)) :-
    text_only(Proof),
    !.
hello_to(_, Hello, Hello).

%!  hello_line(+Hello, -Line:string) is det.
%
%   Line is Hello as it is sent in the handshake.

hello_line(hello(Process, Start, Address, Version, Word, Order), Line) :-
    format(string(Line), "~w ~d ~w ~d ~d ~w",
           [Process, Start, Address, Version, Word, Order]).

%!  hello_codec(+Hello, +PeerHello, -Codec) is det.
%
%   Codec is `fast` only if that is known to be safe, else `text`. The order of
%   the two hellos does not matter.

hello_codec(hello(_, _, _, Version1, Word1, Order1),
            hello(_, _, _, Version2, Word2, Order2), Codec) :-
    (   Word1 == Word2,
        Order1 == Order2,
        Order1 \== none,
        one_record_format(Version1, Version2)
    ->  Codec = fast
    ;   Codec = text
    ).

one_record_format(Version, Version) :-
    !.
one_record_format(V1, V2) :-
    record_format(Low, High),
    between(Low, High, V1),
    between(Low, High, V2).

%   Versions First..Last read each other's records (tested both ways). 9.0.4
%   and 10.1.12 do not: integers of 63 bits and more differ.

record_format(90000, 90299).

		 /*******************************
		 *        AUTHENTICATION        *
		 *******************************/

:- setting(handshake_time, number, 5,
           "Seconds a peer has to prove itself").

:- meta_predicate
    authenticate(+, +, +, +, 1, -).

:- multifile
    greeted/0,                          % the server has, and will prove itself
    text_only/1,                        % Proof: records of a peer with that
                                        % proof are not decoded
    other_line/2.                       % Line, Why: Line is that of a server
                                        % with another protocol

%!  authenticate(+Role, +In, +Out, +Hello, :Cookie, -PeerHello) is det.
%
%   Prove this process to the peer at the other end of In and Out and verify the
%   proof of the peer, Role being `client` or `server`.  Raises an error
%   after `handshake_time` seconds in all. call(Cookie, Secret) returns the
%   shared secret. A server calls it, and makes its nonce, only after the client
%   has greeted, so that a silent client costs neither.
%
%   @error permission_error(authenticate, peer, Why) Why: cookie, protocol,
%   version(Theirs), and reasons of options
%   @error timeout_error(read, In)
%   @error syntax_error(Message) if a line is no hello

authenticate(Role, In, Out, Hello, Cookie, PeerHello) :-
    setting(handshake_time, Seconds),
    deadline(Seconds, Deadline),
    thread_self(Me),
    call_cleanup(
        ( exchange_greetings(Role, In, Out, Deadline, Hello, Ours, Theirs),
          check_self(Theirs, Hello),
          call(Cookie, Secret),
          exchange_proofs(Role, In, Out, Deadline, Secret, Ours, Theirs) ),
        retractall(own_greeting(Me, _))),
    greeting_hello(Theirs, PeerHello).

:- dynamic own_greeting/2.              % Thread, Line: it is in a handshake

greet(Out, Hello, Line) :-
    random_hex(16, Nonce),
    hello_line(Hello, HelloLine),
    protocol(Protocol),
    format(string(Line), "~w ~w ~w", [Protocol, Nonce, HelloLine]),
    thread_self(Me),
    assertz(own_greeting(Me, Line)),
    line_write(Out, Line).

%   A hello is public: a peer that claims to be this process has to be at the
%   other end of a handshake of this process.

check_self(Theirs, Hello) :-
    hello_peer(Hello, Process, Start, _),
    format(string(Me), "~w ~w ", [Process, Start]),
    (   sub_string(Theirs, _, _, _, Me),
        \+ ( own_greeting(Thread, Theirs), \+ thread_self(Thread) )
    ->  permission_error(authenticate, peer, other)
    ;   true
    ).

protocol("typhon 3").

greeting_hello(Line, hello(Process, Start, Address, Version, Word, Order)) :-
    (   split_string(Line, " ", "", [_, _, _, P, S, A, V, W, O]),
        number_string(Start, S),
        number_string(Version, V),
        number_string(Word, W)
    ->  atom_string(Process, P),
        atom_string(Address, A),
        atom_string(Order, O)
    ;   syntax_error(hello)
    ).

%   The server does not answer another protocol, but sends its version to a
%   client of another version of this protocol.

exchange_greetings(client, In, Out, Deadline, Hello, Ours, Theirs) :-
    greet(Out, Hello, Ours),
    line_read(In, Deadline, Theirs),
    check_protocol(Theirs),
    ignore(greeted).
exchange_greetings(server, In, Out, Deadline, Hello, Ours, Theirs) :-
    line_read(In, Deadline, Theirs),
    (   speaks(Theirs, version(_))
    ->  protocol(Protocol),
        line_write(Out, Protocol)
    ;   true
    ),
    check_protocol(Theirs),
    greet(Out, Hello, Ours).

check_protocol(Line) :-
    speaks(Line, What),
    (   What == ours
    ->  true
    ;   permission_error(authenticate, peer, What)
    ).

%   speaks(+Line, -What): `ours`, version(Number), the reason of an option that
%   recognises Line, or `protocol`.

speaks(Line, What) :-
    protocol(Protocol),
    (   string_concat(Protocol, Rest, Line),
        sub_string(Rest, 0, 1, _, " ")
    ->  What = ours
    ;   split_string(Line, " ", "", ["typhon", Number|_]),
        number_string(Version, Number),
        integer(Version)
    ->  What = version(Version)
    ;   other_line(Line, Other)
    ->  What = Other
    ;   What = protocol
    ).

exchange_proofs(client, In, Out, Deadline, Secret, Ours, Theirs) :-
    proof(Secret, client, Ours, Theirs, Proof),
    line_write(Out, Proof),
    check_proof(In, Deadline, Secret, server, Ours, Theirs).
exchange_proofs(server, In, Out, Deadline, Secret, Ours, Theirs) :-
    check_proof(In, Deadline, Secret, client, Theirs, Ours),
    proof(Secret, server, Theirs, Ours, Proof),
    line_write(Out, Proof).

%   A proof is valid for one pair of nonces: the duration of the comparison
%   reveals nothing of use.

check_proof(In, Deadline, Secret, Role, Client, Server) :-
    line_read(In, Deadline, Proof),
    (   proof(Secret, Role, Client, Server, Proof)
    ->  true
    ;   permission_error(authenticate, peer, cookie)
    ).

proof(Cookie, Role, Client, Server, Proof) :-
    format(string(Data), "~w\n~w\n~w", [Role, Client, Server]),
    hmac_sha(Cookie, Data, Hash, [algorithm(sha256), encoding(octet)]),
    hash_atom(Hash, Hex),
    atom_string(Hex, Text),
    Proof = Text.

		 /*******************************
		 *           THE COOKIE         *
		 *******************************/

:- dynamic
    given/1,                            % Cookie
    known_cookie/3.                     % File, Time, Cookie

%!  random_hex(+Count, -Hex:atom) is det.
%
%   Hex are Count random bytes, of a quality for secrets.

random_hex(Count, Hex) :-
    setup_call_cleanup(
        open('/dev/urandom', read, In, [type(binary), buffer(false)]),
        ( length(Bytes, Count),
          maplist(get_byte(In), Bytes) ),
        close(In)),
    hash_atom(Bytes, Hex).

%!  cookie(-Cookie:string) is det.
%
%   Cookie is the secret that all processes of a network share: that of
%   cookie_given/1, the value of the environment variable `TYPHON_COOKIE`, or the
%   content of the file `TYPHON_COOKIE_FILE`, by default `~/.typhon.cookie`. The
%   file is made with random content on first use.
%
%   @error permission_error(use, cookie_file, File) if it belongs to another user,
%   others may read or write it, or it has no cookie of ASCII characters; the
%   context says which

cookie(Cookie) :-
    given(Given),
    !,
    Cookie = Given.
cookie(Cookie) :-
    catch(getenv('TYPHON_COOKIE', Value), error(syntax_error(_), _),
          not_ascii('TYPHON_COOKIE')),  % no text of this locale
    Value \== '',
    !,
    atom_string(Value, Cookie),
    must_be_ascii(Cookie, 'TYPHON_COOKIE').
cookie(Cookie) :-
    cookie_file(File),
    (   exists_file(File)
    ->  true
    ;   make_cookie(File)
    ),
    time_file(File, Time),
    (   known_cookie(File, Time, Known)
    ->  Cookie = Known
    ;   read_cookie(File, Cookie),
        retractall(known_cookie(_, _, _)),
        assertz(known_cookie(File, Time, Cookie))
    ).

%!  cookie_given(+Cookie:string) is det.
%
%   From now on Cookie is that of this process.  An environment variable would
%   show it in each process that this one starts.

cookie_given(Cookie) :-
    retractall(given(_)),
    assertz(given(Cookie)).

cookie_file(File) :-
    (   getenv('TYPHON_COOKIE_FILE', File0),
        File0 \== ''
    ->  true
    ;   has_home
    ->  File0 = '~/.typhon.cookie'
    ;   unfit('~/.typhon.cookie', 'HOME is not set; give TYPHON_COOKIE_FILE \c
                                   or TYPHON_COOKIE')
    ),
    expand_file_name(File0, [File|_]).

has_home :-
    (   current_prolog_flag(windows, true)
    ->  true
    ;   getenv('HOME', Home),
        Home \== ''
    ).

read_cookie(File, Cookie) :-
    check_private(File),
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        read_string(In, "\n", "\r", _, Line),
        close(In)),
    must_be_ascii(Line, File),
    (   string_length(Line, Length),
        Length >= 16
    ->  Cookie = Line
    ;   unfit(File, 'its first line has less than 16 characters; without \c
                    the file a new one is made')
    ).

%   The bytes of other characters depend on the locale.

must_be_ascii(Cookie, Source) :-
    string_codes(Cookie, Codes),
    max_list([0|Codes], Max),
    (   Max < 128
    ->  true
    ;   not_ascii(Source)
    ).

not_ascii(Source) :-
    unfit(Source, 'a cookie has ASCII characters only').

unfit(File, Why) :-
    throw(error(permission_error(use, cookie_file, File), context(_, Why))).

%   Prolog has no predicate for the owner and the mode of a file; `test -O` checks
%   that the owner is this user, and ls prints the mode, as -rw-------, on all
%   systems with modes. A pipe needs no library(process), which is as
%   large as three modules of this library.

check_private(_) :-
    current_prolog_flag(windows, true),
    !.
check_private(File) :-
    shell_word(File, Word),
    format(atom(Command), 'test -O ~w && exec ls -lnd -- ~w', [Word, Word]),
    setup_call_cleanup(
        open(pipe(Command), read, Out),
        read_string(Out, "\n", "\r", _, Line),
        catch(close(Out), error(_, _), true)),
    (   Line == ""
    ->  unfit(File, 'it belongs to another user')
    ;   sub_string(Line, 4, 6, _, "------")
    ->  true
    ;   format(atom(Why), 'others may use it: chmod 600 ~w', [File]),
        unfit(File, Why)
    ).

make_cookie(File) :-
    random_hex(32, Cookie),
    atom_concat(Cookie, '\n', Line),
    catch(private_new(File, Line), error(_, _),
          unfit(File, 'it cannot be made there; give TYPHON_COOKIE_FILE or \c
                       TYPHON_COOKIE')).
