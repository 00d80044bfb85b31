:- module(typhon_join,
          [ agent_join/3                % +Agent, -Outcome, +Timeout
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module('../wire', [endpoint_address/1]).
:- use_module('../host', [process_ask/6, time_wait/3]).
:- use_module('../agent', [agent_home_endpoint/2]).
:- use_module('../travel', [agent_outcome/2, outcome_wait/3]).
:- use_module(named, [agent_once_named/2]).

/** <module> Waiting for the end of an agent

Its home is asked, see typhon_home, which answers when it knows.

*Threading*: any thread.
*/

%!  agent_join(+Agent, -Outcome, +Timeout) is det.
%
%   Wait until Agent has ended, wherever it is, for Timeout seconds (a
%   number or `inf`).  Outcome is `done`, `failed`, raised(Error),
%   `disposed` or `timeout`.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)
%   @error host_unreachable(Home), connection_lost(Home)

agent_join(Agent, Outcome, Timeout) :-
    agent_once_named(Agent, Id),
    (   Timeout == infinite
    ->  Seconds = inf
    ;   Timeout == inf
    ->  Seconds = inf
    ;   must_be(number, Timeout),
        Seconds is max(0, Timeout)
    ),
    (   agent_home_endpoint(Id, Endpoint)
    ->  join(Endpoint, Id, Seconds, Outcome0)
    ;   Outcome0 = unknown
    ),
    (   Outcome0 == unknown
    ->  existence_error(agent, Agent)
    ;   Outcome = Outcome0
    ).

join(Endpoint, Agent, Seconds, Outcome) :-
    (   endpoint_address(Endpoint)
    ;   agent_outcome(Agent, _)
    ),
    !,
    setup_call_cleanup(
        message_queue_create(Queue),    % who is interrupted leaves nothing
        ( outcome_wait(Agent, Seconds, queue(Queue, join)),
          time_wait(Queue, outcome(join, Outcome), inf)
        ),
        message_queue_destroy(Queue)).
join(Endpoint, Agent, Seconds, Outcome) :-
    (   Seconds == inf
    ->  Limit = 1.0e9
    ;   Limit is Seconds+10
    ),
    process_ask(Endpoint, Endpoint, join, join(Agent, Seconds), Outcome,
                Limit).
