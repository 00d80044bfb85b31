:- module(typhon_ros_events,
          [ ros_ignored/2               % +Host, -Count
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module('../../kernel/agent',
              [agent/5, agent_mail/2, mail_count/2, with_agent/2]).
:- use_module('../json', [json_dict/2]).
:- use_module('../common',
              [ service/2, subscribers_notify/5, subscription/3,
                unsubscribe/4 ]).
:- use_module(connection,
              [answer_come/2, answers_fail/2, way_note/2, way_option/3]).
:- use_module(requests, [goal_end/4, request_begin/3, request_end/3]).
:- use_module(advertisements,
              [registration/3, registration_end/3, registration_renew/3]).
:- use_module(messages, [frame_event/2, json_value/3, op_frame/2]).

/** <module> Events from ROS, and their recipients

Agents get messages

  | topic(Topic, Message)         | of topics to which they have subscribed |
  | request(Id, Service, Request) | for a service that they offer          |
  | feedback(Id, Feedback)        | on their goal Id                       |
  | result(Id, Status, Result)    | on their goal Id: the last message     |
  | error(Text)                   | an error in a message that they sent   |

from `ros`, and dropped(Key, Count), see typhon_inbox.

*Threading*: the thread that reads from the server or the node.
*/

:- multifile
    typhon_helper_owner:handle_message/2,
    typhon_helper_owner:again/2,
    typhon_inbox:dropped/3,
    typhon_ros_rosbridge:handle_message/2,
    typhon_ros_rosbridge:up/2,
    typhon_ros_rosbridge:down/2,
    typhon_starting:ends/2,
    typhon_subscribers:wanted/4.

:- dynamic
    ignored/2,                  % Host, Count
    away/1.                     % Host: has lost the connection to ROS

most_complaints(1000).          % complaints that may wait for an agent

                /*******************************
                *            SOURCES           *
                *******************************/

typhon_ros_rosbridge:handle_message(Host, Read) :-
    (   Read = text(Text),
        catch(json_dict(Text, Frame), error(_, _), fail),
        is_dict(Frame)
    ->  frame_event(Frame, Event)
    ;   functor(Read, What, _),
        Event = unknown(What)
    ),
    handle_event(Event, Host).

typhon_helper_owner:handle_message(ros(Host), Dict) :-
    get_dict(frame, Dict, Frame),
    frame_event(Frame, Event),
    handle_event(Event, Host).

handle_event(Event, Host) :-
    service(ros, Host),
    debug(typhon(ros), '~w receives ~p', [Host, Event]),
    deliver(Event, Host),
    !.
handle_event(_, _).

%   A server that was down, or a restarted node, has no record of the host: it
%   gets all operations in force again.

typhon_ros_rosbridge:up(Host, _) :-
    retract(away(Host)),
    print_message(informational, typhon(ros_found(Host))),
    fail.
typhon_ros_rosbridge:up(Host, Frame) :-
    registration(Host, _, Op),
    op_frame(Op, Frame).

typhon_ros_rosbridge:down(Host, Why) :-
    (   Why \== stopped,
        service(ros, Host)
    ->  assertz(away(Host)),
        print_message(warning, typhon(ros_lost(Host, Why)))
    ;   true
    ),
    connection_lost(Host, Why).

typhon_helper_owner:again(ros(Host), _) :-
    connection_lost(Host, node_ended),
    fail.
typhon_helper_owner:again(ros(Host), _{do:frame, frame:Frame}) :-
    registration(Host, _, Op),
    op_frame(Op, Frame).

connection_lost(Host, Why) :-
    answers_fail(Host, Why),
    forget_requests(Host),
    lose_goals(Host, Why).

forget_requests(Host) :-
    (   request_end(Host, _, _)
    ->  forget_requests(Host)
    ;   true
    ).

lose_goals(Host, Why) :-
    (   goal_end(Host, Id, Agent, _)
    ->  format(string(Text), 'lost: ~p', [Why]),
        report_goal_end(Host, Id, Agent, failed, Text),
        lose_goals(Host, Why)
    ;   true
    ).

                /*******************************
                *          RECIPIENTS          *
                *******************************/

deliver(message(Topic, JSON), Host) :-
    (   subscription(ros, Host, Topic)
    ->  message(Host, JSON, Message),
        subscribers_notify(ros, Host, Topic, topic(Topic, Message),
                           topic(Topic, _))
    ;   way_note(Host, unsubscribe(Topic))
    ).
deliver(answer(Id, Answer), _) :-
    ignore(answer_come(Id, Answer)).
deliver(request(Id, Service, JSON), Host) :-
    (   subscription(ros, Host, service(Service)),
        request_begin(Host, Id, Service)
    ->  message(Host, JSON, Request),
        subscribers_notify(ros, Host, service(Service),
                           request(Id, Service, Request), request(Id, _, _))
    ;   way_note(Host, respond(Id, Service, _{}, false))
    ).
deliver(feedback(Id, JSON), Host) :-
    message(Host, JSON, Feedback),
    subscribers_notify(ros, Host, goal(Id), feedback(Id, Feedback),
                       feedback(Id, _)).
deliver(result(Id, Status, JSON), Host) :-
    goal_end(Host, Id, Agent, _),
    message(Host, JSON, Result),
    report_goal_end(Host, Id, Agent, Status, Result).
deliver(dropped(Topic, Count), Host) :-
    subscribers_notify(ros, Host, Topic, dropped(Topic, Count),
                       dropped(Topic, _)).
deliver(status(Level, Id, Text), Host) :-
    complaint(Level, Id, Text, Host).
deliver(unknown(What), Host) :-
    retract(ignored(Host, Count0)),
    !,
    Count is Count0+1,
    assertz(ignored(Host, Count)),
    debug(typhon(ros), '~w ignores ~p', [Host, What]).
deliver(unknown(What), Host) :-
    assertz(ignored(Host, 1)),
    print_message(warning, typhon(ros_ignored(Host, What))).

%   A request that does not fit in the queue of the agent fails at once: its
%   caller need not wait, and it takes no place from other requests.

typhon_inbox:dropped(ros, Host, request(Id, Service, _)) :-
    request_end(Host, Id, Service),
    way_note(Host, respond(Id, Service, _{}, false)).

message(Host, JSON, Message) :-
    way_option(Host, messages(Form), dict),
    json_value(Form, JSON, Message).

report_goal_end(Host, Id, Agent, Status, Result) :-
    subscribers_notify(ros, Host, goal(Id), result(Id, Status, Result),
                       result(Id, _, _)),
    ignore(unsubscribe(ros, Host, goal(Id), Agent)).

%   The id of a complaint identifies the operation about which ROS complains.

complaint(Level, _, Text, Host) :-
    \+ memberchk(Level, [error, warning]),
    !,
    debug(typhon(ros), '~w: ROS reports ~w', [Host, Text]).
complaint(error, Id, Text, _) :-
    answer_come(Id, failed(Text)),
    !.
complaint(_, Id, Text, Host) :-
    atom_concat('publish:', Agent, Id),
    complain(Agent, Host, Text),
    !.
complaint(_, Id, Text, Host) :-
    atom_concat('subscribe:', Topic, Id),
    subscription(ros, Host, Topic),
    !,
    subscribers_notify(ros, Host, Topic, error(Text), error(_)).
complaint(_, _, Text, Host) :-
    print_message(warning, typhon(ros_complaint(Host, Text))).

complain(Agent, Host, Text) :-
    with_agent(Agent, ( agent(Agent, Host, _, _, _),
                        mail_count(Agent, Count),
                        most_complaints(Most),
                        ( Count < Most
                        -> agent_mail(Agent, [ros-error(Text)])
                        ;  true
                        ) )).

%!  ros_ignored(+Host, -Count) is det.
%
%   Host has received Count frames that are not valid for a client.

ros_ignored(Host, Count) :-
    (   ignored(Host, Count0)
    ->  Count = Count0
    ;   Count = 0
    ).

typhon_starting:ends(ros, Host) :-
    retractall(ignored(Host, _)),
    retractall(away(Host)).

                /*******************************
                *         SUBSCRIBERS          *
                *******************************/

typhon_subscribers:wanted(ros, Host, Key, Wanted) :-
    wanted(Wanted, Key, Host).

wanted(false, service(Service), Host) =>
    ignore(registration_end(Host, service(Service), _)),
    refuse_all(Host, Service),
    way_note(Host, withdraw(Service)).
wanted(false, goal(Id), Host) =>
    (   goal_end(Host, Id, _, Action)
    ->  way_note(Host, cancel(Id, Action))
    ;   true
    ).
wanted(false, Topic, Host) =>
    ignore(registration_end(Host, topic(Topic), _)),
    way_note(Host, unsubscribe(Topic)).
wanted(true, goal(Id), Host) =>         % the goal has been cancelled
    subscribers_notify(ros, Host, goal(Id),
                       result(Id, failed, "cancelled: the agent had set out"),
                       result(Id, _, _)).
wanted(true, service(Service), Host) =>
    repeat_operation(Host, service(Service)).
wanted(true, Topic, Host) =>
    repeat_operation(Host, topic(Topic)).

repeat_operation(Host, Key) :-
    (   registration_renew(Host, Key, Op)
    ->  way_note(Host, Op)
    ;   true
    ).

refuse_all(Host, Service) :-
    (   request_end(Host, Id, Service)
    ->  way_note(Host, respond(Id, Service, _{}, false)),
        refuse_all(Host, Service)
    ;   true
    ).
