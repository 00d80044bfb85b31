:- module(test_rosbridge_server,
          [ with_rosbridge/2,           % -URL, :Goal
            rosbridge_begin/2,          % +Port, -URL
            rosbridge_end/1,            % +URL
            rosbridge_frames/1,         % -Frames
            rosbridge_forget/0,
            rosbridge_send/1,           % +Frame or text
            rosbridge_cut/0,
            rosbridge_clients/1         % -Count
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(http/http_dispatch)).
:- use_module(library(http/http_stream), []).
:- use_module(library(http/thread_httpd)).
:- use_module(library(http/websocket)).
:- use_module(library(lists), [member/2, memberchk/2, reverse/2]).
:- use_module('../../prolog/typhon/bridges/json',
              [json_dict/2, json_text/2]).

/** <module> A stand-in for rosbridge_server

Serves the protocol of rosbridge_suite's server, according to its sources and
document: topics among its clients, the services `/add_two_ints`,
`/rosapi/topics` and `/slow`, services that clients advertise, and the action
`/fibonacci`.  A frame with a field missing, or of another type than that
server checks for, is answered with a status. All frames are recorded.

*Threading*: a thread for each client; tables that all share.
*/

:- meta_predicate with_rosbridge(-, 0).

:- dynamic
    client/2,                   % Client, Socket
    frame/1,                    % Dict, as it came
    subscribed/3,               % Client, Topic, Type
    advertised/3,               % Client, Topic, Type
    served/3,                   % Client, Service, Type
    calling/3,                  % Id, Client, Id of the caller
    cancelled/1.                % Id of a goal

:- http_handler('/', http_upgrade_to_websocket(serve, [guarded(false)]),
                [spawn([]), id(rosbridge)]).

%!  with_rosbridge(-URL, :Goal) is semidet.

with_rosbridge(URL, Goal) :-
    setup_call_cleanup(
        rosbridge_begin(_, URL),
        once(Goal),
        rosbridge_end(URL)).

%!  rosbridge_begin(?Port, -URL) is det.
%!  rosbridge_end(+URL) is det.

rosbridge_begin(Port, URL) :-
    rosbridge_forget,
    http_server(http_dispatch, [port(localhost:Port), workers(1), silent(true)]),
    format(atom(URL), 'ws://localhost:~d/', [Port]).

rosbridge_end(URL) :-
    split_string(URL, ":/", "", Parts),
    member(Text, Parts),
    number_string(Port, Text),
    http_stop_server(Port, []),
    rosbridge_cut,
    rosbridge_forget.

rosbridge_forget :-
    retractall(frame(_)),
    retractall(cancelled(_)).

%!  rosbridge_frames(-Frames:list(dict)) is det.
%!  rosbridge_clients(-Count) is det.

rosbridge_frames(Frames) :-
    findall(Frame, frame(Frame), Frames).

rosbridge_clients(Count) :-
    aggregate_all(count, client(_, _), Count).

%!  rosbridge_send(+What) is det.
%!  rosbridge_cut is det.
%
%   Send a frame, or any text, to all clients; disconnect them all.

rosbridge_send(What) :-
    forall(client(Client, _), say(Client, What)).

rosbridge_cut :-
    forall(retract(client(_, Socket)), hang_up(Socket)).

hang_up(Socket) :-
    stream_pair(Socket, _, Out),
    catch(ws_send(Out, close(1001, "going")), error(_, _), true).

                /*******************************
                *            CLIENTS           *
                *******************************/

serve(Socket) :-
    flag(test_rosbridge_client, Client, Client+1),
    assertz(client(Client, Socket)),
    call_cleanup(listen(Client, Socket), gone(Client, Socket)).

gone(Client, Socket) :-
    retractall(client(Client, _)),
    retractall(subscribed(Client, _, _)),
    retractall(advertised(Client, _, _)),
    retractall(served(Client, _, _)),
    catch(close(Socket, [force(true)]), error(_, _), true).

listen(Client, Socket) :-
    catch(ws_receive(Socket, Message, []), error(_, _),
          Message = _{opcode:close}),
    (   Message.opcode == close
    ->  hang_up(Socket)
    ;   handle_text(Client, Message.data),
        listen(Client, Socket)
    ).

handle_text(Client, Text) :-
    catch(json_dict(Text, Frame), error(_, _), fail),
    is_dict(Frame),
    !,
    assertz(frame(Frame)),
    (   catch(frame(Client, Frame), error(Formal, _),
              complain(Client, Frame, Formal))
    ->  true
    ;   complain(Client, Frame, 'unknown operation')
    ).
handle_text(Client, Text) :-
    complain(Client, _{}, no_json(Text)).

complain(Client, Frame, Why) :-
    format(string(Text), '~p', [Why]),
    (   get_dict(id, Frame, Id)
    ->  More = _{id:Id}
    ;   More = _{}
    ),
    say(Client, More.put(_{op:status, level:error, msg:Text})).

say(Client, What) :-
    (   is_dict(What)
    ->  json_text(What, Text)
    ;   Text = What
    ),
    (   client(Client, Socket)
    ->  stream_pair(Socket, _, Out),
        catch(ws_send(Out, text(Text)), error(_, _), true)
    ;   true
    ).

                /*******************************
                *             FRAMES           *
                *******************************/

frame(Client, Frame) :-
    text(Frame, op, Op),
    operation(Op, Client, Frame).

operation("advertise", Client, Frame) :-
    text(Frame, topic, Topic),
    text(Frame, type, Type),
    known_type(Type),
    same_type(Topic, Type),
    retractall(advertised(Client, Topic, _)),
    assertz(advertised(Client, Topic, Type)).
operation("unadvertise", Client, Frame) :-
    text(Frame, topic, Topic),
    retractall(advertised(Client, Topic, _)).
operation("publish", Client, Frame) :-
    text(Frame, topic, Topic),
    object(Frame, msg, Message),
    (   advertised(Client, Topic, _)
    ->  true
    ;   throw(error(not_advertised(Topic), _))
    ),
    forall(subscribed(Other, Topic, _),
           say(Other, _{op:publish, topic:Topic, msg:Message})).
operation("subscribe", Client, Frame) :-
    text(Frame, topic, Topic),
    (   get_dict(type, Frame, _)
    ->  text(Frame, type, Type),
        known_type(Type),
        same_type(Topic, Type)
    ;   Type = none
    ),
    retractall(subscribed(Client, Topic, _)),
    assertz(subscribed(Client, Topic, Type)).
operation("unsubscribe", Client, Frame) :-
    text(Frame, topic, Topic),
    retractall(subscribed(Client, Topic, _)).
operation("call_service", Client, Frame) :-
    text(Frame, service, Service),
    id(Frame, Id),
    call_service(Service, Client, Id, Frame).
operation("advertise_service", Client, Frame) :-
    text(Frame, service, Service),
    text(Frame, type, Type),
    known_type(Type),
    retractall(served(_, Service, _)),
    assertz(served(Client, Service, Type)).
operation("unadvertise_service", _, Frame) :-
    text(Frame, service, Service),
    retractall(served(_, Service, _)).
operation("service_response", _, Frame) :-
    text(Frame, service, _),
    text(Frame, id, Id),
    object(Frame, values, Values),
    get_dict(result, Frame, Result),
    memberchk(Result, [true, false]),
    retract(calling(Id, Client, Caller)),
    text(Frame, service, Service),
    respond(Client, Service, Caller, Values, Result).
operation("send_action_goal", Client, Frame) :-
    text(Frame, action, Action),
    text(Frame, action_type, _),
    id(Frame, Id),
    object(Frame, args, Args),
    thread_create(goal(Action, Client, Id, Args, Frame), _, [detached(true)]).
operation("cancel_action_goal", _, Frame) :-
    text(Frame, action, _),
    text(Frame, id, Id),
    assertz(cancelled(Id)).

text(Frame, Key, Text) :-
    (   get_dict(Key, Frame, Text0),
        string(Text0)
    ->  Text = Text0
    ;   throw(error(field(Key, string), _))
    ).

object(Frame, Key, Dict) :-
    (   get_dict(Key, Frame, Dict0),
        is_dict(Dict0)
    ->  Dict = Dict0
    ;   throw(error(field(Key, object), _))
    ).

id(Frame, Id) :-
    ( get_dict(id, Frame, Id0) -> Id = Id0 ; Id = none ).

known_type(Type) :-
    split_string(Type, "/", "", [Package|_]),
    (   memberchk(Package, ["std_msgs", "std_srvs", "geometry_msgs",
                            "example_interfaces"])
    ->  true
    ;   throw(error(unknown_type(Type), _))
    ).

same_type(Topic, Type) :-
    (   advertised(_, Topic, Other),
        Other \== Type
    ->  throw(error(other_type(Topic, Other), _))
    ;   true
    ).

                /*******************************
                *      SERVICES AND ACTIONS    *
                *******************************/

respond(Client, Service, Id, Values, Result) :-
    say(Client, _{ op:service_response, id:Id, service:Service,
                   values:Values, result:Result }).

call_service("/add_two_ints", Client, Id, Frame) :-
    !,
    object(Frame, args, Args),
    (   _{a:A, b:B} :< Args,
        integer(A),
        integer(B)
    ->  Sum is A+B,
        respond(Client, "/add_two_ints", Id, _{sum:Sum}, true)
    ;   respond(Client, "/add_two_ints", Id,
                "Field a or b is not an integer", false)
    ).
call_service("/rosapi/topics", Client, Id, _) :-
    !,
    findall(Topic-Type,
            ( advertised(_, Topic, Type) ; subscribed(_, Topic, Type) ),
            Pairs0),
    sort(Pairs0, Pairs),
    findall(Topic, member(Topic-_, Pairs), Topics),
    findall(Type, member(_-Type, Pairs), Types),
    respond(Client, "/rosapi/topics", Id, _{topics:Topics, types:Types},
            true).
call_service("/slow", _, _, _) :-
    !.
call_service(Service, Client, Id, Frame) :-
    served(Server, Service, _),
    !,
    format(string(Call), 'service_request:~w:~w', [Service, Id]),
    assertz(calling(Call, Client, Id)),
    ( get_dict(args, Frame, Args) -> true ; Args = _{} ),
    say(Server, _{op:call_service, id:Call, service:Service, args:Args}).
call_service(Service, Client, Id, _) :-
    format(string(Text), 'Service ~w does not exist', [Service]),
    respond(Client, Service, Id, Text, false).

goal("/fibonacci", Client, Id, Args, Frame) :-
    !,
    fibonacci(2, Args.order, [1,0], Client, Id, Frame, Status, Sequence),
    say(Client, _{ op:action_result, id:Id, action:"/fibonacci",
                   values:_{sequence:Sequence}, status:Status,
                   result:true }).
goal(Action, Client, Id, _, _) :-
    say(Client, _{ op:action_result, id:Id, action:Action, status:0,
                   values:"No action server available", result:false }).

fibonacci(_, _, Reversed, Client, Id, _, 5, Sequence) :-
    ( cancelled(Id) ; \+ client(Client, _) ),
    !,
    reverse(Reversed, Sequence).
fibonacci(N, Order, Reversed, _, _, _, 4, Sequence) :-
    N > Order,
    !,
    reverse(Reversed, Sequence).
fibonacci(N, Order, [A,B|Rest], Client, Id, Frame, Status, Sequence) :-
    sleep(0.01),
    C is A+B,
    reverse([C,A,B|Rest], Partial),
    (   get_dict(feedback, Frame, true)
    ->  say(Client, _{ op:action_feedback, id:Id, action:"/fibonacci",
                       values:_{sequence:Partial} })
    ;   true
    ),
    N1 is N+1,
    fibonacci(N1, Order, [C,A,B|Rest], Client, Id, Frame, Status, Sequence).
