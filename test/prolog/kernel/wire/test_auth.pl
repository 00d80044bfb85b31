:- module(test_auth, []).

:- use_module('../../../lib/common').
:- use_module(library(filesex), [chmod/2, directory_file_path/3]).
:- use_module(library(plunit)).
:- use_module(library(sha), [hash_atom/2, hmac_sha/4]).
:- use_module(library(socket)).
:- use_module(library(thread), [concurrent/3]).
:- use_module(library(typhon/kernel/wire),
              [cookie/1, line_read/3, line_write/2]).
:- use_module(library(typhon/kernel/wire/handshake),
              [authenticate/6, hello/4, hello_codec/3, hello_line/2]).

:- begin_tests(cookie).

test(value, Cookie == "value of the environment") :-
    with_env('TYPHON_COOKIE', 'value of the environment', cookie(Cookie)).
%   unusable(-Why, -Advice): called with a directory, Why uses the cookie there.

unusable(others_may_read(Mode), 'chmod 600') :-
    member(Mode, [0o640, 0o602, 0o644]).
unusable(others_may_read_quoted, 'chmod 600').
unusable(file_with("\u00e9234567890123456"), 'ASCII').
unusable(file_with(""), '16 characters').

test(file_that_is_not_used, [ forall(unusable(Why, Advice)),
                              true(sub_atom(Said, _, _, _, Advice)) ]) :-
    catch(( with_tmp_dir(Why), Said = none ),
          error(permission_error(use, cookie_file, _), context(_, Said)),
          true).
test(cookie_is_made_on_first_use_by_one_of_twenty) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, cookie, File),
          with_env('TYPHON_COOKIE_FILE', File, twenty_at_once(Cookies)),
          directory_files(Dir, Files) )),
    sort(Cookies, [Cookie]),
    assertion(string_length(Cookie, 64)),
    subtract(Files, ['.', '..'], Left),
    assertion(Left == [cookie]).

others_may_read(Mode, Dir) :-
    directory_file_path(Dir, cookie, File),
    with_env('TYPHON_COOKIE_FILE', File,
             ( cookie(_), chmod(File, Mode), sleep_past(File), cookie(_) )).

others_may_read_quoted(Dir) :-
    directory_file_path(Dir, 'it''s; odd', Odd),
    make_directory(Odd),
    others_may_read(0o640, Odd).

%   The cookie of a file that has not changed is not read again.

sleep_past(File) :-
    time_file(File, Time),
    Later is Time+2,
    set_time_file(File, [], [modified(Later)]).

file_with(Text, Dir) :-
    directory_file_path(Dir, cookie, File),
    setup_call_cleanup(open(File, write, Out, [encoding(utf8)]),
                       format(Out, "~s\n", [Text]),
                       close(Out)),
    chmod(File, 0o600),
    with_env('TYPHON_COOKIE_FILE', File, cookie(_)).

twenty_at_once(Cookies) :-
    findall(cookie(Cookie)-Cookie, between(1, 20, _), Pairs),
    pairs_keys_values(Pairs, Goals, Cookies),
    concurrent(20, Goals, []).

:- end_tests(cookie).

:- begin_tests(authentication).

test(same_cookie, [ClientSees-ServerSees == ServerHello-ClientHello]) :-
    hello(client, 1, 'c:1', ClientHello),
    hello(server, 7, 's:2', ServerHello),
    meeting(authenticate_as(server, ServerHello, "same"),
            authenticate_as(client, ClientHello, "same"),
            true(ServerSees), true(ClientSees)).
test(wrong_cookie, [Server-Client == Expected]) :-
    Expected = cookie-closed,
    hello(x, 1, 'c:1', Hello),
    meeting(authenticate_as(server, Hello, "one cookie"),
            authenticate_as(client, Hello, "another cookie"),
            error(permission_error(authenticate, peer, Server), _),
            error(ClientError, _)),
    (   memberchk(ClientError, [syntax_error(_), socket_error(_, _),
                                io_error(_, _)])
    ->  Client = closed
    ;   Client = ClientError
    ).
%   impostor(-Server, -Client, -Why): `honest` of the two refuses the other.

impostor(honest, claim_to_be(x), other).
impostor(honest, replays([send(Greeting),read,send(Greeting),read], none),
         other) :-
    greeting_of(x, Greeting).
impostor(honest, replays([send(Greeting),read,send(Proof),read], Change),
         cookie) :-
    recorded(client, [Greeting,Proof]),
    member(Change, [none,proof]).
impostor(honest, proves_as(server, Greeting), cookie) :-
    greeting_of(y, Greeting).
impostor(reflect, honest, other).
impostor(false_server(Kind), honest, cookie) :-
    member(Kind, [reflected,guessed]).
impostor(replays([read,send(Greeting),read,send(Proof)], none), honest,
         cookie) :-
    recorded(server, [Greeting,Proof]).

%   Lines that were recorded prove nothing in another session.

test(impostor_is_refused, [ forall(impostor(Server, Client, Expected)),
                            Why == Expected ]) :-
    acts(Server, server, S),
    acts(Client, client, C),
    meeting(S, C, ServerResult, ClientResult),
    ( Server == honest -> Result = ServerResult ; Result = ClientResult ),
    Result = error(permission_error(authenticate, peer, Why), _).

acts(honest, Role, Act) :-
    !,
    hello(x, 1, 'c:1', Hello),
    Act = authenticate_as(Role, Hello, "cookie").
acts(Act, _, Act).

test(changed_hello_is_refused,
     [ forall(member(From-To, [ "c:1"-"c:2", "s:2"-"s:3",
                                " client 1 "-" client 2 ",
                                " little."-" none." ])),
       Why == cookie ]) :-
    relayed(with_text(From, To), _,
            error(permission_error(authenticate, peer, Why), _), _).
%   invalid(-Client, -Error): of a server; the last two are refused in time.

invalid(say("GET / HTTP/1.1\r\n\r\n"),
        permission_error(authenticate, peer, protocol)).
invalid(say(Line), Error) :-            % a line has at most 512 bytes
    member(Count-Error, [ 512-permission_error(authenticate, peer, protocol),
                          513-syntax_error(line) ]),
    format(string(Line), "~`xt~*|\n", [Count]).
invalid(say(Garbage), syntax_error(line)) :-
    numlist(0, 255, Codes0),
    append([Codes0, Codes0, Codes0], Codes),
    delete(Codes, 10, Line),
    string_codes(Garbage, Line).
invalid(endless, syntax_error(line)).
invalid(say(""), syntax_error(end_of_file)).
invalid(silent, timeout_error(_, _)).
invalid(trickle, timeout_error(_, _)).

test(invalid_client, [ forall(invalid(Client, Error)),
                       true(subsumes_term(Error, E)) ]) :-
    hello(x, 1, 'c:1', Hello),
    with_settings([typhon_handshake:handshake_time=0.5],
                  meeting(authenticate_as(server, Hello, "cookie"), Client,
                          error(E, _), _)).
test(bad_hello) :-
    hello(x, 1, 'c:1', Hello),
    meeting(authenticate_as(server, Hello, "cookie"),
            authenticate_as(client, hello(a, 1, 'a b', 1, 1, 1), "cookie"),
            error(Server, _), _),
    assertion(Server = syntax_error(hello)).

test(greetings_never_repeat, Distinct == 40) :-
    findall(Line, ( between(1, 20, _), recorded(client, Lines),
                    member(Line, Lines) ), Lines),
    sort(Lines, Set),
    length(Set, Distinct).
test(server_proves_nothing_to_a_client_without_the_cookie, Line == none) :-
    hello(x, 1, 'c:1', Hello),
    greeting_of(y, Greeting),
    meeting(authenticate_as(server, Hello, "cookie"),
            told_after([Greeting,"00"]), _, true(Line)).

say(Text, _, Out) :-
    write(Out, Text),
    flush_output(Out).

silent(In, _) :-
    read_string(In, _, _).

trickle(In, Out) :-
    forall(between(1, 200, _),
           (   wait_for_input([In], [], 0.02)
           ->  write(Out, "t"),
               flush_output(Out)
           ;   true
           )).

endless(_, Out) :-
    forall(between(1, 100000, _), write(Out, "typhon 3 ")),
    flush_output(Out).

%   Echoes its input.

claim_to_be(Process, In, Out) :-
    greeting_of(Process, First),
    line_write(Out, First),
    next_line(In, _),
    line_write(Out, "00").

greeting_of(Process, Line) :-
    hello(Process, 1, 'c:1', Hello),
    hello_line(Hello, HelloLine),
    format(string(Line), "typhon 3 00 ~w", [HelloLine]).

next_line(In, Line) :-
    get_time(Now),
    Deadline is Now+5,
    line_read(In, Deadline, Line).

reflect(In, Out) :-
    next_line(In, Greeting),
    line_write(Out, Greeting),
    next_line(In, Proof),
    line_write(Out, Proof).

%   relayed(:Change, -Lines, -ServerResult, -ClientResult): client and server
%   meet over a process in between, which passes on each line as
%   call(Change, Line0, Line) makes it.  Lines are those that were passed on.

:- meta_predicate relayed(2, -, -, -).

relayed(Change, Lines, ServerResult, ClientResult) :-
    hello(client, 1, 'c:1', ClientHello),
    hello(server, 7, 's:2', ServerHello),
    setup_call_cleanup(
        message_queue_create(Queue),
        ( meeting(passes_on(Change, ServerHello, Queue),
                  authenticate_as(client, ClientHello, "same"),
                  _, ClientResult),
          thread_get_message(Queue, passed(Lines, Result)) ),
        message_queue_destroy(Queue)),
    ServerResult = Result.

passes_on(Change, Hello, Queue, In, Out) :-
    meeting(authenticate_as(server, Hello, "same"),
            relays(Change, In-Out, Queue), Result, _),
    thread_get_message(Queue, lines(Lines)),
    thread_send_message(Queue, passed(Lines, Result)).

relays(Change, ClientIn-ClientOut, Queue, ServerIn, ServerOut) :-
    catch(( pass(Change, ClientIn, ServerOut, L1),
            pass(Change, ServerIn, ClientOut, L2),
            pass(Change, ClientIn, ServerOut, L3),
            pass(Change, ServerIn, ClientOut, L4),
            Lines = [L1, L2, L3, L4] ),
          error(_, _),
          Lines = []),
    thread_send_message(Queue, lines(Lines)).

pass(Change, In, Out, Line) :-
    next_line(In, Line0),
    call(Change, Line0, Line),
    line_write(Out, Line).

with_text(From, To, Line0, Line) :-
    (   sub_string(Line0, Before, _, After, From)
    ->  sub_string(Line0, 0, Before, _, Begin),
        sub_string(Line0, _, After, 0, End),
        string_concat(Begin, To, Line1),
        string_concat(Line1, End, Line)
    ;   Line = Line0
    ).

%   recorded(+Role, -Lines): what a true Role has sent in an earlier session.

recorded(Role, Lines) :-
    hello(a, 1, 'a:1', HelloA),
    hello(b, 1, 'b:1', HelloB),
    Other = authenticate_as(client, HelloA, "cookie"),
    (   Role == client
    ->  meeting(listens(HelloB), Other, true(Lines), _)
    ;   greeting_of(a, Greeting),
        meeting(authenticate_as(server, HelloB, "cookie"),
                listens_to_server(Greeting), _, true(Lines))
    ).

listens(Hello, In, Out) :-
    next_line(In, Greeting),
    hello_line(Hello, HelloLine),
    format(string(Ours), "typhon 3 01 ~w", [HelloLine]),
    line_write(Out, Ours),
    next_line(In, Proof),
    nb_setval(seen, [Greeting,Proof]).

listens_to_server(Ours, In, Out) :-
    line_write(Out, Ours),
    next_line(In, Greeting),
    typhon_handshake:proof("cookie", client, Ours, Greeting, Proof),
    line_write(Out, Proof),
    next_line(In, Theirs),
    nb_setval(seen, [Greeting,Theirs]).

replays(Steps, Change, In, Out) :-
    forall(member(Step, Steps), replay(Step, Change, In, Out)).

%   A proof with one digit changed is none either.

replay(read, _, In, _) :-
    catch(next_line(In, _), error(_, _), true).
replay(send(Line), Change, _, Out) :-
    (   Change == proof,
        \+ sub_string(Line, _, _, _, " ")
    ->  sub_string(Line, 1, _, 0, Rest),
        string_concat("0", Rest, Sent)
    ;   Sent = Line
    ),
    line_write(Out, Sent).

proves_as(Role, Ours, In, Out) :-
    line_write(Out, Ours),
    next_line(In, Theirs),
    typhon_handshake:proof("cookie", Role, Ours, Theirs, Proof),
    line_write(Out, Proof),
    replay(read, none, In, Out).

told_after([Greeting,Proof], In, Out) :-
    line_write(Out, Greeting),
    next_line(In, _),
    line_write(Out, Proof),
    ( catch(next_line(In, Line), error(_, _), fail) -> true ; Line = none ),
    nb_setval(seen, Line).

%   A server that does not know the cookie answers with the proof of the client,
%   or with one made with another cookie.

false_server(Kind, In, Out) :-
    next_line(In, Theirs),
    greeting_of(false, Ours),
    line_write(Out, Ours),
    next_line(In, Proof),
    (   Kind == reflected
    ->  Answer = Proof
    ;   format(string(Data), "server\n~w\n~w", [Theirs, Ours]),
        hmac_sha("a guess of 16 bytes", Data, Hash, [algorithm(sha256)]),
        hash_atom(Hash, Answer)
    ),
    line_write(Out, Answer).

:- end_tests(authentication).

:- begin_tests(codec_negotiation).

%   codec(-Mine, -Theirs, -Codec): of hellos with these versions, word sizes and
%   byte orders; `own` is that of this process.

codec(own/own/own, own/own/own, fast).
codec(90004/own/own, 90209/own/own, fast).
codec(100112/own/own, 100112/own/own, fast).
codec(90004/own/own, 100112/own/own, text).
codec(own/own/own, 990000/own/own, text).
codec(own/32/own, own/64/own, text).
codec(own/own/little, own/own/big, text).

test(codec, [forall(codec(Mine, Theirs, Expected)), Codec == Expected]) :-
    maplist(hello_of, [Mine,Theirs], [Hello1,Hello2]),
    hello_codec(Hello1, Hello2, Codec).

hello_of(V/W/O, hello(P, S, A, V1, W1, O1)) :-
    hello(p, 1, a, hello(P, S, A, V0, W0, O0)),
    maplist([X,Own,Y]>>( X == own -> Y = Own ; Y = X ),
            [V,W,O], [V0,W0,O0], [V1,W1,O1]).

test(peer_without_records, Codecs == [text, text, text]) :-
    hello(p, 1, a, With),
    with_settings([typhon_handshake:records=false],
                  hello(p, 1, a, Without)),
    findall(Codec,
            ( member(Mine-Theirs,
                     [With-Without, Without-With, Without-Without]),
              hello_codec(Mine, Theirs, Codec)
            ),
            Codecs).

:- end_tests(codec_negotiation).

%   meeting(:Server, :Client, -ServerResult, -ClientResult): both are
%   called with the two streams of their end; a result is true(X), what
%   authenticate/6 saw, or the exception.

:- meta_predicate
    meeting(2, 2, -, -),
    with_env(+, +, 0).

meeting(Server, Client, ServerResult, ClientResult) :-
    tcp_socket(Socket),
    tcp_bind(Socket, '127.0.0.1':Port),
    tcp_listen(Socket, 5),
    thread_self(Me),
    thread_create(( tcp_accept(Socket, Slave, _),
                    at_end(Slave, Server, Result),
                    thread_send_message(Me, server(Result)) ), Thread),
    tcp_socket(ClientSocket),
    tcp_connect(ClientSocket, '127.0.0.1':Port),
    at_end(ClientSocket, Client, ClientResult0),
    thread_get_message(server(ServerResult0)),
    thread_join(Thread),
    tcp_close_socket(Socket),
    ServerResult = ServerResult0,
    ClientResult = ClientResult0.

at_end(Socket, Goal, Result) :-
    setup_call_cleanup(
        tcp_open_socket(Socket, In, Out),
        catch(( set_stream(In, encoding(octet)),
                set_stream(Out, encoding(octet)),
                call(Goal, In, Out),
                Result = true(Seen),
                (   nb_current(seen, Seen0) -> Seen = Seen0 ; true ) ),
              Result, true),
        ( close(Out, [force(true)]), close(In, [force(true)]) )).

authenticate_as(Role, Hello, Cookie, In, Out) :-
    authenticate(Role, In, Out, Hello, =(Cookie), Peer),
    nb_setval(seen, Peer).

with_env(Name, Value, Goal) :-
    (   getenv(Name, Old)
    ->  Restore = setenv(Name, Old)
    ;   Restore = unsetenv(Name)
    ),
    setup_call_cleanup(setenv(Name, Value), Goal, Restore).
