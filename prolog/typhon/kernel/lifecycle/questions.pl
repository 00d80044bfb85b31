:- module(typhon_questions,
          [ agent_ask/4,                % +Agent, +Question, +Seconds, -Answer
            agent_asked/4,              % +Agent, +Question, +Seconds, -Term
            agent_ask_here/4,           % +Agent, +Question, +Seconds, -Answer
            agent_urge/4,               % +Agent, +Question, +Seconds, -Answer
            question_answered/2,        % +Asker, +Answer
            agent_named/2,              % +Agent, -Id
            agent_once_named/2,         % +Agent, -Id
            agent_met/1,                % +Id
            agent_move/2,               % +Agent, +Host
            agent_move/3,               % +Agent, +Host, +Options
            agent_clone/2,              % +Agent, -Clone
            payload_attach/2,           % +Agent, +Payload
            payload_detach/2,           % +Agent, +Name
            agent_resume/1,             % +Agent
            order_give/3,               % +Agent, +Order, -Result
            agent_answer/3,             % +Agent, +Question, -Answer
            agent_send/2                % +Agent, +Message
          ]).

/** <module> Questions and orders find an agent, by its id or its name

A question is sent to the process in which the agent is believed to be.  A
process from which the agent has left answers with its next location.  The
clauses of the hook here/3 define the questions: properties and orders.

Where only one of the agents known here is called `bob`, `bob` stands for its
id.  Agents are known here if they are in this process, were born in it, or
were created from here elsewhere, and also if modules above know them, such as
the agents of a network.  If no living agent has the name, it stands for the
last ended agent of that name, as long as that is remembered.

An order is sent as a question, so that it finds the agent; orders.pl describes
how the agent takes it.

*Threading*: any thread asks.  Reader threads, which never wait, answer the
questions of other processes.
*/

:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(option), [option/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../agent', [agent/5, agent_home_endpoint/2, agent_name/3]).
:- use_module('../base/bounds', [bounded/3]).
:- use_module('../base/durable', [sync_after/1]).
:- use_module('../base/error_text', [harmless_error/2]).
:- use_module('../base/monotonic', [monotonic_time/1, wait_before/2]).
:- use_module('../base/on_demand',
              [on_demand_later/1, on_demand_load/2, on_demand_part/2]).
:- use_module('../base/options', [check_options/2]).
:- use_module('../host',
              [ address_parts/3, as_guest/1, context_now/2, host_address/2,
                process_ask/6, time_now/1, time_wait/3 ]).
:- use_module('../program', [payload_load/2]).
:- use_module('../travel',
              [ agent_outcome/2, agent_resumed_from/3, ended_agent/1,
                home_agents/1, post/3, post_via/4, whereabouts/2 ]).
:- use_module('../wire', [endpoint_address/1, endpoint_reply/2]).

:- setting(met, positive_integer, 1000,
           "Agents created elsewhere that are known by their names").

:- meta_predicate
    answer_of(+, 1, +, -),
    called(+, 1, -).

:- dynamic
    met/2.                              % Id of an agent created elsewhere, alive
                                        % or gone

:- multifile
    here/3,                             % Question, Agent, Asker
    typhon_endpoint:requested/4,
    typhon_transfer:answered/2,
    elsewhere/1,                        % Id: an agent of another process
    ended_elsewhere/2,                  % +Name, -Id: an agent that ended
    typhon_names:known/2,
    attach_order/2,                     % Payload, Order: attaches Payload
    typhon_options:declared/4.

:- public
    load_and_answer/4.                  % goal of a worker

%   here(+Question, +Agent, +Asker) is semidet: answer Question to Asker, at
%   once or later.  Fails if Agent is not in this process.

%!  agent_ask(+Agent, +Question, +Seconds, -Answer) is semidet.
%
%   Ask Agent.  Answer is answer(Term) or error(Formal).  Fails if there is no
%   such agent.
%
%   @error host_unreachable(Endpoint)
%   @error timeout_error(order, Agent)

agent_ask(Agent, Question, Seconds, Answer) :-
    time_now(Now),
    Deadline is Now+Seconds,
    ask(Agent, Question, by(Deadline), Answer).

%!  agent_asked(+Agent, +Question, +Seconds, -Term) is semidet.
%
%   As agent_ask/4, but an error that is the answer is raised.

agent_asked(Agent, Question, Seconds, Term) :-
    agent_ask(Agent, Question, Seconds, Answer),
    answer_term(Answer, Term).

answer_term(answer(Term), Term).
answer_term(error(Formal), _) :-
    harmless_error(error(Formal, _), Ball),
    throw(Ball).

%!  agent_ask_here(+Agent, +Question, +Seconds, -Answer) is semidet.
%
%   As agent_ask/4, but fails also if the agent is not in this process.

agent_ask_here(Agent, Question, Seconds, Answer) :-
    time_now(Now),
    Deadline is Now+Seconds,
    answer_of(Agent, here(Question, Agent), by(Deadline), Answer).

%!  agent_urge(+Agent, +Question, +Seconds, -Answer) is semidet.
%
%   As agent_ask/4, but waits by real time even where time is virtual,
%   and does not let virtual time run.

agent_urge(Agent, Question, Seconds, Answer) :-
    monotonic_time(Now),
    Deadline is Now+Seconds,
    ask(Agent, Question, by_day(Deadline), Answer).

ask(Agent, Question, Deadline, Answer) :-
    start_endpoint(Agent, Endpoint),
    ask(Endpoint, Agent, Question, Deadline, 16, Answer).

start_endpoint(Agent, here) :-
    agent(Agent, _, _, _, _),
    !.
start_endpoint(Agent, Endpoint) :-
    probably_at(Agent, Endpoint0),
    !,
    or_here(Endpoint0, Endpoint).

probably_at(Agent, Endpoint) :-
    whereabouts(Agent, Address),
    address_parts(Address, _, Endpoint).
probably_at(Agent, Endpoint) :-
    agent_home_endpoint(Agent, Endpoint).

or_here(Endpoint0, Endpoint) :-
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
        or_here(Endpoint, Next),
        ask(Next, Agent, Question, Deadline, Left1, Answer)
    ;   Answer0 \== none,
        Answer = Answer0
    ).

%   The agent moves faster than the question: wait a little.

pause(Deadline, Agent) :-
    seconds_left(Deadline, Seconds),
    (   Seconds > 0
    ->  sleep(0.01)
    ;   throw(error(timeout_error(order, Agent), _))
    ).

ask_at(here, Agent, Question, Deadline, Answer) :-
    !,
    answer_of(Agent, answer(Question, Agent), Deadline, Answer).
ask_at(Endpoint, Agent, Question, Deadline, Answer) :-
    seconds_left(Deadline, Left),
    Seconds is max(0.01, Left),
    catch(process_ask(Endpoint, Endpoint, agent, question(Agent, Question),
                      Answer, Seconds),
          Error,
          denied(Error, Agent, Answer)).

denied(error(permission_error(Right, host, _), _), Agent, Answer) :-
    Right \== authenticate,
    !,
    Answer = error(permission_error(Right, agent, Agent)).
denied(Error, _, _) :-
    throw(Error).

%   answer_of(+Agent, :Asks, +Deadline, -Answer): call(Asks, Asker) asks Agent.

answer_of(Agent, Asks, Deadline, Answer) :-
    setup_call_cleanup(
        message_queue_create(Queue),    % late answers are deleted with it
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
    wait_before(Stamp, thread_get_message(Queue, Answer)).

seconds_left(by(Stamp), Seconds) :-
    time_now(Now),
    Seconds is Stamp-Now.
seconds_left(by_day(Stamp), Seconds) :-
    monotonic_time(Now),
    Seconds is Stamp-Now.

                /*******************************
                *            ANSWERS           *
                *******************************/

typhon_endpoint:requested(agent, question(Agent, Question), _, ReplyTo) :-
    answer(Question, Agent, reply(ReplyTo)).

answer(Question, Agent, Asker) :-
    answer(Question, Agent, Asker, answered_later(Question, Agent, Asker)).

answer(Question, Agent, Asker, Otherwise) :-
    (   here(Question, Agent, Asker)
    ->  true
    ;   call(Otherwise)
    ->  true
    ;   not_here(Agent, Asker)
    ).

%   A worker loads the code that answers, and then answers. Another thread may
%   have loaded it since here/3 was called.

answered_later(Question, Agent, Asker) :-
    functor(Question, Kind, _),
    on_demand_part(question, Kind),
    on_demand_later(typhon_questions:load_and_answer(Kind, Question, Agent,
                                                     Asker)).

load_and_answer(Kind, Question, Agent, Asker) :-
    on_demand_load(question, Kind),
    answer(Question, Agent, Asker, fail).

not_here(Agent, Asker) :-
    (   probably_at(Agent, Endpoint),
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

                /*******************************
                *            NAMES             *
                *******************************/

%   The setting keeps its old name, typhon_named:met, which users know.

typhon_names:known(agent, Id) :-
    living(Id).

%!  agent_met(+Id) is det.
%
%   Record Id, which this process has created in another process.

agent_met(Id) :-
    bounded(met(_, _), typhon_questions:met, assertz(met(Id, alive))).

%!  agent_named(+Agent, -Id) is det.
%
%   Id is Agent itself, or the only agent known here that is called Agent, or
%   the only one of these that is not faulty.
%
%   @error existence_error(agent, Agent), with the id of the agent if Agent is
%          the name of an agent that has ended
%   @error ambiguous_agent(Agent, Ids)

agent_named(Agent, Id) :-
    named(Agent, Id, Ended),
    (   Ended == true
    ->  has_ended(Id)
    ;   true
    ).

has_ended(Id) :-
    agent_outcome(Id, _),               % the message has its outcome
    !,
    existence_error(agent, Id).
has_ended(Id) :-
    throw(error(existence_error(agent, Id), context(_, 'it has ended'))).

%!  agent_once_named(+Agent, -Id) is det.
%
%   As agent_named/2, but if no living agent has the name Id is the last ended
%   agent that had it.
%
%   @error existence_error(agent, Agent)
%   @error ambiguous_agent(Agent, Ids)

agent_once_named(Agent, Id) :-
    named(Agent, Id, _).

named(Agent, Agent, _) :-
    is_id(Agent),
    !.
named(Name, Id, Ended) :-
    must_be(atom, Name),
    living(Name, Ids),
    (   Ids == [],
        last_called(Name, Last)
    ->  Id = Last,
        Ended = true
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
the_only(Ids, _, Id) :-
    exclude(is_faulty, Ids, [Id]),
    !.
the_only([Id|Ids], Name, _) :-
    throw(error(ambiguous_agent(Name, [Id|Ids]), _)).

%   A faulty agent is kept when a supervisor replaces it.

is_faulty(Id) :-
    catch(agent_ask(Id, properties, 10, answer(Properties)), error(_, _),
          fail),
    memberchk(state(faulty(_)), Properties).

%   This process gets no report when an agent that it created elsewhere ends.

living(Name, Ids) :-
    called(Name, living, Ids0),
    sort(Ids0, Ids1),
    exclude(is_gone, Ids1, Ids).

is_gone(Id) :-
    met(Id, alive),
    \+ catch(agent_ask(Id, properties, 10, _), error(_, _), true),
    retract(met(Id, alive)),
    assertz(met(Id, gone)).

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

                /*******************************
                *            ORDERS            *
                *******************************/

%!  agent_move(+Agent, +Host) is det.
%!  agent_move(+Agent, +Host, +Options) is det.
%
%   Order Agent to move to Host.  It takes the order at its next effect.
%   agent_move/2 returns when the order is given, before the agent has moved:
%   it succeeds also if Host cannot be reached or refuses the agent, which then
%   stays, and its process prints a warning.  Option:
%
%     - wait(+Seconds): return when the agent is on Host; raise an error if
%       it stays, if it ends first, or if neither is known within Seconds.
%       After a timeout the order stands.
%
%   @error existence_error(agent, Agent), existence_error(host, Host),
%   ambiguous_agent(Name, Ids), ambiguous_host(Name, Addresses)
%   @error with wait(Seconds): move_refused(Host, Reason),
%   host_unreachable(Host), permission_error(move, static_agent, Agent),
%   timeout_error(order, Agent)
%   @error domain_error(move_option, Option)

agent_move(Agent, Host) :-
    host_address(Host, Address),
    order_give(Agent, move(Address), _).

agent_move(Agent, Host, Options) :-
    check_options(move_option, Options),
    (   option(wait(Seconds), Options)
    ->  host_address(Host, Address),
        agent_answer(Agent, order(arrive(Address)), Seconds, arrived)
    ;   agent_move(Agent, Host)
    ).

typhon_options:declared(move_option, wait(Seconds), number, Seconds).

%!  agent_clone(+Agent, -Clone) is det.
%
%   Order Agent to clone itself.  This is an order from outside, as those of
%   payload_attach/2 and payload_detach/2.  An agent that runs takes such an
%   order at its next effect; the caller waits for that, for 10 seconds at
%   most.  A faulty agent obeys as others do, and stays faulty.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids) if Agent
%          is a name that several agents have
%   @error timeout_error(order, Agent)

agent_clone(Agent, Clone) :-
    must_be(var, Clone),
    order_give(Agent, clone, Clone0),
    Clone = Clone0.

%!  payload_attach(+Agent, +Payload) is det.
%
%   Order Agent to attach Payload, see agent_clone/2.

payload_attach(Agent, Spec) :-
    agent_named(Agent, Id),             % before the payload file is read
    once(payload_load(Spec, Payload)),
    (   attach_order(Payload, Order0)
    ->  Order = Order0
    ;   Order = attach(Payload)
    ),
    order_give(Id, Order, _).

%!  payload_detach(+Agent, +Name) is det.
%
%   Order Agent to detach the payload Name, see agent_clone/2.

payload_detach(Agent, Name) :-
    must_be(atom, Name),
    order_give(Agent, detach(Name), _).

%!  agent_resume(+Agent) is det.
%
%   Order Agent, which is faulty, to try again: it goes on with the goal that
%   failed or raised an error, and is no longer faulty.  It counts again in the
%   load of its host, even if the host is full.
%
%   @error permission_error(resume, agent, Agent) if it is not faulty
%   @error existence_error(agent, Agent)
%   @error timeout_error(order, Agent)

agent_resume(Agent) :-
    agent_named(Agent, Id),
    order_give(Id, resume, resumed(Stamp, Hops)),
    agent_resumed_from(Id, Stamp, Hops).

%!  order_give(+Agent, +Order, -Result) is det.
%
%   @arg Order is move(Host), arrive(Host), `clone`, attach(Payload),
%        detach(Name), `resume`, or an order of an option or a tool, see
%        typhon_orders

order_give(Agent, Order, Result) :-
    agent_answer(Agent, order(Order), Result).

%!  agent_answer(+Agent, +Question, -Answer) is det.
%
%   As agent_ask/4, for 10 seconds at most, but Agent may be a name, and an
%   error that is the answer is raised.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)
%   @error timeout_error(order, Agent)

agent_answer(Agent, Question, Answer) :-
    agent_answer(Agent, Question, 10, Answer).

agent_answer(Agent, Question, Seconds, Answer) :-
    agent_named(Agent, Id),
    (   agent_asked(Id, Question, Seconds, Answer0)
    ->  Answer = Answer0
    ;   existence_error(agent, Agent)
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

%!  agent_send(+Agent, +Message) is det.
%
%   Send Message to Agent, wherever it is.  Agent is its id, or its name, where
%   it is the only agent known here of that name. at(Agent, Host) adds the host
%   on which it probably is.  Does not wait for the message to arrive.
%   Messages from outside are from `user`.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)
%   @error host_unreachable(Host)
%   @error resource_error(frame_bytes) Message is too long to be sent
%   @error type_error(mobile_term, Culprit)
%   @error existence_error(journal, open): this process stops, and Message is
%          not sent.  With other errors of the journal it may be, see
%          doc/journal.md

agent_send(at(Agent, Host), Message) :-
    !,
    agent_named(Agent, Id),
    host_address(Host, Address),
    address_parts(Address, _, Endpoint),
    sender(From),
    sync_after(as_guest(post_via(Id, Endpoint, From, Message))).
agent_send(Agent, Message) :-
    (   atom(Agent),
        agent(Agent, _, _, _, _)        % then this process is not a guest
    ->  sender(From),
        sync_after(post(Agent, From, Message))
    ;   agent_named(Agent, Id),
        sender(From),
        sync_after(as_guest(post(Id, From, Message)))
    ).

sender(From) :-
    (   context_now(_, Agent),
        Agent \== none
    ->  From = Agent
    ;   From = user
    ).
