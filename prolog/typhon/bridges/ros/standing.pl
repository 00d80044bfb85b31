:- module(typhon_ros_standing,
          [ standing/3,                 % ?Host, ?Key, ?Op
            standing_begin/3,           % +Host, +Key, +Op
            standing_end/3,             % +Host, +Key, -Op
            standing_again/3,           % +Host, +Key, -Op
            standing_forget/1           % +Host
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(error), [resource_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> What has been said to ROS and holds until it is taken back

A host has told ROS that it publishes on a topic, Key advertise(Topic), that
it wants to hear one, topic(Topic), or that it has a service,
service(Service).  It says so again to a server that comes back.

*Threading*: any thread.
*/

:- setting(most, positive_integer, 1000,
           "Topics and services that a host may use, each in its way").

:- dynamic
    standing/3,                 % Host, Key, Op
    ended/3.                    % Host, Key, Op: the last so many

%!  standing(?Host, ?Key, ?Op) is nondet.
%!  standing_begin(+Host, +Key, +Op) is det.
%!  standing_end(+Host, +Key, -Op) is semidet.
%!  standing_again(+Host, +Key, -Op) is semidet.
%!  standing_forget(+Host) is det.
%
%   What holds; it holds from now on, or no longer, or again as it did last.
%
%   @error resource_error(ros_standing)

standing_begin(Host, Key, Op) :-
    with_mutex(typhon_ros_standing, begin(Host, Key, Op)).

begin(Host, Key, _) :-
    standing(Host, Key, _),
    !.
begin(Host, Key, Op) :-
    aggregate_all(count, standing(Host, _, _), Count),
    setting(most, Most),
    (   Count < Most
    ->  assertz(standing(Host, Key, Op))
    ;   resource_error(ros_standing)
    ).

standing_end(Host, Key, Op) :-
    with_mutex(typhon_ros_standing, end(Host, Key, Op)).

end(Host, Key, Op) :-
    retract(standing(Host, Key, Op)),
    !,
    retractall(ended(Host, Key, _)),
    assertz(ended(Host, Key, Op)),
    predicate_property(ended(_, _, _), number_of_clauses(Count)),
    setting(most, Most),
    (   Count > Most,
        retract(ended(_, _, _))
    ->  true
    ;   true
    ).

standing_again(Host, Key, Op) :-
    ended(Host, Key, Op),
    !,
    standing_begin(Host, Key, Op).

standing_forget(Host) :-
    retractall(standing(Host, _, _)),
    retractall(ended(Host, _, _)).
