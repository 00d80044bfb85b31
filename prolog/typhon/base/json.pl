:- module(typhon_json, []).

/** <module> JSON, wherever this Prolog has it

library(http/json) until SWI-Prolog 9.3, library(json) since, where the old
name prints a message.

*Threading*: no state.
*/

:- if(exists_source(library(json))).
:- reexport(library(json), [atom_json_dict/3, json_read_dict/2]).
:- else.
:- reexport(library(http/json), [atom_json_dict/3, json_read_dict/2]).
:- endif.
