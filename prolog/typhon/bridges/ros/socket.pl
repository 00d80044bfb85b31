:- module(typhon_ros_socket,
          [ socket_open/3,              % +URL, +Silence, -Socket
            socket_read/2,              % +Socket, -Read
            socket_write/2,             % +Socket, +Text
            socket_ping/1,              % +Socket
            socket_bye/1,               % +Socket
            socket_close/1              % +Socket
          ]).
:- use_module(library(http/http_stream), []).
:- use_module(library(http/websocket),
              [http_open_websocket/3, ws_send/2]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> A WebSocket with bounds

What library(http/websocket) gives, but a message that is longer than the
setting `longest` is passed over without being kept.  library(http/http_stream)
is there because without it the request says HTTP/1.0, which servers refuse.

*Threading*: one thread reads, one other writes.  Both may be signalled.
*/

:- setting(longest, nonneg, 4 000 000,
           "Characters of one message from a rosbridge server").

%!  socket_open(+URL, +Silence, -Socket) is det.
%
%   Silence is how many seconds a server may say nothing at all.
%
%   @error What http_open/3 and http_open_websocket/3 raise

socket_open(URL, Silence, socket(In, Out)) :-
    http_open_websocket(URL, Pair, [timeout(Silence)]),
    stream_pair(Pair, In, Out).

%!  socket_read(+Socket, -Read) is det.
%
%   Waits for a message.  Read is text(String), too_long(Characters), `binary`,
%   or end(Why).  Answers pings.
%
%   @error timeout_error(read, Stream)

socket_read(Socket, Read) :-
    Socket = socket(In, _),
    websocket:ws_read_header(In, Code, _),
    read_frame(Code, Socket, Read0),
    (   Read0 == none
    ->  socket_read(Socket, Read)
    ;   Read = Read0
    ).

read_frame(end_of_file, _, end(closed)) :- !.
read_frame(Code, Socket, Read) :-
    Socket = socket(In, Out),
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

%!  socket_write(+Socket, +Text) is det.
%!  socket_ping(+Socket) is det.
%!  socket_bye(+Socket) is det.
%
%   Write a message; what the server has to answer; that we are going, to
%   which its end is the answer.

socket_write(socket(_, Out), Text) :-
    ws_send(Out, text(Text)).

socket_ping(socket(_, Out)) :-
    ws_send(Out, ping('')).

socket_bye(socket(_, Out)) :-
    ws_send(Out, close(1000, "")).

%!  socket_close(+Socket) is det.

socket_close(socket(In, Out)) :-
    catch(close(Out, [force(true)]), error(_, _), true),
    catch(close(In, [force(true)]), error(_, _), true).
