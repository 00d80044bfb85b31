:- module(typhon_subscribers,
          [ subscriber/2,               % -Host, -Agent
            subscribe/5,                % +Service, +Host, +Key, +Agent,
                                        % +Options
            unsubscribe/4,              % +Service, +Host, +Key, +Agent
            subscription/3,             % ?Service, ?Host, ?Key
            subscribers_notify/5,       % +Service, +Host, +Key, +Message,
                                        % +Same
            subscribers_notify_new/5,   % +Service, +Host, +Key, +Message,
                                        % +Same
            subscribers_drop/4,         % +Service, +Host, +Key, +Message
            subscribers_forget/2        % +Service, +Host
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [max_list/2, member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../../kernel/host',
              [ context_agent/1, context_now/2, events_subscribe/3,
                events_unsubscribe/1 ]).
:- use_module('../../kernel/agent', [agent/5]).
:- use_module(inbox, [gap_forget/3, inbox_key/2, inbox_put/4]).

/** <module> Subscribers of services

Agents subscribe to a Key, such as a topic.  They receive its messages until
they unsubscribe, leave the host, end, or become faulty; an agent whose hop
fails stays subscribed.  A goal of remote/2 has no agent, so messages of its
subscriptions are stored as facts, until the service ends.

*Threading*: any thread; the thread that reads incoming messages calls
subscribers_notify/5, which does not wait.  The hook wanted/4 runs inside a
mutex, so that its calls are in order, and must not wait.
*/

:- multifile
    wanted/4,                   % Service, Host, Key, Boolean: a subscriber
                                % came back; or the last one has left
    typhon_events:handle_event/4,
    typhon_options:declared/4.

:- dynamic
    subscribed/6,               % Text, Agent, Service, Host, How, Key: indexed
                                % by Text, see inbox_key/2
    away/2,                     % Agent, subscribed(...): Agent has departed
    subscribed_events/1.        % Host: its events are received

:- setting(queue, positive_integer, 1000,
           "Messages of bridges that may wait for an agent").

%!  subscriber(-Host, -Agent) is det.
%
%   Agent is the running agent, `none` in goals of remote/2, and Host its host.
%
%   @error existence_error(running_agent, here)

subscriber(Host, Agent) :-
    (   context_now(Host, Agent)
    ->  true
    ;   context_agent(Agent)
    ).

%!  subscribe(+Service, +Host, +Key, +Agent, +Options) is det.
%
%   Agent subscribes to Key, an atom or another ground term; a second
%   subscription replaces the first.  Options:
%
%     - as(How): `message` (default): as a message Service-Message; `fact`: as a
%       fact Service-Message in the tuple space; `latest`: as such a fact, which
%       replaces an older fact about the same subject
%     - queue(N): when so many messages wait for the agent, or the tuple space
%       has so many facts, further ones are dropped and counted; default is the
%       setting `queue`
%
%   @error domain_error(subscription_option, Option)

subscribe(Service, Host, Key, Agent, Options) :-
    check_options(subscription_option, Options),
    how(Options, Agent, How),
    inbox_key(Key, Text),
    with_mutex(typhon_subscribers,
               ( subscribe_events(Host),
                 retractall(subscribed(Text, Agent, Service, Host, _, _)),
                 assertz(subscribed(Text, Agent, Service, Host, How,
                                    Key)) )).

how(Options, Agent, how(As, Max, Since)) :-
    monotonic_time(Since),
    setting(queue, Default),
    option(queue(Max), Options, Default),
    option(as(As), Options, message),
    (   As == message,
        Agent == none
    ->  existence_error(running_agent, here)
    ;   true
    ).

typhon_options:declared(subscription_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(as(X), oneof([message,fact,latest]), X).
option_type(queue(X), positive_integer, X).

%!  unsubscribe(+Service, +Host, +Key, +Agent) is semidet.
%
%   End the subscription of Agent to Key.  Fails if there is none.

unsubscribe(Service, Host, Key, Agent) :-
    inbox_key(Key, Text),
    with_mutex(typhon_subscribers,
               ( once(retract(subscribed(Text, Agent, Service, Host, _, _))),
                 unsubscribed(Service, Host, Key, Agent) )).

unsubscribed(Service, Host, Key, Agent) :-
    gap_forget(Service, Key, Agent),
    inbox_key(Key, Text),
    (   subscribed(Text, _, Service, Host, _, _)
    ->  true
    ;   ignore(catch(wanted(Service, Host, Key, false), error(Formal, _),
                     not_unsubscribed(Formal)))
    ).

not_unsubscribed(Formal) :-
    debug(typhon(bridge), '~p', [Formal]).

%!  subscription(?Service, ?Host, ?Key) is nondet.

subscription(Service, Host, Key) :-
    subscribed(_, _, Service, Host, _, Key0),
    Key = Key0.

%!  subscribers_notify(+Service, +Host, +Key, +Message, +Same) is det.
%!  subscribers_notify_new(+Service, +Host, +Key, +Message, +Same) is det.
%
%   Deliver Message, which has arrived for Key.  Same is a pattern of the
%   messages that this one replaces for subscribers with as(latest).
%   subscribers_notify_new/5 delivers a message that is meant for new
%   subscribers: only to those that subscribed at most a second before the last
%   one.

subscribers_notify(Service, Host, Key, Message, Same) :-
    inbox_key(Key, Text),
    findall(Agent-How, subscribed(Text, Agent, Service, Host, How, _), Pairs),
    notify_all(Pairs, Service, Host, Key, Message-Same).

subscribers_notify_new(Service, Host, Key, Message, Same) :-
    inbox_key(Key, Text),
    findall(Since-(Agent-How),
            ( subscribed(Text, Agent, Service, Host, How, _),
              How = how(_, _, Since) ),
            Subscribers),
    pairs_keys(Subscribers, Times),
    max_list([0|Times], Last),
    findall(Pair,
            ( member(Since-Pair, Subscribers), Since > Last-1 ),
            Pairs),
    notify_all(Pairs, Service, Host, Key, Message-Same).

notify_all(Pairs, Service, Host, Key, What) :-
    forall(member(Agent-how(As, Max, _), Pairs),
           notify(how(As, Max), Service-Key, Host-Agent, What)).

notify(How, Service-Key, Host-Agent, What) :-
    inbox_put(How, Service-Key, Host-Agent, What),
    !.
notify(_, Service-Key, Host-Agent, _) :- % the agent has left
    ignore(unsubscribe(Service, Host, Key, Agent)).

%!  subscribers_drop(+Service, +Host, +Key, +Message) is det.
%
%   Key is not available: subscribers get Message and are dropped.

subscribers_drop(Service, Host, Key, Message) :-
    subscribers_notify(Service, Host, Key, Message, Message),
    inbox_key(Key, Text),
    findall(Agent, subscribed(Text, Agent, Service, Host, _, _), Agents),
    forall(member(Agent, Agents),
           ignore(unsubscribe(Service, Host, Key, Agent))).

%!  subscribers_forget(+Service, +Host) is det.

subscribers_forget(Service, Host) :-
    with_mutex(typhon_subscribers,
               ( forget(Service, Host),
                 unsubscribe_events(Host) )).

forget(Service, Host) :-
    retract(subscribed(_, Agent, Service, Host, _, Key)),
    !,
    gap_forget(Service, Key, Agent),
    forget(Service, Host).
forget(_, _).

                /*******************************
                *    AGENTS THAT LEAVE OR END  *
                *******************************/

%   Events of a host are received while it has subscribers.

subscribe_events(Host) :-
    (   subscribed_events(Host)
    ->  true
    ;   assertz(subscribed_events(Host)),
        events_subscribe([life,bad_ends,hops], Host, subscribers(Host))
    ).

unsubscribe_events(Host) :-
    (   subscribed(_, _, _, Host, _, _)
    ->  true
    ;   retractall(subscribed_events(Host)),
        events_unsubscribe(subscribers(Host))
    ).

typhon_events:handle_event(subscribers(_), Host, Agent, What) :-
    agent_event(What, Host, Agent).

agent_event(left(_), Host, Agent) =>
    with_mutex(typhon_subscribers,
               ( sweep, departs(Agent, Host) )).
agent_event(stayed(_), _, Agent) =>
    with_mutex(typhon_subscribers, comes_back(Agent)).
agent_event(ended(_), Host, Agent) =>
    drop_subscriptions(Agent, Host).
agent_event(faulty(_), Host, Agent) =>
    drop_subscriptions(Agent, Host).
agent_event(_, _, _) =>
    true.

departs(Agent, Host) :-
    retract(subscribed(Text, Agent, Service, Host, How, Key)),
    !,
    assertz(away(Agent, subscribed(Text, Agent, Service, Host, How, Key))),
    unsubscribed(Service, Host, Key, Agent),
    departs(Agent, Host).
departs(_, _).

comes_back(Agent) :-
    retract(away(Agent, Subscribed)),
    !,
    Subscribed = subscribed(_, _, Service, Host, _, Key),
    assertz(Subscribed),
    ignore(wanted(Service, Host, Key, true)),
    comes_back(Agent).
comes_back(_).

drop_subscriptions(Agent, Host) :-
    (   subscribed(_, Agent, _, Host, _, _)
    ->  with_mutex(typhon_subscribers, unsubscribe_all(Agent, Host))
    ;   true
    ).

unsubscribe_all(Agent, Host) :-
    retract(subscribed(_, Agent, Service, Host, _, Key)),
    !,
    unsubscribed(Service, Host, Key, Agent),
    unsubscribe_all(Agent, Host).
unsubscribe_all(_, _).

%   Remove agents that have departed and arrived elsewhere.  Each departure adds
%   one agent and checks two, so the table stays small.

sweep :-
    sweep_one,
    sweep_one.

sweep_one :-
    (   retract(away(Agent, Subscribed))
    ->  Subscribed = subscribed(_, _, _, Host, _, _),
        (   agent(Agent, Host, _, _, _)
        ->  assertz(away(Agent, Subscribed))
        ;   true
        )
    ;   true
    ).
