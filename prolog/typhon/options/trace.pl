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

An agent is seen from outside, event by event or goal by goal, wherever it
goes.  This is the interface of the layer; its modules are loaded when an agent
is traced, in each process that it comes to, or a predicate of a program is
spied, see typhon_spying.

*Threading*: any thread that may wait.
*/

:- multifile prolog:debug_control_hook/1.

%!  agent_trace(+Agent, +What) is det.
%!  agent_notrace(+Agent) is det.
%
%   Print what happens to Agent from now on, wherever it is and goes, and
%   write it in the log of the host where it happens, if that has one.  What
%   is a list out of `hops`, `messages`, `facts`, which is what it leaves in
%   and takes from the tuple spaces of hosts, and `goals`, which are those
%   that the machine comes to, not those within what Prolog runs to its end
%   by itself.  Clones are traced, too.
%
%   agent_notrace/1 ends this, and lets an agent go on that is held, see
%   agent_step/1.
%
%   @error existence_error(agent, Agent)
%   @error domain_error(trace_kind, Kind)

agent_trace(Agent, What) :-
    on_demand_call(order, watched, typhon_tracing:agent_trace(Agent, What)).

agent_notrace(Agent) :-
    on_demand_call(order, watched, typhon_tracing:agent_notrace(Agent)).

%!  agent_step(+Agent) is det.
%
%   Agent runs its next goal, and is held before the one after it, wherever
%   that is; this goal is printed.  One that is not held yet is held at its
%   next goal, which it comes to after its next effect if it runs now.  Where
%   it stops otherwise, waits for a message or ends, that is printed.
%   agent_notrace/1 lets it go on.
%
%   @error existence_error(agent, Agent)
%   @error timeout_error(order, Agent): it came to no goal within 10 seconds
%   @error permission_error(step, agent, Agent) where turns have limits

agent_step(Agent) :-
    on_demand_call(order, watched, typhon_stepping:agent_step(Agent)).

%   The first spy point on what may be a program.

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

%   trace/2 has no hook.

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
