:- module(tartarus_names,
          [ platform_close/0, platform_reset/0, get_platform_details/2,
            save_platform_state/1, load_platform_state/1,
            platform_assert_file/1, agent_execute/3, agent_kill/1,
            agent_move/2, agent_clone/3, agent_post/2, agent_post/3,
            agent_save/2, agent_list/0, agent_list/1, list_agents/0,
            agent_isexist/3
          ]).
:- use_module(agents,
              [execute_agent/3, isexist_agent/3, list_agent/0, list_agent/1,
               purge_agent/1]).
:- use_module(messages, [post_agent/2, post_agent/3]).
:- use_module(moves, [clone_agent/3, move_agent/2]).
:- use_module(platform,
              [ assert_file_to_tartarus/1, close_tartarus/0,
                get_tartarus_details/2, reset_tartarus/0 ]).
:- use_module(states,
              [load_tartarus_state/1, save_agent/2, save_tartarus_state/1]).

/** <module> The names before 2019

*Threading*: as what they stand for.
*/

%!  platform_close is semidet.
%!  platform_reset is semidet.
%!  get_platform_details(-Ip, -Port) is semidet.
%!  platform_assert_file(+File) is semidet.
%!  save_platform_state(+File) is det.
%!  load_platform_state(+File) is semidet.

platform_close :- close_tartarus.
platform_reset :- reset_tartarus.
get_platform_details(Ip, Port) :- get_tartarus_details(Ip, Port).
platform_assert_file(File) :- assert_file_to_tartarus(File).
save_platform_state(File) :- save_tartarus_state(File).
load_platform_state(File) :- load_tartarus_state(File).

%!  agent_execute(+Name, +Location, +Handler) is det.
%!  agent_kill(+Name) is det.
%!  agent_move(+Name, +Location) is det.
%!  agent_clone(+Name, +Location, -Clone) is semidet.
%!  agent_post(+Name, +Message) is semidet.
%!  agent_post(+Platform, +Location, ?Message) is semidet.
%!  agent_save(+Name, +File) is semidet.
%!  agent_list is det.
%!  agent_list(-Agents) is det.
%!  list_agents is det.
%!  agent_isexist(?Name, ?Location, ?Handler) is semidet.

agent_execute(Name, Location, Handler) :-
    execute_agent(Name, Location, Handler).
agent_kill(Name) :- purge_agent(Name).
agent_move(Name, Location) :- move_agent(Name, Location).
agent_clone(Name, Location, Clone) :- clone_agent(Name, Location, Clone).
agent_post(Name, Message) :- post_agent(Name, Message).
agent_post(Platform, Location, Message) :-
    post_agent(Platform, Location, Message).
agent_save(Name, File) :- save_agent(Name, File).
agent_list :- list_agent.
agent_list(Agents) :- list_agent(Agents).
list_agents :- list_agent.
agent_isexist(Name, Location, Handler) :-
    isexist_agent(Name, Location, Handler).
