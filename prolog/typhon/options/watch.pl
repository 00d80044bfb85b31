:- module(typhon_watching,
          [ watch/3,                    % +Hosts, :OnEvent, -Watch
            unwatch/1,                  % +Watch
            overview/3,                 % +Hosts, -Processes, -Silent
            metrics/2                   % +Hosts, -Text
          ]).
:- autoload('watch/metrics', [processes_metrics/2]).
:- autoload('watch/watched_hosts', [processes_overview/3]).
:- autoload('watch/watches', [watch_begin/3, watch_end/1]).

/** <module> Watching: events of hosts as they happen

A process can watch hosts of this and of other processes.  This is the interface
of the layer: higher layers import from here.  Its modules are loaded when this
process begins a watch, or another process watches its hosts.

*Threading*: any thread that may wait.
*/

%   `:` and not 1: a lambda expression in a meta-argument is compiled when its
%   file is loaded, and then loses variables that are not parameters.

:- meta_predicate watch(+, :, -).

%!  watch(+Hosts, :OnEvent, -Watch:atom) is det.
%
%   Call call(OnEvent, Event) for each event on Hosts from now on.  Hosts is a
%   host, a network, or a list of hosts and networks, of any process.  Event is
%   event(Time, Host, Agent, What), where Time is in seconds of the clock of
%   Host, Host is an address, Agent an id or `none`, and What is one of
%
%     - created, ended(Outcome), fault(Fault)
%       An agent begins, ends, or becomes faulty; Fault is the one of
%       agent_property/2.  A faulty agent ends when it is disposed of.
%     - left(To), arrived(From, Seconds), stayed(To)
%       An agent departs for To; has arrived after a hop of Seconds; could not
%       move to To.
%     - cloned(Id), sent(To), received(From), log(Term)
%       On hosts whose option log(Address, Kinds) has messages(content), also
%       sent(To, Message) and received(From, Message).
%     - leave(Fact), take(Fact)
%       A fact is put into the tuple space of Host, or taken out.
%     - link(To), unlink(To), started, stopped
%       Agent is `none`.
%     - refused(Agent, Reason)
%       Host did not admit Agent: the name of an agent to be created there, or
%       the id of an arriving one.  Reason is the one of move_refused/2.  The
%       agent of the event is `none`.
%     - lost
%       The process of Host has ended or cannot be reached any more.  When it
%       is reachable again, Host has the event `started`.
%     - skipped(Count)
%       Count events of Host were dropped, since OnEvent is too slow.
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
    watch_begin(Hosts, OnEvent, Watch).

%!  unwatch(+Watch:atom) is det.
%
%   End Watch.  Earlier events are delivered first, for at most two seconds (the
%   setting `typhon_watches:last_seconds`); later ones are not.
%
%   @error existence_error(watch, Watch)

unwatch(Watch) :-
    watch_end(Watch).

%!  overview(+Hosts, -Processes:list, -Silent:list(atom)) is det.
%
%   Processes are the processes of Hosts, see watch/3, as
%   process(Endpoint, Pid, Hosts, Agents), with
%
%     - host(Address, Time, Load, Options, Links)
%       Time is the time of its clock, Load the number of its agents that
%       count towards its capacity, Options those of host_start/2 except
%       tokens, Links pairs To-Cost.
%     - agent(Id, Host, Program, State, Hops)
%       State is that of agent_property/2, without the error of faulty agents.
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
