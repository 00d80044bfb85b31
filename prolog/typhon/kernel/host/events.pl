:- module(typhon_events,
          [ event/4,                    % +Kind, +Host, +Agent, +What
            event_subscribed/1,         % +Kind
            event_shown/3,              % +Host, +What, -Shown
            events_subscribe/3,         % +Kinds, +Key, +Listener
            log_kind/2,                 % ?Wanted, -Kind
            events_forget/1,            % +Key
            events_unsubscribe/1        % +Listener
          ]).
:- use_module(library(error), []).
:- use_module(library(lists), [member/2]).
:- use_module('../base/reports', [report/4]).

/** <module> Events, and their listeners

Modules report events here, by event/4, and need not know the listeners: the
log of a host, tracers of an agent, watches.

  | kind     | events                                                     |
  | -------- | ---------------------------------------------------------- |
  | life     | `created`, ended(Outcome)                                  |
  | bad_ends | faulty(Error), and ended(failed) of an agent that is kept  |
  | faults   | fault(Fault), and ended(Outcome) of an agent that was kept |
  | hops     | left(To), arrived(From, Seconds), stayed(To), cloned(Id)   |
  | messages | sent(To, Message), received(From, Message)                 |
  | facts    | leave(Fact), take(Fact)                                    |
  | said     | log(Term): what agents log                                 |
  | links    | link(To), unlink(To)                                       |
  | hosts    | `started`, `stopped`, refused(Agent, Reason)               |
  | goals    | goal(Goal): only of agents that are traced                 |

An event that concerns a host, and no agent, has the agent `none`.

A listener is registered for a kind, and for the host or the agent whose events
it gets.  As long as a kind has no listener, an event of it costs less than a
tenth of a microsecond.

*Threading*: any thread reports events. A listener must not make it wait.
*/

:- multifile
    handle_event/4,             % Listener, Host, Agent, What
    shown/3,                    % Host, What, Shown: with content
    error:has_type/2.

:- dynamic subscription/3.      % Kind, Host or agent, Listener

%   A log can have events of these kinds.  Goals are only for tracers of an
%   agent.

error:has_type(event_kind, Kind) :-
    nonvar(Kind),
    log_kind(Kind, _).

%!  log_kind(?Wanted, -Kind) is nondet.
%
%   A log can be configured with Wanted, and then gets events of Kind.

log_kind(messages(content), messages).
log_kind(Kind, Kind) :-
    member(Kind, [hops, messages, facts, links, hosts, faults]).

%!  event(+Kind, +Host, +Agent, +What) is det.
%
%   Report the event What of Agent on Host, the name of a host of this process.

event(Kind, Host, Agent, What) :-
    (   subscription(Kind, _, _)
    ->  notify_listeners(Kind, Host, Agent, What)
    ;   true
    ).

%!  event_subscribed(+Kind) is semidet.
%
%   There is a listener for Kind in this process.

event_subscribed(Kind) :-
    subscription(Kind, _, _),
    !.

%!  event_shown(+Host, +What, -Shown) is det.
%
%   What is an event on Host; Shown is the form of it that logs and watches get:
%   without the content of messages, unless an option of Host shows it.

event_shown(Host, What, Shown) :-
    (   shown(Host, What, Shown0)
    ->  Shown = Shown0
    ;   without_content(What, Shown)
    ).

without_content(sent(To, _), Shown) =>
    Shown = sent(To).
without_content(received(From, _), Shown) =>
    Shown = received(From).
without_content(What, Shown) =>
    Shown = What.

notify_listeners(Kind, Host, Agent, What) :-
    subscription(Kind, Agent, _),
    !,
    findall(Listener, listener(Kind, Host, Agent, Listener), Listeners0),
    sort(Listeners0, Listeners),
    forall(member(Listener, Listeners),
           notify(Listener, Host, Agent, What)).
notify_listeners(Kind, Host, Agent, What) :-
    forall(subscription(Kind, Host, Listener),
           notify(Listener, Host, Agent, What)).

%   An event that is printed for one agent also goes to the log.

listener(Kind, Host, _, Listener) :-
    subscription(Kind, Host, Listener).
listener(Kind, _, Agent, Listener) :-
    subscription(Kind, Agent, Listener).
listener(Kind, _, Agent, log) :-
    subscription(Kind, Agent, _).

%   An error or a failure of a listener does not stop the agent.

notify(Listener, Host, Agent, What) :-
    catch(ignore(handle_event(Listener, Host, Agent, What)),
          error(Formal, Context),
          report(warning, errors_of_listeners, Host,
                 typhon(raised(error(Formal, Context))))).

%!  events_subscribe(+Kinds:list, +Key, +Listener) is det.
%
%   Register Listener, which handle_event/4 defines, for events of Kinds on the
%   host, or of the agent, Key.

events_subscribe(Kinds, Key, Listener) :-
    with_mutex(typhon_events,
               forall(( member(Kind, Kinds),
                        \+ subscription(Kind, Key, Listener) ),
                      assertz(subscription(Kind, Key, Listener)))).

%!  events_forget(+Key) is det.
%
%   Remove all listeners for Key.

events_forget(Key) :-
    (   subscription(_, _, _)
    ->  retractall(subscription(_, Key, _))
    ;   true
    ).

%!  events_unsubscribe(+Listener) is det.
%
%   Remove Listener for all keys.

events_unsubscribe(Listener) :-
    retractall(subscription(_, _, Listener)).
