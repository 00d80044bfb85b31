:- module(typhon_source_view,
          [ agent_listing/1,            % +Agent
            goals_shown/4,              % +Agent, +Facts, +Goals, -Shown
            goal_named/4                % +Clauses, +Lists, +Goal, -Named
          ]).
:- autoload('source_view/listing', [list_agent/1, show_goals/4]).
:- autoload('source_view/variable_names', [name_goal/4]).

/** <module> Agents as their programs have them

Which clause a goal comes from, and what its variables are called there.
This is the interface of the layer.  Its modules are loaded when an agent is
listed, or when one is faulty.

*Threading*: any thread.
*/

%!  agent_listing(+Agent) is det.
%
%   Print the program of Agent, with the names of variables if it was read from
%   a file, its facts, and the goals that it has left, as
%   clauses.  An arrow marks the goal at which it stands; where several
%   clauses would go on in the same way, each of them.  Of an agent that runs
%   at this moment the goals are not known, see agent_step/1.
%
%   @error existence_error(agent, Agent)

agent_listing(Agent) :-
    list_agent(Agent).

%!  goals_shown(+Agent, +Facts, +Goals, -Shown) is det.
%
%   Shown are Goals, which Agent with these Facts has left, with '$VAR'(Name)
%   for variables whose names in the program are known.
%
%   @error existence_error(agent, Agent)

goals_shown(Agent, Facts, Goals, Shown) :-
    show_goals(Agent, Facts, Goals, Shown).

%!  goal_named(+Clauses, +Lists, +Goal, -Named) is det.
%
%   Named is Goal with '$VAR'(Name) for variables, if all the clauses that could
%   have called it agree on their names.  Lists are the names of the variables
%   of each of the first of Clauses.

goal_named(Clauses, Lists, Goal, Named) :-
    name_goal(Clauses, Lists, Goal, Named).
