:- module(typhon_ros_websocket,
          [ socket_open/3,              % +URL, +Silence, -Socket
            socket_read/2,              % +Socket, -Read
            socket_close/1              % +Socket
          ]).
:- use_module(library(http/http_stream), []).
:- use_module(library(http/websocket), [http_open_websocket/3, ws_send/2]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> WebSockets with bounded messages

WebSockets of library(http/websocket), except that a message longer than the
setting `typhon_ros_rosbridge:longest` is skipped and not stored.
library(http/http_stream) is loaded since without it requests have the version
HTTP/1.0, which servers refuse.

*Threading*: one thread reads, another writes.
*/

:- setting(typhon_ros_rosbridge:longest, nonneg, 4 000 000,
           "Characters of one message from a rosbridge server").

%!  socket_open(+URL, +Silence, -Socket) is det.
%
%   Connect to URL.  Reading raises a timeout when the server has sent nothing
%   for Silence seconds.  Without nodelay a frame would wait until the server
%   has acknowledged the previous one.
%
%   @error the errors of http_open/3 and http_open_websocket/3

socket_open(URL, Silence, socket(In, Out)) :-
    http_open_websocket(URL, Pair, [timeout(Silence), nodelay(true)]),
    stream_pair(Pair, In, Out).

%!  socket_read(+Socket, -Read) is det.
%
%   Wait for a message, and answer pings meanwhile.  Read is text(String),
%   too_long(Characters), `binary`, or end(Why).
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
    setting(typhon_ros_rosbridge:longest, Longest),
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

%!  socket_close(+Socket) is det.
%
%   Close both streams of Socket.

socket_close(socket(In, Out)) :-
    catch(close(Out, [force(true)]), error(_, _), true),
    catch(close(In, [force(true)]), error(_, _), true).
