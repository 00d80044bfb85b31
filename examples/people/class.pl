% A class votes, elects a speaker and sorts; people answer by their links:
%     swipl examples/people/class.pl -- anna ben carla
% With --bind=0.0.0.0 --advertise=ADDRESS also by phones, and with --qr.

:- use_module('../../prolog/typhon').   % library(typhon), once installed
:- use_module(start).
:- initialization(main, main).

:- prolog_load_context(directory, Dir),
   assertz(user:file_search_path(people, Dir)).

main :-
    current_prolog_flag(argv, Argv),
    begin(Argv, Names),
    ring(Names),
    vote,
    elect(Names),
    order,
    finish(Names).

%   The fact next(Host) makes a ring of the hosts of the people.

ring(Names) :-
    Names = [First|Rest],
    append(Rest, [First], Nexts),
    maplist(followed_by, Names, Nexts).

followed_by(Name, Next) :-
    host_property(Next, address(Address)),
    remote(Name, leave(next(Address))).

vote :-
    agent_create(people(vote), Agent,
                 [ host(desk), facts([ question("Where shall we go?"),
                                       choices([lake, museum, forest]) ]) ]),
    prints(vote, Agent).

elect(Names) :-
    Facts = facts([question("How many letters has your longest word?")]),
    findall(Agent,
            ( member(Name, Names),
              agent_create(people(elect), Agent, [host(Name), Facts]) ),
            Agents),
    findall(Agent, ( member(Agent, Agents), agent_join(Agent, done, inf) ),
            [Speaker]),
    prints(speaker, Speaker).

order :-
    agent_create(people(order), Agent,
                 [ host(desk), facts([things([tea, milk, juice, water])]) ]),
    prints(order, Agent).

prints(What, Agent) :-
    agent_result(Agent, Result, inf),
    format("~w: ~w~n", [What, Result]).
