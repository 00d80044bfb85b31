% People are the robots of an allocation; two chores find whom they need:
%     swipl examples/people/chores.pl -- anna ben carla
% Options are those of class.pl.

:- use_module('../../prolog/typhon').   % library(typhon), once installed
:- use_module(agents(allocation/operator)).
:- use_module(start).
:- initialization(main, main).

main :-
    current_prolog_flag(argv, Argv),
    begin(Argv, Names),
    maplist(profile, Names, Profiles),
    maplist(robot, Names, Profiles),
    chore(wipe, [1-[tall]], "Please wipe the board.", Wipe),
    chore(carry, [2-[]], "Please carry the table, both of you.", Carry),
    forall(member(Name-Agent, [wipe-Wipe, carry-Carry]),
           ( agent_join(Agent, done, inf),
             format("~w: done~n", [Name]) )),
    finish(Names).

%   Each person says what an allocator may ask for.

profile(Name, Agent) :-
    agent_create(clauses([ (:- agent(profile, [])),
                           (main :- choose("Do you reach the top of the board?",
                                           [yes, no], Answer),
                                    result(Answer)) ]),
                 Agent, [host(Name)]).

robot(Name, Profile) :-
    agent_result(Profile, Answer, inf),
    ( Answer == yes -> Properties = [tall] ; Properties = [] ),
    host_property(Name, address(Host)),
    robot_start(Host, Properties, []).

chore(Name, Teams, Text, Agent) :-
    Goal = choose(Text, [done], done),
    task_allocate(task(Name, Teams, [goal(Goal)]), desk, [], Agent).
