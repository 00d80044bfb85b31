:- module(typhon_sending,
          [ agent_send/2                % +Agent, +Message
          ]).
:- use_module('../base/durable_changes', [output_waits/0, sync_changes/0]).
:- use_module('../host',
              [address_parts/3, as_guest/1, context_now/2, host_address/2]).
:- use_module('../agent', [agent/5]).
:- use_module('../travel', [post/3, post_via/4]).
:- use_module(named, [agent_named/2]).

/** <module> Messages from outside

*Threading*: any thread.
*/

%!  agent_send(+Agent, +Message) is det.
%
%   Send Message to Agent, wherever it is: its id, or its name, where it is
%   the only agent known here of that name.  at(Agent, Host) says where it
%   is believed to be.  Does not wait for it to arrive.  Messages from
%   outside are from `user`.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)
%   @error host_unreachable(Host)
%   @error resource_error(frame_bytes) Message is too long to be sent
%   @error type_error(mobile_term, Culprit)

agent_send(at(Agent, Host), Message) :-
    !,
    agent_named(Agent, Id),
    host_address(Host, Address),
    address_parts(Address, _, Endpoint),
    sender(From),
    as_guest(post_via(Id, Endpoint, From, Message)),
    sync_changes.
agent_send(Agent, Message) :-
    (   atom(Agent),
        agent(Agent, _, _, _, _)        % then this process is no guest
    ->  sender(From),
        post(Agent, From, Message)
    ;   agent_named(Agent, Id),
        sender(From),
        as_guest(post(Id, From, Message))
    ),
    ( output_waits -> sync_changes ; true ).

sender(From) :-
    (   context_now(_, Agent),
        Agent \== none
    ->  From = Agent
    ;   From = user
    ).
