:- module(quick_start, []).

% What is there already in the processes that suites start, and imported
% nowhere; see test_quick_swipl.

:- use_module('../../prolog/typhon', []).
