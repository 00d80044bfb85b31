:- module(typhon_watch_senders, []).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/compiling', [topics/1]).
:- use_module('../../kernel/base/own_thread', [stop_thread/1]).
:- use_module('../../kernel/wire',
              [endpoint_address/1, endpoint_reply/2, mobile_term/1]).
:- use_module('../../kernel/host',
              [ clock/3, event_shown/3, events_subscribe/3,
                events_unsubscribe/1, host/3, peer_may/3, time_repeats/2,
                time_kind/1 ]).
:- use_module(event_sender,
              [ buffer_close/1, buffer_open/3, buffer_put/3, sender_signal/2,
                sender_run/1, time_at/2 ]).

/** <module> Sending events to watches

Each watch, of this process or another, of hosts of this process has a thread,
see module `event_sender`, and a buffer in which its events gather.

A watch is removed when it ends, when its process answers that it has no watch
of that name, or when that process cannot be reached any more.

A watching process sends requests of kind `watch`; Wanted are names of hosts, or
`all`:

  | watch(Id, Wanted) | watching(Endpoint, New, Hosts), see module `typhon_watches` |
  | unwatch(Id)       | `ended`, when all events have been sent            |

Events are sent with requests of kind `watched`:

  | events(Id, Events) | `more`, or `no` if there is no such watch |
  | alive(Id)          | `yes` or `no`                             |

*Threading*: a sender for each watch, joined by the thread that removes its
record.  The sender is no `server`, since it waits for the answer of the watch
to each batch.
*/

:- topics([watch]).

:- multifile
    typhon_endpoint:connection/2,
    typhon_endpoint:requested/4,
    typhon_events:handle_event/4,
    typhon_hosting:begins/1,
    typhon_runtime:ending/1.

:- setting(events, positive_integer, 10 000,
           "Events that may wait for a slow watch").
:- setting(virtual_events, positive_integer, 1 000 000,
           "The same in virtual time, which runs ahead of all watches").

:- setting(watches, positive_integer, 100,
           "Watches that another process may have here").

:- dynamic sender/5.            % Peer, Id, Thread, Signals,
                                % watch(Wanted, Buffer)

kinds([life, faults, hops, messages, facts, said, links, hosts]).

                /*******************************
                *            WATCHES           *
                *******************************/

typhon_endpoint:requested(watch, watch(Id, Wanted), Peer, ReplyTo) :-
    with_mutex(typhon_watch_senders, sender_start(Peer, Id, Wanted, New)),
    !,
    subscribe_hosts(New, Wanted, Peer, Id, Hosts),
    (   endpoint_address(Own)
    ->  endpoint_reply(ReplyTo, watching(Own, New, Hosts))
    ;   true                            % the endpoint has stopped
    ).
typhon_endpoint:requested(watch, watch(_, _), _, ReplyTo) :-
    endpoint_reply(ReplyTo, not_permitted(watch)).
typhon_endpoint:requested(watch, unwatch(Id), Peer, ReplyTo) :-
    (   sender(Peer, Id, _, Signals, watch(_, Buffer))
    ->  events_unsubscribe(watch(Buffer, _, _)),
        sender_signal(Signals, end(ReplyTo))
    ;   endpoint_reply(ReplyTo, ended)
    ).

sender_start(Peer, Id, Wanted, New) :-
    retract(sender(Peer, Id, Thread, Signals, watch(_, Buffer))),
    !,
    assertz(sender(Peer, Id, Thread, Signals, watch(Wanted, Buffer))),
    New = false.
sender_start(Peer, Id, Wanted, true) :-
    has_space(Peer),
    message_queue_create(Signals),
    most(Most),
    buffer_open(Most, Signals, Buffer),
    flag(typhon_event_sender, N, N+1),
    atom_concat(typhon_event_sender_, N, Alias),
    thread_create(sender(Peer, Id, Signals, Buffer), Thread, [alias(Alias)]),
    assertz(sender(Peer, Id, Thread, Signals, watch(Wanted, Buffer))),
    debug(typhon(watch), '~w of ~w watches', [Id, Peer]).

has_space(Peer) :-
    endpoint_address(Peer),
    !.
has_space(Peer) :-
    aggregate_all(count, sender(Peer, _, _, _, _), Count),
    setting(watches, Most),
    Count < Most.

most(Most) :-
    time_kind(Kind),
    time_repeats(Kind, _),
    !,
    setting(virtual_events, Most).
most(Most) :-
    setting(events, Most).

subscribe_hosts(New, Wanted, Peer, Id, Hosts) :-
    sender(Peer, Id, _, _, watch(_, Buffer)),
    !,
    findall(Name-(Address-clock(Epoch, Rate)),
            ( host(Name, Address, _),
              is_wanted(Wanted, Name),
              may_watch(Peer, Name),
              clock(Name, Epoch, Rate) ),
            Pairs),
    forall(( New == true, member(Name-Host, Pairs) ),
           subscribe_host(Name, Host, Buffer)),
    findall(Host, member(_-Host, Pairs), Hosts).
subscribe_hosts(_, _, _, _, []).

is_wanted(all, _).
is_wanted([Name0|Names], Name) :-
    memberchk(Name, [Name0|Names]).

may_watch(Peer, _) :-
    endpoint_address(Peer),
    !.
may_watch(Peer, Name) :-
    peer_may(Peer, Name, watch).

subscribe_host(Name, Address-Clock, Buffer) :-
    kinds(Kinds),
    events_subscribe(Kinds, Name, watch(Buffer, Address, Clock)).

typhon_hosting:begins(Name) :-
    sender(Peer, _, _, _, watch(Wanted, Buffer)),
    is_wanted(Wanted, Name),
    may_watch(Peer, Name),
    host(Name, Address, _),
    clock(Name, Epoch, Rate),
    subscribe_host(Name, Address-clock(Epoch, Rate), Buffer).

typhon_endpoint:connection(Peer, down) :-
    forall(sender(Peer, _, _, Signals, _), sender_signal(Signals, now(check))).

%   Senders end only after they have sent the last events, the stops of the
%   hosts.

typhon_runtime:ending(before) :-
    stop_senders.

stop_senders :-
    with_mutex(typhon_watch_senders, retract(sender(_, _, Thread, Signals, _))),
    !,
    sender_signal(Signals, end(none)),
    stop_thread(Thread),
    stop_senders.
stop_senders.

typhon_events:handle_event(watch(Buffer, Address, Clock), Host, Agent, What) :-
    time_at(Clock, Time),
    event_shown(Host, What, Shown),
    public_event(Shown, Clock, Public),
    catch(buffer_put(Buffer, Address-Clock,
                    event(Time, Address, Agent, Public)),
          error(existence_error(_, _), _),
          true).                        % the sender has ended

%   A watch needs the clock of a host that starts, to date its loss.  Agents may
%   log terms that cannot travel.

public_event(started, Clock, Public) =>
    Public = started(Clock).
public_event(log(Term), _, Public) =>
    (   catch(mobile_term(Term), error(_, _), fail)
    ->  Public = log(Term)
    ;   format(atom(Text), '~q', [Term]),
        Public = log(Text)
    ).
public_event(What, _, Public) =>
    Public = What.

sender(Peer, Id, Signals, Buffer) :-
    call_cleanup(sender_run(to(Peer, Id, Signals, Buffer)),
                 sender_end(Peer, Id, Signals, Buffer)).

sender_end(Peer, Id, Signals, Buffer) :-
    debug(typhon(watch), '~w of ~w watches no more', [Id, Peer]),
    events_unsubscribe(watch(Buffer, _, _)),
    thread_self(Me),
    (   with_mutex(typhon_watch_senders,
                   retract(sender(Peer, Id, _, Signals, _)))
    ->  thread_detach(Me)
    ;   true
    ),
    buffer_close(Buffer),
    message_queue_destroy(Signals).
