:- module(typhon_post,
          [ post/3,                     % +Id, +From, +Message
            post_via/4,                 % +Id, +Endpoint, +From, +Message
            post_on/2                   % +Id, +Mail
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(agent,
              [ agent/5, agent_status/3, with_agent/2, agent_mail/2,
                agent_home/2 ]).
:- use_module(endpoint,
              [ endpoint_address/1, endpoint_post/3, endpoint_peer/2 ]).
:- use_module(frame, [mobile_term/1]).
:- use_module(host, [address_parts/3]).
:- use_module(scheduler, [alarm_set/3, scheduler_call/1]).
:- use_module(whereabouts, [whereabouts/3, agent_outcome/2]).

/** <module> Messages

A message is put in the mailbox of an agent that stands in this process,
also while it is under way out of it: it then follows.  Otherwise the
message goes where the agent went, or to its home, which knows.

Mail is a list of From-Message, oldest first.  What follows an agent
together stays together, so that whatever waited for one that hops without
pause reaches it at once, and not each message after a chase of its own.

*Threading*: any thread.
*/

:- multifile
    typhon_endpoint:received/3,
    typhon_scheduler:fire/2.

%   A message that has been forwarded so often chases its agent in vain
%   for the moment, or those who should know do not know yet: it waits a
%   little.

max_forwards(12800).
forwards_at_once(64).
pause(0.05).                    % seconds

%!  post(+Id, +From, +Message) is det.
%
%   @error existence_error(agent, Id) if it is known that there is none
%   @error type_error(mobile_term, Culprit)
%   @error host_unreachable(Host)

post(Id, From, Message) :-
    mobile_term(Message),
    max_forwards(Max),
    route(Id, [From-Message], Max).

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
        send_on(Endpoint, Id, [From-Message], Max)
    ).

%!  post_on(+Id, +Mail) is det.
%
%   As post/3 for each of Mail, for a thread that must not wait for a
%   connection to be made.  What cannot be delivered is reported.

post_on(Id, Mail) :-
    max_forwards(Max),
    pass_on(Id, Mail, Max).

pass_on(_, [], _) :-
    !.
pass_on(Id, Mail, Left) :-
    (   with_agent(Id, put_in(Id, Mail))
    ->  true
    ;   whereabouts(Id, Address, _),
        address_parts(Address, _, Endpoint),
        endpoint_peer(Endpoint, state(up))
    ->  deliver(Id, Mail, Left)
    ;   scheduler_call(typhon_post:deliver(Id, Mail, Left))
    ).

typhon_endpoint:received(message, message(Id, Mail, Left), _) :-
    pass_on(Id, Mail, Left).

deliver(Id, Mail, Left) :-
    catch(route(Id, Mail, Left),
          error(Formal, _),
          undeliverable(Formal, Id, Mail)).

undeliverable(Formal, Id, Mail) :-
    (   agent_outcome(Id, _)
    ->  Severity = silent
    ;   Severity = warning
    ),
    forall(member(From-Message, Mail),
           print_message(Severity,
                         typhon(undeliverable(Formal, Id, From, Message)))).

                /*******************************
                *             ROUTE            *
                *******************************/

%   route(+Id, +Mail, +Left): after at most Left forwards.

route(Id, Mail, _) :-
    with_agent(Id, put_in(Id, Mail)),
    !.
route(Id, Mail, Left) :-
    Left > 0,
    next_endpoint(Id, Endpoint),
    !,
    Left1 is Left-1,
    forwards_at_once(Most),
    (   (   Left1 mod Most =:= 0
        ;   endpoint_address(Endpoint)  % on its way in
        )
    ->  later(Id, Mail, Left1)
    ;   send_on(Endpoint, Id, Mail, Left1)
    ).
route(Id, _, _) :-
    existence_error(agent, Id).

%   Who is not here has left a trace, or the home knows.  The record of an
%   agent is looked at under its mutex only: there is none for a moment when
%   it goes from host to host inside a process.

put_in(Id, Mail) :-
    agent(Id, _, _, _, _),
    !,
    (   agent_status(Id, faulty(_), _)
    ->  true
    ;   put_all(Mail, Id)
    ).

put_all([], _).
put_all([Message|Mail], Id) :-
    agent_mail(Id, Message),
    put_all(Mail, Id).

next_endpoint(Id, Endpoint) :-
    whereabouts(Id, Address, _),
    !,
    address_parts(Address, _, Endpoint).
next_endpoint(Id, Endpoint) :-
    home_endpoint(Id, Endpoint),
    \+ endpoint_address(Endpoint).

home_endpoint(Id, Endpoint) :-
    agent_home(Id, Home),
    address_parts(Home, _, Endpoint).

later(Id, Mail, Left) :-
    pause(Seconds),
    get_time(Now),
    Stamp is Now+Seconds,
    flag(typhon_later, N, N+1),
    alarm_set(Stamp, Id, deliver(N, Mail, Left)).

typhon_scheduler:fire(Id, deliver(_, Mail, Left)) :-
    !,
    scheduler_call(typhon_post:deliver(Id, Mail, Left)).

%   Where a forwarding address leads to a process that is gone, the home
%   may know better.

send_on(Endpoint, Id, Mail, Left) :-
    catch(send_to(Endpoint, Id, Mail, Left),
          error(unreachable(_), _),
          send_home(Endpoint, Id, Mail, Left)).

send_home(Failed, Id, Mail, Left) :-
    (   home_endpoint(Id, Home),
        Home \== Failed,
        \+ endpoint_address(Home)
    ->  catch(send_to(Home, Id, Mail, Left),
              error(unreachable(_), _),
              throw(error(host_unreachable(Home), _)))
    ;   throw(error(host_unreachable(Failed), _))
    ).

%   What is too long for one frame goes in two.

send_to(Endpoint, Id, Mail, Left) :-
    catch(endpoint_post(Endpoint, message, message(Id, Mail, Left)),
          error(resource_error(frame_bytes), Context),
          ( halves(Mail, Older, Newer)
          ->  send_to(Endpoint, Id, Older, Left),
              send_to(Endpoint, Id, Newer, Left)
          ;   throw(error(resource_error(frame_bytes), Context))
          )).

halves(Mail, Older, Newer) :-
    length(Mail, Count),
    Count > 1,
    Half is Count//2,
    length(Older, Half),
    append(Older, Newer, Mail).
