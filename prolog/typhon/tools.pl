:- module(typhon_people, []).

/** <module> For people

Tables, and the texts of errors and reports.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(tools/tables, [agents/0, hosts/0]).
:- reexport(tools/survey, [survey/4, survey_agents/2, survey_hosts/4]).
:- reexport('tools/host_report').
:- reexport(tools/event_text, [own_event/1]).
:- use_module(tools/editors, []).
:- use_module(tools/completion, []).
:- use_module(tools/messages, []).
:- use_module(tools/manual, []).
:- use_module(tools/fault_messages, []).
:- use_module(tools/agent_words, []).
