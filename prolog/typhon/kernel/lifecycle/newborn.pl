:- module(typhon_newborn,
          [ newborn_state/6,            % +Options, +Declared, +Initial, +Clauses,
                                        % -Life, -State
            newborn_goals/3             % +Clauses, +Initial, -Goals
          ]).
:- use_module(library(apply), [foldl/4, maplist/2]).
:- use_module(library(error), [must_be/2, permission_error/3]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(option), [option/3]).
:- use_module('../program', [clause_parts/3, payload_load/2]).
:- use_module('../agent', [make_life/5, not_carried/2, payload_marks/2]).

/** <module> What a new agent begins with

That is what its program declares, and what the options of agent_create/3 add.

*Threading*: pure, but payloads are read from files.
*/

%!  newborn_state(+Options, +Declared, +Initial, +Clauses, -Life, -State) is det.
%
%   Options are those of agent_create/3; the program declares the predicates
%   Declared as state, with the clauses Initial, and has Clauses.  State is
%   state(PIs, StateClauses).
%
%   @error existence_error(state, PI, Declared)
%   @error permission_error(attach, procedure, PI)
%   @error permission_error(attach, payload, Name)

newborn_state(Options, Declared, Initial, Clauses, Life,
              state(PIs, StateClauses)) :-
    option(tokens(Tokens), Options, []),
    option(lifetime(Lifetime), Options, inf),
    option(static(Static), Options, false),
    option(facts(Facts), Options, []),
    option(payloads(Specs), Options, []),
    append(Initial, Facts, StateClauses0),
    foldl(add_payload(Clauses), Specs, []-(Declared-StateClauses0),
          Payloads-(PIs-StateClauses)),
    maplist(initial_fact(Clauses, PIs), Facts),
    make_life(Lifetime, Tokens, Payloads, Static, Life).

initial_fact(Clauses, PIs, Fact) :-
    clause_parts(Fact, Head, _),
    must_be(callable, Head),
    functor(Head, Name, Arity),
    not_static(Clauses, Name/Arity),
    (   memberchk(Name/Arity, PIs)
    ->  true
    ;   throw(error(existence_error(state, Name/Arity, PIs), _))
    ).

not_static(Clauses, Name/Arity) :-
    functor(General, Name, Arity),
    (   member(Clause, Clauses),
        clause_parts(Clause, General, _)
    ->  permission_error(attach, procedure, Name/Arity)
    ;   true
    ).

add_payload(Clauses, Spec, Payloads-(PIs0-State0),
            [Name-New|Payloads]-(PIs-State)) :-
    payload_load(Spec, Payload),
    Payload = payload(Name, New, More),
    maplist(not_static(Clauses), New),
    maplist(not_among(PIs0), New),
    not_carried(Name, Payloads),
    append(PIs0, New, PIs),
    payload_marks(Payload, Marks),
    append([State0, More, Marks], State).

not_among(PIs, PI) :-
    (   memberchk(PI, PIs)
    ->  permission_error(attach, procedure, PI)
    ;   true
    ).

%!  newborn_goals(+Clauses, +Initial, -Goals) is det.
%
%   [main] if its program or its initial state defines main/0.

newborn_goals(Clauses, Initial, Goals) :-
    (   member(All, [Clauses,Initial]),
        member(Clause, [main,(main:-_)]),
        memberchk(Clause, All)
    ->  Goals = [main]
    ;   Goals = []
    ).
