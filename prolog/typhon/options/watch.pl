:- module(typhon_watches,
          [ watch/3,                    % +Hosts, :OnEvent, -Watch
            unwatch/1,                  % +Watch
            overview/3,                 % +Hosts, -Processes, -Silent
            metrics/2                   % +Hosts, -Text
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2]).
:- use_module('../kernel/base/monotonic', [wait_within/2]).
:- use_module('../kernel/base/own_thread', [in_own_thread/1, stop_thread/1]).
:- use_module('../kernel/wire', [endpoint_request/4]).
:- use_module('../kernel/host',
              [ address_parts/3, host_unknown/1, process_ask/6,
                runtime_acquire/2, runtime_release/1 ]).
:- autoload('watch/metrics', [processes_metrics/2]).
:- autoload('watch/watch_receiver',
            [ receiver_close/1, receiver_open/2, receiver_put/2,
              receiver_run/4 ]).
:- autoload('watch/watched_hosts', [processes_overview/3, watched_places/2]).

/** <module> Watching: events of hosts as they happen

A process can watch hosts of this and of other processes.  A watch has a thread,
which calls OnEvent, see typhon_watch_receiver.  The processes of the hosts send
the events, see typhon_watch_senders.

This is the interface of the layer.  Its other modules are loaded when this
process begins a watch, or another process watches its hosts.

*Threading*: any thread that may wait; the thread of a watch may end it, too.
*/

%   `:` and not 1: a lambda expression in a meta-argument is compiled when its
%   file is loaded, and then loses variables that are not parameters.

:- meta_predicate watch(+, :, -).

:- dynamic watch_thread/2.      % Watch, Thread

%!  watch(+Hosts, :OnEvent, -Watch:atom) is det.
%
%   Call call(OnEvent, Event) for each event on Hosts from now on.  Hosts is a
%   host, a network, or a list of hosts and networks, of any process.  Event is
%   event(Time, Host, Agent, What), where Time is in seconds of the clock of
%   Host, Host is an address, Agent an id or `none`, and What is one of
%
%     - created, ended(Outcome), fault(Fault): an agent begins, ends, or becomes
%       faulty; Fault is the one of agent_property/2.  A faulty agent ends when
%       it is disposed of
%     - left(To), arrived(From, Seconds), stayed(To): an agent departs for To;
%       has arrived after a hop of Seconds; could not move to To
%     - cloned(Id), sent(To), received(From), log(Term), on hosts whose option
%       log(Address, Kinds) has messages(content) also sent(To, Message) and
%       received(From, Message)
%     - leave(Fact), take(Fact): a fact is put into the tuple space of Host, or
%       taken out
%     - link(To), unlink(To), started, stopped: Agent is `none`
%     - refused(Agent, Reason): Host did not admit Agent: the name of an agent
%       to be created there, or the id of an arriving one.  Reason is the one of
%       move_refused/2.  The agent of the event is `none`
%     - lost: the process of Host has ended or cannot be reached any more.  When
%       it is reachable again, Host has the event `started`
%     - skipped(Count): Count events of Host were dropped, since OnEvent is too
%       slow
%
%   The events of one host arrive in order.  All calls run one after the other
%   in a thread of the watch, so that hosts never wait for OnEvent.  Failure of
%   a call is ignored; the first exception is printed as a warning, and the
%   watch continues.
%
%   OnEvent may be a lambda expression; variables that are bound when watch/3 is
%   called keep these values, as Q in [E]>>p(Q, E).
%
%   Watch holds the endpoint of this process until unwatch/1.
%
%   @error existence_error(host, Host)
%   @error host_unreachable(Host), permission_error(authenticate, host, Host)

watch(Hosts, OnEvent, Watch) :-
    must_be(var, Watch),
    strip_module(OnEvent, _, Plain),
    must_be(callable, Plain),
    flag(typhon_watches, N, N+1),
    atom_concat(watch, N, Id),
    once(setup_call_catcher_cleanup(
             runtime_acquire(watch(Id), []),
             begin(Id, Hosts, OnEvent),
             Catcher,
             release_unless_begun(Catcher, Id))),
    Watch = Id.

begin(Id, Hosts, OnEvent) :-
    watched_places(Hosts, Places),
    receiver_open(Id, Queue),
    catch(start_thread(Places, Id, Queue, OnEvent), Ball,
          ( undo_begin(Places, Id, Queue),
            throw(Ball) )).

start_thread(Places, Id, Queue, OnEvent) :-
    findall(Asked, ( member(Place, Places), ask(Place, Id, Asked) ), All),
    atom_concat(typhon_, Id, Alias),
    thread_create(receiver_run(Id, Queue, OnEvent, All), Thread,
                  [alias(Alias)]),
    assertz(watch_thread(Id, Thread)).

undo_begin(Places, Id, Queue) :-
    receiver_close(Id),
    message_queue_destroy(Queue),
    forall(member(place(Endpoint, _, _), Places),
           endpoint_request(Endpoint, watch, unwatch(Id), ignored)).

:- public ignored/1.

ignored(_).

release_unless_begun(exit, _) :-
    !.
release_unless_begun(_, Id) :-
    in_own_thread(runtime_release(watch(Id))).

%   ask(+Place, +Id, -Asked): request the events of the watch Id from Place.  If
%   the process is one of a network, it may have ended.

ask(place(Endpoint, Wanted, Hosts), Id, asked(Endpoint, Wanted, Answer)) :-
    (   Hosts = asked([_-Host|_])
    ->  true
    ;   Host = Endpoint
    ),
    catch(process_ask(Endpoint, Host, watch, watch(Id, Wanted), Answer, 10),
          error(Formal, Context),
          process_gone(Hosts, error(Formal, Context), Answer)),
    must_have_hosts(Hosts, Answer).

process_gone(carried(Addresses), _, Answer) =>
    Answer = gone(Addresses).
process_gone(_, Error, _) =>
    throw(Error).

must_have_hosts(asked(Hosts), watching(_, _, There)) =>
    forall(( member(Name-Host, Hosts),
             \+ ( member(Address-_, There),
                  address_parts(Address, Name, _) ) ),
           host_unknown(Host)).
must_have_hosts(carried(_), _) =>
    true.

%!  unwatch(+Watch:atom) is det.
%
%   End Watch.  Earlier events are delivered first, for at most two seconds (the
%   setting `typhon_watches:last_seconds`); later ones are not.
%
%   @error existence_error(watch, Watch)

unwatch(Watch) :-
    must_be(atom, Watch),
    (   with_mutex(typhon_watches, retract(watch_thread(Watch, Thread)))
    ->  end(Watch, Thread)
    ;   existence_error(watch, Watch)
    ).

%   If the thread of the watch ends it, it cannot wait for earlier events, and
%   delivers none.

end(Watch, Thread) :-
    thread_self(Me),
    (   thread_property(Me, id(Id)),
        thread_property(Thread, id(Id))
    ->  receiver_close(Watch),
        thread_detach(Me)
    ;   in_own_thread(end_from_outside(Watch, Thread))
    ),
    runtime_release(watch(Watch)).

end_from_outside(Watch, Thread) :-
    setting(typhon_watches:last_seconds, Seconds),
    setup_call_cleanup(
        message_queue_create(Done),
        ( receiver_put(Watch, end(Done)),
          ignore(wait_within(Seconds, thread_get_message(Done, done)))
        ),
        message_queue_destroy(Done)),
    receiver_close(Watch),
    stop_thread(Thread).

%!  overview(+Hosts, -Processes:list, -Silent:list(atom)) is det.
%
%   Processes are the processes of Hosts, see watch/3, as
%   process(Endpoint, Pid, Hosts, Agents), with
%
%     - host(Address, Time, Load, Options, Links): Time is the time of its
%       clock, Load the number of its agents that count towards its capacity,
%       Options those of host_start/2 except tokens, Links pairs To-Cost
%     - agent(Id, Host, Program, State, Hops): State is that of
%       agent_property/2, without the error of faulty agents
%
%   Silent are the endpoints of processes that did not answer within five
%   seconds.
%
%   @error existence_error(host, Host)

overview(Hosts, Processes, Silent) :-
    processes_overview(Hosts, Processes, Silent).

%!  metrics(+Hosts, -Text:string) is det.
%
%   Text contains the metrics of the processes of Hosts, see watch/3, in the
%   text format of Prometheus.  Counters begin at 0 with the first request.
%
%   @error existence_error(host, Host)

metrics(Hosts, Text) :-
    processes_metrics(Hosts, Text).
