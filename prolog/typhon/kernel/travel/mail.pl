:- module(typhon_mail,
          [ post/3,                     % +Id, +From, +Message
            post_via/4,                 % +Id, +Endpoint, +From, +Message
            post_on/2,                  % +Id, +Messages
            post_waiting/2,             % +Id, -Messages
            mail_again/2,               % +Id, +Mail
            mail_lost/3,                % +Formal, +Id, +Mail
            mail_admit/3,               % +Letter, +Id, +Mail
            backlog/1,                  % +Id
            retries_go_on/0,
            post_tried/0
          ]).

/** <module> Messages

A message is put in the mailbox of an agent of this process, also if the agent
is under way to another: the message follows it.  Otherwise the message goes to
the process to which the agent went, or to the home of the agent.

The unit of transport is letter(Mail, Left), which may be forwarded Left times
more.  Mail is a list of mail(Origin, From, Message), the oldest first; Origin is
the endpoint of the sender, which gets a report if the agent cannot be found.
Messages that follow an agent together stay together: so all that wait for an
agent that hops without pause reach it at once, and not each message after a
chase of its own.

A letter that cannot be sent now waits here, and later letters for the same
agent wait behind it, in order.  They are tried again as long as the next
process may be alive, and a while longer, since the news that the agent has left
that process may be under way.  While they are tried, a worker holds them; at
most one worker for each agent.

*Threading*: post/3 and post_via/4 may wait for a connection, post_on/2 and the
hooks never do; mail_lost/3 is for any thread.  What way_in/2 and way_out/3 do
and the backlog of an agent are inside with_agent/2 of the agent, and never
wait; retries_go_on/0 and post_tried/0 are for any thread.  way_send/3 may wait
for a connection; one_letter/2 is pure.
*/

:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3, maplist/4, partition/4]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2, resource_error/1]).
:- use_module(library(lists), [append/2, append/3, max_list/2, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../agent',
              [ agent/5, agent_home/2, agent_home_endpoint/2, agent_mail/2,
                agent_on/2, mail_fitting/4, mail_full/2, with_agent/2 ]).
:- use_module('../base/durable',
              [ deferred_act/4, durable/5, durable/6, durable_assertz/1,
                durable_drop/3, durable_drop_all/2,
                durable_number/1, durable_on/0, durable_post/3, durable_put/4,
                effects_deferred/0, enqueue_changes/0, unit_of_work/1 ]).
:- use_module('../base/bounds', [bounded/3]).
:- use_module('../base/fifo', [fifo_empty/2]).
:- use_module('../base/reports', [report/4, report/5]).
:- use_module('../host',
              [ address_parts/3, alarm_in/3, amended/5, host/3, hosts_apart/2,
                parts/3, scheduler_call/1 ]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_gone/1, endpoint_peer/2,
                endpoint_post/3, endpoint_post_up/3, mobile_term/1 ]).
:- use_module(sender_authorization,
              [ mail_accepted/5, mail_routes/4, senders_checked/0,
                with_proof/5 ]).
:- use_module(whereabouts, [agent_outcome/2, whereabouts/2]).

:- setting(typhon_backlog:messages, positive_integer, 100 000,
           "Messages that wait, in all, for agents that cannot be reached now").

:- setting(admitted, positive_integer, 20 000,
           "Letters that were kept elsewhere, and are recognised if they come again").

:- dynamic
    admitted/1,                         % Letter
    waits/4.                            % Id, Queue, Tries, State: `idle`, or
                                        % tried(Messages)

:- multifile
    typhon_bounds:forgotten/1,
    typhon_durable:act/3,
    typhon_endpoint:received/3,
    typhon_endpoint:together/3,
    mail_kept/3,                        % Formal, Id, Mail: keep Mail, which cannot
                                        % be sent on now
    returned/3,                         % From, Id, Message: the bridge of From takes
                                        % it back
    typhon_durable:undelivered/4,
    typhon_durable:go_on/0,
    typhon_runtime:ending/1,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

                /*******************************
                *            POSTS             *
                *******************************/

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
        go(Way, Id, From, Message)
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
    go(Way, Id, From, Message).

retry_if_waiting(wait(Letter), Id, done) :-
    !,
    retry_later(Id, Letter, wait(Letter)).
retry_if_waiting(Way, _, Way).

%   A message that an agent sends is noted in the turn, and leaves after it.

typhon_durable:act(letter, Id, From-Message) :-
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

%!  mail_again(+Id, +Mail) is det.
%
%   Mail, which waited in this process since Id was away, goes on its way, as in
%   post_on/2: Id is not where the mail could wait.

mail_again(Id, Mail) :-
    max_forwards(Max),
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
typhon_endpoint:received(message, lost(Formal, Id, Mail), _) :-
    came_back(Formal, Id, Mail).

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

%!  mail_admit(+Letter, +Id, +Mail) is det.
%
%   Mail, which was kept elsewhere for Id under the name Letter, goes on its way,
%   unless it has done so before.  Where senders are checked, no process proves
%   whose it is: messages of agents are refused.

mail_admit(Letter, Id, Mail) :-
    unit_of_work(admit(Letter, Id, Mail)).

admit(Letter, _, _) :-
    admitted(Letter),
    !.
admit(Letter, Id, Mail) :-
    bounded(admitted(_), typhon_mail:admitted,
            durable_assertz(admitted(Letter))),
    max_forwards(Max),
    letter_receive(Id, [], Mail, Max, none).

:- durable(admitted, Letter, 0, '', admitted(Letter)).

typhon_bounds:forgotten(admitted(Letter)) :-
    durable_drop(admitted, Letter, 0).

typhon_runtime:ending(after) :-
    retractall(admitted(_)).

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

way(Id, letter(Mail, _), nowhere) :-
    cut_off(Id, Mail),
    !.
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

%   go(+Way, +Id, +From, +Message): in a thread that may wait; errors are raised
%   to the caller.

go(done, _, _, _).
go(to(Endpoint, Letter), Id, _, _) :-
    way_send(Endpoint, Id, Letter).
go(wait(Letter), Id, _, _) :-
    with_agent(Id, retry_if_waiting(wait(Letter), Id, done)).
go(nowhere, Id, From, Message) :-
    new_letter(From, Message, letter(Mail, _)),
    (   agent_on(Id, Host),
        host(Host, Address, _)
    ->  Formal = host_unreachable(Address)
    ;   Formal = existence_error(agent, Id)
    ),
    kept_or_error(Formal, Id, Mail).

%   kept_or_error(+Formal, +Id, +Mail) is det: in a thread that may wait, outside
%   with_agent/2.  With a journal the hook runs in the unit of work in which the
%   letter leaves: what it notes is committed with that, and what it sends must
%   wait for the commit.

kept_or_error(Formal, Id, Mail) :-
    (   kept(Formal, Id, Mail)
    ->  true
    ;   throw(error(Formal, _))
    ).

kept(Formal, Id, Mail) :-
    mail_may_be_kept(Id),
    mail_kept(Formal, Id, Mail),
    !,
    debug(typhon(mail), '~w: a letter is kept, ~p', [Id, Formal]).

mail_may_be_kept(Id) :-
    '$get_predicate_attribute'(typhon_mail:mail_kept(_, _, _),
                               number_of_clauses, _),
    \+ agent_outcome(Id, _).

                /*******************************
                *           ROUTING            *
                *******************************/

%   After so many forwards without a pause the letter chases its agent in vain,
%   or processes lack news of the agent that is under way: the letter waits a
%   little.

forwards_at_once(64).

%   one_letter(+Letters, -Letter): Letter has the mail of all Letters.

one_letter([Letter], Letter) :-
    !.
one_letter(Letters, letter(Mail, Left)) :-
    maplist(letter_parts, Letters, Mails, Lefts),
    append(Mails, Mail),
    max_list(Lefts, Left).

letter_parts(letter(Mail, Left), Mail, Left).

%   cut_off(+Id, +Mail) is semidet: the host of Id, or of a sender, is away.

cut_off(Id, Mail) :-
    parts(away, _, _),
    agent_on(Id, Host),
    member(mail(_, From, _), Mail),
    (   agent_on(From, There)
    ->  hosts_apart(There, Host)
    ;   parts(away, Host, _)
    ),
    !.

%   way_in(+Id, +Mail): put the part of Mail that Id, an agent of this process,
%   accepts into its mailbox; what its mailbox has no space for becomes dead
%   letters.

way_in(Id, Mail) :-
    fitting(Id, Mail, Accepted),
    mail_fitting(Id, Accepted, Fitting, Rest),
    messages(Fitting, Messages),
    agent_mail(Id, Messages),
    ( Rest == [] -> true ; mail_lost(resource_error(mailbox), Id, Rest) ).

fitting(Id, Mail, Fitting) :-
    (   parts(deliver, _, _),
        agent(Id, Host, _, _, _)
    ->  amended(deliver, Host, Id, Mail, Fitting)
    ;   Fitting = Mail
    ).

messages([], []).
messages([mail(_, From, Message)|Mail], [From-Message|Messages]) :-
    messages(Mail, Messages).

%   way_out(+Id, +Letter, -Way): Way is `done`, to(Endpoint, Letter) if a
%   connection has to be made first, wait(Letter) if it is better to wait, or
%   `nowhere`.

way_out(Id, letter(Mail, Left), Way) :-
    Left > 0,
    next_endpoint(Id, Endpoint),
    !,
    Left1 is Left-1,
    Letter = letter(Mail, Left1),
    forwards_at_once(Most),
    (   (   Left1 mod Most =:= 0
        ;   Endpoint == here            % the agent is on its way in
        )
    ->  Way = wait(Letter)
    ;   sent(Endpoint, Id, Letter, endpoint_post_up)
    ->  Way = done
    ;   Way = to(Endpoint, Letter)
    ).
way_out(_, _, nowhere).

%   next_endpoint(+Id, -Endpoint): the process to which the agent went, as far
%   as this process knows, or its home.  Endpoint is `here` if it is that of
%   this process.

next_endpoint(Id, Endpoint) :-
    whereabouts(Id, Address),
    address_parts(Address, _, Endpoint0),
    \+ endpoint_gone(Endpoint0),
    !,
    (   endpoint_address(Endpoint0)
    ->  Endpoint = here
    ;   Endpoint = Endpoint0
    ).
next_endpoint(Id, Endpoint) :-
    agent_home_endpoint(Id, Endpoint),
    \+ endpoint_address(Endpoint).

%!  way_send(+Endpoint, +Id, +Letter) is det.
%
%   If the process at Endpoint, a forwarding address, is gone, the letter goes
%   to the home of the agent.
%
%   @error host_unreachable(Endpoint)

way_send(Endpoint, Id, Letter) :-
    catch(sent(Endpoint, Id, Letter, endpoint_post),
          error(unreachable(_), _),
          send_home(Endpoint, Id, Letter)).

send_home(Failed, Id, Letter) :-
    Letter = letter(Mail, _),
    (   agent_home_endpoint(Id, Home),
        Home \== Failed,
        \+ endpoint_address(Home)
    ->  catch(sent(Home, Id, Letter, endpoint_post),
              error(unreachable(_), _),
              kept_or_error(host_unreachable(Home), Id, Mail))
    ;   kept_or_error(host_unreachable(Failed), Id, Mail)
    ).

%   sent(+Endpoint, +Id, +Letter, :Post): send the mail of Letter to Endpoint,
%   except messages that another process has to forward.

sent(Endpoint, Id, letter(Mail, Left), Post) :-
    mail_routes(Endpoint, Id, Mail, Parts),
    (   Parts = [To-_]
    ->  posted(To, Id, letter(Mail, Left), Post)
    ;   Post == endpoint_post           % endpoint_post_up must not connect
    ->  forall(member(To-Part, Parts), part_sent(To, Id, Part, Left))
    ).

part_sent(Endpoint, Id, Mail, Left) :-
    catch(posted(Endpoint, Id, letter(Mail, Left), endpoint_post),
          error(unreachable(_), _),
          kept_or_lost(host_unreachable(Endpoint), Id, Mail)).

kept_or_lost(Formal, Id, Mail) :-
    (   kept(Formal, Id, Mail)
    ->  true
    ;   mail_lost(Formal, Id, Mail)
    ).

%   posted(+Endpoint, +Id, +Letter, :Post): a letter too long for one frame is
%   sent in two.  With a journal the post is durable, and sent when possible.

posted(Endpoint, Id, letter(Mail, Left), Post) :-
    message(Endpoint, Id, Mail, Left, Message),
    (   durable_on
    ->  By = durable_post
    ;   By = Post
    ),
    catch(call(By, Endpoint, message, Message),
          error(resource_error(frame_bytes), Context),
          sent_halves(Endpoint, Id, letter(Mail, Left), Post, Context)),
    debug(typhon(mail), '~w: a letter goes to ~w', [Id, Endpoint]).

message(Endpoint, Id, Mail, Left, Message) :-
    senders_checked,
    !,
    findall(From, member(mail(_, From, _), Mail), Froms),
    (   whereabouts(Id, Address),
        address_parts(Address, _, Endpoint)
    ->  There = [Id]
    ;   There = []
    ),
    with_proof(Endpoint, [Id|Froms], There, message(Id, Mail, Left), Message).
message(_, Id, Mail, Left, message(Id, Mail, Left)).

sent_halves(Endpoint, Id, letter(Mail, Left), Post, Context) :-
    (   halves(Mail, Older, Newer)
    ->  posted(Endpoint, Id, letter(Older, Left), Post),
        posted(Endpoint, Id, letter(Newer, Left), Post)
    ;   throw(error(resource_error(frame_bytes), Context))
    ).

halves(Mail, Older, Newer) :-
    length(Mail, Count),
    Count > 1,
    Half is Count//2,
    length(Older, Half),
    append(Older, Newer, Mail).

                /*******************************
                *         DEAD LETTERS         *
                *******************************/

%!  mail_lost(+Formal, +Id, +Mail) is det.
%
%   Report once that Mail cannot be delivered, in the process that sent it, or
%   here if there is no connection to that, unless Id has ended, which is normal.
%   A message whose sender is not an agent, but a term such as fipa(Name), is
%   returned to the bridge of the process that sent it.

mail_lost(Formal, Id, Mail) :-
    partition(is_from_bridge, Mail, Bridged, Sent),
    partition(was_sent_here, Bridged, Here, Elsewhere),
    give_back(Formal, Id, Here),
    report_to_origins(Formal, Id, Elsewhere),
    (   ( Sent == [] ; agent_outcome(Id, _) )
    ->  true
    ;   forall(of_origin(Sent, Origin, Lost),
               report_once(Origin, Formal, Id, Lost))
    ).

is_from_bridge(mail(_, From, _)) :-
    compound(From).

was_sent_here(mail(Origin, _, _)) :-
    endpoint_address(Origin).

%   A worker calls the bridge, because the bridge may have to wait.

give_back(Formal, Id, Mail) :-
    forall(member(One, Mail),
           scheduler_call(typhon_mail:given_back(Formal, Id, One))).

given_back(Formal, Id, Mail) :-
    Mail = mail(_, From, Message),
    (   returned(From, Id, Message)
    ->  true
    ;   report(Formal, Id, [Mail])
    ).

report_to_origins(Formal, Id, Mail) :-
    forall(of_origin(Mail, Origin, Lost),
           scheduler_call(report_to_origin(Origin, Formal, Id, Lost))).

report_to_origin(Origin, Formal, Id, Lost) :-
    catch(endpoint_post(Origin, message, lost(Formal, Id, Lost)),
          error(_, _),
          true).

of_origin(Mail, Origin, Lost) :-
    findall(O, member(mail(O, _, _), Mail), Origins0),
    sort(Origins0, Origins),
    member(Origin, Origins),
    findall(mail(Origin, From, Message),
            member(mail(Origin, From, Message), Mail), Lost).

report_once(Origin, Formal, Id, Lost) :-
    \+ endpoint_address(Origin),
    endpoint_post_up(Origin, message, lost(Formal, Id, Lost)),
    !.
report_once(_, Formal, Id, Lost) :-
    report(Formal, Id, Lost).

report(Formal, Id, [mail(_, From, Message)|More]) :-
    length(More, Others),
    (   More == []
    ->  Problem = undeliverable(Formal, Id, From, Message)
    ;   Problem = undeliverable(Formal, Id, From, Message, Others)
    ),
    Count is Others+1,
    report(warning, lost_messages, Id, Count, typhon(Problem)).

came_back(Formal, Id, Mail) :-
    partition(is_from_bridge, Mail, Bridged, Sent),
    give_back(Formal, Id, Bridged),
    (   Sent == []
    ->  true
    ;   report(Formal, Id, Sent)
    ).

typhon_durable:undelivered(message, shown(_, Message), Endpoint,
                                   Formal) :-
    typhon_durable:undelivered(message, Message, Endpoint, Formal).
typhon_durable:undelivered(message, message(Id, Mail, _), _, Formal) :-
    (   mail_may_be_kept(Id)
    ->  scheduler_call(unit_of_work(kept_or_lost(Formal, Id, Mail)))
    ;   mail_lost(Formal, Id, Mail)
    ).

                /*******************************
                *            LETTERS           *
                *******************************/

%!  backlog(+Id) is semidet.
%
%   There are letters that wait for Id.

backlog(Id) :-
    waits(Id, _, _, _),
    !.

%   backlog_add(+Id, +Letter): add Letter to the backlog of Id. If as many
%   messages wait as the setting `messages` allows, they are lost.

backlog_add(Id, Letter) :-
    (   counted_in(Letter)
    ->  durable_number(N),
        durable_put(wait, Id, N, Letter),
        put(Id, Letter)
    ;   Letter = letter(Mail, _),
        mail_lost(resource_error(backlog), Id, Mail)
    ).

%   The flag has the number of messages that wait, those that are being tried
%   included.

counted_in(Letter) :-
    setting(typhon_backlog:messages, Most),
    message_count([Letter], More),
    flag(typhon_mail, Count, Count+More),
    (   Count+More =< Most
    ->  true
    ;   flag(typhon_mail, Now, Now-More),
        fail
    ).

counted(Letters, Sign) :-
    message_count(Letters, Count),
    count(Sign*Count).

count(More) :-
    flag(typhon_mail, All, All+More).

message_count(Letters, Count) :-
    aggregate_all(sum(N), ( member(letter(Mail, _), Letters), length(Mail, N) ),
                  Count).

%   A journal has letters one by one; a saved network has all letters of an
%   agent as one item.

:- durable(wait, Id, _, Letter, letter_item(Id, Letter), add(Id, Letter)).
:- durable(backlog, Id, Tries, Letters, backlog_item(Id, Tries, Letters),
           backlog_restore(Id, Tries, Letters)).

letter_item(Id, Letter) :-
    backlog_item(Id, _, Letters),
    member(Letter, Letters).

%   Called while no thread tries letters: the queue is emptied and filled again.

backlog_item(Id, Tries, Letters) :-
    waits(Id, Queue, Tries, _),
    fifo_empty(Queue, Letters),
    maplist(thread_send_message(Queue), Letters).

backlog_restore(Id, Tries, Letters) :-
    message_queue_create(Queue),
    counted(Letters, 1),
    maplist(thread_send_message(Queue), Letters),
    assertz(waits(Id, Queue, Tries, idle)).

add(Id, Letter) :-
    counted([Letter], 1),
    put(Id, Letter).

put(Id, Letter) :-
    (   waits(Id, Queue, _, _)
    ->  true
    ;   message_queue_create(Queue),
        assertz(waits(Id, Queue, 0, idle))
    ),
    thread_send_message(Queue, Letter).

%   backlog_begin(+Id, -Letters:list, -Tries) is semidet.
%
%   Take out all letters to try them; Tries attempts have failed before.

backlog_begin(Id, Letters, Tries) :-
    retract(waits(Id, Queue, Tries, idle)),
    !,
    fifo_empty(Queue, Letters),
    message_count(Letters, Count),
    assertz(waits(Id, Queue, Tries, tried(Count))).

%   backlog_again(+Id, +Letters:list, +Tries) is det.
%
%   Put Letters back, before those that have come meanwhile.

backlog_again(Id, Letters, Tries) :-
    retract(waits(Id, Queue, _, tried(_))),
    !,
    fifo_empty(Queue, Newer),
    append(Letters, Newer, All),
    durable_drop_all(wait, Id),
    maplist(note_letter(Id), All),
    maplist(thread_send_message(Queue), All),
    assertz(waits(Id, Queue, Tries, idle)).

note_letter(Id, Letter) :-
    durable_number(N),
    durable_put(wait, Id, N, Letter).

%   backlog_done(+Id) is semidet.
%
%   The letters that were taken out have been sent.  Fails if others wait now.

backlog_done(Id) :-
    retract(waits(Id, Queue, _, tried(Count))),
    !,
    count(-Count),
    (   thread_peek_message(Queue, _)
    ->  assertz(waits(Id, Queue, 0, idle)),
        fail
    ;   message_queue_destroy(Queue)
    ).

%!  post_tried is semidet.
%
%   A thread is trying letters.

post_tried :-
    waits(_, _, _, tried(_)),
    !.

%   backlog_leaves(+Id, +Letters) is det.
%
%   Drop from the journal the letters that are being tried, but Letters, as the
%   others will be noted elsewhere; those that have come meanwhile stay.

backlog_leaves(Id, Letters) :-
    durable_drop_all(wait, Id),
    maplist(note_letter(Id), Letters),
    (   waits(Id, Queue, _, tried(_))
    ->  fifo_empty(Queue, Newer),
        maplist(note_letter(Id), Newer),
        maplist(thread_send_message(Queue), Newer)
    ;   true
    ).

%   backlog_all(+Id, -Letters:list): take the letters for Id, which has
%   arrived. A thread that is trying letters finds the agent by itself.

backlog_all(Id, Letters) :-
    (   retract(waits(Id, Queue, _, idle))
    ->  fifo_empty(Queue, Letters),
        counted(Letters, -1),
        durable_drop_all(wait, Id),
        message_queue_destroy(Queue)
    ;   Letters = []
    ).

%   The scheduler has stopped, so no thread can try them.

typhon_runtime:ending(after) :-
    retract(waits(_, Queue, _, State)),
    fifo_empty(Queue, Letters),
    counted(Letters, -1),
    ( State = tried(Count) -> count(-Count) ; true ),
    message_queue_destroy(Queue),
    fail.

                /*******************************
                *             TRIES            *
                *******************************/

%   The pause before the next attempt.  A process is presumed gone after
%   most_tries/1 attempts.

pause(Tries, Seconds) :-
    Seconds is min(2.0, 0.05*2**min(Tries, 10)).

most_tries(6).

%   The end of a process that was never connected is not reported.  A letter for
%   it waits as long as news for an unreachable home.

unknown_tries(Tries) :-
    most_tries(Least),
    pause(Least, Pause),
    setting(typhon_news:news_seconds, Seconds),
    Tries is max(Least, ceiling(Seconds/Pause)).

%   retry_later(+Id, +Letter, +Way): keep Letter, and try it later; Way, see
%   way_out/3, is the reason. Inside with_agent/2.

retry_later(Id, _, wait(Letter)) :-
    !,
    backlog_add(Id, Letter),
    try_later(Id, 0).
retry_later(Id, _, to(_, Letter)) :-
    !,
    backlog_add(Id, Letter),
    scheduler_call(try(Id)).
retry_later(Id, letter(Mail, _), nowhere) :-
    agent_outcome(Id, _),
    !,
    mail_lost(existence_error(agent, Id), Id, Mail).
retry_later(Id, Letter, nowhere) :-
    backlog_add(Id, Letter),
    try_later(Id, 0).

try_later(Id, Tries) :-
    pause(Tries, Seconds),
    debug(typhon(mail), '~w: a letter waits ~3f seconds', [Id, Seconds]),
    alarm_in(Seconds, Id, mail).

typhon_scheduler:fire(Id, mail) :-
    !,
    scheduler_call(try(Id)).

typhon_scheduler:over(Id, mail) :-
    \+ backlog(Id).

typhon_durable:go_on :-
    retries_go_on.

%!  retries_go_on is det.
%
%   Soon try all letters that wait.

retries_go_on :-
    forall(backlog(Id), try_later(Id, 0)).

%   try(+Id): try the letters for Id; in a worker.

try(Id) :-
    (   with_agent(Id, backlog_begin(Id, Letters, Tries))
    ->  one_letter(Letters, Letter),
        unit_of_work(tried(Id, Letter, Tries))
    ;   true
    ).

%   One with_agent/2 makes one journal entry of two changes: the letter leaves
%   the backlog, and it has a new place.  This entry must precede the entries of
%   other threads about the backlog.

tried(Id, Letter, Tries) :-
    with_agent(Id, ( catch(leave_backlog(Id, Letter, Way), error(Formal, _),
                           Way = failed(Formal)),
                     (   Way = to(_, _)
                     ->  true
                     ;   Way == nowhere,
                         mail_may_be_kept(Id)
                     ->  backlog_leaves(Id, [Letter]),
                         enqueue_changes
                     ;   conclude(Way, Id, Letter, Tries),
                         enqueue_changes
                     ) )),
    send_connecting(Way, Id, Letter, Tries).

leave_backlog(Id, Letter, Way) :-
    backlog_leaves(Id, []),
    step(Id, Letter, Way).

%   The letter needs a new connection, or may be kept; it leaves the backlog when
%   it is sent, or kept.

send_connecting(to(Endpoint, Letter1), Id, Letter, Tries) :-
    !,
    catch(( way_send(Endpoint, Id, Letter1), Way = done ), error(Formal, _),
          Way = failed(Formal)),
    with_agent(Id, conclude(Way, Id, Letter, Tries)).
send_connecting(nowhere, Id, Letter, Tries) :-
    mail_may_be_kept(Id),
    !,
    Letter = letter(Mail, _),
    (   kept(existence_error(agent, Id), Id, Mail)
    ->  Way = done
    ;   Way = nowhere
    ),
    with_agent(Id, ( backlog_leaves(Id, []),
                     conclude(Way, Id, Letter, Tries),
                     enqueue_changes )).
send_connecting(_, _, _, _).

step(Id, letter(Mail, _), nowhere) :-
    cut_off(Id, Mail),
    !.
step(Id, letter(Mail, _), done) :-
    way_in(Id, Mail),
    !.
step(Id, Letter, Way) :-
    way_out(Id, Letter, Way).

conclude(done, Id, _, _) :-
    (   backlog_done(Id)
    ->  true
    ;   scheduler_call(try(Id))
    ).
conclude(wait(Letter), Id, _, _) :-
    backlog_again(Id, [Letter], 0),
    try_later(Id, 0).
conclude(nowhere, Id, Letter, Tries) :-
    attempt_failed(Id, Letter, Tries, existence_error(agent, Id)).
conclude(failed(Formal), Id, Letter, Tries) :-
    attempt_failed(Id, Letter, Tries, Formal).

attempt_failed(Id, letter(Mail, _), Tries, Formal) :-
    is_hopeless(Formal, Id, Tries),
    !,
    mail_lost(Formal, Id, Mail),
    conclude(done, Id, _, 0).
attempt_failed(Id, Letter, Tries, _) :-
    Tries1 is Tries+1,
    backlog_again(Id, [Letter], Tries1),
    try_later(Id, Tries1).

is_hopeless(existence_error(agent, Id), Id, Tries) :-
    (   agent_outcome(Id, _)
    ->  true
    ;   most_tries(Most),
        Tries >= Most
    ).
is_hopeless(host_unreachable(Endpoint), _, Tries) :-
    endpoint_gone(Endpoint),
    most_tries(Most),
    Tries >= Most.
is_hopeless(host_unreachable(Endpoint), _, Tries) :-
    \+ endpoint_peer(Endpoint, process(_)),
    unknown_tries(Most),
    Tries >= Most.
is_hopeless(resource_error(frame_bytes), _, _).
is_hopeless(existence_error(endpoint, _), _, _).   % this process ends
