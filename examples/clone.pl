% An agent sends a clone to every neighbour.      swipl examples/clone.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- initialization(main, main).

main :-
    host_start(base),
    forall(member(Host, [north, east, south]),
           ( host_start(Host), link(base, Host) )),
    scout(Program),
    agent_create(Program, Agent, [host(base)]),
    agent_join(Agent, done, 10).

% clone/2 is like fork: both agents continue after it; Who distinguishes them.

scout(clauses(
    [ (:- agent(scout, [])),

      (main :-
           neighbours(Hosts),
           scout(Hosts),
           await(Hosts)),

      scout([]),
      (scout([Host|Hosts]) :-
           clone(Host, Who),
           (   Who = clone(Parent)
           ->  here(Here),              % on Host: its last goals
               send(Parent, arrived(Here)),
               dispose
           ;   scout(Hosts)
           )),

      await([]),
      (await([_|More]) :-
           receive(From-arrived(Host)),
           format("~w is at ~w~n", [From, Host]),
           await(More))
    ])).
