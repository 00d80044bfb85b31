:- module(typhon, []).
:- reexport(typhon/api).
:- reexport(typhon/hosting).
:- reexport(typhon/remote).
:- reexport(typhon/program, [agent_check/1]).
:- reexport(typhon/tables).
:- use_module(typhon/vocabulary, []).
:- use_module(typhon/paths, []).
:- use_module(typhon/messages, []).
