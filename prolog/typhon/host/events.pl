:- module(typhon_events,
          [ event/4,                    % +Kind, +Host, +Agent, +What
            event_heard/1,              % +Kind
            events_hear/3,              % +Kinds, +Key, +Listener
            events_unhear/3,            % +Kinds, +Key, +Listener
            events_forget/1,            % +Key
            events_log/1,               % +Host
            host_log/3,                 % +Host, +Agent, +What
            host_logs/1                 % +Host
          ]).
:- use_module(library(error), []).
:- use_module(library(lists), [member/2]).
:- use_module('../wire', [endpoint_post/3]).
:- use_module(hosts, [address_parts/3, host/3, host_option/2]).

/** <module> What happens, and who wants to hear of it

Rooms that do something say so here, by event/4, and need not know who
listens: the log of a host, somebody who traces an agent, or who watches.

  | kind     | what                                                       |
  | -------- | ---------------------------------------------------------- |
  | life     | `created`, ended(Outcome), faulty(Error)                   |
  | hops     | left(To), arrived(From, Seconds), stayed(To), cloned(Id)   |
  | messages | sent(To, Message), received(From, Message)                 |
  | facts    | leave(Fact), take(Fact)                                    |
  | goals    | goal(Goal): only of agents that are traced                 |

Listeners are noted by kind, and by the host or the agent whose events they
want.  As long as nobody has asked for a kind, an event of it costs less than
a tenth of a microsecond.

*Threading*: any thread says something, and is not to wait for those who
listen.
*/

:- multifile
    told/4,                     % Listener, Host, Agent, What
    error:has_type/2.

:- dynamic hears/3.             % Kind, Host or agent, Listener

%   Of goals only those can hear who trace an agent.

error:has_type(event_kind, Kind) :-
    memberchk(Kind, [hops, messages, facts]).

%!  event(+Kind, +Host, +Agent, +What) is det.
%
%   What has happened to Agent on Host, the name of a host of this process.

event(Kind, Host, Agent, What) :-
    (   hears(Kind, _, _)
    ->  tell(Kind, Host, Agent, What)
    ;   true
    ).

%!  event_heard(+Kind) is semidet.
%
%   Somebody in this process may want to hear of Kind.

event_heard(Kind) :-
    hears(Kind, _, _),
    !.

%   What is told of one agent to people is in the log, too.

tell(Kind, Host, Agent, What) :-
    findall(Listener, listener(Kind, Host, Agent, Listener), Listeners0),
    sort(Listeners0, Listeners),
    forall(member(Listener, Listeners),
           tell_one(Listener, Host, Agent, What)).

listener(Kind, Host, _, Listener) :-
    hears(Kind, Host, Listener).
listener(Kind, _, Agent, Listener) :-
    hears(Kind, Agent, Listener).
listener(Kind, _, Agent, log) :-
    hears(Kind, Agent, _).

%   Who cannot be told is no reason for an agent to stop.

tell_one(Listener, Host, Agent, What) :-
    catch(ignore(told(Listener, Host, Agent, What)),
          error(Formal, Context),
          print_message(warning, error(Formal, Context))).

%!  events_hear(+Kinds:list, +Key, +Listener) is det.
%!  events_unhear(+Kinds:list, +Key, +Listener) is det.
%!  events_forget(+Key) is det.
%
%   Listener, of which told/4 knows, hears of events of Kinds on a host, or
%   of an agent, Key, or no longer; nobody listens any more to what happens
%   to Key.

events_hear(Kinds, Key, Listener) :-
    forall(member(Kind, Kinds), assertz(hears(Kind, Key, Listener))).

events_unhear(Kinds, Key, Listener) :-
    forall(member(Kind, Kinds), retractall(hears(Kind, Key, Listener))).

events_forget(Key) :-
    (   hears(_, _, _)
    ->  retractall(hears(_, Key, _))
    ;   true
    ).

                /*******************************
                *              LOG             *
                *******************************/

%!  events_log(+Host) is det.
%
%   The log of Host, if it has one, hears what its options say.

events_log(Host) :-
    (   log_server(Host, _, Kinds)
    ->  events_hear([life|Kinds], Host, log)
    ;   true
    ).

log_server(Host, Log, []) :-
    host_option(Host, log(Log)).
log_server(Host, Log, Kinds) :-
    host_option(Host, log(Log, Kinds)).

told(log, Host, Agent, What) :-
    without_contents(What, Public),
    host_log(Host, Agent, Public).

without_contents(sent(To, _), Public) =>
    Public = sent(To).
without_contents(received(From, _), Public) =>
    Public = received(From).
without_contents(What, Public) =>
    Public = What.

%!  host_log(+Host, +Agent, +What) is det.
%!  host_logs(+Host) is semidet.
%
%   Send an event to the log server of Host, if it has one; whether it has.

host_log(Host, Agent, What) :-
    log_server(Host, Log, _),
    !,
    host(Host, Address, _),
    address_parts(Log, _, Endpoint),
    catch(endpoint_post(Endpoint, log, event(Log, Address, Agent, What)),
          error(Formal, Context),
          print_message(warning, error(Formal, Context))).
host_log(_, _, _).

host_logs(Host) :-
    log_server(Host, _, _),
    !.
