:- module(typhon, []).
:- reexport(typhon/api).
:- reexport(typhon/hosting).
:- reexport(typhon/remote).
:- reexport(typhon/program, [agent_check/1]).
:- use_module(typhon/vocabulary, []).
