:- module(typhon_join,
          [ agent_join/3,               % +Agents, -Outcome, +Timeout
            agent_result/3              % +Agent, -Term, +Timeout
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [append/2, append/3, last/2, member/2]).
:- use_module('../wire', [endpoint_address/1]).
:- use_module('../host', [process_ask/6, time_now/1, time_wait/3]).
:- use_module('../agent', [agent/5, agent_home_endpoint/2, result_facts/2]).
:- use_module('../travel',
              [ agent_known_at/2, agent_outcome/2, clones_ask/3, results_ask/4,
                outcome_wait/3 ]).
:- use_module(questions,
              [agent_ask/4, agent_once_named/2, question_answered/2]).

/** <module> Waiting for the end of agents, and for their results

The caller asks the home of the agent, see typhon_whereabouts, which answers when it
has the outcome.  If the home is gone, or does not know the agent, the hooks
known_end/2 and known_results/2 are asked.

*Threading*: any thread.
*/

:- multifile
    known_end/2,                % Id, Outcome: an option knows how Id ended
    known_results/2,            % Id, Results: as in agent_ended/4
    typhon_questions:here/3.

%!  agent_join(+Agents, -Outcome, +Timeout) is det.
%
%   Wait until an agent has ended, wherever it is, for Timeout seconds (a
%   number or `inf`).  Outcome is `done`, `failed`, raised(Error), `disposed`
%   or `timeout`; lost(Host), after the Timeout, if the process of Host, where
%   the agent was, is known to be gone.
%
%   Agents is an agent, or family(Agent): Agent, its clones, and theirs. Then this
%   waits until the last of them has ended.  Outcome is then a list of pairs
%   Agent-Outcome, each agent before its clones, and these in the order in
%   which they were born in a process.  At the timeout the outcome of agents
%   that have not ended is `timeout`.  Outcomes that the home has discarded are
%   reported as `unknown`.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)
%   @error host_unreachable(Home), connection_lost(Home): for a family, of
%   any of its members

agent_join(Agents, Outcomes, Timeout) :-
    nonvar(Agents),
    Agents = family(Agent),
    !,
    wait_seconds(Timeout, Seconds),
    agent_once_named(Agent, Id),
    until(Seconds, Until),
    agent_join(Id, Outcome, Seconds),
    clones(Id, Outcome, Clones),
    members(Clones, Until, Others),
    Outcomes = [Id-Outcome|Others].
agent_join(Agent, Outcome, Timeout) :-
    wait_seconds(Timeout, Seconds),
    agent_once_named(Agent, Id),
    outcome_within(Id, Seconds, Outcome0),
    (   Outcome0 == unknown
    ->  existence_error(agent, Agent)
    ;   Outcome = Outcome0
    ).

wait_seconds(Timeout, inf) :-
    (   Timeout == inf
    ;   Timeout == infinite
    ;   float(Timeout),
        Timeout =:= inf
    ),
    !.
wait_seconds(Timeout, Seconds) :-
    must_be(number, Timeout),
    Seconds is max(0, Timeout).

outcome_within(Agent, Seconds, Outcome) :-
    (   agent_home_endpoint(Agent, Endpoint)
    ->  until(Seconds, Until),
        catch(join(Endpoint, Agent, Seconds, Outcome0), error(Formal, Context),
              Outcome0 = no_home(Formal, Context)),
        outcome_known(Outcome0, Agent, Until, Outcome)
    ;   Outcome = unknown
    ).

%   If the home is gone, or does not know the agent, an option may know it.

outcome_known(Outcome0, Agent, Until, Outcome) :-
    ( Outcome0 == unknown ; Outcome0 = no_home(Formal, _), is_gone(Formal) ),
    end_known(Agent, Until, Outcome1),
    !,
    Outcome = Outcome1.
outcome_known(no_home(Formal, Context), _, _, _) :-
    !,
    throw(error(Formal, Context)).
outcome_known(Outcome, _, _, Outcome).

is_gone(host_unreachable(_)).
is_gone(connection_lost(_)).

end_known(Agent, Until, Outcome) :-
    (   has_ended(Agent, Outcome0)
    ->  Outcome = Outcome0
    ;   agent_known_at(Agent, _)
    ->  seconds_left(Until, Seconds),
        (   Seconds > 0
        ->  Pause is min(0.2, Seconds),
            sleep(Pause),
            end_known(Agent, Until, Outcome)
        ;   Outcome = timeout
        )
    ;   has_ended(Agent, Outcome)       % between the two questions
    ).

has_ended(Agent, Outcome) :-
    known_end(Agent, Outcome0),
    !,
    Outcome = Outcome0.

join(Endpoint, Agent, Seconds, Outcome) :-
    home_here(Agent, Endpoint),
    !,
    setup_call_cleanup(
        message_queue_create(Queue),    % deleted even after an interrupt
        ( outcome_wait(Agent, Seconds, queue(Queue, join)),
          outcome_received(Queue, Outcome)
        ),
        message_queue_destroy(Queue)).
join(Endpoint, Agent, Seconds, Outcome) :-
    (   Seconds == inf
    ->  Limit = 1.0e9
    ;   Limit is Seconds+10
    ),
    process_ask(Endpoint, Endpoint, join, join(Agent, Seconds), Outcome,
                Limit).

%   A plain wait in the thread of virtual time would stop the time.

outcome_received(Queue, Outcome) :-
    time_wait(Queue, outcome(join, Outcome0), inf),
    !,
    Outcome = Outcome0.
outcome_received(_, timeout).

                /*******************************
                *            FAMILIES          *
                *******************************/

%   members(+Agents, +Until, -Outcomes): Outcomes are those of Agents and of
%   their clones.

members([], _, []).
members([Agent|Agents], Until, [Agent-Outcome|Outcomes]) :-
    seconds_left(Until, Seconds),
    outcome_within(Agent, Seconds, Outcome),
    clones(Agent, Outcome, Clones),
    append(Clones, Agents, Others),
    members(Others, Until, Outcomes).

until(inf, inf) :-
    !.
until(Seconds, Until) :-
    time_now(Now),
    Until is Now+Seconds.

seconds_left(inf, inf) :-
    !.
seconds_left(Until, Seconds) :-
    time_now(Now),
    Seconds is max(0, Until-Now).

clones(Agent, Outcome, Clones) :-
    results_of(Agent, Outcome, cloned, Items),
    findall(Some,
            ( member(cloned(Endpoint), Items),
              clones_ask(Endpoint, Agent, Some) ),
            Lists),
    append(Lists, Clones).

                /*******************************
                *            RESULTS           *
                *******************************/

%!  agent_result(+Agent, -Term, +Timeout) is semidet.
%
%   Wait at most Timeout seconds, a number or `inf`, until Agent has ended,
%   wherever and however.  Term is the last term that it gave with result/1.
%   Fails after a timeout.  Its home keeps the results of the last 20,000
%   agents (the setting typhon_outcomes:results).
%
%   @error existence_error(result, Agent) if it has given none
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)
%   @error host_unreachable(Home), connection_lost(Home)

agent_result(Agent, Term, Timeout) :-
    wait_seconds(Timeout, Seconds),
    agent_once_named(Agent, Id),
    agent_join(Id, Outcome, Seconds),
    \+ memberchk(Outcome, [timeout, lost(_)]),
    results_of(Id, Outcome, result, Results),
    (   last(Results, result(Result))
    ->  Term = Result
    ;   existence_error(result, Agent)
    ).

%   home_here(+Agent, +Home): the home of Agent is this process, or was when
%   this process had another endpoint.

home_here(_, Home) :-
    endpoint_address(Home),
    !.
home_here(Agent, _) :-
    agent_outcome(Agent, _).

%   results_of(+Agent, +Outcome, +Kind, -Items): the results of Agent.  If the
%   agent has not ended, or is kept because it is faulty, it answers, else its
%   home.

results_of(Agent, Outcome, Kind, Items) :-
    may_still_exist(Outcome),
    catch(agent_ask(Agent, results(Kind), 2, answer(Items0)), error(_, _),
          fail),
    !,
    Items = Items0.
results_of(Agent, _, Kind, Items) :-
    agent_home_endpoint(Agent, Home),
    ( home_here(Agent, Home) -> Where = here ; Where = Home ),
    catch(results_ask(Where, Agent, Kind, Items0), error(Formal, Context),
          Items0 = no_home(Formal, Context)),
    items_known(Items0, Agent, Kind, Items).

items_known([Item|Items], _, _, [Item|Items]) :-
    !.
items_known(_, Agent, Kind, Items) :-
    known_results(Agent, All),
    !,
    items(All, Kind, Items).
items_known(no_home(Formal, Context), _, _, _) :-
    !,
    throw(error(Formal, Context)).
items_known([], _, _, []).

items(All, Kind, Items) :-
    functor(Item, Kind, 1),
    findall(Item, member(Item, All), Items).

may_still_exist(timeout).
may_still_exist(failed).
may_still_exist(raised(_)).

typhon_questions:here(results(Kind), Agent, Asker) :-
    agent(Agent, _, Module, _, _),
    !,
    result_facts(Module, Items0),
    items(Items0, Kind, Items),
    question_answered(Asker, answer(Items)).
