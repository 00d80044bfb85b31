:- module(typhon_python, []).

/** <module> Python functions as predicates of a place

    :- use_module(library(typhon/python)).

    ?- host_start(alpha), python_start(alpha, 'sensors.py', []).

The functions that the file defines are predicates that agents on alpha can
call, with the result as last argument.  See doc/bridges.md.
*/

:- use_module(tools/user_errors, [user_errors/1]).
:- reexport(bridges/common/starting, [python_start/3, python_stop/1]).
:- use_module('bridges/python/service', []).

:- user_errors(typhon_python).
