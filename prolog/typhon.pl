:- module(typhon, []).

/** <module> Typhon: agents that travel

The whole public interface of the platform.  Nothing is defined here: see
the rooms.

  | hosts and links          | typhon/hosting    |
  | agents                   | typhon/api        |
  | checking programs        | typhon/program    |
  | goals on any host        | typhon/remote     |
  | networks                 | typhon/network    |
  | the log server           | typhon/log        |
  | tables for people        | typhon/tables     |
  | what agents can say      | typhon/inside     |
*/

:- reexport(typhon/hosting).
:- reexport(typhon/api).
:- reexport(typhon/program, [agent_check/1]).
:- reexport(typhon/remote).
:- reexport(typhon/network,
            [network_start/3, network_stop/1, network_property/2]).
:- reexport(typhon/log,
            [log_server_start/2, log_server_stop/1, log_events/2]).
:- reexport(typhon/tables).
:- use_module(typhon/vocabulary, []).
:- use_module(typhon/paths, []).
:- use_module(typhon/messages, []).
