:- module(typhon_metering,
          [ metered_run/4,              % +Where, +Context, +Goals, -Outcome
            metered_ball/1              % -Outcome
          ]).
:- use_module('../base/trees', [is_tree/2]).
:- use_module('../program', [machine_run/3]).
:- use_module('../host', [context_set/3, quota/3, quota_any/1]).

/** <module> Agents run within what they may use

See typhon_quotas.  A quota that is passed is not the agent's to catch: it
ends, with the outcome raised(error(resource_error(What), _)).

*Threading*: in the worker that has the agent.
*/

%!  metered_run(+Where, +Context, +Goals, -Outcome) is det.
%
%   As machine_run/3 for Where, Id-Host; Outcome may be over(What), too.

metered_run(_-Host, Context, Goals, Outcome) :-
    \+ quota_any(Host),
    !,
    machine_run(Context, Goals, Outcome).
metered_run(Id-Host, Context, Goals, Outcome) :-
    Context = context(_, Module),
    context_set(Host, Id, Module),      % its seconds begin
    nb_setval(typhon_over, none),
    far_limit(Host),
    within_inferences(Host, Context, Goals, Outcome0),
    over(Outcome0, Outcome).

%   Who passes the quota of stack is interrupted long before its stack is full: an
%   agent that fills it to the brim while it catches all that is raised leaves no
%   room for exceptions, and then 9.0.4 ends the process.  A limit near the quota
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

%   What it has passed is not said of who runs in this thread after it.

over(_, over(What)) :-
    metered_ball(raised(error(resource_error(What), _))),
    !.
over(raised(inference_limit_exceeded), over(inferences)) :-
    !.
over(raised(error(resource_error(What0), _)), Outcome) :-
    !,
    quota_named(What0, What),
    Outcome = over(What).
over(raised(Ball), over(cells)) :-
    \+ is_tree(Ball, 10 000),          % nobody could print it
    !.
over(Outcome, Outcome).

quota_named(program_space, state) :- !.
quota_named(What, What).

%!  metered_ball(-Outcome) is semidet.
%
%   Who was interrupted in this thread had passed a quota.

metered_ball(raised(error(resource_error(What), _))) :-
    nb_current(typhon_over, What),
    What \== none,
    nb_setval(typhon_over, none).
