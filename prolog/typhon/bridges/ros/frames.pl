:- module(typhon_ros_frames,
          [ op_frame/2,                 % +Op, -Frame
            frame_event/2               % +Frame, -Event
          ]).

/** <module> The rosbridge protocol

What is said to ROS, and heard of it, as terms, and the dicts that stand
for them: those of rosbridge 2.0 with the actions of ROS 2.  A server behind
a WebSocket and our own helper with rclpy take and give the same ones.
Messages in them are as value_json/2 makes them.

*Threading*: any thread; no state.
*/

%!  op_frame(+Op, -Frame:dict) is det.

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
%     - request(Id, Service, JSON): a call of what we offer
%     - feedback(Id, JSON), result(Id, Status, JSON): of a goal; Status is
%       `succeeded`, `canceled`, `aborted` or `failed`, then JSON is text
%     - dropped(Topic, Count): messages that came too fast for our own node
%     - status(Level, Id, Text): a complaint; Id may be `none`
%     - unknown(What): not for us, or not as it should be

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

%   Servers leave out what has no fields, or send an empty list for it.

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

%   As action_msgs/msg/GoalStatus counts.

goal_outcome(failed(Text), _, failed, Text).
goal_outcome(ok(Values), Frame, Status, Values) :-
    (   get_dict(status, Frame, Number),
        goal_status(Number, Status0)
    ->  Status = Status0
    ;   Status = succeeded
    ).

goal_status(5, canceled).
goal_status(6, aborted).

%   An id may be a number; it is given back as it came.

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
