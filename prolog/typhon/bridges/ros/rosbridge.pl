:- module(typhon_ros_rosbridge,
          [ rosbridge_open/4,           % +Host, +URL, +Seconds, +Silence
            rosbridge_close/1,          % +Host
            rosbridge_send/3,           % +Host, +Frame, +Seconds
            rosbridge_up/1              % ?Host
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [permission_error/3, resource_error/1]).
:- use_module(library(http/http_open), [http_open/3]).
:- use_module(library(http/http_stream), []).
:- use_module(library(http/websocket), [ws_open/3, ws_send/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/fifo', [fifo_send/2]).
:- use_module('../../kernel/base/monotonic',
              [ monotonic_time/1, poll_within/2, wait_within/2 ]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../json', [json_text/2]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).

/** <module> The connection to a rosbridge server

A thread connects and reads.  When the connection is lost it connects again,
after a tenth of a second, then after twice that time, up to ten seconds.  A
second thread writes the messages in its queue, which is bounded: a caller that
sends faster than the server reads waits, and gets an error after its time
limit.

library(http/http_stream) is loaded since without it requests of WebSockets have
the version HTTP/1.0, which servers refuse.

*Threading*: any thread may call rosbridge_send/3.  The reading thread runs the
hooks, and reads nothing meanwhile.  The reading thread is no `server`, since it
waits for a stream.  The writing thread is none, since it ends with its
connection.
*/

:- setting(longest, nonneg, 4 000 000,
           "Characters of one message from a rosbridge server").

:- multifile
    handle_message/2,           % Host, Read: as of socket_read/2
    up/2,                       % Host, Frame: to be sent first
    down/2.                     % Host, Why: `stopped` if closed by this process

:- dynamic
    handle_message/2,
    up/2,
    reader/2,                   % Host, Thread
    writer/2.                   % Host, Thread: while there is a connection

longest_queue(1000).
first_wait(0.1).
longest_wait(10).
bye_seconds(1).
soon(5).                        % seconds: a connection that ends earlier failed

%!  rosbridge_open(+Host, +URL, +Seconds, +Silence) is det.
%
%   Connect Host within Seconds, and keep it connected.  A server that has sent
%   nothing for Silence seconds, not even answers to pings, counts as gone.
%
%   @error the errors of http_open/3, permission_error(open, websocket, URL),
%   timeout_error(connect, URL)

rosbridge_open(Host, URL, Seconds, Silence) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        first_attempt(link(Host, URL, Silence, Queue), Seconds, Result),
        message_queue_destroy(Queue)),
    (   Result == true
    ->  true
    ;   rosbridge_close(Host),
        throw(Result)
    ).

first_attempt(Link, Seconds, Result) :-
    Link = link(Host, URL, _, Queue),
    alias(reader, Host, Alias),
    first_wait(Wait),
    thread_create(catch(connect(Link, Wait),
                        typhon_ros_stop, true),
                  Reader, [alias(Alias)]),
    assertz(reader(Host, Reader)),
    (   wait_within(Seconds, thread_get_message(Queue, attempt(Result0)))
    ->  Result = Result0
    ;   Result = error(timeout_error(connect, URL), _)
    ).

%   An alias has a number, as a thread that is about to end may still have its
%   alias.

alias(Role, Host, Alias) :-
    flag(typhon_ros_thread, N, N+1),
    atomic_list_concat([typhon_ros, Role, Host, N], '_', Alias).

%!  rosbridge_up(?Host) is nondet.

rosbridge_up(Host) :-
    writer(Host, _).

%!  rosbridge_send(+Host, +Frame:dict, +Seconds) is det.
%
%   Put Frame into the queue of the writer.  Waits at most Seconds for space.
%
%   @error ros_error(not_connected, Host), resource_error(ros_queue)

rosbridge_send(Host, Frame, Seconds) :-
    json_text(Frame, Text),
    (   writer(Host, Writer),
        catch(pass(Writer, text(Text), Seconds),
              error(existence_error(_, _), _), fail)
    ->  true
    ;   throw(error(ros_error(not_connected, Host), _))
    ).

pass(Writer, Message, Seconds) :-
    (   wait_within(Seconds, thread_send_message(Writer, Message))
    ->  true
    ;   resource_error(ros_queue)
    ).

%!  rosbridge_close(+Host) is det.
%
%   Close the connection of Host.  If the server does not close its end within a
%   second the connection is cut.

rosbridge_close(Host) :-
    (   unregister_reader(Host, Reader)
    ->  in_own_thread(close_down(Host, Reader))
    ;   true
    ).

%   Succeeds for only one of concurrent callers.

unregister_reader(Host, Reader) :-
    reader(Host, Reader),
    retract(reader(Host, Reader)),
    !.

close_down(Host, Reader) :-
    thread_self(Me),
    ignore(fifo_send(Reader, stop(Me))),
    (   send_close(Host),
        bye_seconds(Seconds),
        wait_within(Seconds, thread_get_message(Me, stopped(Reader)))
    ->  true
    ;   ignore(interrupt(Reader))
    ),
    thread_join(Reader, _).

%   When Prolog halts it aborts its threads.  So this hook closes connections
%   before that.  On 9.0.4 a wait with a
%   deadline might not end in a hook of halt/0, so the hook polls.

:- at_halt(close_all).

close_all :-
    findall(Host, reader(Host, _), Hosts),
    findall(Reader,
            ( member(Host, Hosts),
              unregister_reader(Host, Reader),
              order_stop(Host, Reader) ),
            Readers),
    bye_seconds(Seconds),
    ignore(poll_within(Seconds, \+ any_runs(Readers))).

order_stop(Host, Reader) :-
    thread_self(Me),
    Reader \== Me,
    fifo_send(Reader, stop(Me)),
    (   send_close(Host)
    ->  true
    ;   interrupt(Reader)
    ).

any_runs(Readers) :-
    member(Reader, Readers),
    catch(thread_property(Reader, status(running)),
          error(existence_error(_, _), _), fail),
    !.

send_close(Host) :-
    writer(Host, Writer),
    catch(thread_send_message(Writer, close(1000, ""), [timeout(0)]),
          error(existence_error(_, _), _), fail).

interrupt(Thread) :-
    catch(thread_signal(Thread, throw(typhon_ros_stop)),
          error(existence_error(_, _), _), fail).

                /*******************************
                *            READING           *
                *******************************/

connect(Link, Wait) :-
    Link = link(Host, URL, Silence, Asker),
    catch(socket_open(URL, Silence, Socket), error(Formal, Context), true),
    (   nonvar(Socket)
    ->  monotonic_time(Start),
        catch(serve_connection(Link, Socket), error(Kind, Where),
              print_error(error, error(Kind, Where))),
        pause_after(Start, Wait, Pause)
    ;   report_attempt(Asker, error(Formal, Context)),
        debug(typhon(ros), '~w: ~w is not there: ~p', [Host, URL, Formal]),
        Pause = Wait
    ),
    pause(Link, Pause).

%   After a connection that lasted, the pause before the next one is short.  A
%   server that closes connections at once gets the longer pause.

pause_after(Start, Wait, Pause) :-
    monotonic_time(Now),
    soon(Soon),
    (   Now-Start > Soon
    ->  first_wait(Pause)
    ;   Pause = Wait
    ).

pause(Link, Pause) :-
    thread_self(Me),
    (   wait_within(Pause, thread_get_message(Me, stop(Caller)))
    ->  thread_send_message(Caller, stopped(Me))
    ;   longest_wait(Longest),
        Longer is min(Longest, 2*Pause),
        connect(Link, Longer)
    ).

%   The thread in rosbridge_open/4 waits for the result of the first attempt.

report_attempt(Asker, Result) :-
    ignore(fifo_send(Asker, attempt(Result))).

%   A cleanup handler cannot be used, since it must not wait.  So a thread that
%   is interrupted during tidy/3 repeats it.

serve_connection(Link, Socket) :-
    Link = link(Host, _, Silence, _),
    writer_begin(Host, Silence, Socket, Writer),
    catch(serve_until_end(Link, Socket, Writer, Why), Ball, true),
    catch(tidy(Host, Writer, Socket), typhon_ros_stop,
          tidy(Host, Writer, Socket)),
    debug(typhon(ros), '~w: the connection has ended: ~p', [Host, Why]),
    ignore(lost(Host, Why)),
    ( var(Ball) -> true ; throw(Ball) ).

%   rosbridge_close/1, or the halt of the process, has removed the reader from
%   reader/2. Then the connection has not been lost, but stopped.

lost(Host, Why) :-
    thread_self(Me),
    (   reader(Host, Me)
    ->  down(Host, Why)
    ;   down(Host, stopped)
    ).

tidy(Host, Writer, Socket) :-
    retractall(writer(Host, _)),
    writer_end(Writer),
    socket_close(Socket).

serve_until_end(link(Host, _, Silence, Asker), Socket, Writer, Why) :-
    findall(Frame, up(Host, Frame), Before),
    send_all(Before, Writer, Silence),
    assertz(writer(Host, Writer)),
    findall(Frame, ( up(Host, Frame), \+ memberchk(Frame, Before) ), Since),
    send_all(Since, Writer, Silence),
    report_attempt(Asker, true),
    catch(read_loop(Host, Socket, Why), error(Why, _), true).

%   A frame for a change that occurs meanwhile may be sent twice, but not
%   missed.

send_all(Frames, Writer, Seconds) :-
    forall(member(Frame, Frames),
           ( json_text(Frame, Text),
             pass(Writer, text(Text), Seconds) )).

read_loop(Host, Socket, Why) :-
    socket_read(Socket, Read),
    (   Read = end(Why0)
    ->  Why = Why0
    ;   catch(handle_message(Host, Read), error(Formal, Context),
              print_error(error, error(Formal, Context))),
        read_loop(Host, Socket, Why)
    ).

                /*******************************
                *            WRITING           *
                *******************************/

writer_begin(Host, Silence, Socket, Writer) :-
    alias(writer, Host, Alias),
    longest_queue(Max),
    Every is Silence/3,
    thread_self(Me),
    thread_create(writer_run(Socket, Every, Me), Writer,
                  [alias(Alias), queue_max_size(Max)]).

writer_run(Socket, Every, Reader) :-
    catch(write_loop(Socket, Every), typhon_ros_stop, true),
    thread_self(Me),
    thread_send_message(Reader, written(Me)).

%   The writer ends by itself when writing fails, as the server is gone.

write_loop(Socket, Every) :-
    thread_self(Me),
    (   wait_within(Every, thread_get_message(Me, Message))
    ->  true
    ;   Message = ping('')              % the server answers it
    ),
    Socket = socket(_, _, Out),
    (   catch(ws_send(Out, Message), error(_, _), fail),
        Message \= close(_, _)          % the server closes its end
    ->  write_loop(Socket, Every)
    ;   true
    ).

%   If the server does not read, the writer blocks again after an interrupt,
%   because the library then writes the rest.  So the interrupt is repeated.

writer_end(Writer) :-
    thread_self(Me),
    writer_stop(Writer, Me),
    catch(thread_join(Writer, _), error(existence_error(_, _), _), true),
    ignore(thread_get_message(Me, written(Writer), [timeout(0)])).

writer_stop(Writer, Me) :-
    interrupt(Writer),
    \+ wait_within(0.1, thread_get_message(Me, written(Writer))),
    !,
    writer_stop(Writer, Me).
writer_stop(_, _).

%   Reading raises a timeout when the server has sent nothing for Silence
%   seconds.  Without nodelay a frame would wait until the server has acknowledged
%   the previous one.

socket_open(URL, Silence, socket(Raw, In, Out)) :-
    Key = 'VHlwaG9uIHJvc2JyaWRnZQ==',
    http_open(URL, Pair,
              [ status_code(Status), header(sec_websocket_accept, Accept),
                connection('Keep-alive, Upgrade'),
                request_header('Upgrade'=websocket),
                request_header('Sec-WebSocket-Key'=Key),
                request_header('Sec-WebSocket-Version'=13),
                output(Output), timeout(Silence), nodelay(true) ]),
    (   Status == 101,
        websocket:sec_websocket_accept(_{key:Key}, Accept)
    ->  stream_pair(Pair, Raw, RawOut),
        stream_pair(Output, Raw, RawOut),
        ws_open(Raw, In, [mode(client)]),
        ws_open(RawOut, Out, [mode(client)])
    ;   close(Output),
        close(Pair),
        permission_error(open, websocket, URL)
    ).

%   socket_read(+Socket, -Read): wait for a message, and answer pings meanwhile.
%   Read is text(String), `binary`, end(Why), or too_long(Characters) for a
%   message longer than the setting `longest`, which is skipped and not stored.
%
%   @error timeout_error(read, Stream)

socket_read(Socket, Read) :-
    Socket = socket(Raw, In, _),
    await_header(Raw),
    websocket:ws_read_header(In, Code, _),
    read_frame(Code, Socket, Read0),
    (   Read0 == none
    ->  socket_read(Socket, Read)
    ;   Read = Read0
    ).

%   The library drops an exception that reaches it while it waits for a header:
%   that of a signal, or of the end of Prolog.  So all bytes of the header are in
%   the buffer before.  A header with a long length has two or eight more.

await_header(Raw) :-
    peek_string(Raw, 2, Start),
    (   string_code(2, Start, Second),
        Short is Second /\ 127,
        more_bytes(Short, More)
    ->  peek_string(Raw, More, _)
    ;   true
    ).

more_bytes(126, 4).
more_bytes(127, 10).

read_frame(end_of_file, _, end(closed)) :- !.
read_frame(Code, Socket, Read) :-
    Socket = socket(_, In, Out),
    setting(longest, Longest),
    read_string(In, Longest, Text),
    rest(In, 0, More),
    (   More > 0
    ->  Length is Longest+More,
        Read = too_long(Length)
    ;   frame_read(Code, Text, Out, Read)
    ).

frame_read(1, Text, _, text(Text)) :- !.
frame_read(2, _, _, binary) :- !.
frame_read(8, _, _, end(closed)) :- !.
frame_read(9, Text, Out, none) :- !, ws_send(Out, pong(Text)).
frame_read(_, _, _, none).

rest(In, Count0, Count) :-
    read_string(In, 4096, Text),
    string_length(Text, Length),
    (   Length =:= 0
    ->  Count = Count0
    ;   Count1 is Count0+Length,
        rest(In, Count1, Count)
    ).

socket_close(socket(_, In, Out)) :-
    catch(close(Out, [force(true)]), error(_, _), true),
    catch(close(In, [force(true)]), error(_, _), true).
