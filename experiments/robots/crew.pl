:- module(robots_crew,
          [ crew_services/1,            % -Services
            crew_join/2,                % +Hosts, +Ports
            crew_task/3                 % +Name, +Spec, -Task
          ]).
:- use_module('../../prolog/typhon', [remote/2]).
:- use_module('../../prolog/typhon/program/paths', []).
:- use_module('../../prolog/typhon/program/programs', [payload_load/2]).
:- use_module(library(thread), [concurrent_maplist/3]).

/** <module> Hosts that have robots

The place of such a host offers library(typhon/nxt), the robot interface,
and in its tuple space brick(Brick) names the brick that is connected there.
That is all that a program which comes to the host must know.

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
%   Each of Hosts connects to the brick at the end of the serial line that
%   stands at the same place in Ports, and leaves brick(Brick).  A brick has
%   ten seconds to answer: the computer may be busy.  It does not acknowledge
%   motor commands: each wheel has one of its own, and while the robot waited
%   for the first answer it would turn.
%
%   @error what nxt_connect/3 throws, host_unreachable(Host)

crew_join(Hosts, Ports) :-
    concurrent_maplist(join, Hosts, Ports).

join(Host, Port) :-
    remote(Host, ( nxt_connect(robot, Port,
                               [deadline(10), confirm(false)]),
                   leave(brick(robot)) )).

%!  crew_task(+Name, +Spec, -Task) is det.
%
%   Task is Name-Goal, where Goal carries the payload file Spec with it:
%   the agent who calls it takes up the payload, calls the predicate that
%   has the name of the payload and no arguments, and lays it down again,
%   also when that fails or raises something.
%
%   @error those of a payload file, see agent_check/1

crew_task(Name, Spec, Name-Goal) :-
    payload_load(Spec, Payload),
    Payload = payload(Entry, _, _),
    Goal = ( attach(Payload),
             catch(( Entry -> Done = true ; Done = fail ), Ball,
                   Done = throw(Ball)),
             detach(Entry),
             Done ).
