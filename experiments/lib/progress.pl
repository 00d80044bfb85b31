:- module(experiment_progress, []).
:- reexport('../engine/progress').
