% A supervisor and two workers, one of which ends.  swipl examples/supervisor.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- initialization(main, main).

main :-
    set_prolog_flag(verbose, silent),   % do not print what agents log
    host_start(alpha),
    worker(Worker),
    user(User),
    agent_create(User, Agent, [host(alpha), facts([program(Worker)])]),
    agent_join(Agent, done, 10).

worker(clauses(
    [ (:- agent(worker, [state([post/2])])),
      (main :- post(User, Side), send(User, ready(Side)), receive(_-stop))
    ])).

% The supervisor restarts a child whatever its outcome: it is permanent.

user(clauses(
    [ (:- agent(user, [state([program/1])])),
      (main :-
           self(Me),
           program(Worker),
           create(agents(supervisor), Supervisor,
                  [facts([child(left, Worker, [facts([post(Me, left)])]),
                          child(right, Worker, [facts([post(Me, right)])])])]),
           receive(Left-ready(left)),
           receive(_-ready(right)),
           send(Left, stop),
           receive(Next-ready(left)),
           format("~w ends, ~w takes its place~n", [Left, Next]),
           monitor(Supervisor),
           send(Supervisor, stop),
           receive(system-down(Supervisor, Outcome)),
           format("The supervisor ends: ~w~n", [Outcome]))
    ])).
