:- module(typhon_source_view,
          [ agent_listing/1,            % +Agent
            goals_shown/5,              % +Agent, +Facts, +Goals, -Shown,
                                        % -Program
            goal_named/4                % +Clauses, +Lists, +Goal, -Named
          ]).
:- autoload('source_view/listing', [list_agent/1, show_goals/5]).
:- autoload('source_view/variable_names', [name_goal/4]).

/** <module> Source view: goals of agents in the text of their programs

The layer finds the clause from which a goal comes, and the names of its
variables in that clause.  This is its interface.  Its modules are loaded when
an agent is listed, or becomes faulty.

*Threading*: any thread.
*/

%!  agent_listing(+Agent) is det.
%
%   Print the program of Agent, with the names of variables if it was read from
%   a file, its facts, and its remaining goals, as clauses.  An arrow marks the
%   next goal; if several clauses end in the same way, each of them has an
%   arrow.  The goals of a running agent are not known, see agent_step/1.
%
%   @error existence_error(agent, Agent)

agent_listing(Agent) :-
    list_agent(Agent).

%!  goals_shown(+Agent, +Facts, +Goals, -Shown, -Program:string) is det.
%
%   Shown are Goals, the remaining goals of Agent, which has these Facts, with
%   '$VAR'(Name) for variables whose names in the program are known.  Program is
%   the part of agent_listing/1 with the declarations and the clauses.
%
%   @error existence_error(agent, Agent)

goals_shown(Agent, Facts, Goals, Shown, Program) :-
    show_goals(Agent, Facts, Goals, Shown, Program).

%!  goal_named(+Clauses, +Lists, +Goal, -Named) is det.
%
%   Named is Goal with '$VAR'(Name) for variables, if all clauses that could
%   have called Goal agree on their names.  Lists has the names of variables of
%   the first clauses of Clauses, one list for each clause.

goal_named(Clauses, Lists, Goal, Named) :-
    name_goal(Clauses, Lists, Goal, Named).
