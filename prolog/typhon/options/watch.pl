:- module(typhon_watching,
          [ watch/3,                    % +Hosts, :OnEvent, -Watch
            unwatch/1,                  % +Watch
            overview/3,                 % +Hosts, -Processes, -Silent
            metrics/2                   % +Hosts, -Text
          ]).
:- autoload('watch/metrics', [processes_metrics/2]).
:- autoload('watch/watched', [processes_overview/3]).
:- autoload('watch/watches', [watch_begin/3, watch_end/1]).

/** <module> Watching

What happens on hosts anywhere, as it happens.
This is the interface of the layer: higher layers import from here.  Its
modules are loaded when this process watches, or another watches its hosts.

*Threading*: any thread that may wait.
*/

%   `:` and not 1: lambda expressions in arguments that are called are compiled
%   while a file is loaded, and lose there what is not a parameter.

:- meta_predicate watch(+, :, -).

%!  watch(+Hosts, :OnEvent, -Watch) is det.
%
%   Have call(OnEvent, Event) called for what happens on Hosts from now on:
%   a host, a network, or a list of such, of this process and of others.
%   Event is event(Time, Host, Agent, What), Time in seconds of the clock of
%   Host, Host an address, Agent an id or `none`, and What is one of
%
%     - created, ended(Outcome), fault(Fault)
%       An agent begins, ends, or is faulty, Fault being as of
%       agent_property/2; one that is faulty ends when it is given up.
%     - left(To), arrived(From, Seconds), stayed(To)
%       It sets out for To; is there, after a hop of so many seconds; could
%       not go there.
%     - cloned(Id), sent(To), received(From), log(Term)
%       On hosts whose option log(Address, Kinds) has messages(content),
%       sent(To, Message) and received(From, Message).
%     - leave(Fact), take(Fact)
%       What is put in the tuple space of Host, and taken out.
%     - link(To), unlink(To), started, stopped
%       Agent is `none`.
%     - refused(Agent, Reason)
%       Host did not admit Agent: the name of one that was to be created there,
%       or the id of one that was to come.  Reason is as of move_refused/2.
%       Agent of the event is `none`.
%     - lost
%       The process of Host has ended or cannot be reached any more.  When it
%       is there again, Host has `started`.
%     - skipped(Count)
%       So many events of Host were not told: OnEvent is slower than they come.
%
%   Those of one host come in order.  All are called in one thread, one after
%   the other, and not where they happen: whatever OnEvent does, hosts do not
%   wait for it.  That it fails means nothing; an exception is reported once,
%   and the watch goes on.
%
%   OnEvent may be a lambda expression; its variables that are bound when
%   watch/3 is called are as they are then, as in [E]>>p(Q, E).
%
%   Watch holds the endpoint of this process until unwatch/1.
%
%   @error existence_error(host, Host)
%   @error host_unreachable(Host), permission_error(authenticate, host, Host)

watch(Hosts, OnEvent, Watch) :-
    watch_begin(Hosts, OnEvent, Watch).

%!  unwatch(+Watch) is det.
%
%   Earlier events are still delivered, if that can be done in two seconds, and
%   then no event any more.
%
%   @error existence_error(watch, Watch)

unwatch(Watch) :-
    watch_end(Watch).

%!  overview(+Hosts, -Processes, -Silent) is det.
%
%   Hosts as of watch/3.  Processes are process(Endpoint, Pid, Hosts, Agents):
%
%     - host(Address, Time, Load, Options, Links)
%       Time is what its clock shows, Load how many agents count there,
%       Options those of host_start/2 but for tokens, Links To-Cost.
%     - agent(Id, Host, Program, State, Hops)
%       State as of agent_property/2, without the error of those that are
%       faulty.
%
%   Silent are the endpoints of processes that have not answered in five
%   seconds.
%
%   @error existence_error(host, Host)

overview(Hosts, Processes, Silent) :-
    processes_overview(Hosts, Processes, Silent).

%!  metrics(+Hosts, -Text:string) is det.
%
%   Text are the numbers of the processes that have Hosts, as of watch/3, in
%   the text format of Prometheus.  What is counted begins at 0 when it is
%   asked for the first time.
%
%   @error existence_error(host, Host)

metrics(Hosts, Text) :-
    processes_metrics(Hosts, Text).
