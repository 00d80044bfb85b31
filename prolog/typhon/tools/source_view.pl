:- module(typhon_source_view,
          [ agent_listing/1,            % +Agent
            goals_shown/4,              % +Agent, +Facts, +Goals, -Shown
            goal_named/4                % +Clauses, +Lists, +Goal, -Named
          ]).
:- autoload('source_view/listing', [list_agent/1, show_goals/4]).
:- autoload('source_view/variable_names', [name_goal/4]).

/** <module> Source view: goals of agents in the text of their programs

The modules find the clause that a goal comes from, and the names that its
variables have there.  This is the interface of the layer.  Its modules are
loaded when an agent is listed, or when one is faulty.

*Threading*: any thread.
*/

%!  agent_listing(+Agent) is det.
%
%   Print the program of Agent, with the names of variables if it was read from
%   a file, its facts, and its remaining goals, as clauses.  An arrow marks the
%   next goal; if several clauses end in the same way, there is one in each of
%   them. The goals of an agent that is running are not known, see agent_step/1.
%
%   @error existence_error(agent, Agent)

agent_listing(Agent) :-
    list_agent(Agent).

%!  goals_shown(+Agent, +Facts, +Goals, -Shown) is det.
%
%   Shown are Goals, the remaining goals of Agent, which has these Facts, with
%   '$VAR'(Name) for variables whose names in the program are known.
%
%   @error existence_error(agent, Agent)

goals_shown(Agent, Facts, Goals, Shown) :-
    show_goals(Agent, Facts, Goals, Shown).

%!  goal_named(+Clauses, +Lists, +Goal, -Named) is det.
%
%   Named is Goal with '$VAR'(Name) for variables, if all the clauses that could
%   have called it agree on their names.  Lists are lists of the names of
%   variables, for the first of Clauses.

goal_named(Clauses, Lists, Goal, Named) :-
    name_goal(Clauses, Lists, Goal, Named).
