:- module(quick_tartarus, []).

% Preloaded in the platforms of Tartarus, see test_tartarus_nodes.

:- use_module(quick_start, []).
:- use_module('../../prolog/tartarus', []).
