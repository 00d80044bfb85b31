:- module(experiment_signals, []).
:- reexport('../engine/signals').
