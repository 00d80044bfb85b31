:- module(typhon_sending,
          [ agent_send/2                % +Agent, +Message
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module('../host', [address_parts/3, as_guest/1, context_now/2, host_address/2]).
:- use_module('../travel', [post/3, post_via/4]).

/** <module> Messages from outside

*Threading*: any thread.
*/

%!  agent_send(+Agent, +Message) is det.
%
%   Send Message to Agent, wherever it is; at(Agent, Host) says where it
%   is believed to be.  Does not wait for it to arrive.  Messages from
%   outside are from `user`.
%
%   @error existence_error(agent, Agent)
%   @error host_unreachable(Host)
%   @error type_error(mobile_term, Culprit)

agent_send(at(Agent, Host), Message) :-
    !,
    must_be(atom, Agent),
    host_address(Host, Address),
    address_parts(Address, _, Endpoint),
    sender(From),
    as_guest(post_via(Agent, Endpoint, From, Message)).
agent_send(Agent, Message) :-
    must_be(atom, Agent),
    sender(From),
    as_guest(post(Agent, From, Message)).

sender(From) :-
    (   context_now(_, Agent),
        Agent \== none
    ->  From = Agent
    ;   From = user
    ).
