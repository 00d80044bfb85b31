:- module(typhon_state_text,
          [ state_text/2,               % +Id, -Characters
            state_text_forget/1         % +Id
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module('../base/trees', [atoms_length/2]).
:- use_module('../host', [context_now/2, quota/3, quota_passed/1]).

/** <module> Atoms in the state of an agent

The size of a clause does not include the text of its atoms, which live
outside.  So on a host with a quota of state the text that an agent adds is
counted.  What it takes away is not: when the count passes the quota the text
that is there is counted anew.

*Threading*: the thread that runs the agent; state_text/2 any thread.
*/

:- multifile typhon_host_parts:part/4.

:- dynamic text/2.                      % Id, Characters

typhon_host_parts:part(adds_clause, Host, 10, typhon_state_text:text_added) :-
    once(quota(Host, state, _)).

:- public text_added/2.

%   text_added(+Module, +Clause): the running agent, whose state is in Module,
%   adds Clause.
%
%   @error resource_error(state)

text_added(Module, Clause) :-
    (   context_now(Host, Id),
        Id \== none,
        quota(Host, state, Most)
    ->  atoms_length(Clause, Length),
        add(Id, Length, Count),
        (   Count =< Most
        ->  true
        ;   recount(Id, Module, Length, Most)
        )
    ;   true
    ).

add(Id, Length, Count) :-
    (   retract(text(Id, Count0))
    ->  Count is Count0+Length
    ;   Count = Length
    ),
    assertz(text(Id, Count)).

recount(Id, Module, Length, Most) :-
    aggregate_all(sum(Its),
                  ( state_clause(Module, Head, Body),
                    atoms_length(Head-Body, Its) ),
                  There),
    retractall(text(Id, _)),
    Count is There+Length,
    assertz(text(Id, Count)),
    (   Count =< Most
    ->  true
    ;   quota_passed(state)
    ).

state_clause(Module, Head, Body) :-
    '$c_current_predicate'(_, Module:Head),
    '$get_predicate_attribute'(Module:Head, (dynamic), 1),
    \+ '$get_predicate_attribute'(Module:Head, imported, _),
    clause(Module:Head, Body).

%!  state_text(+Id, -Characters:integer) is det.
%
%   At least so much text is in the state of Id, unless it was taken away.

state_text(Id, Characters) :-
    (   text(Id, Count)
    ->  Characters = Count
    ;   Characters = 0
    ).

%!  state_text_forget(+Id) is det.

state_text_forget(Id) :-
    retractall(text(Id, _)).
