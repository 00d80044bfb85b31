:- module(typhon_people, []).

/** <module> For people

Tables, and the texts of errors and reports.
This is the door of the layer: who is above takes what it needs from here.
*/

:- reexport(people/tables, [agents/0, hosts/0]).
:- reexport(people/survey, [survey/4, survey_agents/2, survey_hosts/4]).
:- reexport('people/close_up').
:- reexport(people/happenings, [own_event/1]).
:- use_module(people/editors, []).
:- use_module(people/completion, []).
:- use_module(people/messages, []).
:- use_module(people/manual, []).
:- use_module(people/fault_messages, []).
:- use_module(people/agent_words, []).
