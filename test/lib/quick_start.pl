:- module(quick_start, []).

% Preloaded in the processes that suites start, and imported nowhere; see
% test_quick_swipl.

:- use_module('../../prolog/typhon', []).
