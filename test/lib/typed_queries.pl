% Loaded by the top level of a transcript: marks in the output where the echo
% of a query ends and its output begins. The query `next` marks the end.

:- multifile user:expand_query/4.
:- dynamic user:expand_query/4.

user:expand_query(next, true, Bindings, Bindings) :-
    !,
    format("~n@@next@@~n").
user:expand_query(_, _, _, _) :-
    format("~n@@begin@@~n"),
    fail.

% 9.2.9 starts the tracer at the second error of a session, whatever is loaded.

:- if(( current_prolog_flag(version, V), V >= 90200, V < 90300 )).
:- set_prolog_flag(debug_on_error, false).
:- endif.
