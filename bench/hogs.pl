:- module(bench_hogs,
          [ hog_clauses/2,              % ?What, -Clauses
            beside_hogs/3               % +Host, +Clauses, :Goal
          ]).
:- use_module(library(typhon)).

/** <module> Agents that use up resources

*Threading*: a thread creates one each half second.
*/

:- meta_predicate beside_hogs(+, +, 0).

%!  beside_hogs(+Host, +Clauses, :Goal) is semidet.
%
%   Calls Goal once while agents with the program Clauses arrive at Host.

beside_hogs(Host, Clauses, Goal) :-
    setup_call_cleanup(
        thread_create(hogs(Host, Clauses), Thread),
        once(Goal),
        ( thread_send_message(Thread, stop),
          thread_join(Thread, _) )).

hogs(Host, Clauses) :-
    agent_create(clauses([(:- agent(hog, [state([s/1])]))|Clauses]), _,
                 [host(Host)]),
    thread_self(Me),
    (   thread_get_message(Me, stop, [timeout(0.5)])
    ->  true
    ;   hogs(Host, Clauses)
    ).

%!  hog_clauses(?What, -Clauses) is nondet.
%
%   The program of an agent that uses up What.

hog_clauses(time, [ (main :- lp), (lp :- lp) ]).
hog_clauses(stack, [ (main :- lr(0)), (lr(N) :- M is N+1, lr(M), true) ]).
hog_clauses(findall, [ (main :- findall(X, between(1, inf, X), _)) ]).
hog_clauses(strings, [ (main :- ls("abc")), (ls(S) :- string_concat(S, S, T), ls(T)) ]).
hog_clauses(state, [ (main :- between(1, inf, X), assertz(s(X)), fail) ]).
hog_clauses(tuples, [ (main :- between(1, inf, X), leave(s(X)), fail) ]).
hog_clauses(messages, [ (main :- self(M), between(1, inf, X), send(M, X), fail) ]).
hog_clauses(clones, [ (main :- clone(_), main) ]).
