% Loaded by the top level of a transcript: marks in what it prints where the
% echo of a query ends and its output begins. The query `next` marks the end.

:- multifile user:expand_query/4.
:- dynamic user:expand_query/4.

user:expand_query(next, true, Bindings, Bindings) :-
    !,
    format("~n@@next@@~n").
user:expand_query(_, _, _, _) :-
    format("~n@@begin@@~n"),
    fail.
