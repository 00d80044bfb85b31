:- module(typhon_metering, []).
:- use_module('../base/trees', [is_tree/2]).
:- use_module('../program', [fault_note/1, fault_noted/1, machine_run/3]).
:- use_module('../host', [context_set/3, quota/3, quota_any/1, quota_begin/0]).
:- use_module(turn, []).

/** <module> Turns of agents on hosts with quotas

See typhon_quotas.  An agent cannot catch that it passed a quota: it ends, with
the outcome raised(error(resource_error(What), _)).

*Threading*: in the worker that has the agent.
*/

:- multifile
    typhon_turn:bound/2,
    typhon_turn:limit_passed/1.

typhon_turn:bound(Host, typhon_metering:metered_run) :-
    quota_any(Host).

:- public metered_run/3.

metered_run(turn(Id, Host, Context), Goals, Outcome) :-
    Context = context(_, Module),
    context_set(Host, Id, Module),      % its seconds begin
    quota_begin,
    far_limit(Host),
    within_inferences(Host, Context, Goals, Outcome0),
    over(Outcome0, Outcome1),
    storable(Outcome1, Host, Outcome).

%   An agent that passes the quota of stack is interrupted long before its stack
%   is full: one that fills it to the brim while it catches all that is raised leaves no
%   space for exceptions, and then 9.0.4 ends the process.  A limit near the quota
%   would make it worse: the brim would be there sooner.

far_limit(Host) :-
    (   quota(Host, stack, Most),
        Far is 4*integer(Most),
        current_prolog_flag(stack_limit, Limit),
        Limit < Far
    ->  set_prolog_flag(stack_limit, Far)
    ;   true
    ).

within_inferences(Host, Context, Goals, Outcome) :-
    quota(Host, inferences, Most),
    !,
    call_with_inference_limit(machine_run(Context, Goals, Outcome0), Most,
                              Within),
    (   Within == inference_limit_exceeded
    ->  Outcome = over(inferences)
    ;   Outcome = Outcome0
    ).
within_inferences(_, Context, Goals, Outcome) :-
    machine_run(Context, Goals, Outcome).

over(_, over(What)) :-
    passed(What),
    !.
over(raised(inference_limit_exceeded), over(inferences)) :-
    !.
over(raised(error(resource_error(What0), _)), Outcome) :-
    !,
    quota_named(What0, What),
    Outcome = over(What).
over(raised(Ball), over(cells)) :-
    \+ is_tree(Ball, 10 000),          % printing it would never end
    !.
over(Outcome, Outcome).

%   storable(+Outcome0, +Host, -Outcome): what is kept of the agent is stored
%   as a tree, while others wait for it.

storable(Outcome0, Host, Outcome) :-
    (   kept(Outcome0, Kept),
        quota(Host, cells, Most),
        \+ is_tree(Kept, Most)
    ->  fault_note(none),
        Outcome = over(cells)
    ;   Outcome = Outcome0
    ).

kept(effect(Control, _, Goals), Control-Goals).
kept(failed, Fault) :- fault_noted(Fault).
kept(raised(_), Fault) :- fault_noted(Fault).

quota_named(program_space, state) :- !.
quota_named(What, What).

typhon_turn:limit_passed(raised(error(resource_error(What), _))) :-
    passed(What).

%   passed(-What) is semidet: once, so that it does not count against the agent
%   that runs in this thread next.

passed(What) :-
    nb_current(typhon_over, What),
    What \== none,
    nb_setval(typhon_over, none).
