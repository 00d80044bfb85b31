:- module(typhon_external_recipients, []).
:- use_module(library(error), [must_be/2, type_error/2]).
:- use_module('../kernel/wire',
              [endpoint_address/1, endpoint_post/3, mobile_term/1]).
:- use_module('../kernel/host', [address_parts/3, scheduler_call/1]).
:- use_module('../kernel/agent', [agent_home_endpoint/2]).
:- use_module('../kernel/travel',
              [mail_accepted/5, mail_lost/3, sender_accepted/1, with_proof/5]).

/** <module> Messages for recipients that are not agents

A bridge, such as library(typhon/fipa), takes messages for recipients outside
Typhon, which are compound terms.  If this process has no bridge for the
recipient, the message goes to the process of the host in at(To, Host), or else
to the home of the sender.  So an agent can answer from a process without the
bridge.

*Threading*: any thread; may wait for a connection.
*/

:- multifile
    carried/4,                  % Host, To, From, Message: a bridge takes it
    typhon_endpoint:received/3,
    typhon_on_demand:joins/2,
    typhon_words:posts_external/4.

typhon_on_demand:joins(recipient, external).

%   Send Message of the agent From, which is on Host, to To.  The bridge of Host
%   is tried first, then the other bridges of the process.
%
%   @error type_error(receiver, To) if no bridge here takes it and no other
%   process can be asked
%   @error host_unreachable(Host), type_error(mobile_term, Culprit)
%   @error those of the bridge

typhon_words:posts_external(Host, To0, From, Message) :-
    mobile_term(Message),
    hint(To0, To, Hint),
    (   carried(Host, To, From, Message)
    ->  true
    ;   elsewhere(Hint, From, Endpoint)
    ->  mobile_term(To),
        send_on(Endpoint, To0, To, From, Message)
    ;   type_error(receiver, To)
    ).

hint(at(To0, Hint0), To, Hint) =>
    must_be(nonvar, To0),
    To = To0,
    Hint = Hint0.
hint(To0, To, Hint) =>
    To = To0,
    Hint = none.

%   elsewhere(+Hint, +From, -Endpoint): a process that may have a bridge.

elsewhere(Hint, From, Endpoint) :-
    Hint \== none,
    sender_accepted(From),
    address_parts(Hint, _, Endpoint),
    \+ endpoint_address(Endpoint),
    !.
elsewhere(_, From, Endpoint) :-
    agent_home_endpoint(From, Endpoint),
    \+ endpoint_address(Endpoint).

%   If other processes do not accept messages of From from this process, the
%   home of From gets the hint along with the recipient, to forward the message.

send_on(Endpoint, To0, To1, From, Message) :-
    ( sender_accepted(From) -> To = To1 ; To = To0 ),
    with_proof(Endpoint, [From], [], abroad(To, From, Message), Sent),
    catch(endpoint_post(Endpoint, message, Sent),
          error(unreachable(_), _),
          throw(error(host_unreachable(Endpoint), _))).

%   A bridge may take long, and must not block the reader thread.

typhon_endpoint:received(message, abroad(To, From, Message), Peer) :-
    receive(To, From, Message, [], Peer).
typhon_endpoint:received(message, shown(Births, abroad(To, From, Message)),
                         Peer) :-
    receive(To, From, Message, Births, Peer).

receive(To, From, Message, Births, Peer) :-
    must_be(compound, To),
    mail_accepted(Peer, To, Births, [mail(Peer, From, Message)], Accepted),
    (   Accepted == []
    ->  true
    ;   scheduler_call(carry_on(To, From, Message, Peer))
    ).

%   To may be at(To, Host), which names the host of the bridge.

carry_on(To0, From, Message, Peer) :-
    hint(To0, To, Hint),
    catch(carry_or_forward(Hint, To, From, Message), error(Formal, _), true),
    (   nonvar(Formal)
    ->  mail_lost(Formal, To, [mail(Peer, From, Message)])
    ;   true
    ),
    !.
carry_on(To, From, Message, Peer) :-
    mail_lost(type_error(receiver, To), To, [mail(Peer, From, Message)]).

carry_or_forward(_, To, From, Message) :-
    carried(none, To, From, Message),
    !.
carry_or_forward(Hint, To, From, Message) :-
    Hint \== none,
    elsewhere(Hint, From, Endpoint),
    send_on(Endpoint, To, To, From, Message).
