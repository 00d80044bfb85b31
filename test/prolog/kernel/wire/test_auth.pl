:- module(test_auth, []).

:- use_module('../../../lib/common').
:- use_module(library(filesex), [chmod/2, directory_file_path/3]).
:- use_module(library(plunit)).
:- use_module(library(sha), [hash_atom/2, hmac_sha/4]).
:- use_module(library(settings), [set_setting/2, setting/2]).
:- use_module(library(socket)).
:- use_module(library(thread), [concurrent/3]).
:- use_module(library(typhon/kernel/wire),
              [cookie/1, line_read/3, line_write/2]).
:- use_module(library(typhon/kernel/wire/handshake),
              [authenticate/6, hello/4, hello_codec/3, hello_line/2]).

:- begin_tests(cookie).

test(value, Cookie == "value of the environment") :-
    with_env('TYPHON_COOKIE', 'value of the environment', cookie(Cookie)).
test(cookie_is_made_on_first_use) :-
    with_tmp_dir(made_on_first_use).
test(name_with_a_quote,
     error(permission_error(use, cookie_file, _))) :-
    with_tmp_dir(others_may_read_quoted).
test(readable_by_others, error(permission_error(use, cookie_file, _))) :-
    with_tmp_dir(others_may_read(0o640)).
test(writable_by_others, error(permission_error(use, cookie_file, _))) :-
    with_tmp_dir(others_may_read(0o602)).
test(empty, error(permission_error(use, cookie_file, _))) :-
    with_tmp_dir(empty_file).
test(error_says_why_the_file_is_not_used,
     [ forall(member(Why-Text,
                     [ others_may_read(0o644)-'chmod 600',
                       file_with("\u00e9234567890123456")-'ASCII',
                       empty_file-'16 characters' ])) ]) :-
    catch(( with_tmp_dir(Why), Said = none ),
          error(permission_error(use, cookie_file, _), context(_, Said)),
          true),
    assertion(sub_atom(Said, _, _, _, Text)).
test(twenty_at_once) :-
    with_tmp_dir(twenty_at_once).

made_on_first_use(Dir) :-
    directory_file_path(Dir, cookie, File),
    with_env('TYPHON_COOKIE_FILE', File,
             ( cookie(Cookie), cookie(Again) )),
    assertion(Cookie == Again),
    assertion(string_length(Cookie, 64)),
    directory_files(Dir, Files),
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

empty_file(Dir) :-
    file_with("", Dir).

file_with(Text, Dir) :-
    directory_file_path(Dir, cookie, File),
    setup_call_cleanup(open(File, write, Out, [encoding(utf8)]),
                       format(Out, "~s\n", [Text]),
                       close(Out)),
    chmod(File, 0o600),
    with_env('TYPHON_COOKIE_FILE', File, cookie(_)).

twenty_at_once(Dir) :-
    directory_file_path(Dir, cookie, File),
    with_env('TYPHON_COOKIE_FILE', File,
             ( findall(cookie(Cookie)-Cookie, between(1, 20, _), Pairs),
               pairs_keys_values(Pairs, Goals, Cookies),
               concurrent(20, Goals, []) )),
    sort(Cookies, Distinct),
    assertion(Distinct = [_]).

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
test(peer_cannot_claim_to_be_this_process, Why == other) :-
    hello(x, 1, 'c:1', Hello),
    meeting(authenticate_as(server, Hello, "cookie"), claim_to_be(x),
            error(permission_error(authenticate, peer, Why), _), _).
test(reflected_greeting_is_refused, Why == other) :-
    hello(x, 1, 'c:1', Hello),
    meeting(reflect, authenticate_as(client, Hello, "cookie"),
            _, error(permission_error(authenticate, peer, Why), _)).
test(reflected_proof_of_a_client_is_refused, Why == cookie) :-
    hello(x, 1, 'c:1', Hello),
    meeting(false_server(reflected), authenticate_as(client, Hello, "cookie"),
            _, error(permission_error(authenticate, peer, Why), _)).
test(server_without_the_cookie_is_refused, Why == cookie) :-
    hello(x, 1, 'c:1', Hello),
    meeting(false_server(guessed), authenticate_as(client, Hello, "cookie"),
            _, error(permission_error(authenticate, peer, Why), _)).
test(changed_hello_is_refused,
     [ forall(member(From-To, [ "c:1"-"c:2", "s:2"-"s:3",
                                " client 1 "-" client 2 ",
                                " little."-" none." ])),
       Why == cookie ]) :-
    relayed(with_text(From, To), _,
            error(permission_error(authenticate, peer, Why), _), _).
test(unexpected_term) :-
    refusal(say("GET / HTTP/1.1\r\n\r\n"),
            permission_error(authenticate, peer, protocol)).
test(random_bytes) :-
    numlist(0, 255, Codes0),
    append([Codes0, Codes0, Codes0], Codes),
    delete(Codes, 10, Line),
    string_codes(Garbage, Line),
    refusal(say(Garbage), syntax_error(line)).
test(endless_line) :-
    refusal(endless, syntax_error(line)).
test(client_closes_at_once) :-
    refusal(say(""), syntax_error(end_of_file)).
test(silent, [setup(quick), cleanup(usual)]) :-
    in_time(refusal(silent, timeout_error(_, _))).
test(slow_client, [setup(quick), cleanup(usual)]) :-
    in_time(refusal(trickle, timeout_error(_, _))).
test(bad_hello) :-
    hello(x, 1, 'c:1', Hello),
    meeting(authenticate_as(server, Hello, "cookie"),
            authenticate_as(client, hello(a, 1, 'a b', 1, 1, 1), "cookie"),
            error(Server, _), _),
    assertion(Server = syntax_error(hello)).

%   Lines that were recorded prove nothing in another session.

test(replayed_lines_of_a_client_are_refused,
     [forall(member(Change, [none,proof])), Why == cookie]) :-
    recorded(client, [Greeting,Proof]),
    hello(x, 1, 'c:1', Hello),
    meeting(authenticate_as(server, Hello, "cookie"),
            replays([send(Greeting),read,send(Proof),read], Change),
            error(permission_error(authenticate, peer, Why), _), _).
test(replayed_lines_of_a_server_are_refused, Why == cookie) :-
    recorded(server, [Greeting,Proof]),
    hello(x, 1, 'c:1', Hello),
    meeting(replays([read,send(Greeting),read,send(Proof)], none),
            authenticate_as(client, Hello, "cookie"),
            _, error(permission_error(authenticate, peer, Why), _)).
test(reflected_greeting_of_a_server_is_refused, Why == other) :-
    hello(x, 1, 'c:1', Hello),
    greeting_of(x, Greeting),
    meeting(authenticate_as(server, Hello, "cookie"),
            replays([send(Greeting),read,send(Greeting),read], none),
            error(permission_error(authenticate, peer, Why), _), _).
test(proof_of_a_server_is_none_of_a_client, Why == cookie) :-
    hello(x, 1, 'c:1', Hello),
    greeting_of(y, Greeting),
    meeting(authenticate_as(server, Hello, "cookie"),
            proves_as(server, Greeting),
            error(permission_error(authenticate, peer, Why), _), _).
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

quick :- set_setting(typhon_handshake:handshake_time, 0.5).
usual :- set_setting(typhon_handshake:handshake_time, 5).

in_time(Goal) :-
    get_time(T0),
    call(Goal),
    get_time(T1),
    assertion(T1-T0 < 4).

refusal(Client, Formal) :-
    hello(x, 1, 'c:1', Hello),
    meeting(authenticate_as(server, Hello, "cookie"), Client,
            error(Error, _), _),
    assertion(Error = Formal).

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

%   relayed(:Change, -Lines, -ServerResult, -ClientResult): client and server meet
%   over a process in between, which passes on each line as call(Change, Line0,
%   Line) makes it.  Lines are those that were passed on.

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

test(same_version, Codec == fast) :-
    hello(p, 1, a, Hello),
    hello_codec(Hello, Hello, Codec).
test(versions_within_the_tested_range, Codec == fast) :-
    hello(p, 1, a, hello(P, S, A, _, W, O)),
    hello_codec(hello(P, S, A, 90004, W, O), hello(P, S, A, 90209, W, O),
                Codec).
test(same_version_outside_the_tested_range, Codec == fast) :-
    hello(p, 1, a, hello(P, S, A, _, W, O)),
    hello_codec(hello(P, S, A, 100112, W, O), hello(P, S, A, 100112, W, O),
                Codec).
test(versions_outside_the_tested_range, Codec == text) :-
    hello(p, 1, a, hello(P, S, A, _, W, O)),
    hello_codec(hello(P, S, A, 90004, W, O), hello(P, S, A, 100112, W, O),
                Codec).
test(other_word_size, Codec == text) :-
    hello(p, 1, a, Hello),
    Hello = hello(P, S, A, V, W, O),
    Other is 96-W,                      % 32 or 64
    hello_codec(Hello, hello(P, S, A, V, Other, O), Codec).
test(other_byte_order, Codec == text) :-
    hello(p, 1, a, Hello),
    Hello = hello(P, S, A, V, W, _),
    hello_codec(Hello, hello(P, S, A, V, W, big), Codec).
test(untested_version, Codec == text) :-
    hello(p, 1, a, Hello),
    Hello = hello(P, S, A, _, W, O),
    hello_codec(Hello, hello(P, S, A, 990000, W, O), Codec).
test(peer_without_records, Codecs == [text, text, text]) :-
    hello(p, 1, a, With),
    setting(typhon_handshake:records, Old),
    setup_call_cleanup(
        set_setting(typhon_handshake:records, false),
        hello(p, 1, a, Without),
        set_setting(typhon_handshake:records, Old)),
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
