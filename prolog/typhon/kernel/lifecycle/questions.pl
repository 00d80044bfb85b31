:- module(typhon_questions,
          [ agent_ask/4,                % +Agent, +Question, +Seconds, -Answer
            agent_ask_here/4,           % +Agent, +Question, +Seconds, -Answer
            agent_urge/4,               % +Agent, +Question, +Seconds, -Answer
            question_answered/2         % +Asker, +Answer
          ]).
:- use_module('../base/on_demand',
              [on_demand_later/1, on_demand_load/2, on_demand_missing/2]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_reply/2]).
:- use_module('../host',
              [ address_parts/3, peer_may/3, process_ask/6, security_event/3,
                time_now/1, time_wait/3 ]).
:- use_module('../agent', [agent/5, agent_home_endpoint/2]).
:- use_module('../travel', [whereabouts/2]).

/** <module> Questions that find an agent

A question is put to the process in which the agent stands.  A process
that knows better says where the agent went.  What can be asked is defined
by clauses for the hook here/3: properties and orders.

*Threading*: any thread asks.  Questions of others are answered in the
reader threads, which never wait.
*/

:- meta_predicate answer_of(+, 1, +, -).

:- multifile
    here/3,                     % Question, Agent, Asker
    typhon_endpoint:requested/4,
    typhon_transfer:answered/2.

%   here(+Question, +Agent, +Asker) is semidet: fails if Agent does not stand
%   in this process.  Else Asker gets the answer, then or later.

%!  agent_ask(+Agent, +Question, +Seconds, -Answer) is semidet.
%!  agent_ask_here(+Agent, +Question, +Seconds, -Answer) is semidet.
%!  agent_urge(+Agent, +Question, +Seconds, -Answer) is semidet.
%
%   Put Question to Agent.  Answer is answer(Term) or error(Formal).  Fails if
%   there is no such agent; agent_ask_here/4 also if it is not in this process.
%   agent_urge/4 waits by the time of day, even where time is virtual, and does
%   not let it run.
%
%   @error host_unreachable(Endpoint)
%   @error timeout_error(order, Agent)

agent_ask(Agent, Question, Seconds, Answer) :-
    time_now(Now),
    Deadline is Now+Seconds,
    ask(Agent, Question, by(Deadline), Answer).

agent_ask_here(Agent, Question, Seconds, Answer) :-
    time_now(Now),
    Deadline is Now+Seconds,
    answer_of(Agent, here(Question, Agent), by(Deadline), Answer).

agent_urge(Agent, Question, Seconds, Answer) :-
    get_time(Now),
    Deadline is Now+Seconds,
    ask(Agent, Question, by_day(Deadline), Answer).

ask(Agent, Question, Deadline, Answer) :-
    start_endpoint(Agent, Endpoint),
    ask(Endpoint, Agent, Question, Deadline, 16, Answer).

start_endpoint(Agent, here) :-
    agent(Agent, _, _, _, _),
    !.
start_endpoint(Agent, Endpoint) :-
    (   whereabouts(Agent, Address)
    ->  address_parts(Address, _, Endpoint0)
    ;   agent_home_endpoint(Agent, Endpoint0)
    ),
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
    seconds_left(Deadline, Seconds),
    (   Seconds > 0
    ->  thread_self(Me),
        \+ thread_get_message(Me, '$typhon_never', [timeout(0.01)])
    ;   throw(error(timeout_error(order, Agent), _))
    ).

ask_at(here, Agent, Question, Deadline, Answer) :-
    !,
    answer_of(Agent, answer(Question, Agent), Deadline, Answer).
ask_at(Endpoint, Agent, Question, Deadline, Answer) :-
    seconds_left(Deadline, Left),
    Seconds is max(0.01, Left),
    process_ask(Endpoint, Endpoint, agent, question(Agent, Question), Answer,
                Seconds).

%   answer_of(+Agent, :Asks, +Deadline, -Answer): call(Asks, Asker) asks it.

answer_of(Agent, Asks, Deadline, Answer) :-
    setup_call_cleanup(
        message_queue_create(Queue),    % what comes too late goes with it
        ( call(Asks, queue(Queue)),
          wait_for(Queue, Deadline, Agent, Answer)
        ),
        message_queue_destroy(Queue)).

wait_for(Queue, Deadline, Agent, Answer) :-
    (   answered_by(Deadline, Queue, Answer0)
    ->  Answer = Answer0
    ;   throw(error(timeout_error(order, Agent), _))
    ).

answered_by(by(Stamp), Queue, Answer) :-
    time_wait(Queue, Answer, Stamp).
answered_by(by_day(Stamp), Queue, Answer) :-
    thread_get_message(Queue, Answer, [deadline(Stamp)]).

seconds_left(by(Stamp), Seconds) :-
    time_now(Now),
    Seconds is Stamp-Now.
seconds_left(by_day(Stamp), Seconds) :-
    get_time(Now),
    Seconds is Stamp-Now.

                /*******************************
                *            ANSWERS           *
                *******************************/

typhon_endpoint:requested(agent, question(Agent, Question), Peer, ReplyTo) :-
    (   agent(Agent, Host, _, _, _),
        right_for(Question, Right),
        \+ may_ask(Right, Peer, Host, Agent, Question)
    ->  endpoint_reply(ReplyTo, error(permission_error(Right, agent, Agent)))
    ;   answer(Question, Agent, reply(ReplyTo))
    ).

right_for(order(_), Right) => Right = orders.
right_for(dispose, Right) => Right = orders.
right_for(force, Right) => Right = orders.
right_for(_, Right) => Right = inspect.

may_ask(Right, Peer, Host, Agent, Question) :-
    peer_may(Peer, Host, Right),
    (   Right == orders
    ->  security_event(Host, Peer, order(Agent, Question))
    ;   true
    ).

answer(Question, Agent, Asker) :-
    (   here(Question, Agent, Asker)
    ->  true
    ;   answered_later(Question, Agent, Asker)
    ->  true
    ;   not_here(Agent, Asker)
    ).

%   A worker loads the code that answers.

answered_later(Question, Agent, Asker) :-
    functor(Question, Kind, _),
    on_demand_missing(question, Kind),
    on_demand_later(typhon_questions:load_and_answer(Kind, Question, Agent,
                                                     Asker)).

:- public load_and_answer/4.            % goal of a worker

load_and_answer(Kind, Question, Agent, Asker) :-
    on_demand_load(question, Kind),
    answer(Question, Agent, Asker).

not_here(Agent, Asker) :-
    (   whereabouts(Agent, Address),
        address_parts(Address, _, Endpoint),
        \+ endpoint_address(Endpoint)
    ->  Answer = elsewhere(Endpoint)
    ;   agent_home_endpoint(Agent, Endpoint),
        \+ endpoint_address(Endpoint)
    ->  Answer = elsewhere(Endpoint)
    ;   Answer = none
    ),
    question_answered(Asker, Answer).

%!  question_answered(+Asker, +Answer) is det.

question_answered(queue(Queue), Answer) :-
    catch(thread_send_message(Queue, Answer),
          error(existence_error(_, _), _), true).
question_answered(reply(ReplyTo), Answer) :-
    endpoint_reply(ReplyTo, Answer).

typhon_transfer:answered(Asker, Answer) :-
    question_answered(Asker, Answer).
