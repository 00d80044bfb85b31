:- module(typhon_questions,
          [ agent_ask/4,                % +Agent, +Question, +Seconds, -Answer
            agent_asked/4,              % +Agent, +Question, +Seconds, -Term
            agent_ask_here/4,           % +Agent, +Question, +Seconds, -Answer
            agent_urge/4,               % +Agent, +Question, +Deadline, -Answer
            question_answered/2,        % +Asker, +Answer
            agent_named/2,              % +Agent, -Id
            agent_once_named/2,         % +Agent, -Id
            agent_met/1                 % +Id
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../base/fifo', [fifo_send/2]).
:- use_module('../base/monotonic', [monotonic_time/1, wait_before/2]).
:- use_module('../base/on_demand',
              [on_demand_later/1, on_demand_load/2, on_demand_part/2]).
:- use_module('../base/bounds', [bounded/3]).
:- use_module('../wire', [endpoint_address/1, endpoint_reply/2]).
:- use_module('../host',
              [address_parts/3, process_ask/6, time_now/1, time_wait/3]).
:- use_module('../agent', [agent/5, agent_home_endpoint/2, agent_name/3]).
:- use_module('../base/error_lines', [harmless_error/2]).
:- use_module('../travel',
              [agent_outcome/2, ended_agent/1, home_agents/1, whereabouts/2]).

/** <module> Questions that find an agent, by its id or its name

A question is sent to the process in which the agent is believed to be.  A
process from which the agent has left answers with its next location.  The
clauses of the hook here/3 define the questions: properties and orders.

Where only one of the agents known here is called `bob`, `bob` stands for its
id.  Agents are known here if they are in this process, were born in it, or
were created from here elsewhere, and also if modules above know them, such as
the agents of a network.  If no living agent has the name, it stands for the
last ended agent of that name, as long as that is remembered.

*Threading*: any thread asks.  Reader threads, which never wait, answer the
questions of other processes.
*/

:- meta_predicate answer_of(+, 1, +, -).

:- multifile
    here/3,                     % Question, Agent, Asker
    typhon_endpoint:requested/4,
    typhon_transfer:answered/2.

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

%!  agent_urge(+Agent, +Question, +Deadline, -Answer) is semidet.
%
%   As agent_ask/4, but waits by real time even where time is virtual, until
%   Deadline, a monotonic_time/1, and does not let virtual time run.

agent_urge(Agent, Question, Deadline, Answer) :-
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

:- public load_and_answer/4.            % goal of a worker

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
    ignore(fifo_send(Queue, Answer)).
question_answered(reply(ReplyTo), Answer) :-
    endpoint_reply(ReplyTo, Answer).

typhon_transfer:answered(Asker, Answer) :-
    question_answered(Asker, Answer).

                /*******************************
                *            NAMES             *
                *******************************/

%   The setting keeps its old name, typhon_named:met, which users know.

:- setting(met, positive_integer, 1000,
           "Agents created elsewhere that are known by their names").

:- multifile
    elsewhere/1,                % Id: an agent of another process
    ended_elsewhere/2,          % +Name, -Id: an agent that ended
    typhon_names:known/2.

:- dynamic
    met/2.                      % Id of an agent created elsewhere, alive
                                % or gone

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
    last(Ids, Id).
last_called(Name, Id) :-
    ended_elsewhere(Name, Id).

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
