:- module(quick_study, []).

% Preloaded in the processes of the suites of studies, besides quick_start: what
% experiments/study.pl loads.

:- use_module(quick_start, []).
:- use_module('../../app/typhon/arguments', []).
:- use_module('../../app/typhon/engine_options', []).
:- use_module('../../experiments/engine/catalogue', []).
:- use_module('../../experiments/engine/commands', []).
:- use_module('../../experiments/engine/figures', []).
:- use_module('../../experiments/engine/fleet_runs', []).
:- use_module('../../experiments/engine/live', []).
:- use_module('../../experiments/engine/machines', []).
:- use_module('../../experiments/engine/replays', []).
:- use_module('../../experiments/engine/work', []).
