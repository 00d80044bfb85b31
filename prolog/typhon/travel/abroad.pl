:- module(typhon_abroad,
          [ post_abroad/4               % +Host, +To, +From, +Message
          ]).
:- use_module(library(error), [must_be/2, type_error/2]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_post/3, mobile_term/1]).
:- use_module('../host', [address_parts/3, scheduler_call/1]).
:- use_module('../agent', [agent_home_endpoint/2]).
:- use_module(lost, [mail_lost/3]).

/** <module> Messages for those who are no agents

A bridge, as library(typhon/fipa), takes messages for somebody beyond it,
who is a compound term.  If there is none in this process the message goes
to the one that at(To, Host) names, or else to the home of who sends it: so
an agent can be away from the bridge and still answer.

*Threading*: any thread; may wait for a connection.
*/

:- multifile
    carried/4,                  % Host, To, From, Message: a bridge takes it
    typhon_endpoint:received/3.

:- dynamic carried/4.

%!  post_abroad(+Host, +To, +From, +Message) is det.
%
%   Message of the agent From, which stands on Host, goes to To.  The bridge
%   of Host comes first, then others of the process.
%
%   @error type_error(receiver, To) if there is no bridge for it here, and no
%   other process to ask
%   @error host_unreachable(Host), type_error(mobile_term, Culprit)
%   @error what the bridge raises

post_abroad(Host, To0, From, Message) :-
    mobile_term(Message),
    hint(To0, To, Hint),
    (   carried(Host, To, From, Message)
    ->  true
    ;   elsewhere(Hint, From, Endpoint)
    ->  mobile_term(To),
        send_on(Endpoint, abroad(To, From, Message))
    ;   type_error(receiver, To)
    ).

hint(at(To0, Hint0), To, Hint) =>
    must_be(nonvar, To0),
    To = To0,
    Hint = Hint0.
hint(To0, To, Hint) =>
    To = To0,
    Hint = none.

%   elsewhere(+Hint, +From, -Endpoint): who may have a bridge.

elsewhere(Hint, _, Endpoint) :-
    Hint \== none,
    address_parts(Hint, _, Endpoint),
    \+ endpoint_address(Endpoint),
    !.
elsewhere(_, From, Endpoint) :-
    agent_home_endpoint(From, Endpoint),
    \+ endpoint_address(Endpoint).

send_on(Endpoint, Message) :-
    catch(endpoint_post(Endpoint, message, Message),
          error(unreachable(_), _),
          throw(error(host_unreachable(Endpoint), _))).

%   A bridge may have a lot to do with it, and who reads has not.

typhon_endpoint:received(message, abroad(To, From, Message), Peer) :-
    must_be(compound, To),
    must_be(atom, From),
    scheduler_call(typhon_abroad:carry_on(To, From, Message, Peer)).

carry_on(To, From, Message, Peer) :-
    catch(carried(none, To, From, Message), error(Formal, _), true),
    (   nonvar(Formal)
    ->  mail_lost(Formal, To, [mail(Peer, From, Message)])
    ;   true
    ),
    !.
carry_on(To, From, Message, Peer) :-
    mail_lost(type_error(receiver, To), To, [mail(Peer, From, Message)]).
