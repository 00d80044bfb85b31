:- module(typhon, []).

/** <module> Typhon: mobile agents

The public interface of the platform; nothing is defined here.  Each layer is
a folder, with an interface of the same name beside it:

  | checking programs               | typhon/tools/checks      |
  | listing agents                  | typhon/tools/source_view |
  | hosts, links, goals on a host   | typhon/kernel/host       |
  | agents                          | typhon/kernel/lifecycle  |
  | predicates that agents can call | typhon/kernel/vocabulary |
  | networks, the log server        | typhon/network           |
  | agents, event by event          | typhon/options/trace     |
  | events, as they happen          | typhon/options/watch     |
  | fleets                          | typhon/options/fleet     |
  | tables at the top level, help/1 | typhon/tools/environment |
  | a page for a browser            | typhon/tools/page        |
  | Python, MQTT, ROS, FIPA, pins   | typhon/bridges           |
*/

:- use_module(typhon/kernel/base/compiling,
              [compiling_begin/1, compiling_end/1]).

:- if(( ( current_prolog_flag(threads, true)
        ; current_prolog_flag(emscripten, true) ),
        [] \== '[]' )).

:- compiling_begin(Flags),
   nb_setval(typhon_flags, Flags).

:- use_module(typhon/tools/user_errors, [user_errors/1]).
:- reexport(typhon/tools/administration,
            [ host_change/2, host_property/2, link/2, link/3, unlink/2,
              remote/2, agent_change/2, agent_property/2, agent_where/2,
              agent_save/2,
              agent_load/2, agent_load/3 ]).
:- reexport(typhon/tools/checks, [agent_check/1, agent_check/2]).
:- reexport(typhon/tools/source_view, [agent_listing/1]).
:- reexport(typhon/options/watch, [watch/3, unwatch/1]).
:- reexport(typhon/kernel/host,
            [ host_start/1, host_start/2, host_stop/1 ]).
:- reexport(typhon/kernel/lifecycle,
            [ agent_create/2, agent_create/3, agent_send/2,
              agent_move/2, agent_move/3, agent_clone/2, agent_resume/1,
              agent_dispose/1, agent_dispose/2, agent_join/3,
              agent_result/3,
              payload_attach/2, payload_detach/2
            ]).
:- reexport(typhon/options/trace,
            [agent_trace/2, agent_notrace/1, agent_step/1]).
:- reexport(typhon/options/trail, [agent_trail/2]).
:- reexport(typhon/network,
            [ network_start/3, network_stop/1, network_property/2,
              network_advance/2, network_at/3, network_save/2, network_load/3,
              log_server_start/2, log_server_stop/1, log_events/2 ]).
:- reexport(typhon/options/fleet,
            [ fleet_join/2, fleet_leave/1, fleet_hosts/3, fleet_watch/3,
              fleet_unwatch/1, fleet_drain/2, fleet_parked/2, work_put/3,
              work_take/4, work_keep/4, work_done/4, work_left/3,
              work_results/3 ]).
:- reexport(typhon/tools/environment, [agents/0, hosts/0]).
:- reexport(typhon/tools/page,
            [ page_start/1, page_stop/0, people_start/2, people_start/3,
              people_revoke/1, people_stop/0 ]).
:- reexport(typhon/bridges/common/starting,
            [ mqtt_start/3, mqtt_stop/1, python_start/3, python_stop/1,
              ros_start/3, ros_stop/1, ros_property/2, fipa_start/3,
              fipa_stop/1, gpio_start/3, gpio_stop/1 ]).
:- use_module(typhon/kernel/vocabulary, []).
:- use_module(typhon/options/migration, []).
:- use_module(typhon/kernel/base/error_lines, []).
:- use_module(typhon/tools/messages, []).
:- use_module(typhon/tools/problem_text, []).
:- use_module(typhon/tools/event_text, []).
:- use_module(typhon/tools/old_settings, []).
:- use_module(typhon/options/tls, []).
:- use_module(typhon/options/identity, []).
:- reexport(typhon/options/supervision, [agent_monitor/2]).
:- use_module(typhon/options/directory, []).

:- user_errors(typhon).

:- nb_getval(typhon_flags, Flags),
   compiling_end(Flags),
   nb_delete(typhon_flags).

:- else.

:- print_message(error,
                 format('swipl --traditional and --no-threads do not run \c
                         library(typhon); without threads use \c
                         library(typhon/kernel)', [])).

:- endif.
