:- module(typhon_cell_acts,
          [ cell_outcome/1,             % @Outcome
            cell_fault/3,               % +Note, +Outcome, -Fault
            cell_turn_begins/0,
            cell_changes_made/3,        % +Changes, +Host, +Module
            cell_answer/5,              % +Goal, +Kind, +Host, +Agent, -Answer
            cell_stop/4,                % +Outcome0, +Host, +Agent, -Outcome
            cell_violation/1            % +What
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [permission_error/3, resource_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module('../../kernel/program', [clause_parts/3, control_use/2]).
:- use_module('../../kernel/host',
              [host/3, parts_call/3, place_service/2, security_event/2]).
:- use_module('../../kernel/agent',
              [ agent_add/2, agent_clauses/3, agent_variant/2 ]).
:- use_module('../../language/faults', [printable_fallback/2]).
:- use_module(cell_frames, [cell_word/2, state_predicate/2]).

/** <module> Checking and carrying out the messages of a cell

A cell sends outcomes, changes of the state of an agent, and goals.  None of
them is trusted: clauses are checked like those of an agent that arrives; a goal
is called only if its predicate is of the vocabulary or a service of the place,
and only if the policy lets an agent call it, also where the agent has a
predicate of that name.

*Threading*: in the worker that runs the turn of the agent.
*/

                /*******************************
                *           OUTCOMES           *
                *******************************/

%!  cell_outcome(@Outcome) is semidet.

cell_outcome(done).
cell_outcome(failed).
cell_outcome(raised(Error)) :-
    nonvar(Error),
    Error \== '$aborted',
    Error \= unwind(_).
cell_outcome(effect(Control, Hole, Goals)) :-
    var(Hole),
    nonvar(Control),
    control_use(Control, Use),
    may_come(Use),
    is_list(Goals),
    maplist(is_goal, Goals).

is_goal(Goal) :-
    var(Goal),
    !.
is_goal(Goal) :-
    callable(Goal),
    Goal \= '$fault'(_).

may_come(called(_)).
may_come(waits(_, Until)) :- number(Until).

%!  cell_fault(+Note, +Outcome, -Fault) is det.
%
%   Fault is the fault in the form of typhon_faults, without references to
%   clauses, or `none` if Note is no valid fault of Outcome.

cell_fault(note(How, fault(Goal, Goals, natives(Raising, []))), Outcome,
           How-fault(Goal, Goals, natives(Raising, []))) :-
    functor(Outcome, How, _),
    ( Goals == unknown -> true ; is_list(Goals) ),
    !.
cell_fault(_, _, none).

%!  cell_changes_made(+Changes, +Host, +Module) is semidet.
%
%   Replace the clauses of predicates of the state.  Changes is a list of
%   Name/Arity-Clauses; fails if it is not.
%
%   @error cell_violation(What) the policy forbids a change

cell_changes_made(Changes, Host, Module) :-
    is_list(Changes),
    maplist(make_change(Host, Module), Changes).

make_change(Host, Module, Change) :-
    subsumes_term(Name/Arity-_, Change),
    Change = Name/Arity-Clauses,
    atom(Name),
    between(0, 255, Arity),
    is_list(Clauses),
    functor(Head, Name, Arity),
    maplist(is_clause_of(Head), Clauses),
    catch(allowed(Module, Head, Name/Arity, Clauses, Allowed),
          error(Formal, _), cell_violation(Formal)),
    retractall(Module:Head),
    forall(member(Clause, Allowed),
           parts_call(adds_clause, Host, [Module, Clause])),
    agent_add(Allowed, Module).

is_clause_of(Head, Clause) :-
    nonvar(Clause),
    clause_parts(Clause, Head1, _),
    callable(Head1),
    \+ Head1 \= Head.

allowed(Module, Head, PI, Clauses, Allowed) :-
    (   state_predicate(Module, Head)
    ->  true
    ;   agent_variant(Module, Variant),
        typhon_agent_module:declares(Variant, PI),
        \+ '$c_current_predicate'(_, Module:Head)
    ->  dynamic(Module:PI)
    ;   cell_violation(PI)
    ),
    agent_clauses(Module, Clauses, Allowed).

                /*******************************
                *             ACTS             *
                *******************************/

%!  cell_turn_begins is det.
%
%   A turn begins in this thread: reset its count of refused requests.

cell_turn_begins :-
    nb_setval(typhon_cell_refused, 0).

%!  cell_answer(+Goal, +Kind, +Host, +Agent, -Answer) is det.
%
%   Call Goal for the agent whose turn it is.  Kind is that of cell_word/2.
%   Answer is solutions(Goals), with an empty list for the kind `tells`, or
%   raised(Error).
%
%   @error cell_violation(refused) too many requests of this turn were refused.
%   Each refusal writes a line to the audit log

cell_answer(Goal, Kind, Host, Agent, Answer) :-
    callable(Goal),
    of_policy(answer_allowed(Goal, Kind, Host, Agent, Answer), Host, Agent,
              Answer).

answer_allowed(Goal0, Kind, Host, agent(Id, _, Module, _, _), Answer) :-
    functor(Goal0, Name, Arity),
    (   may_ask(Kind, Host, Name/Arity, Of)
    ->  policy_goal(Module, Goal0, Goal),
        goal_module(Of, Host, Id, Name/Arity, Called),
        solutions(Kind, Goal, Called, Answer)
    ;   permission_error(call, sandboxed, Goal0)
    ).

%!  cell_stop(+Outcome0, +Host, +Agent, -Outcome) is det.
%
%   The agent stops with Outcome0 of cell_outcome/1.  If the policy refuses the
%   control predicate that is an error of the agent.

cell_stop(Outcome0, Host, Agent, Outcome) :-
    (   Outcome0 = effect(Control, _, _)
    ->  Agent = agent(_, _, Module, _, _),
        of_policy(( policy_goal(Module, Control, _), Outcome = Outcome0 ),
                  Host, Agent, Outcome)
    ;   Outcome = Outcome0
    ).

%   policy_goal(+Module, +Goal0, -Goal): the same check as of a goal that the
%   agent calls in this process, but of none of the agent's own predicates.

policy_goal(Module, Goal0, Goal) :-
    agent_variant(Module, Variant),
    typhon_agent_module:called(Variant, none, Goal0, [], Goal).

%   of_policy(:Goal, +Host, +Agent, -Outcome): call Goal; an error is its
%   Outcome, raised(Error), and a refusal is audited.

:- meta_predicate of_policy(0, +, +, -).

of_policy(Goal, Host, agent(Id, _, _, _, _), Outcome) :-
    catch(Goal, error(Formal, Where),
          ( note_refusal(Formal, Host, Id),
            printable_fallback(error(Formal, Where), Portable),
            Outcome = raised(Portable) )).

%   The host that refuses a move has written that to its audit log already.

note_refusal(permission_error(call, sandboxed, Goal), Host, Id) =>
    printable_fallback(Goal, Shown),
    security_event(Host, refused(Id, policy(Shown))),
    count_refusal.
note_refusal(move_refused(_, _), _, _) =>
    count_refusal.
note_refusal(_, _, _) =>
    true.

most_refused(100).

count_refusal :-
    nb_getval(typhon_cell_refused, Count),
    most_refused(Most),
    (   Count < Most
    ->  Count1 is Count+1,
        nb_setval(typhon_cell_refused, Count1)
    ;   cell_violation(refused)
    ).

most_solutions(10 000).

solutions(tells, Goal, Module, solutions([])) :-
    !,
    ignore(Module:Goal).
solutions(_, Goal, Module, solutions(Goals)) :-
    most_solutions(Most),
    More is Most+1,
    findall(Goal, limit(More, Module:Goal), Goals),
    length(Goals, Count),
    (   Count =< Most
    ->  true
    ;   resource_error(solutions)
    ).

may_ask(Kind, _, PI, vocabulary) :-
    cell_word(Kind0, PI),
    !,
    (   Kind0 == Kind
    ->  true
    ;   Kind == acts,
        memberchk(Kind0, [fixed,tells,looks])
    ).
may_ask(acts, Host, PI, place(Place)) :-
    host(Host, _, Place),
    place_service(Place, PI),
    !.

goal_module(vocabulary, _, _, _, typhon_vocabulary).
goal_module(place(Place), Host, Id, PI, Place) :-
    parts_call(acts, Host, [Id, service(PI)]).

%!  cell_violation(+What).
%
%   Raise the error by which the gatekeeper ends a cell, and with it the agent.
%
%   @error cell_violation(What) the cell has broken the protocol or a limit

cell_violation(What) :-
    throw(error(cell_violation(What), _)).
