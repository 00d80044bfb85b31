:- module(applications_stage,
          [ stage/3,                    % :Argv, +Scene, :Play
            stage_option/3,             % ?Name, -Type, -Help
            stage_story/3               % +Network, +Seconds, :Say
          ]).
:- use_module('../../app/typhon/arguments', [arguments/3]).
:- use_module('../../prolog/typhon',
              [ network_advance/2, network_start/3, network_stop/1 ]).
:- use_module('../../prolog/typhon/tools/page', [page_serve/2, page_stop/0]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).

/** <module> Common part of the applications: network, page, and end

    swipl examples/applications/NAME.pl [--speed=5] [--port=8080] [--seed=1]

starts the network of an application, serves its page, and runs until Ctrl-C.
At speed 0 time is virtual: there is no page, and the program ends with its
story.

*Threading*: a story runs in a thread of its own: while the main thread creates
threads, a signal may reach a new thread, and would be lost.
*/

:- meta_predicate
    stage(:, +, 2),
    stage_story(+, +, 2).

:- dynamic pace/1.              % host seconds per second; none: virtual time

%!  stage(:Argv, +Scene, :Play) is det.
%
%   Calls call(Play, Network, Options); Options are the parsed Argv, as defined
%   by opt_type/3 and opt_help/2 of its module, see arguments/3.  Scene is a
%   module with scene_network(+Options, -Topology, -NetworkOptions);
%   scene_step(-Seconds), of the world; the speed is in steps per second;
%   scene_picture(-Svg) for the page; and scene_stop, called before the network
%   ends.  Ends the process, with status 1 if Play raises an error.

stage(Argv, Scene, Play) :-
    arguments(Argv, [], Options),
    forall(member(Signal, [int, term]),
           on_signal(Signal, _, applications_stage:stop)),
    thread_create(acted(Scene, Play, Options), Thread),
    thread_get_message(stop),
    catch(thread_send_message(Thread, stop), error(_, _), true),
    thread_join(Thread, Status),
    (   Status == true
    ->  halt(0)
    ;   report(Status),
        halt(1)
    ).

report(exception(error(socket_error(eaddrinuse, _), _))) :-
    !,
    print_message(error, format('the port is in use; --port=0 takes a free one',
                                [])).
report(exception(Ball)) :-
    !,
    print_message(error, Ball).
report(Status) :-
    print_message(error, format('the application ended: ~p', [Status])).

%!  stage_option(?Name, -Type, -Help) is nondet.
%
%   Options of all applications.

stage_option(speed, number,
             "Steps of the world per second; 0: virtual time [5]").
stage_option(port, between(0, 65535), "Port of the page; 0: a free one [8080]").
stage_option(seed, integer, "Seed of all random choices [1]").

:- public stop/1.               % called by on_signal/3

stop(_) :-
    thread_send_message(main, stop).

acted(Scene, Play, Options) :-
    call_cleanup(act(Scene, Play, Options),
                 thread_send_message(main, stop)).

act(Scene, Play, Options) :-
    option(speed(Speed), Options, 5),
    option(seed(Seed), Options, 1),
    Scene:scene_step(Step),
    ( Speed =:= 0 -> Clock = virtual ; Clock is Speed*Step ),
    Scene:scene_network(Options, Topology, More),
    network_start(Topology, Network,
                  [clock(Clock), seed(Seed), log('/dev/null')|More]),
    catch(play(Clock, Network, Scene, Play, Options), Ball, true),
    page_stop,
    Scene:scene_stop,
    network_stop(Network),
    ( var(Ball) -> true ; throw(Ball) ).

play(virtual, Network, _, Play, Options) :-
    !,
    call(Play, Network, Options).
play(Clock, Network, Scene, Play, Options) :-
    option(port(Port), Options, 8080),
    page_serve([port(Port), world(Scene:scene_picture)], Link),
    assertz(pace(Clock)),
    format('Open ~w in a browser. Ctrl-C ends the program.~n', [Link]),
    flush_output,
    (   call(Play, Network, Options)
    ->  thread_get_message(stop)
    ;   thread_peek_message(stop)
    ).

%!  stage_story(+Network, +Seconds, :Say) is semidet.
%
%   Calls call(Say, Time, Ends) every Seconds of host time, until Ends is
%   `true`; Say reports the state.  Fails if the program is to end before.

stage_story(Network, Seconds, Say) :-
    story(Network, Seconds, 0, Say).

story(Network, Seconds, Time0, Say) :-
    advance(Network, Seconds),
    Time is Time0+Seconds,
    call(Say, Time, Ends),
    flush_output,
    ( Ends == true -> true ; story(Network, Seconds, Time, Say) ).

%   In pieces of half a second, because the user may end the program.

advance(Network, Seconds) :-
    pace(Rate),
    !,
    Piece is min(Seconds, Rate/2),
    network_advance(Network, Piece),
    \+ thread_peek_message(stop),
    Left is Seconds-Piece,
    ( Left > 0 -> advance(Network, Left) ; true ).
advance(Network, Seconds) :-
    network_advance(Network, Seconds).
