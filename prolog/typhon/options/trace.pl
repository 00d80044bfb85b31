:- module(typhon_trace,
          [ agent_trace/2,              % +Agent, +What
            agent_notrace/1,            % +Agent
            agent_step/1                % +Agent
          ]).
:- use_module(library(prolog_trace), [trace/2]).
:- use_module(library(prolog_wrap), [wrap_predicate/4]).
:- use_module('../kernel/base/on_demand',
              [on_demand_call/3, on_demand_load/2, on_demand_missing/2]).

/** <module> Tracing, stepping and spying

These predicates print the events or the goals of an agent, on whatever host it
runs.  This is the interface of the layer.  Its modules are loaded in each
process where a traced agent arrives, and when a predicate of a program gets a
spy point, see typhon_spying.

*Threading*: any thread that may wait.
*/

:- multifile prolog:debug_control_hook/1.

%!  agent_trace(+Agent, +What) is det.
%!  agent_notrace(+Agent) is det.
%
%   From now on this process prints the events of Agent, on whatever host it is.
%   A host with a log also writes the events to its log.  What is a list of
%
%     - `hops`
%     - `messages`
%     - `facts` that Agent leaves in tuple spaces of hosts, or takes from them
%     - `goals` that the machine runs, without the goals inside a predicate that
%       Prolog runs to its end
%
%   Clones are traced, too.  agent_notrace/1 ends tracing and stepping, see
%   agent_step/1, and lets a held agent continue.
%
%   @error existence_error(agent, Agent)
%   @error domain_error(trace_kind, Kind)

agent_trace(Agent, What) :-
    on_demand_call(order, watched, typhon_tracing:agent_trace(Agent, What)).

agent_notrace(Agent) :-
    on_demand_call(order, watched, typhon_tracing:agent_notrace(Agent)).

%!  agent_step(+Agent) is det.
%
%   Agent runs its next goal and is held before the goal after it, on whatever
%   host that is.  This process prints the goal before which it is held.  An
%   agent that is not held yet is held at its next goal; if it runs now, at the
%   goal after its next effect.  If Agent stops for another reason, waits for a
%   message or ends, that is printed instead.  agent_notrace/1 lets it continue.
%
%   @error existence_error(agent, Agent)
%   @error timeout_error(order, Agent) Agent reached no goal within 10 seconds
%   @error permission_error(step, agent, Agent) Agent is on a host that limits
%   turns

agent_step(Agent) :-
    on_demand_call(order, watched, typhon_stepping:agent_step(Agent)).

%   The first spy point whose module may be a program loads the modules.

prolog:debug_control_hook(Action) :-
    on_demand_missing(spied, program),
    ( Action = spy(Spec) ; Action = nospy(Spec) ),
    !,
    may_name_program(Spec),
    on_demand_load(spied, program),
    prolog:debug_control_hook(Action).

may_name_program(Spec) :-
    strip_module(Spec, Module, _),
    \+ memberchk(Module, [user, system]).

%   trace/2 has no hook, so it is wrapped.

:- initialization(
       wrap_predicate(prolog_trace:trace(Spec, Ports), typhon, Closure,
                      ( typhon_trace:program_traced(Spec, Ports)
                      ->  true
                      ;   Closure
                      ))).

:- public program_traced/2.

program_traced(Spec, Ports) :-
    may_name_program(Spec),
    on_demand_call(spied, program, typhon_spying:trace_program(Spec, Ports)).
