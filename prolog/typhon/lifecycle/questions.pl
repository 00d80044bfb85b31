:- module(typhon_questions,
          [ agent_ask/4                 % +Agent, +Question, +Seconds, -Answer
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module('../program', [code_program/2, code_receive/2]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_call/5, endpoint_reply/2,
                mobile_term/1 ]).
:- use_module('../host', [address_parts/3, host/3]).
:- use_module('../agent',
              [ agent/5, agent_home/2, agent_id/3, agent_name/3,
                agent_state/2, agent_status/3, mail_list/2, with_agent/2 ]).
:- use_module('../travel', [hop_state/2, whereabouts/2]).
:- use_module(creation, [agent_clone_here/5, agent_start/4]).
:- use_module(running, [agent_do/2]).

/** <module> Questions and orders that find an agent

A question is put to the process in which the agent stands.  A process
that knows better says where the agent went.

*Threading*: any thread asks.  Questions of others are answered in the
reader threads, orders by the worker that has the agent.
*/

:- multifile
    typhon_endpoint:requested/4,
    typhon_hop:forward_order/2.

%!  agent_ask(+Agent, +Question, +Seconds, -Answer) is semidet.
%
%   Put Question to Agent: `properties` or order(Order).  Answer is
%   answer(Term) or error(Formal).  Fails if there is no such agent.
%
%   @error host_unreachable(Endpoint)
%   @error timeout_error(order, Agent)

agent_ask(Agent, Question, Seconds, Answer) :-
    get_time(Now),
    Deadline is Now+Seconds,
    start_endpoint(Agent, Endpoint),
    ask(Endpoint, Agent, Question, Deadline, 16, Answer).

start_endpoint(Agent, here) :-
    agent(Agent, _, _, _, _),
    !.
start_endpoint(Agent, Endpoint) :-
    (   whereabouts(Agent, Address)
    ;   agent_home(Agent, Address)
    ),
    !,
    address_parts(Address, _, Endpoint0),
    (   endpoint_address(Endpoint0)
    ->  Endpoint = here
    ;   Endpoint = Endpoint0
    ).

ask(_, Agent, Question, Deadline, 0, Answer) :-
    !,
    pause(Deadline, Agent),
    start_endpoint(Agent, Endpoint),
    ask(Endpoint, Agent, Question, Deadline, 16, Answer).
ask(Where, Agent, Question, Deadline, Left, Answer) :-
    ask_at(Where, Agent, Question, Deadline, Answer0),
    (   Answer0 = elsewhere(Endpoint)
    ->  Left1 is Left-1,
        (   endpoint_address(Endpoint)
        ->  ask(here, Agent, Question, Deadline, Left1, Answer)
        ;   ask(Endpoint, Agent, Question, Deadline, Left1, Answer)
        )
    ;   Answer0 \== none,
        Answer = Answer0
    ).

%   It runs away from us: wait a little.

pause(Deadline, Agent) :-
    get_time(Now),
    (   Now < Deadline
    ->  thread_self(Me),
        \+ thread_get_message(Me, '$typhon_never', [timeout(0.01)])
    ;   throw(error(timeout_error(order, Agent), _))
    ).

ask_at(here, Agent, Question, Deadline, Answer) :-
    !,
    setup_call_cleanup(
        message_queue_create(Queue),    % what comes too late goes with it
        ( answer(Question, Agent, queue(Queue)),
          wait_for(Queue, Deadline, Agent, Answer)
        ),
        message_queue_destroy(Queue)).
ask_at(Endpoint, Agent, Question, Deadline, Answer) :-
    get_time(Now),
    Seconds is max(0.01, Deadline-Now),
    catch(endpoint_call(Endpoint, agent, question(Agent, Question),
                        answer(Answer), Seconds),
          error(unreachable(_), _),
          throw(error(host_unreachable(Endpoint), _))).

wait_for(Queue, Deadline, Agent, Answer) :-
    (   thread_get_message(Queue, Answer0, [deadline(Deadline)])
    ->  Answer = Answer0
    ;   throw(error(timeout_error(order, Agent), _))
    ).

                /*******************************
                *            ANSWERS           *
                *******************************/

typhon_endpoint:requested(agent, Request, _Peer, ReplyTo) :-
    request(Request, ReplyTo).

request(question(Agent, Question), ReplyTo) :-
    answer(Question, Agent, reply(ReplyTo)).
request(create(HostName, Name, Start, Program), ReplyTo) :-
    catch(create(HostName, Name, Start, Program, Answer),
          error(Formal, _),
          Answer = refused(error(Formal))),
    endpoint_reply(ReplyTo, Answer).

create(HostName, Name, Start, Program, Answer) :-
    Start = start(Hash, _, _, _, _),
    (   host(HostName, Address, _)
    ->  code_receive(Hash, Program),
        agent_id(Name, Address, Id),
        agent_start(Id, HostName, Start, Answer0),
        (   Answer0 == ok
        ->  Answer = created(Id)
        ;   Answer = Answer0
        )
    ;   Answer = refused(unknown_host)
    ).

%   answer(+Question, +Agent, +Asker) is det.

answer(properties, Agent, Asker) :-
    (   with_agent(Agent, findall(P, property(P, Agent), Properties)),
        Properties \== []
    ->  tell(Asker, answer(Properties))
    ;   not_here(Agent, Asker)
    ).
answer(order(Order), Agent, Asker) :-
    (   at_once(Order)
    ->  Task = Order
    ;   Task = call(typhon_questions:carry_out(Order, Agent, Asker))
    ),
    catch(accept(Task, Agent, Accepted),
          error(Formal, _),
          Accepted = error(Formal)),
    (   Accepted == none
    ->  not_here(Agent, Asker)
    ;   at_once(Order)
    ->  tell(Asker, Accepted)
    ;   Accepted = error(_)
    ->  tell(Asker, Accepted)
    ;   true                            % answered when carried out
    ).

accept(Task, Agent, Accepted) :-
    (   agent_do(Agent, Task)
    ->  Accepted = answer(ok)
    ;   Accepted = none
    ).

at_once(move(_)).
at_once(dispose).

not_here(Agent, Asker) :-
    (   whereabouts(Agent, Address),
        address_parts(Address, _, Endpoint),
        \+ endpoint_address(Endpoint)
    ->  Answer = elsewhere(Endpoint)
    ;   agent_home(Agent, Home),
        address_parts(Home, _, Endpoint),
        \+ endpoint_address(Endpoint)
    ->  Answer = elsewhere(Endpoint)
    ;   Answer = none
    ),
    tell(Asker, Answer).

tell(queue(Queue), Answer) :-
    catch(thread_send_message(Queue, Answer),
          error(existence_error(_, _), _), true).
tell(reply(ReplyTo), Answer) :-
    endpoint_reply(ReplyTo, Answer).

%   Orders to an agent that left in the meantime follow it.

typhon_hop:forward_order(Agent, call(typhon_questions:carry_out(Order, _, Asker))) :-
    !,
    forward(Agent, Order, Asker).
typhon_hop:forward_order(Agent, Order) :-
    forward(Agent, Order, none).

forward(Agent, Order, Asker) :-
    (   catch(agent_ask(Agent, order(Order), 10, Answer), error(Formal, _),
              Answer = error(Formal))
    ->  true
    ;   Answer = none
    ),
    (   Asker \== none
    ->  tell(Asker, Answer)
    ;   Answer = error(Problem)
    ->  print_message(warning, typhon(order_failed(Agent, Problem)))
    ;   true
    ).

%   carry_out(+Order, +Agent, +Asker): in a worker, while Agent is ready.

carry_out(Order, Agent, Asker) :-
    catch(( carried_out(Order, Agent, Result),
            Answer = answer(Result)
          ),
          error(Formal, _),
          Answer = error(Formal)),
    tell(Asker, Answer).

carried_out(attach(Payload), Agent, ok) :-
    typhon_words:attach_to(Agent, Payload).
carried_out(detach(Name), Agent, ok) :-
    typhon_words:detach_from(Agent, Name).
carried_out(clone, Agent, CloneId) :-
    agent(Agent, Host, _, _, _),
    agent_status(Agent, _, Goals),
    host(Host, Address, _),
    agent_name(Agent, Name, _),
    agent_id(Name, Address, CloneId),
    agent_clone_here(Agent, CloneId, Host, Goals, Answer),
    (   Answer = refused(Reason)
    ->  throw(error(move_refused(Address, Reason), _))
    ;   true
    ).
carried_out(image, Agent,
            image(Name, Program, Life, State, Goals, Mail)) :-
    agent(Agent, _, Module, Hash, Life),
    agent_status(Agent, _, Goals),
    code_program(Hash, Program),
    agent_name(Agent, Name, _),
    agent_state(Module, State),
    mail_list(Agent, Mail),
    mobile_term(State-Goals).

                /*******************************
                *          PROPERTIES          *
                *******************************/

property(host(Address), Agent) :-
    agent(Agent, Host, _, _, _),
    host(Host, Address, _).
property(program(Name), Agent) :-
    agent(Agent, _, _, Hash, _),
    code_program(Hash, program(Name, _, _, _)).
property(state(State), Agent) :-
    agent_status(Agent, Status, _),
    shown(Status, Agent, State).
property(hops(Hops), Agent) :-
    agent(Agent, _, _, _, life(_, Hops, _, _, _, _)).
property(home(Home), Agent) :-
    agent(Agent, _, _, _, _),
    agent_home(Agent, Home).
property(goals(Goals), Agent) :-
    agent_status(Agent, _, Goals0),
    goal_list(Goals0, Goals).
property(facts(Facts), Agent) :-
    agent(Agent, _, Module, _, _),
    agent_state(Module, state(_, Clauses)),
    findall(Clause, visible(Clauses, Clause), Facts).
property(payloads(Names), Agent) :-
    agent(Agent, _, _, _, life(_, _, _, _, Payloads, _)),
    pairs_keys(Payloads, Names).

visible(Clauses, Clause) :-
    member(Clause, Clauses),
    Clause \= '$memory'(_).

shown(ready, _, running).
shown(running, _, running).
shown(arriving, _, in_transit).
shown(sleeping(_), _, sleeping).
shown(waiting(_, _), _, waiting).
shown(obeying, _, running).
shown(cloning(Host, Sent), _, State) :-
    hop_state(cloning(Host, Sent), State0),
    (   State0 == in_doubt
    ->  State = in_doubt
    ;   State = waiting
    ).
shown(resident, _, resident).
shown(leaving(_, _), _, in_transit).
shown(transit(Host, Sent), _, State) :-
    hop_state(transit(Host, Sent), State).
shown(faulty(Error), _, faulty(Error)).

goal_list(hop(Goals0, _, _, _), Goals) :- !, without_hole(Goals0, Goals).
goal_list(hop(Goals0, _), Goals) :- !, without_hole(Goals0, Goals).
goal_list(clone(Goals0-_, _, _), Goals) :- !, without_hole(Goals0, Goals).
goal_list(Goals, Goals).

without_hole(Hole-Goals0, Goals) :-
    (   Goals0 = [Goal|Goals1],
        Goal == Hole
    ->  Goals = Goals1
    ;   ignore(Hole = true),
        Goals = Goals0
    ).
