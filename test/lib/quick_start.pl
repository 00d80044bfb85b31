:- module(quick_start, []).

% Preloaded in the processes that suites start, and imported nowhere; see
% test_quick_swipl.

:- use_module('../../prolog/typhon', []).

% What most of them load besides.

:- use_module('../../prolog/typhon/network/child_output', []).
:- use_module('../../prolog/typhon/network/children', []).
:- use_module('../../prolog/typhon/options/journal', []).
:- use_module('../../prolog/typhon/options/snapshot', []).
:- use_module(quick_system, []).

%   The processes of networks run this state, too: it has no goal of its own,
%   for which the library avoids saved states.

:- abolish(typhon_node_program:swipl/1),
   assertz((typhon_node_program:swipl(Swipl) :-
                current_prolog_flag(executable, Swipl))),
   compile_predicates([typhon_node_program:swipl/1]).
