:- module(typhon_named,
          [ agent_named/2,              % +Agent, -Id
            agent_once_named/2,         % +Agent, -Id
            agent_met/1                 % +Id
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../base/bounds', [bounded/2]).
:- use_module('../agent', [agent/5, agent_name/3]).
:- use_module('../travel', [agent_outcome/2, ended_agent/1, home_agents/1]).
:- use_module(questions, [agent_ask/4]).

/** <module> Agents by the names that people give them

Where only one of the agents known here is called `bob`, `bob` stands for its
id.  Known are agents that stand in this process, were born in it, or were
created from here elsewhere, and those that modules above know, as the agents
of a network.  If no living agent has the name, it stands for the last one
that has ended, as long as that is remembered.

*Threading*: any thread.
*/

%   The name under which people know it.

:- setting(met, positive_integer, 1000,
           "Agents created elsewhere that are known by their names").

:- multifile
    elsewhere/1,                % Id: an agent of another process
    ended_elsewhere/2,          % +Name, -Id: one that ended
    typhon_names:known/2.

:- dynamic
    met/2.                      % Id of an agent created elsewhere, alive
                                % or gone

typhon_names:known(agent, Id) :-
    living(Id).

%!  agent_met(+Id) is det.
%
%   Id was created from here in another process.

agent_met(Id) :-
    assertz(met(Id, alive)),
    bounded(met(_, _), typhon_named:met).

%!  agent_named(+Agent, -Id) is det.
%!  agent_once_named(+Agent, -Id) is det.
%
%   Id is Agent itself, or the only agent known here that is called Agent;
%   in agent_once_named/2, if there is none, the last one that has ended.
%
%   @error existence_error(agent, Agent); of agent_named/2 with the id of the
%   agent if Agent is the name of one that has ended
%   @error ambiguous_agent(Agent, Ids)

agent_named(Agent, Id) :-
    is_id(Agent),
    !,
    Id = Agent.
agent_named(Name, Id) :-
    must_be(atom, Name),
    living(Name, Ids),
    (   Ids == [],
        last_called(Name, Ended)
    ->  has_ended(Ended)
    ;   the_only(Ids, Name, Id)
    ).

has_ended(Id) :-
    agent_outcome(Id, _),               % the message says which
    !,
    existence_error(agent, Id).
has_ended(Id) :-
    throw(error(existence_error(agent, Id), context(_, 'it has ended'))).

agent_once_named(Agent, Id) :-
    is_id(Agent),
    !,
    Id = Agent.
agent_once_named(Name, Id) :-
    must_be(atom, Name),
    living(Name, Ids),
    (   Ids == [],
        last_called(Name, Ended)
    ->  Id = Ended
    ;   the_only(Ids, Name, Id)
    ).

last_called(Name, Id) :-
    member(Which, [ended, gone, ended_agent]),
    called(Name, Which, Ids),
    last(Ids, Id),
    !.
last_called(Name, Id) :-
    ended_elsewhere(Name, Id),
    !.

is_id(Agent) :-
    atom(Agent),
    sub_atom(Agent, _, _, _, @),
    !.

the_only([Id], _, Id) :-
    !.
the_only([], Name, _) :-
    existence_error(agent, Name).
the_only([Id|Ids], Name, _) :-
    throw(error(ambiguous_agent(Name, [Id|Ids]), _)).

%   The end of an agent that was created elsewhere is not reported here.

living(Name, Ids) :-
    called(Name, living, Ids0),
    sort(Ids0, Ids1),
    exclude(is_gone, Ids1, Ids).

is_gone(Id) :-
    met(Id, alive),
    \+ catch(agent_ask(Id, properties, 10, _), error(_, _), true),
    retract(met(Id, alive)),
    assertz(met(Id, gone)).

:- meta_predicate called(+, 1, -).

called(Name, Which, Ids) :-
    atom_concat(Name, '.', Begin),
    findall(Id,
            ( call(Which, Id),
              sub_atom(Id, 0, _, _, Begin),
              agent_name(Id, Name, _) ),
            Ids).

living(Id) :-
    agent(Id, _, _, _, _).
living(Id) :-
    home_agents(Ids),
    member(Id, Ids).
living(Id) :-
    elsewhere(Id).
living(Id) :-
    met(Id, alive).

ended(Id) :-
    agent_outcome(Id, _).

gone(Id) :-
    met(Id, gone).
