:- module(typhon_post,
          [ post/3,                     % +Id, +From, +Message
            post_via/4,                 % +Id, +Endpoint, +From, +Message
            post_on/2,                  % +Id, +Messages
            post_waiting/2              % +Id, -Messages
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [existence_error/2, resource_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module('../base/reports', [report/4]).
:- use_module('../base/durable_changes',
              [ deferred_act/4, durable_on/0, effects_deferred/0,
                enqueue_changes/0, unit_of_work/1 ]).
:- use_module('../wire', [endpoint_address/1, mobile_term/1]).
:- use_module('../host', [parts/3]).
:- use_module('../agent',
              [agent_home/2, agent_mail/2, agent_on/2, mail_full/2, with_agent/2]).
:- use_module(backlog,
              [backlog/1, backlog_add/2, backlog_all/2, retry_later/3]).
:- use_module(sender_authorization, [mail_accepted/5, senders_checked/0]).
:- use_module(routing, [one_letter/2, way_in/2, way_out/3, way_send/3]).

/** <module> Messages

A message is put in the mailbox of an agent of this process, also if the agent
is under way to another: the message follows it.  Otherwise the message goes to
the process to which the agent went, or to the home of the agent.

The unit of transport is letter(Mail, Left).  Mail is a list of
mail(Origin, From, Message), the oldest first; Origin is the endpoint of the
sender, which gets a report if the agent cannot be found.  Messages that follow
an agent together stay together: so all that wait for an agent that hops without
pause reach it at once, and not each message after a chase of its own.

A letter that cannot be sent now waits, see typhon_backlog.

*Threading*: any thread.  post/3 and post_via/4 may wait for a connection,
post_on/2 and the hooks never do.
*/

:- multifile
    typhon_durable_changes:act/3,
    typhon_endpoint:received/3,
    typhon_endpoint:together/3.

%   A bound on forwarding, for an agent that hops without pause.

max_forwards(12800).

%!  post(+Id, +From, +Message) is det.
%
%   @error existence_error(agent, Id) if the agent is known not to exist
%   @error type_error(mobile_term, Culprit)
%   @error host_unreachable(Host)
%   @error resource_error(frame_bytes)
%   @error resource_error(mailbox) if Id is here, and its mailbox is full

post(Id, From, Message) :-
    mobile_term(Message),
    (   \+ durable_on
    ->  with_agent(Id, post_way(Id, From, Message, Way)),
        go(Way, Id)
    ;   effects_deferred
    ->  ( agent_on(Id, _) -> By = any ; By = frame ),
        deferred_act(letter, Id, From-Message, By)
    ;   unit_of_work(post_now(Id, From, Message))
    ).

%   One journal entry has both changes: the message has left, and it waits.

post_now(Id, From, Message) :-
    with_agent(Id, ( post_way(Id, From, Message, Way0),
                     retry_if_waiting(Way0, Id, Way),
                     enqueue_changes )),
    go(Way, Id).

retry_if_waiting(wait(Letter), Id, done) :-
    !,
    retry_later(Id, Letter, wait(Letter)).
retry_if_waiting(Way, _, Way).

%   A message that an agent sends is noted in the turn, and leaves after it.

typhon_durable_changes:act(letter, Id, From-Message) :-
    catch(post_now(Id, From, Message), error(Formal, _),
          report(warning, lost_messages, Id,
                 typhon(undeliverable(Formal, Id, From, Message)))).

post_way(Id, From, Message, Way) :-
    parts(deliver, _, _),
    agent_on(Id, _),
    !,
    new_letter(From, Message, Letter),
    way(Id, Letter, Way).
post_way(Id, From, _, _) :-
    mail_full(Id, From),
    resource_error(mailbox).
post_way(Id, From, Message, done) :-
    agent_mail(Id, [From-Message]),
    !.
post_way(Id, From, Message, Way) :-
    new_letter(From, Message, Letter),
    way_on(Id, Letter, Way).

new_letter(From, Message, letter([mail(Origin, From, Message)], Max)) :-
    (   endpoint_address(Origin)
    ->  true
    ;   Origin = none
    ),
    max_forwards(Max).

%!  post_via(+Id, +Endpoint, +From, +Message) is det.
%
%   As post/3, for an agent that is probably in the process at Endpoint.

post_via(Id, Endpoint, From, Message) :-
    mobile_term(Message),
    (   (   agent_on(Id, _)
        ;   endpoint_address(Endpoint)
        ;   senders_checked,            % that process may not forward it
            agent_home(From, _)
        )
    ->  post(Id, From, Message)
    ;   new_letter(From, Message, Letter),
        way_send(Endpoint, Id, Letter)
    ).

%!  post_on(+Id, +Messages) is det.
%
%   As post/3 for each of Messages, From-Message, for a thread that must not
%   wait for a connection to be made.

post_on(_, []) :-
    !.
post_on(Id, Messages) :-
    endpoint_address(Origin),
    max_forwards(Max),
    findall(mail(Origin, From, Text), member(From-Text, Messages), Mail),
    pass_on(Id, letter(Mail, Max)).

pass_on(Id, Letter) :-
    with_agent(Id, forward_or_retry(Id, Letter)).

forward_or_retry(Id, Letter) :-
    way(Id, Letter, Way),
    (   Way == done
    ->  true
    ;   retry_later(Id, Letter, Way)
    ),
    enqueue_changes.

typhon_endpoint:received(message, message(Id, Mail, Left), Peer) :-
    letter_receive(Id, [], Mail, Left, Peer).
typhon_endpoint:received(message, shown(Births, message(Id, Mail, Left)),
                         Peer) :-
    letter_receive(Id, Births, Mail, Left, Peer).

letter_receive(Id, Births, Mail0, Left, Peer) :-
    mail_accepted(Peer, Id, Births, Mail0, Mail),
    (   Mail == []
    ->  true
    ;   pass_on(Id, letter(Mail, Left))
    ).

%   Letters that come in one batch are merged into one for each agent.

typhon_endpoint:together(message, Letters, Fewer) :-
    maplist(letter_to, Letters, Pairs),
    keysort(Pairs, Sorted),
    group_pairs_by_key(Sorted, Groups),
    maplist(one_message, Groups, Fewer).

letter_to(message(Id, Mail, Left), Id-letter(Mail, Left)) :-
    atom(Id),
    is_list(Mail),
    integer(Left).

one_message(Id-Letters, message(Id, Mail, Left)) :-
    one_letter(Letters, letter(Mail, Left)).

%!  post_waiting(+Id, -Messages:list) is det.
%
%   Take the messages that waited here for Id, which has arrived; inside
%   with_agent/2.

post_waiting(Id, Messages) :-
    backlog_all(Id, Letters),
    messages_in(Letters, Messages).

messages_in([], []) :-                  % nearly always
    !.
messages_in(Letters, Messages) :-
    findall(From-Message,
            ( member(letter(Mail, _), Letters),
              member(mail(_, From, Message), Mail) ),
            Messages).

                /*******************************
                *            ROUTING           *
                *******************************/

%   way(+Id, +Letter, -Way): one step, inside with_agent/2.  Way is `done`,
%   to(Endpoint, Letter) if a connection has to be made first, wait(Letter) if
%   it is better to wait, or `nowhere`.

way(Id, letter(Mail, _), done) :-
    way_in(Id, Mail),
    !.
way(Id, Letter, Way) :-
    way_on(Id, Letter, Way).

way_on(Id, Letter, done) :-
    backlog(Id),
    !,
    backlog_add(Id, Letter).
way_on(Id, Letter, Way) :-
    way_out(Id, Letter, Way).

%   go(+Way, +Id): in a thread that may wait; errors are raised to the caller.

go(done, _).
go(to(Endpoint, Letter), Id) :-
    way_send(Endpoint, Id, Letter).
go(wait(Letter), Id) :-
    with_agent(Id, retry_if_waiting(wait(Letter), Id, done)).
go(nowhere, Id) :-
    existence_error(agent, Id).
