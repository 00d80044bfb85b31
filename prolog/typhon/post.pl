:- module(typhon_post,
          [ post/3,                     % +Id, +From, +Message
            post_via/4                  % +Id, +Endpoint, +From, +Message
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(agent,
              [ agent/5, agent_status/3, with_agent/2, agent_mail/2,
                agent_home/2 ]).
:- use_module(endpoint,
              [ endpoint_address/1, endpoint_post/3, endpoint_peer/2 ]).
:- use_module(frame, [mobile_term/1]).
:- use_module(host, [address_parts/3]).
:- use_module(scheduler, [scheduler_call/1]).
:- use_module(whereabouts, [whereabouts/3, agent_outcome/2]).

/** <module> Messages

A message is put in the mailbox of an agent that stands in this process,
also while it is under way out of it: it then follows.  Otherwise the
message goes where the agent went, or to its home, which knows.

*Threading*: any thread.
*/

:- multifile typhon_endpoint:received/3.

%   A message that has been forwarded so often chases its agent in vain
%   for the moment: it goes by the home then, which is never behind for
%   long.

max_forwards(64).

%!  post(+Id, +From, +Message) is det.
%
%   @error existence_error(agent, Id) if it is known that there is none
%   @error type_error(mobile_term, Culprit)
%   @error host_unreachable(Host)

post(Id, From, Message) :-
    mobile_term(Message),
    max_forwards(Max),
    route(Id, From, Message, Max).

%!  post_via(+Id, +Endpoint, +From, +Message) is det.
%
%   As post/3, where the agent is believed to be in the process at
%   Endpoint.

post_via(Id, Endpoint, From, Message) :-
    mobile_term(Message),
    (   (   agent(Id, _, _, _, _)
        ;   endpoint_address(Endpoint)
        )
    ->  post(Id, From, Message)
    ;   max_forwards(Max),
        send_on(Endpoint, Id, From, Message, Max)
    ).

route(Id, From, Message, _) :-
    agent(Id, _, _, _, _),
    with_agent(Id, put_in(Id, From, Message)),
    !.
route(Id, From, Message, Left) :-
    Left > 0,
    whereabouts(Id, Address, _),
    address_parts(Address, _, Endpoint),
    \+ endpoint_address(Endpoint),
    !,
    Left1 is Left-1,
    send_on(Endpoint, Id, From, Message, Left1).
route(Id, From, Message, Left) :-
    agent_home(Id, Home),
    address_parts(Home, _, Endpoint),
    !,
    (   endpoint_address(Endpoint)
    ->  no_route(Id, From, Message, Left)
    ;   Left1 is Left-1,
        send_on(Endpoint, Id, From, Message, Left1)
    ).
route(Id, _, _, _) :-
    existence_error(agent, Id).

%   The home is here.  The agent may have come back between our looking
%   for it here and elsewhere.

no_route(Id, From, Message, _) :-
    agent(Id, _, _, _, _),
    with_agent(Id, put_in(Id, From, Message)),
    !.
no_route(Id, From, Message, Left) :-
    Left > 0,
    whereabouts(Id, _, _),
    !,
    Left1 is Left-1,
    route(Id, From, Message, Left1).
no_route(Id, _, _, _) :-
    existence_error(agent, Id).

put_in(Id, From, Message) :-
    agent_status(Id, Status, _),
    Status \= faulty(_),
    !,
    agent_mail(Id, From-Message).
put_in(_, _, _).

send_on(Endpoint, Id, From, Message, Left) :-
    catch(endpoint_post(Endpoint, message, message(Id, From, Message, Left)),
          error(unreachable(_), _),
          throw(error(host_unreachable(Endpoint), _))).

%   A message for an agent that is elsewhere: the reader of a connection
%   must not wait for another one to be made.

typhon_endpoint:received(message, message(Id, From, Message, Left), _) :-
    (   agent(Id, _, _, _, _),
        with_agent(Id, put_in(Id, From, Message))
    ->  true
    ;   whereabouts(Id, Address, _),
        address_parts(Address, _, Endpoint),
        endpoint_peer(Endpoint, state(up))
    ->  deliver(Id, From, Message, Left)
    ;   scheduler_call(typhon_post:deliver(Id, From, Message, Left))
    ).

deliver(Id, From, Message, Left) :-
    catch(route(Id, From, Message, Left),
          error(Formal, _),
          undeliverable(Formal, Id, From, Message)).

undeliverable(Formal, Id, From, Message) :-
    (   agent_outcome(Id, _)
    ->  Severity = silent
    ;   Severity = warning
    ),
    print_message(Severity,
                  typhon(undeliverable(Formal, Id, From, Message))).
