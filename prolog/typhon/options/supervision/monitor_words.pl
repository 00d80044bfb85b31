:- module(typhon_monitor_words,
          [ monitor/1,                  % +Agent
            monitor/2,                  % +Agent, +Options
            unmonitor/1,                % +Agent
            dispose/1,                  % +Agent
            dispose/2,                  % +Agent, +Options
            followers/1                 % -Agents
          ]).
:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../../kernel/program', [vocabulary/1]).
:- use_module('../../kernel/wire', [endpoint_address/1]).
:- use_module('../../kernel/host', [context/3, parts_call/3, process_ask/6]).
:- use_module('../../kernel/agent', [agent_home_endpoint/2, agent_variant/2]).
:- use_module('../../kernel/lifecycle', [agent_dispose/2]).
:- autoload(monitors, [monitor_begin/3, monitor_end/2, monitor_set/2]).
:- autoload(relations, [relations/2]).

/** <module> The predicates by which agents monitor others

The home of a monitoring agent keeps its monitors, since the home knows its
location, and gets the news of its end.

*Threading*: the thread that runs the agent; waits for the home, if that is
another process.
*/

:- vocabulary(typhon_monitor_words).

:- multifile
    typhon_creation:at_birth/2,
    typhon_creation:first_goal/3,
    typhon_options:declared/4.

typhon_options:declared(monitor_option, shared(Shared),
                        oneof([true,false,agent,self]), Shared).
typhon_options:declared(agent_option, follows(Follows), boolean, Follows).

typhon_creation:first_goal(Options, Parent,
                           monitor(Parent, [shared(self)])) :-
    Parent \== none,
    option(follows(true), Options).

%   This process is the home of Id.  The monitor is set before Id begins, and so
%   before it can move or fail, and its parent cannot end unnoticed.

typhon_creation:at_birth(monitor(Parent, [shared(self)]), Id) :-
    atom(Parent),
    agent_home_endpoint(Parent, _),
    monitor_begin(Id, Parent, self).

%!  monitor(+Agent:atom) is det.
%!  monitor(+Agent:atom, +Options:list) is det.
%!  unmonitor(+Agent:atom) is det.
%
%   This agent gets one message, `system-down(Agent, Outcome)`, when Agent ends,
%   is faulty or is lost, wherever both are by then; at once if that has
%   happened already.  Outcome is that of agent_monitor/2.  A second monitor of
%   the same agent changes nothing.  After unmonitor/1 no message arrives that
%   is not in the mailbox yet.  Option:
%
%     - shared(+Shared): default `false`.  If `true`, each of the two is
%       disposed of if the other ends otherwise than `done`, as with link/1 of
%       Erlang.  If `agent`, only Agent is, as the child of a supervisor; if
%       `self`, only this agent is, and it gets no message
%
%   With follows(true) among the options of create/3 the new agent begins with
%   monitor(Parent, [shared(self)]): it does not outlive its parent, even if
%   that ends before it can monitor the new agent.
%
%   Where the policy is not `trusted`, Shared must be `false` or `self`.
%
%   @error existence_error(agent, Agent): Agent is not an id
%   @error permission_error(call, sandboxed, monitor(Agent, Options))
%   @error domain_error(monitor_option, Option)
%   @error host_unreachable(Home), connection_lost(Home): the home of this agent

monitor(Agent) :-
    monitor(Agent, []).

monitor(Agent, Options) :-
    check_options(monitor_option, Options),
    option(shared(Shared), Options, false),
    (   memberchk(Shared, [true,agent]),
        is_checked
    ->  permission_error(call, sandboxed, monitor(Agent, Options))
    ;   true
    ),
    ask_home(begin(Agent, Shared), Agent).

unmonitor(Agent) :-
    ask_home(end(Agent), Agent).

is_checked :-
    context(_, _, Module),
    agent_variant(Module, _).

%!  dispose(+Agent:atom) is det.
%!  dispose(+Agent:atom, +Options:list) is det.
%
%   As agent_dispose/1,2.  Where the policy is not `trusted`, Agent must follow
%   this one, as by follows(true) at its creation.
%
%   @error permission_error(call, sandboxed, dispose(Agent, Options))
%   @error as agent_dispose/2

dispose(Agent) :-
    dispose(Agent, []).

dispose(Agent, Options) :-
    must_be(atom, Agent),
    context(Host, Id, _),
    parts_call(acts, Host, [Id, send(dispose(Agent))]),
    (   is_checked,
        \+ follows(Agent, Id)
    ->  permission_error(call, sandboxed, dispose(Agent, Options))
    ;   agent_dispose(Agent, Options)
    ).

%   follows(+Agent, +Id) is semidet: Agent is disposed of if Id ends otherwise
%   than `done`, according to the home of Agent.

follows(Agent, Id) :-
    agent_home_endpoint(Agent, Home),
    (   endpoint_address(Home)
    ->  once(monitor_set(ends(Agent), Id))
    ;   process_ask(Home, Home, monitor, follows(Agent, Id), Answer, 10),
        Answer == true
    ).

%!  followers(-Agents:ordset) is det.
%
%   Agents are those that are disposed of if this agent ends otherwise than
%   `done`, as far as their homes are known here and answer within five seconds.

followers(Agents) :-
    context(Host, Id, _),
    parts_call(acts, Host, [Id, send(followers)]),
    relations(Id, Relations),
    findall(Agent, member(follows(Agent, Id), Relations), Agents).

ask_home(Request, Agent) :-
    must_be(atom, Agent),
    context(Host, Id, _),
    parts_call(acts, Host, [Id, send(Request)]),
    (   agent_home_endpoint(Agent, _),
        agent_home_endpoint(Id, Home)
    ->  at_home(Home, Id, Request)
    ;   existence_error(agent, Agent)
    ).

at_home(Home, Id, Request) :-
    endpoint_address(Home),
    !,
    here(Request, Id).
at_home(Home, Id, Request) :-
    process_ask(Home, Home, monitor, by(Id, Request), ok, 10).

here(begin(Agent, Shared), Id) :-
    monitor_begin(Id, Agent, Shared).
here(end(Agent), Id) :-
    monitor_end(Id, Agent).
