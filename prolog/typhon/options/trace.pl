:- module(typhon_trace, []).

/** <module> Tracing, stepping and spying

An agent is seen from outside, event by event or goal by goal, wherever it
goes.  This is the interface of the layer.
*/

:- reexport(trace/tracing, [agent_trace/2, agent_notrace/1]).
:- reexport(trace/stepping, [agent_step/1]).
