:- module(robots_crew,
          [ crew_services/1,            % -Services
            crew_join/2,                % +Hosts, +Ports
            crew_leave/0,
            crew_task/3                 % +Name, +Spec, -Task
          ]).
:- use_module('../../prolog/typhon', [remote/2]).
:- use_module('../../prolog/typhon/nxt', [nxt_brick/2, nxt_disconnect/1]).
:- use_module('../../prolog/typhon/kernel/program/paths', []).
:- use_module('../../prolog/typhon/language/programs', [payload_load/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [relative_file_name/3]).

/** <module> Hosts that have robots

The place of such a host offers library(typhon/nxt), the robot interface, and
the tuple brick(Brick) in its tuple space names its connected brick. An
arriving program needs no other information.

*Threading*: no state; any thread.
*/

%!  crew_services(-Services) is det.
%
%   For the option services(Services) of host_start/2.

crew_services([File]) :-
    module_property(robots_crew, file(Here)),
    relative_file_name(File, Here, '../../prolog/typhon/nxt.pl').

%!  crew_join(+Hosts, +Ports) is det.
%
%   Each of Hosts connects to the brick at the serial line at the same position
%   in Ports, and leaves brick(Brick); Brick is the name of the host.  A brick
%   has a minute to answer, as the computer may be busy.  It acknowledges motor
%   commands: the arena has received a command before time advances.
%
%   @error errors of nxt_connect/3, host_unreachable(Host)

crew_join(Hosts, Ports) :-
    maplist(join, Hosts, Ports).

join(Host, Port) :-
    atomic_list_concat([Brick|_], @, Host),
    remote(Host, ( nxt_connect(Brick, Port, [deadline(60)]),
                   leave(brick(Brick)) )).

%!  crew_leave is det.
%
%   Disconnects the bricks of this process.

crew_leave :-
    forall(nxt_brick(Brick, _), nxt_disconnect(Brick)).

%!  crew_task(+Name, +Spec, -Task) is det.
%
%   Task is Name-Goal, where Goal includes the payload file Spec: the agent that
%   calls Goal attaches the payload, calls the predicate with the name of the
%   payload and no arguments, and detaches the payload, also after a failure or
%   an error.
%
%   @error errors of a payload file, see agent_check/1

crew_task(Name, Spec, Name-Goal) :-
    payload_load(Spec, Payload),
    Payload = payload(Entry, _, _),
    Goal = ( attach(Payload),
             catch(( Entry -> Done = true ; Done = fail ), Ball,
                   Done = throw(Ball)),
             detach(Entry),
             Done ).
