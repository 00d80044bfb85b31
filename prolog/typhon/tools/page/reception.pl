:- module(typhon_page_reception,
          [ reception_open/2,           % +Address, :Serve
            reception_close/0,
            with_body/4                 % +In, +Length, -Body, :Goal
          ]).
:- use_module(library(error), [syntax_error/1]).
:- use_module(library(http/http_wrapper), [http_wrapper/5]).
:- use_module(library(lists), [member/2]).
:- use_module(library(memfile),
              [free_memory_file/1, new_memory_file/1, open_memory_file/4]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(socket),
              [ tcp_bind/2, tcp_close_socket/1, tcp_listen/2,
                tcp_open_socket/2, tcp_setopt/2, tcp_socket/1 ]).
:- use_module('../../kernel/base/clients',
              [client_becomes/1, clients_end/1, clients_start/4]).
:- use_module('../../kernel/base/options', [blaming/2]).

/** <module> Connections of browsers

The head of a request is read into memory before the library of HTTP looks at
it: it has a bounded size, and has to be there in time, from its first byte to
its last.  A client that has not sent it holds a connection only while no other
client wants it, see typhon_clients.  The body, which is read when the token is
known to be right, has to be there in time, too.

*Threading*: an acceptor, and a thread for each client.
*/

:- setting(connections, positive_integer, 64,
           "A page has so many clients at a time").
:- setting(request_seconds, positive_integer, 20,
           "The head of a request takes no longer, and no longer its body").
:- setting(head_bytes, positive_integer, 16 384,
           "The head of a request is no longer").

:- meta_predicate
    reception_open(+, 2),
    with_body(+, +, -, 0),
    with_bytes(1, -, 0).

:- dynamic listens/1.           % Socket

%!  reception_open(+Address, :Serve) is det.
%!  reception_close is det.
%
%   Serve clients that connect to Address, Interface:Port, by call(Serve, In,
%   Request), which prints an answer as handlers of library(http) do; In has the
%   body.  reception_close/0 ends all clients.
%
%   @error socket_error(Code, Message)

%   Processes that are started later must not inherit the socket: the port would
%   be in use as long as they are.

reception_open(Interface:Port, Serve) :-
    setting(connections, Most),
    tcp_socket(Socket),
    catch(( tcp_setopt(Socket, reuseaddr),
            blaming(port(Port), tcp_bind(Socket, Interface:Port)),
            tcp_listen(Socket, 64),
            tcp_open_socket(Socket, Stream),
            set_stream(Stream, close_on_exec(true)),
            clients_start(typhon_page, Socket, Most,
                          typhon_page_reception:client(Serve)) ),
          Ball,
          ( tcp_close_socket(Socket), throw(Ball) )),
    assertz(listens(Socket)).

reception_close :-
    (   retract(listens(Socket))
    ->  clients_end(typhon_page),
        tcp_close_socket(Socket)
    ;   true
    ).

:- public client/3.             % called by typhon_clients

client(_, none, Out) :-
    !,
    format(Out, 'HTTP/1.1 503 Service Unavailable\r\n\c
                 Content-Length: 0\r\nConnection: close\r\n\r\n', []),
    flush_output(Out).
client(Serve, In, Out) :-
    setting(request_seconds, Seconds),
    set_stream(In, close_on_exec(true)),
    set_stream(Out, timeout(Seconds)),
    deadline(Deadline),
    setting(head_bytes, Most),
    head(In, Most, 0'\n, Deadline, Bytes),
    client_becomes(busy),
    handler(Serve, In, Handler),
    with_bytes(written(Bytes), Head,
               http_wrapper(Handler, Head, Out, Close, [])),
    switched(Close, In, Out).

%   http_wrapper/5 adds the request, which its declaration does not say.

handler(Serve, In, typhon_page_reception:serve(Serve, In)).

:- public serve/3.

serve(Serve, In, Request) :-
    call(Serve, In, Request).

%   The rest of the connection is a WebSocket.

switched(switch_protocol(Goal, _), In, Out) :-
    !,
    client_becomes(apart),
    set_stream(Out, timeout(infinite)),
    call(Goal, In, Out).
switched(_, _, _).

                /*******************************
                *             TIME             *
                *******************************/

deadline(Deadline) :-
    setting(request_seconds, Seconds),
    get_time(Now),
    Deadline is Now+Seconds.

%   before(+Deadline, +In): the next byte has to be there by then.

before(Deadline, In) :-
    get_time(Now),
    Left is Deadline-Now,
    (   Left > 0
    ->  set_stream(In, timeout(Left))
    ;   throw(error(timeout_error(read, In), _))
    ).

%   head(+In, +Most, +Last, +Deadline, -Bytes): until the end of an empty line,
%   Last being the byte before, of returns aside.

head(In, Most, Last, Deadline, [Byte|Bytes]) :-
    before(Deadline, In),
    get_byte(In, Byte),
    Byte \== -1,
    Most > 0,
    (   Byte == 0'\n,
        Last == 0'\n
    ->  Bytes = []
    ;   ( Byte == 0'\r -> Next = Last ; Next = Byte ),
        Most1 is Most-1,
        head(In, Most1, Next, Deadline, Bytes)
    ).

%!  with_body(+In, +Length, -Body, :Goal) is semidet.
%
%   Run Goal once while Body is a stream with the body of that Length, which
%   has been read from In.
%
%   @error timeout_error(read, In), syntax_error(http_length) if it is shorter

with_body(In, Length, Body, Goal) :-
    deadline(Deadline),
    with_bytes(copied(In, Length, Deadline), Body, Goal).

copied(In, Left, Deadline, Out) :-
    (   Left > 0
    ->  before(Deadline, In),
        (   peek_byte(In, -1)
        ->  syntax_error(http_length)
        ;   true
        ),
        read_pending_codes(In, Bytes, []),
        written(Bytes, Out),
        length(Bytes, Count),
        Left1 is Left-Count,
        copied(In, Left1, Deadline, Out)
    ;   true
    ).

written(Bytes, Out) :-
    forall(member(Byte, Bytes), put_byte(Out, Byte)).

%   with_bytes(:Write, -In, :Goal): In has what call(Write, Out) writes.

with_bytes(Write, In, Goal) :-
    setup_call_cleanup(
        new_memory_file(File),
        ( setup_call_cleanup(
              open_memory_file(File, write, Out, [encoding(octet)]),
              call(Write, Out),
              close(Out)),
          setup_call_cleanup(
              open_memory_file(File, read, In, [encoding(octet)]),
              once(Goal),
              close(In)) ),
        free_memory_file(File)).
