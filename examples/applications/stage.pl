:- module(applications_stage,
          [ stage/3,                    % +Argv, +Scene, :Play
            stage_story/3               % +Network, +Seconds, :Say
          ]).
:- use_module('../../prolog/typhon',
              [ network_advance/2, network_start/3, network_stop/1 ]).
:- use_module('../../prolog/typhon/tools/page', [page_serve/2, page_stop/0]).
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [argv_options/3]).
:- use_module(library(option), [option/3]).

/** <module> What the applications have in common: a network, a page, an end

    swipl examples/applications/NAME.pl [--speed=5] [--port=8080] [--seed=1]

starts the network of an application, serves its page, and runs until Ctrl-C.  At
speed 0 time is virtual: there is no page, and the program ends with its story.

*Threading*: a story runs in a thread of its own: while the main thread creates
threads, signals reach one of those, and are lost.
*/

:- meta_predicate
    stage(+, +, 2),
    stage_story(+, +, 2).

%!  stage(+Argv, +Scene, :Play) is det.
%
%   Calls call(Play, Network, Options), Options being what Argv says.  Scene is a
%   module with scene_network(+Options, -Topology, -NetworkOptions);
%   scene_step(-Seconds), of the world, of which as many pass in a second as the
%   speed is; scene_picture(-Svg) for the page; and scene_stop, called before the
%   network ends.  Ends the process, with status 1 if Play raises an error.

stage(Argv, Scene, Play) :-
    argv_options(Argv, _, Options),
    forall(member(Signal, [int, term]),
           on_signal(Signal, _, applications_stage:stop)),
    thread_create(acted(Scene, Play, Options), Thread),
    thread_get_message(stop),
    catch(thread_send_message(Thread, stop), error(_, _), true),
    thread_join(Thread, Status),
    (   Status == true
    ->  halt(0)
    ;   print_message(error, format('The application ended: ~p', [Status])),
        halt(1)
    ).

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
play(_, Network, Scene, Play, Options) :-
    option(port(Port), Options, 8080),
    page_serve([port(Port), world(Scene:scene_picture)], Link),
    format('Open ~w in a browser. Ctrl-C ends the program.~n', [Link]),
    flush_output,
    (   call(Play, Network, Options)
    ->  thread_get_message(stop)
    ;   thread_peek_message(stop)
    ).

%!  stage_story(+Network, +Seconds, :Say) is semidet.
%
%   Each time when so many host seconds have passed, call(Say, Time, Ends) says how
%   things are, until Ends is `true`.  Fails when the program is to end before.

stage_story(Network, Seconds, Say) :-
    story(Network, Seconds, 0, Say).

story(Network, Seconds, Time0, Say) :-
    network_advance(Network, Seconds),
    \+ thread_peek_message(stop),
    Time is Time0+Seconds,
    call(Say, Time, Ends),
    flush_output,
    ( Ends == true -> true ; story(Network, Seconds, Time, Say) ).
