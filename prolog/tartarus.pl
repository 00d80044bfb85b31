:- module(tartarus, []).

/** <module> Programs written for Tartarus

This library defines the predicates of the three generations of Tartarus by
library(typhon): programs written for Tartarus run unchanged.

    ?- use_module(library(tartarus)).

A platform is a host called `tartarus` whose place is module `user`.  As in
Tartarus, an agent is a set of clauses in `user` whose first argument is its
name.  When it moves, a small agent of Typhon carries these clauses, so that the
agent is neither lost nor duplicated.

  | starting and stopping, printing        | tartarus/platform |
  | agents: records, threads, saving       | tartarus/lives    |
  | agents: their clauses                  | tartarus/clauses  |
  | agents: creating, running, ending      | tartarus/agents   |
  | moves between platforms, their times   | tartarus/moves    |
  | messages, log servers                  | tartarus/messages |
  | speech, Python, robots                 | tartarus/devices  |
  | pins of a Raspberry Pi                 | tartarus/pins     |

Local definitions take precedence: programs may define predicates of these
names.
*/

:- use_module(library(prolog_wrap), [wrap_predicate/4]).
:- use_module(typhon/kernel/base/on_demand, []).
:- use_module(typhon/tools/user_errors, [user_errors/1]).
:- reexport(tartarus/platform,
            [ start_tartarus/1, start_tartarus/2, start_tartarus/3,
              close_tartarus/0, reset_tartarus/0, get_tartarus_details/2,
              set_token/1, print_tartarus_status/0,
              assert_file_to_tartarus/1, verbose/1, platform_start/2,
              nothing/0 ]).
:- reexport(tartarus/agents, except([agent_create/2, agent_create/3])).
:- reexport(tartarus/moves,
            [ clone_agent/3, hoptime/4, in_hop_time/2, in_hop_time/5,
              in_hop_time_stat/3, in_hop_times_details/1,
              in_hop_times_info/1, move_agent/2, out_hop_time/2,
              out_hop_time/5, out_hop_time_stat/3, out_hop_times_details/1,
              out_hop_times_info/1, overall_hop_time_stat/3 ]).
:- reexport(tartarus/messages,
            [ post_agent/2, post_agent/3, send_log/2, send_log1/2,
              send_log2/2, set_log_server/2, set_log_serverr/2,
              set_log_serverrr/2 ]).
:- reexport(tartarus/lives,
            [load_tartarus_state/1, save_agent/2, save_tartarus_state/1]).
:- reexport(tartarus/devices).
:- reexport(tartarus/pins).

%   The names before 2019.

:- reexport(tartarus/platform,
            [ assert_file_to_tartarus/1 as platform_assert_file,
              close_tartarus/0 as platform_close,
              get_tartarus_details/2 as get_platform_details,
              reset_tartarus/0 as platform_reset ]).
:- reexport(tartarus/agents,
            [ execute_agent/3 as agent_execute,
              isexist_agent/3 as agent_isexist,
              list_agent/0 as agent_list,
              list_agent/1 as agent_list,
              purge_agent/1 as agent_kill ]).
:- reexport(tartarus/agents,
            [list_agent/0 as list_agents, list_agent/1 as list_agents]).
:- reexport(tartarus/moves,
            [clone_agent/3 as agent_clone]).
:- reexport(tartarus/messages,
            [post_agent/2 as agent_post, post_agent/3 as agent_post]).
:- reexport(tartarus/lives,
            [ load_tartarus_state/1 as load_platform_state,
              save_tartarus_state/1 as save_platform_state ]).

%   Typhon has four of these names. Its predicates are exported, and wrapped, so
%   that a file may import both libraries: the arguments tell whose call it is.

:- reexport(typhon,
            [agent_create/2, agent_create/3, agent_move/2, agent_save/2]).

share_names :-
    forall(shared_name(Head, Own, Goal), share_name(Head, Own, Goal)).

share_name(Head, Own, Goal) :-
    predicate_property(typhon:Head, imported_from(Home)),
    wrap_predicate(Home:Head, tartarus, Wrapped,
                   ( Own -> Goal ; Wrapped )).

shared_name(agent_create(Name, Handler), nonvar(Handler),
            tartarus_agents:agent_create(Name, Handler)).
shared_name(agent_create(Name, Location, Handler), \+ is_list(Handler),
            tartarus_agents:agent_create(Name, Location, Handler)).
shared_name(agent_move(Name, Location), subsumes_term((_,_), Location),
            tartarus_moves:move_agent(Name, Location)).
shared_name(agent_save(Name, File), user:agent_GUID(Name, _, _),
            tartarus_lives:save_agent(Name, File)).

%   A saved state does not keep wrappers.

:- initialization(share_names, now).

%   Programs consult the file of the platform under some path.  If there is no
%   such file, this library is loaded in its place.

:- multifile user:prolog_load_file/2.
:- dynamic user:prolog_load_file/2.

user:prolog_load_file(Spec, _) :-
    strip_module(Spec, Module, File),
    tartarus:platform_file(File),
    Module:use_module(library(tartarus)).

platform_file(File) :-
    atomic(File),
    atomic_list_concat(Parts, \, File),         % of Windows, too
    atomic_list_concat(Parts, /, Path),
    file_base_name(Path, Base),
    downcase_atom(Base, Name),
    once(( sub_atom(Name, 0, _, _, platform)
         ; sub_atom(Name, 0, _, _, tartarus) )),
    \+ absolute_file_name(File, _,
                          [ file_type(prolog), access(exist),
                            file_errors(fail) ]).

:- user_errors(tartarus).
