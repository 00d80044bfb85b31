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

These predicates print what an agent does, event by event or goal by goal,
wherever it goes.  This is the interface of the layer; its modules are loaded
in each process to which a traced agent comes, and when a predicate of a program
gets a spy point, see typhon_spying.

*Threading*: any thread that may wait.
*/

:- multifile prolog:debug_control_hook/1.

%!  agent_trace(+Agent, +What) is det.
%!  agent_notrace(+Agent) is det.
%
%   Print what Agent does from now on, wherever it is and goes, and write it to
%   the log of the host where it happens, if that has one.  What is a list of
%   `hops`; `messages`; `facts`, those that it leaves in and takes from the
%   tuple spaces of hosts; and `goals`, those that the machine runs, without the
%   goals inside a predicate that Prolog runs to its end.  Clones are traced,
%   too.
%
%   agent_notrace/1 ends this, and lets a held agent continue, see agent_step/1.
%
%   @error existence_error(agent, Agent)
%   @error domain_error(trace_kind, Kind)

agent_trace(Agent, What) :-
    on_demand_call(order, watched, typhon_tracing:agent_trace(Agent, What)).

agent_notrace(Agent) :-
    on_demand_call(order, watched, typhon_tracing:agent_notrace(Agent)).

%!  agent_step(+Agent) is det.
%
%   Agent runs its next goal and is held before the one after it, wherever that
%   is; that goal is printed.  An agent that is not held yet is held at its next
%   goal; if it runs now, at the goal after its next effect.  If it stops for
%   another reason, waits for a message or ends, that is printed.
%   agent_notrace/1 lets it continue.
%
%   @error existence_error(agent, Agent)
%   @error timeout_error(order, Agent): it reached no goal within 10 seconds
%   @error permission_error(step, agent, Agent) on a host that limits turns

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
