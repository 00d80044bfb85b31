:- module(typhon_ros_connection,
          [ way_open/3,                 % +Host, +Where, +Options
            way_close/1,                % +Host
            way_option/3,               % +Host, ?Option, +Default
            way_state/3,                % ?Host, -Where, -Connected
            way_say/2,                  % +Host, +Op
            way_note/2,                 % +Host, +Op
            way_await/5,                % +Host, +Id, +Op, +Seconds, -Answer
            answer_come/2,              % +Id, +Answer
            answers_fail/2              % +Host, +Why
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(frames, [op_frame/2]).
:- use_module(node,
              [node_close/1, node_note/2, node_open/2, node_say/3, node_up/1]).
:- use_module(rosbridge,
              [ rosbridge_close/1, rosbridge_open/4, rosbridge_send/3,
                rosbridge_up/1 ]).

/** <module> The connection of a host to ROS

A node of our own, or a rosbridge server: both take the same frames.

*Threading*: any thread.  A caller that waits for an answer has a queue of its
own, so what comes too late is dropped.
*/

:- dynamic
    way/4.                      % Host, node or server, Where, Options

%!  way_open(+Host, +Where, +Options) is det.
%
%   Where is `ros2` or a URL.
%
%   @error those of node_open/2 and rosbridge_open/4

way_open(Host, Where, Options) :-
    kind(Where, Kind),
    assertz(way(Host, Kind, Where, Options)),
    open_way(Kind, Host, Where, Options).

kind(ros2, node) :-
    !.
kind(_, server).

open_way(node, Host, _, Options) :-
    node_open(Host, Options).
open_way(server, Host, URL, Options) :-
    option(connect_deadline(Seconds), Options, 5),
    option(silence(Silence), Options, 30),
    rosbridge_open(Host, URL, Seconds, Silence).

%!  way_close(+Host) is det.

way_close(Host) :-
    (   way(Host, Kind, _, _)
    ->  close_way(Kind, Host),
        retractall(way(Host, _, _, _))
    ;   true
    ).

close_way(node, Host) :-
    node_close(Host).
close_way(server, Host) :-
    rosbridge_close(Host).

%!  way_option(+Host, ?Option, +Default) is det.

way_option(Host, Option, Default) :-
    the_way(Host, _, Options),
    option(Option, Options, Default).

the_way(Host, Kind, Options) :-
    (   way(Host, Kind0, _, Options0)
    ->  Kind = Kind0,
        Options = Options0
    ;   existence_error(ros, Host)
    ).

%!  way_state(?Host, -Where, -Connected:boolean) is nondet.

way_state(Host, Where, Connected) :-
    way(Host, Kind, Where, _),
    (   connected(Kind, Host)
    ->  Connected = true
    ;   Connected = false
    ).

connected(node, Host) :-
    node_up(Host).
connected(server, Host) :-
    rosbridge_up(Host).

%!  way_say(+Host, +Op) is det.
%
%   Say Op; our own node says what is wrong with it.
%
%   @error existence_error(ros, Host), those of node_say/3 and
%          rosbridge_send/3

way_say(Host, Op) :-
    the_way(Host, Kind, Options),
    option(deadline(Seconds), Options, 5),
    op_frame(Op, Frame),
    debug(typhon(ros), '~w says ~p', [Host, Op]),
    say(Kind, Host, Frame, Seconds).

say(node, Host, Frame, Seconds) :-
    node_say(Host, Frame, Seconds).
say(server, Host, Frame, Seconds) :-
    rosbridge_send(Host, Frame, Seconds).

%!  way_note(+Host, +Op) is det.
%
%   Say Op if that needs no waiting.  What is not said then, because nothing
%   is there or too much waits, need not be.

way_note(Host, Op) :-
    op_frame(Op, Frame),
    debug(typhon(ros), '~w notes ~p', [Host, Op]),
    catch(note(Host, Frame), error(Formal, _),
          debug(typhon(ros), '~w has not said ~p: ~p', [Host, Op, Formal])).

note(Host, Frame) :-
    the_way(Host, Kind, _),
    note(Kind, Host, Frame).

note(node, Host, Frame) :-
    node_note(Host, Frame).
note(server, Host, Frame) :-
    rosbridge_send(Host, Frame, 0).

%!  way_await(+Host, +Id, +Op, +Seconds, -Answer) is det.
%
%   Say Op, and wait for what comes for Id, see answer_await/5.

way_await(Host, Id, Op, Seconds, Answer) :-
    answer_await(Host, Id, way_say(Host, Op), Seconds, Answer).

                /*******************************
                *           ANSWERS            *
                *******************************/

:- meta_predicate answer_await(+, +, 0, +, -).

:- dynamic
    awaited/3.                  % Id, Host, Queue

%   answer_await(+Host, +Id, :Ask, +Seconds, -Answer) is det.
%
%   Run Ask once, and wait for what another thread gives to answer_come/2.
%   Answer is that, lost(Why), or `timeout`.

answer_await(Host, Id, Ask, Seconds, Answer) :-
    setup_call_cleanup(
        ( message_queue_create(Queue),
          assertz(awaited(Id, Host, Queue)) ),
        ( once(Ask),
          wait(Queue, Seconds, Answer) ),
        ( retractall(awaited(Id, _, _)),
          message_queue_destroy(Queue) )).

wait(Queue, Seconds, Answer) :-
    (   thread_get_message(Queue, answer(Answer0), [timeout(Seconds)])
    ->  Answer = Answer0
    ;   Answer = timeout
    ).

%!  answer_come(+Id, +Answer) is semidet.
%
%   Fails if no caller waits for it any more.

answer_come(Id, Answer) :-
    retract(awaited(Id, _, Queue)),
    !,
    catch(thread_send_message(Queue, answer(Answer)),
          error(existence_error(_, _), _),
          fail).

%!  answers_fail(+Host, +Why) is det.
%
%   Callers on Host that wait for an answer get lost(Why).

answers_fail(Host, Why) :-
    findall(Id, awaited(Id, Host, _), Ids),
    answers_lost(Ids, Why).

answers_lost([], _).
answers_lost([Id|Ids], Why) :-
    ignore(answer_come(Id, lost(Why))),
    answers_lost(Ids, Why).
