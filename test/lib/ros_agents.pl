:- module(test_ros_agents,
          [ goal_agent/2,               % +Host, -Agent
            does/4,                     % +Host, +Agent, +Goal, -Result
            does/3,                     % +Host, +Agent, +Goal
            gets/3,                     % +Host, +Agent, ?Message
            goal_error/4                % +Host, +Agent, +Goal, -Formal
          ]).
:- use_module(common).
:- use_module(library(typhon)).

/** <module> Agents that execute goals in messages, and report received
    messages

*Threading*: any thread; one at a time for each agent.
*/

%!  goal_agent(+Host, -Agent) is det.

goal_agent(Host, Agent) :-
    findall(Term, goal_agent_clause(Term), Terms),
    agent_create(clauses(Terms), Agent, [host(Host)]).

goal_agent_clause((:- agent(puppet, [state([kept/1])]))).
goal_agent_clause((main :- true)).
goal_agent_clause((on_message(_, do(Goal)) :-
                   catch(( call(Goal) -> Result = yes(Goal) ; Result = no ),
                         error(Formal, _),
                         Result = raised(Formal)),
                   self(Me),
                   leave(did(Me, Result)))).
goal_agent_clause((on_message(_, go(Host)) :- move(Host))).
goal_agent_clause((on_message(_, do_move(Host)) :-
                   catch(move(Host), error(move_refused(_, _), _), true))).
goal_agent_clause((on_message(_, end) :- dispose)).
goal_agent_clause((on_message(ros, Message) :-
                   self(Me),
                   leave(got(Me, Message)))).

%!  does(+Host, +Agent, +Goal, -Result) is det.
%!  does(+Host, +Agent, +Goal) is det.
%
%   Result is yes(Goal), `no` or raised(Formal).

does(Host, Agent, Goal, Result) :-
    agent_send(Agent, do(Goal)),
    wait_until(remote(Host, take(did(Agent, Result0))), 20),
    Result = Result0.

does(Host, Agent, Goal) :-
    does(Host, Agent, Goal, Result),
    (   Result = yes(Done)
    ->  Goal = Done
    ;   throw(error(did_not(Goal, Result), _))
    ).

%!  goal_error(+Host, +Agent, +Goal, -Formal) is det.

goal_error(Host, Agent, Goal, Formal) :-
    does(Host, Agent, Goal, Result),
    (   Result = raised(Formal0)
    ->  Formal = Formal0
    ;   throw(error(did_not_raise(Goal, Result), _))
    ).

%!  gets(+Host, +Agent, ?Message) is det.

gets(Host, Agent, Message) :-
    wait_until(remote(Host, take(got(Agent, Message))), 10).
