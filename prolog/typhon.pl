:- module(typhon, []).

/** <module> Typhon: agents that travel

The whole public interface of the platform.  Nothing is defined here: each
layer has a door, and behind it a folder with its rooms.

  | checking programs              | typhon/program    |
  | hosts, links, goals on a host  | typhon/host       |
  | agents                         | typhon/lifecycle  |
  | what agents can say            | typhon/language   |
  | networks, the log server       | typhon/network    |
  | events, as they happen         | typhon/watching   |
  | tables for people              | typhon/people     |
  | a page for a browser           | typhon/page       |
  | Python, MQTT, ROS, FIPA        | typhon/bridge     |
*/

%   Arithmetic is compiled in all rooms; what they tell by debug/3 stays. From 9.2
%   on it is library(debug) that has the flag.

:- use_module(library(debug), []).
:- set_prolog_flag(optimise, true).
:- set_prolog_flag(optimise_debug, false).

:- use_module(typhon/kernel/base/user_errors, [user_errors/1]).
:- reexport(typhon/kernel/program, [agent_check/1, agent_check/2]).
:- reexport(typhon/options/watch, [watch/3, unwatch/1]).
:- reexport(typhon/kernel/host,
            [ host_start/1, host_start/2, host_change/2, host_stop/1,
              host_property/2, link/2, link/3, unlink/2, remote/2
            ]).
:- reexport('typhon/kernel/lifecycle',
            except([ agent_glance/2, agent_named/2, goals_shown/4,
                     status_shown/2 ])).
:- reexport('typhon/network').
:- reexport(typhon/tools, [agents/0, hosts/0]).
:- reexport(typhon/tools/page, [page_start/1, page_stop/0]).
:- reexport(typhon/bridges/common/starting,
            [ mqtt_start/3, mqtt_stop/1, python_start/3, python_stop/1,
              ros_start/3, ros_stop/1, ros_property/2, fipa_start/3, fipa_stop/1 ]).
:- use_module(typhon/kernel/vocabulary, []).

:- user_errors(typhon).

:- set_prolog_flag(optimise_debug, default).
