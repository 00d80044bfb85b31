:- module(warehouse_rosbridge,
          [ rosbridge_start/3,          % :Heard, :Served, -Port
            rosbridge_publish/2,        % +Topic, +Message
            rosbridge_stop/1            % +Port
          ]).
:- use_module('../../../prolog/typhon/bridges/json',
              [json_dict/2, json_text/2]).
:- use_module(library(http/http_stream), []).
:- use_module(library(http/thread_httpd),
              [http_server/2, http_spawn/2, http_stop_server/2]).
:- use_module(library(http/websocket),
              [ http_upgrade_to_websocket/3, ws_receive/3, ws_send/2 ]).
:- use_module(library(socket),
              [tcp_bind/2, tcp_listen/2, tcp_setopt/2, tcp_socket/1]).

/** <module> A rosbridge server for simulated robots

Implements the part of the protocol of rosbridge_server that robots need: topics
that clients publish and subscribe to, and services of the robots.  So hosts
connect to simulated robots by ros_start/3, as to real ones.

*Threading*: a thread for each client; one mutex keeps frames whole.
*/

:- meta_predicate rosbridge_start(2, 3, -).

:- dynamic
    robots/2,                   % Heard, Served
    client/2,                   % Client, Out
    subscribed/2.               % Client, Topic

%!  rosbridge_start(:Heard, :Served, -Port) is det.
%!  rosbridge_stop(+Port) is det.
%
%   One server in a process.  Each message that a client publishes is passed to
%   call(Heard, Topic, Message), as JSON; a service call to call(Served,
%   Service, Request, Response), which fails if there is no such service.

rosbridge_start(Heard, Served, Port) :-
    assertz(robots(Heard, Served)),
    tcp_socket(Socket),
    tcp_setopt(Socket, nodelay),        % no waiting for earlier frames
    tcp_bind(Socket, localhost:Port),
    tcp_listen(Socket, 5),
    http_server(warehouse_rosbridge:upgraded,
                [ port(localhost:Port), tcp_socket(Socket), workers(1),
                  silent(true) ]).

rosbridge_stop(Port) :-
    retractall(robots(_, _)),
    http_stop_server(Port, []).

%!  rosbridge_publish(+Topic:atom, +Message:dict) is det.

rosbridge_publish(Topic, Message) :-
    forall(subscribed(Client, Topic),
           say(Client, _{op:publish, topic:Topic, msg:Message})).

:- public upgraded/1.           % called by http_server/2

upgraded(Request) :-
    http_spawn(http_upgrade_to_websocket(serve, [guarded(false)], Request), []).

serve(Socket) :-
    flag(warehouse_rosbridge, Client, Client+1),
    stream_pair(Socket, _, Out),
    assertz(client(Client, Out)),
    call_cleanup(listen(Client, Socket), gone(Client, Socket)).

gone(Client, Socket) :-
    retractall(client(Client, _)),
    retractall(subscribed(Client, _)),
    catch(close(Socket, [force(true)]), error(_, _), true).

listen(Client, Socket) :-
    catch(ws_receive(Socket, Message, []), error(_, _), fail),
    Message.opcode \== close,
    !,
    json_dict(Message.data, Frame),
    (   catch(frame(Frame.op, Client, Frame), error(_, _), fail)
    ->  true
    ;   say(Client, _{op:status, level:error, msg:"not understood"})
    ),
    listen(Client, Socket).
listen(_, Socket) :-
    stream_pair(Socket, _, Out),
    catch(ws_send(Out, close(1000, "")), error(_, _), true).

frame("advertise", _, _).
frame("unadvertise", _, _).
frame("publish", _, Frame) :-
    atom_string(Topic, Frame.topic),
    robots(Heard, _),
    call(Heard, Topic, Frame.msg).
frame("subscribe", Client, Frame) :-
    atom_string(Topic, Frame.topic),
    retractall(subscribed(Client, Topic)),
    assertz(subscribed(Client, Topic)).
frame("unsubscribe", Client, Frame) :-
    atom_string(Topic, Frame.topic),
    retractall(subscribed(Client, Topic)).
frame("call_service", Client, Frame) :-
    atom_string(Service, Frame.service),
    robots(_, Served),
    (   call(Served, Service, Frame.args, Values)
    ->  Result = true
    ;   format(string(Values), 'Service ~w does not exist', [Service]),
        Result = false
    ),
    say(Client, _{ op:service_response, id:(Frame.id), service:Service,
                   values:Values, result:Result }).

say(Client, Frame) :-
    json_text(Frame, Text),
    (   client(Client, Out)
    ->  with_mutex(warehouse_rosbridge,
                   catch(ws_send(Out, text(Text)), error(_, _), true))
    ;   true
    ).
