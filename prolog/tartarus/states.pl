:- module(tartarus_states,
          [ save_agent/2,               % +Name, +File
            save_tartarus_state/1,      % +File
            load_tartarus_state/1       % +File
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(listing), [portray_clause/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(clauses, [body/3]).
:- use_module(lives,
              [ life_begin/6, record/3, record_payload/2, run_handler/4 ]).
:- use_module(platform, [here/1, must/1, wrong/2]).

/** <module> Saved agents and platforms

As text one can read: of an agent its clauses, of a platform its agents
without their tokens.

*Threading*: any thread.
*/

%!  save_agent(+Name, +File) is semidet.
%
%   The clauses of an agent, as listing/1 writes them.

save_agent(Name, File) :-
    body_of(Name, Indicators, Clauses),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        ( forall(member((Predicate,Arity), Indicators),
                 format(Out, ":- dynamic ~q/~d.~n", [Predicate, Arity])),
          nl(Out),
          forall(member(Clause, Clauses), written(Out, Clause)) ),
        close(Out)).

body_of(Name, Indicators, Clauses) :-
    (   record(Name, Handler, _)
    ->  record_payload(Name, Payload),
        Indicators = [(Handler,3)|Payload],
        body(Name, Indicators, Clauses)
    ;   wrong('There is no agent ~w here', [Name]),
        fail
    ).

written(Out, (Head:-true)) :-
    !,
    portray_clause(Out, Head).
written(Out, Clause) :-
    portray_clause(Out, Clause).

%!  save_tartarus_state(+File) is det.
%!  load_tartarus_state(+File) is semidet.
%
%   The agents of a platform.  Those that are loaded run, from `main`.

save_tartarus_state(File) :-
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        forall(record(Name, Handler, _), save(Out, Name, Handler)),
        close(Out)).

save(Out, Name, Handler) :-
    body_of(Name, [_|Payload], Clauses),
    portray_clause(Out, agent(Name, Handler, Payload, Clauses)).

load_tartarus_state(File) :-
    must([ check(ls1, 'the file exists', ( ground(File), exists_file(File) )),
           check(ls2, 'a platform has been started', here(_)) ]),
    read_file_to_terms(File, Agents, [encoding(utf8)]),
    here(Here),
    forall(member(agent(Name, Handler, Payload, Clauses), Agents),
           ( life_begin(Name, Here, Handler, [], Payload, Clauses),
             run_handler(Name, Handler, main, now) )).
