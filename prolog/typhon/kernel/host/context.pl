:- module(typhon_context,
          [ context_set/3,              % +Host, +Agent, +Module
            context_clear/0,
            context/3,                  % -Host, -Agent, -Module
            context_now/2,              % ?Host, -Agent
            context_host/1,             % -Host
            context_agent/1,            % -Agent
            in_context/2                % +Host, :Goal
          ]).

:- use_module(turns, [turn_begins/1]).

/** <module> The running agent and its host

While a worker runs an agent, or a thread runs a goal in the place of a
host, the vocabulary has to know the host and the agent.

*Threading*: a global variable, so local to each thread.
*/

:- meta_predicate in_context(+, 0).

%!  context_set(+Host, +Agent, +Module) is det.
%!  context_clear is det.
%
%   The running agent: its host, id and module.

context_set(Host, Agent, Module) :-
    nb_linkval(typhon_context, context(Host, Agent, Module)),  % new, ground
    turn_begins(Agent).

context_clear :-
    nb_linkval(typhon_context, none).

%!  context_now(?Host, -Agent) is semidet.
%
%   The running agent, `none` for another goal on Host.  Fails if there is
%   none.

context_now(Host, Agent) :-
    nb_current(typhon_context, context(Host, Agent, _)).

%!  context(-Host, -Agent, -Module) is det.
%
%   @error existence_error(running_agent, here)

context(Host, Agent, Module) :-
    (   nb_current(typhon_context, context(Host, Agent, Module)),
        Agent \== none
    ->  true
    ;   throw(error(existence_error(running_agent, here),
                    context(_, 'only an agent can do this')))
    ).

%!  context_agent(-Agent) is det.

context_agent(Agent) :-
    context(_, Agent, _).

%!  context_host(-Host) is det.
%
%   @error existence_error(host, here)

context_host(Host) :-
    (   context_now(Host, _)
    ->  true
    ;   throw(error(existence_error(host, here),
                    context(_, 'only an agent or remote/2 can do this')))
    ).

%!  in_context(+Host, :Goal) is semidet.
%
%   Run Goal once on Host, not as an agent.

in_context(Host, Goal) :-
    (   nb_current(typhon_context, Old)
    ->  true
    ;   Old = none
    ),
    setup_call_cleanup(
        nb_setval(typhon_context, context(Host, none, none)),
        once(Goal),
        nb_setval(typhon_context, Old)).
