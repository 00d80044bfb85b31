:- module(typhon_order_client,
          [ agent_move/2,               % +Agent, +Host
            agent_move/3,               % +Agent, +Host, +Options
            agent_clone/2,              % +Agent, -Clone
            payload_attach/2,           % +Agent, +Payload
            payload_detach/2,           % +Agent, +Name
            agent_resume/1,             % +Agent
            order_give/3,               % +Agent, +Order, -Result
            agent_answer/3,             % +Agent, +Question, -Answer
            agent_send/2                % +Agent, +Message
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(option), [option/2]).
:- use_module('../base/options', [check_options/2]).
:- use_module('../base/durable', [durable_restores/0, sync_after/1]).
:- use_module('../program', [payload_load/2]).
:- use_module('../host',
              [address_parts/3, as_guest/1, context_now/2, host_address/2]).
:- use_module('../travel', [agent_resumed_from/3, post/3, post_via/4]).
:- use_module('../agent', [agent/5]).
:- use_module(questions, [agent_asked/4, agent_named/2]).

/** <module> Orders and messages from outside

An order is sent as a question, see typhon_questions, so that it finds the
agent; typhon_orders describes how the agent takes it.

*Threading*: any thread.
*/

:- multifile
    attach_order/2,             % Payload, Order: attaches Payload
    typhon_options:declared/4.

%!  agent_move(+Agent, +Host) is det.
%!  agent_move(+Agent, +Host, +Options) is det.
%
%   Order Agent to move to Host.  It takes the order at its next effect.
%   agent_move/2 returns when the order is given, before the agent has moved:
%   it succeeds also if Host cannot be reached or refuses the agent, which then
%   stays, and its process prints a warning.  Option:
%
%     - wait(+Seconds): return when the agent is on Host; raise an error if
%       it stays, if it ends first, or if neither is known within Seconds, a
%       number or `inf`.  After a timeout the order stands.
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
    (   option(wait(Seconds0), Options)
    ->  ( Seconds0 == inf -> Seconds = 1.0e9 ; Seconds = Seconds0 ),
        host_address(Host, Address),
        agent_answer(Agent, order(arrive(Address)), Seconds, arrived)
    ;   agent_move(Agent, Host)
    ).

typhon_options:declared(move_option, wait(Seconds), number, Seconds).
typhon_options:declared(move_option, wait(Seconds), oneof([inf]), Seconds).

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
        agent(Agent, _, _, _, _),       % then this process is not a guest
        \+ durable_restores
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
