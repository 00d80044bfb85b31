:- module(typhon_ros_messages,
          [ value_json/2,               % +Message, -JSON
            json_value/3,               % +Form, +JSON, -Message
            ros_name/3,                 % +Kind, +Name, -Atom
            ros_word/2,                 % +Kind, +Name
            ros_type/3,                 % +Kind, +Type, -Atom
            ros_id/1,                   % -Id
            op_frame/2,                 % +Op, -Frame
            frame_event/2               % +Frame, -Event
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error),
              [ domain_error/2, instantiation_error/1, must_be/2,
                type_error/2 ]).
:- use_module(library(uuid), [uuid/1]).

/** <module> Messages of ROS as terms, names, and frames

A message is a dict, or a list of its fields, Name=Value, Name-Value or
Name(Value); values are numbers, `true` and `false`, text, lists of values, and
messages.  A message from ROS is a dict with text as strings or, if requested, a
list of Name=Value in the order of the names.

Names are checked before they are sent, since a server may not report errors in
them.

Frames to and from ROS are terms, op_frame/2 and frame_event/2, and the dicts
of rosbridge 2.0 with the actions of ROS 2.  A server behind a WebSocket and the
helper with rclpy use the same dicts.

*Threading*: any thread; no state.
*/

%!  value_json(+Message, -JSON) is det.
%
%   JSON is Message as a term for json_write_dict/3.
%
%   @error type_error(ros_message, Message), type_error(ros_value, Value)
%   @error duplicate_key(Field)

value_json(Message, JSON) :-
    must_be(nonvar, Message),
    (   message(Message, JSON0)
    ->  JSON = JSON0
    ;   type_error(ros_message, Message)
    ).

message(Dict, JSON) :-
    is_dict(Dict),
    !,
    dict_pairs(Dict, _, Pairs0),
    maplist(field, Pairs0, Pairs),
    dict_pairs(JSON, _, Pairs).
message(json(Fields), JSON) :-
    !,
    message(Fields, JSON).
message(Fields, JSON) :-
    is_list(Fields),
    maplist(field, Fields, Pairs),
    dict_pairs(JSON, _, Pairs).

field(Field, Name-Value) :-
    must_be(nonvar, Field),
    name_value(Field, Name, Value0),
    atom(Name),
    value(Value0, Value).

name_value(Name=Value, Name, Value) :- !.
name_value(Name-Value, Name, Value) :- !.
name_value(Field, Name, Value) :-
    compound(Field),
    compound_name_arguments(Field, Name, [Value]).

value(Value, _) :-
    var(Value),
    !,
    instantiation_error(Value).
value(Number, Number) :-
    integer(Number),
    !.
value(Number, Number) :-
    float(Number),
    !,
    finite(Number).
value(Text, Text) :-
    ( string(Text) ; Text == true ; Text == false ),
    !.
value([], []) :-
    !.
value(Atom, String) :-
    atom(Atom),
    !,
    atom_string(Atom, String).
value(Message, JSON) :-
    message(Message, JSON),
    !.
value(List, Values) :-
    is_list(List),
    !,
    maplist(value, List, Values).
value(Value, _) :-
    type_error(ros_value, Value).

%   JSON has no infinite numbers and no NaN.

finite(Number) :-
    (   float_class(Number, Class),
        memberchk(Class, [infinite, nan])
    ->  type_error(ros_value, Number)
    ;   true
    ).

%!  json_value(+Form, +JSON, -Message) is det.
%
%   Message is JSON, a term of json_dict/2, in the Form `dict` or `terms`.

json_value(dict, JSON, JSON).
json_value(terms, JSON, Message) :-
    terms(JSON, Message).

terms(Dict, Fields) :-
    is_dict(Dict),
    !,
    dict_pairs(Dict, _, Pairs),         % sorted by name
    maplist(term_field, Pairs, Fields).
terms(List, Terms) :-
    is_list(List),
    !,
    maplist(terms, List, Terms).
terms(Value, Value).

term_field(Name-JSON, Name=Value) :-
    terms(JSON, Value).

                /*******************************
                *            NAMES             *
                *******************************/

%!  ros_name(+Kind, +Name, -Atom) is det.
%
%   Atom is Name as an atom.  Name is text such as `/robot/cmd_vel`, `cmd_vel`
%   or `~/cmd_vel`: words of letters, digits and `_` that do not begin with a
%   digit.
%
%   @error domain_error(ros_name(Kind), Name), where Kind is topic, service,
%          action or node

ros_name(Kind, Name, Atom) :-
    text(Name, Atom),
    atom_codes(Atom, Codes),
    length(Codes, Length),
    (   Length =< 255,
        phrase(name, Codes)
    ->  true
    ;   domain_error(ros_name(Kind), Name)
    ).

%!  ros_word(+Kind, +Name:atom) is det.
%
%   Name is one word of such a name.
%
%   @error domain_error(ros_name(Kind), Name)

ros_word(Kind, Name) :-
    (   word(Name)
    ->  true
    ;   domain_error(ros_name(Kind), Name)
    ).

name --> "~/", !, words.
name --> "/", !, words.
name --> words.

words --> word, more.

more --> "/", !, words.
more --> [].

word --> [C], { code_type(C, csymf), C < 128 }, rest.

rest --> [C], { code_type(C, csym), C < 128 }, !, rest.
rest --> [].

%!  ros_type(+Kind, +Type, -Atom) is det.
%
%   Atom is Type as an atom.  Type is text such as `std_msgs/msg/String`, or in
%   the form of ROS 1, `std_msgs/String`; Kind is msg, srv or action.
%
%   @error domain_error(ros_type(Kind), Type)

ros_type(Kind, Type, Atom) :-
    text(Type, Atom),
    atomic_list_concat(Parts, /, Atom),
    (   ( Parts = [Package,Name] ; Parts = [Package,Kind,Name] ),
        word(Package),
        word(Name)
    ->  true
    ;   domain_error(ros_type(Kind), Type)
    ).

word(Atom) :-
    atom_codes(Atom, Codes),
    phrase(word, Codes).

text(Text, Atom) :-
    must_be(nonvar, Text),
    (   ( atom(Text) ; string(Text) )
    ->  atom_string(Atom, Text)
    ;   must_be(atom, Text)
    ).

%!  ros_id(-Id:atom) is det.
%
%   Id is new and unique among all clients of a server: some servers keep the
%   ids of all clients in one table.

ros_id(Id) :-
    uuid(Uuid),
    atom_concat('typhon:', Uuid, Id).

                /*******************************
                *            FRAMES            *
                *******************************/

%!  op_frame(+Op, -Frame:dict) is det.
%
%   Frame is the frame of rosbridge for the operation Op.

op_frame(advertise(Topic, Type),
         _{op:advertise, id:Id, topic:Topic, type:Type}) :-
    atom_concat('advertise:', Topic, Id).
op_frame(publish(Id, Topic, Message),
         _{op:publish, id:Id, topic:Topic, msg:Message}).
op_frame(subscribe(Topic, Type),
         _{op:subscribe, id:Id, topic:Topic, type:Type}) :-
    atom_concat('subscribe:', Topic, Id).
op_frame(unsubscribe(Topic),
         _{op:unsubscribe, id:Id, topic:Topic}) :-
    atom_concat('subscribe:', Topic, Id).
op_frame(call(Id, Service, Type, Args, Seconds),
         _{ op:call_service, id:Id, service:Service, type:Type, args:Args,
            timeout:Seconds }).
op_frame(offer(Service, Type),
         _{op:advertise_service, service:Service, type:Type}).
op_frame(withdraw(Service),
         _{op:unadvertise_service, service:Service}).
op_frame(respond(Id, Service, Values, Result),
         _{ op:service_response, id:Id, service:Service, values:Values,
            result:Result }).
op_frame(goal(Id, Action, Type, Goal),
         _{ op:send_action_goal, id:Id, action:Action, action_type:Type,
            args:Goal, feedback:true }).
op_frame(cancel(Id, Action),
         _{op:cancel_action_goal, id:Id, action:Action}).

%!  frame_event(+Frame:dict, -Event) is det.
%
%   Event is one of
%
%     - message(Topic, JSON)
%     - answer(Id, Answer): to a call; Answer is ok(JSON) or failed(Text)
%     - request(Id, Service, JSON): a call of a service that the host offers
%     - feedback(Id, JSON), result(Id, Status, JSON): of a goal; Status is
%       `succeeded`, `canceled`, `aborted` or `failed`; if it is `failed`, JSON
%       is text
%     - dropped(Topic, Count): the node has dropped Count messages that arrived
%       too fast
%     - status(Level, Id, Text): a complaint; Id may be `none`
%     - unknown(What): the frame is invalid, or not for a client

frame_event(Frame, Event) :-
    get_dict(op, Frame, Op),
    string(Op),
    event(Op, Frame, Event0),
    !,
    Event = Event0.
frame_event(Frame, unknown(Op)) :-
    get_dict(op, Frame, Op),
    !.
frame_event(_, unknown(no_op)).

event("publish", Frame, message(Topic, Message)) :-
    name(topic, Frame, Topic),
    object(msg, Frame, Message).
event("service_response", Frame, answer(Id, Answer)) :-
    name(id, Frame, Id),
    outcome(Frame, Answer).
event("call_service", Frame, request(Id, Service, Args)) :-
    name(id, Frame, Id),
    name(service, Frame, Service),
    optional(args, Frame, Args).
event("action_feedback", Frame, feedback(Id, Values)) :-
    name(id, Frame, Id),
    object(values, Frame, Values).
event("action_result", Frame, result(Id, Status, Values)) :-
    name(id, Frame, Id),
    outcome(Frame, Outcome),
    goal_outcome(Outcome, Frame, Status, Values).
event("dropped", Frame, dropped(Topic, Count)) :-
    name(topic, Frame, Topic),
    get_dict(count, Frame, Count),
    integer(Count).
event("status", Frame, status(Level, Id, Text)) :-
    name(level, Frame, Level),
    text(msg, Frame, Text),
    (   name(id, Frame, Id0)
    ->  Id = Id0
    ;   Id = none
    ).

%   For a message without fields servers send an empty list, or nothing.

optional(Key, Frame, Dict) :-
    (   get_dict(Key, Frame, Value),
        Value \== []
    ->  is_dict(Value),
        Dict = Value
    ;   Dict = _{}
    ).

object(Key, Frame, Dict) :-
    get_dict(Key, Frame, Dict),
    is_dict(Dict).

outcome(Frame, ok(Values)) :-
    get_dict(result, Frame, true),
    !,
    optional(values, Frame, Values).
outcome(Frame, failed(Text)) :-
    text(values, Frame, Text).

%   The numbers are those of action_msgs/msg/GoalStatus.

goal_outcome(failed(Text), _, failed, Text).
goal_outcome(ok(Values), Frame, Status, Values) :-
    (   get_dict(status, Frame, Number),
        goal_status(Number, Status0)
    ->  Status = Status0
    ;   Status = succeeded
    ).

goal_status(5, canceled).
goal_status(6, aborted).

%   An id may be a number, and stays a number.

name(Key, Frame, Name) :-
    get_dict(Key, Frame, Value),
    (   string(Value)
    ->  atom_string(Name, Value)
    ;   integer(Value),
        Name = Value
    ).

text(Key, Frame, Text) :-
    (   get_dict(Key, Frame, Value)
    ->  ( string(Value) -> Text = Value ; format(string(Text), '~p', [Value]) )
    ;   Text = ""
    ).
