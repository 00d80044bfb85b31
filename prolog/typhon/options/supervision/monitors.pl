:- module(typhon_monitors,
          [ monitor_begin/3,            % +Id, +Agent, +Shared
            monitor_end/2,              % +Id, +Agent
            monitor_call/2,             % +Agent, :OnDown
            monitor_set/2               % ?Watcher, ?Agent
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/durable',
              [durable/5, durable_assertz/1, durable_drop/3, unit_of_work/1]).
:- use_module('../../kernel/base/error_text', [is_abort/1, print_error/2]).
:- use_module('../../kernel/wire',
              [ endpoint_address/1, endpoint_gone/1, endpoint_reply/2,
                endpoint_request/4 ]).
:- use_module('../../kernel/host',
              [ alarm_in/3, runtime_acquire/2, runtime_release/1,
                scheduler_call/1 ]).
:- use_module('../../kernel/agent', [agent_home/2, agent_home_endpoint/2]).
:- use_module('../../kernel/travel',
              [outcome_wait/3, peer_may_send_for/3, post_on/2]).
:- use_module('../../kernel/lifecycle', [agent_dispose/1, agent_named/2]).
:- use_module(monitored_agents, [monitored_add/2, orphans_end/1]).

/** <module> Monitors, at the home of the monitoring agents

The home of a watcher keeps its monitors.  For each monitored agent it sends one
request to the home of that agent, which answers when the agent is down, see
typhon_monitored_agents.  If the request is lost, the home of the agent is gone,
and its agents are taken to be lost; or the home keeps a journal, and the
request is sent again.  Several reports may say that the agent is down: only the
thread that removes the monitor sends the message, so it is sent once.  With a
journal both are one unit of work.

A watcher is the id of an agent that gets a message; ends(Id), an agent that is
disposed of if the monitored agent ends otherwise than `done`; or call(N), a
goal of this process.

*Threading*: any thread; only monitor_call/2 waits.
*/

:- multifile
    typhon_durable:go_on/0,
    typhon_durable:restored/0,
    typhon_endpoint:requested/4,
    typhon_failed_processes:detection_needed/0,
    typhon_failed_processes:process_failed/1,
    typhon_identity:ids_anew/0,
    typhon_runtime:ending/1,
    typhon_scheduler:fire/2.

:- meta_predicate monitor_call(+, :).

:- setting(again_seconds, number, 1,
           "Seconds until a lost request to the home of an agent is repeated").

:- dynamic
    monitor/3,                  % Key, Watcher, Agent
    asked/2,                    % Agent, Since: a request to its home is open;
                                % Since is `first`, `before` if it repeats a
                                % lost request, or `lost`: the home is gone
    removal_set/1,              % Id: its monitors are removed when it ends
    goal/2.                     % N, Goal

:- durable(monitor, Key, 0, Watcher-Agent, monitor(Key, Watcher, Agent)).

typhon_identity:ids_anew :-
    forget.

typhon_runtime:ending(after) :-
    forget.

forget :-
    retractall(monitor(_, _, _)),
    retractall(asked(_, _)),
    retractall(removal_set(_)),
    retractall(goal(_, _)).

                /*******************************
                *        BEGIN AND END         *
                *******************************/

%!  monitor_begin(+Id, +Agent, +Shared) is det.
%!  monitor_end(+Id, +Agent) is det.
%
%   Begin or end a monitor of Agent by Id, whose home is here.  Shared is the
%   option of monitor/2.

monitor_begin(Id, Agent, self) :-
    !,
    monitor_add(ends(Id), Agent).
monitor_begin(Id, Agent, Shared) :-
    monitor_add(Id, Agent),
    (   Shared == true
    ->  monitor_add(ends(Id), Agent)
    ;   true
    ),
    (   Shared == false
    ->  true
    ;   shares(Agent, monitor_add(ends(Agent), Id))
    ).

monitor_end(Id, Agent) :-
    ignore(monitor_remove(Id, Agent)),
    ignore(monitor_remove(ends(Id), Agent)),
    shares(Agent, monitor_remove(ends(Agent), Id)).

%!  monitor_set(?Watcher, ?Agent) is nondet.
%
%   Watcher, see above, has a monitor of Agent in this process.

monitor_set(Watcher, Agent) :-
    monitor(_, Watcher, Agent).

%   shares(+Agent, +Change): run Change, a goal that adds or removes the monitor
%   that makes Agent share the fate of another agent, at the home of Agent.

shares(Agent, Change) :-
    agent_home_endpoint(Agent, Home),
    (   endpoint_address(Home)
    ->  ignore(Change)
    ;   endpoint_request(Home, monitor, Change,
                         typhon_monitors:share_answered(Agent, Change))
    ).

:- public share_answered/3.

share_answered(_, _, answer(_)) :-
    !.
share_answered(Agent, Change, _) :-
    agent_home_endpoint(Agent, Home),
    (   endpoint_gone(Home)
    ->  true
    ;   retry_later(Agent, share(Change))
    ).

monitor_remove(Watcher, Agent) :-
    key(Watcher, Agent, Key),
    retract(monitor(Key, _, _)),
    !,
    durable_drop(monitor, Key, 0).

key(Watcher, Agent, Key) :-
    format(atom(Key), '~w ~w', [Watcher, Agent]).

monitor_add(Watcher, Agent) :-
    key(Watcher, Agent, Key),
    with_mutex(typhon_monitors, add(Key, Watcher, Agent, New)),
    (   New == true
    ->  remove_at_end(Watcher),
        watch(Agent, first)
    ;   true
    ).

add(Key, _, _, false) :-
    monitor(Key, _, _),
    !.
add(Key, Watcher, Agent, true) :-
    durable_assertz(monitor(Key, Watcher, Agent)).

%   When an agent ends, its own monitors are removed.

remove_at_end(ends(Id)) :-
    !,
    remove_at_end(Id).
remove_at_end(Id) :-
    atom(Id),
    \+ removal_set(Id),
    !,
    assertz(removal_set(Id)),
    outcome_wait(Id, inf, call(typhon_monitors:watcher_ended(Id))).
remove_at_end(_).

:- public watcher_ended/2.

watcher_ended(Id, _) :-
    retractall(removal_set(Id)),
    findall(Watcher-Agent,
            ( member(Watcher, [Id,ends(Id)]), monitor(_, Watcher, Agent) ),
            Pairs),
    forall(member(Watcher-Agent, Pairs),
           ignore(monitor_remove(Watcher, Agent))).

typhon_endpoint:requested(monitor, by(Id, Request), Peer, ReplyTo) :-
    peer_may_send_for(Peer, [], Id),
    for_peer(Request, Id),
    endpoint_reply(ReplyTo, ok).
typhon_endpoint:requested(monitor, monitor_add(Ends, Id), _, ReplyTo) :-
    ignore(monitor_add(Ends, Id)),
    endpoint_reply(ReplyTo, ok).
typhon_endpoint:requested(monitor, follows(Agent, Id), _, ReplyTo) :-
    ( monitor_set(ends(Agent), Id) -> Answer = true ; Answer = false ),
    endpoint_reply(ReplyTo, Answer).
typhon_endpoint:requested(monitor, monitor_remove(Ends, Id), _, ReplyTo) :-
    ignore(monitor_remove(Ends, Id)),
    endpoint_reply(ReplyTo, ok).

for_peer(begin(Agent, Shared), Id) :-
    agent_home(Agent, _),
    monitor_begin(Id, Agent, Shared).
for_peer(end(Agent), Id) :-
    monitor_end(Id, Agent).

%!  monitor_call(+Agent, :OnDown) is det.
%
%   See agent_monitor/2.

monitor_call(Agent, OnDown) :-
    strip_module(OnDown, _, Plain),
    must_be(callable, Plain),
    agent_named(Agent, Id),
    flag(typhon_monitor, N, N+1),
    runtime_acquire(monitor(N), []),
    assertz(goal(N, OnDown)),
    monitor_add(call(N), Id).

                /*******************************
                *       REQUESTS TO HOMES      *
                *******************************/

%   watch(+Agent, +Since): request the outcome of Agent from its home, unless a
%   request is open.

watch(Agent, Since) :-
    with_mutex(typhon_monitors, note_request(Agent, Since)),
    !,
    agent_home_endpoint(Agent, Home),
    (   endpoint_address(Home)
    ->  monitored_add(Agent, call(typhon_monitors:down(Agent)))
    ;   endpoint_request(Home, monitor, watch(Agent),
                         typhon_monitors:home_answered(Agent, Home))
    ).
watch(_, _).

note_request(Agent, Since) :-
    \+ asked(Agent, _),
    monitor(_, _, Agent),
    assertz(asked(Agent, Since)).

:- public home_answered/3.

home_answered(Agent, Home, answer(unknown)) :-
    !,
    (   asked(Agent, before)
    ->  scheduler_call(typhon_monitors:lost(Home))
    ;   scheduler_call(typhon_monitors:unknown(Agent))
    ).
home_answered(Agent, _, answer(not_permitted(_))) :-
    !,
    down(Agent, unknown).
home_answered(Agent, _, answer(Outcome)) :-
    !,
    down(Agent, Outcome).
home_answered(Agent, Home, _) :-
    (   endpoint_gone(Home)
    ->  scheduler_call(typhon_monitors:lost(Home))
    ;   retractall(asked(Agent, _)),
        retry_later(Agent, watch)
    ).

%   unknown(+Agent): the process at the address of its home does not know Agent.
%   This may be a new process, and the agent may still run elsewhere: so it is
%   disposed of.

:- public unknown/1.

unknown(Agent) :-
    orphans_end([Agent]),
    down(Agent, unknown).

%   lost(+Home): the process at Home is gone.  All its monitored agents are
%   reported as lost; those that still run elsewhere are disposed of first.

:- public lost/1.

lost(Home) :-
    with_mutex(typhon_monitors, claim_lost(Home, Agents)),
    (   Agents == []
    ->  true
    ;   orphans_end(Agents),
        forall(member(Agent, Agents), lost_with_home(Agent))
    ).

claim_lost(Home, Agents) :-
    findall(Agent,
            ( asked(Agent, Since),
              Since \== lost,
              agent_home_endpoint(Agent, Home) ),
            Agents),
    forall(member(Agent, Agents),
           ( retractall(asked(Agent, _)), assertz(asked(Agent, lost)) )).

lost_with_home(Agent) :-
    agent_home(Agent, Address),
    down(Agent, lost(Address)).

retry_later(Agent, What) :-
    setting(again_seconds, Seconds),
    alarm_in(Seconds, Agent, monitor(What)).

typhon_scheduler:fire(Agent, monitor(watch)) :-
    !,
    watch(Agent, before).
typhon_scheduler:fire(Agent, monitor(share(Change))) :-
    !,
    shares(Agent, Change).

typhon_failed_processes:detection_needed :-
    asked(_, _),
    !.

typhon_failed_processes:process_failed(Peer) :-
    lost(Peer).

typhon_durable:go_on :-
    scheduler_call(typhon_monitors:go_on).

:- public go_on/0.

go_on :-
    findall(Watcher-Agent, monitor(_, Watcher, Agent), Pairs),
    forall(member(Watcher-Agent, Pairs),
           ( remove_at_end(Watcher), watch(Agent, first) )).

%   The goals of agent_monitor/2 ended with the process that kept the journal,
%   and a new goal may get the number of one of them.

typhon_durable:restored :-
    findall(N-Agent, monitor(_, call(N), Agent), Calls),
    forall(member(N-Agent, Calls), ignore(monitor_remove(call(N), Agent))).

                /*******************************
                *             DOWN             *
                *******************************/

%   down(+Agent, +Outcome): notify and remove each monitor of Agent.

:- public down/2.

down(Agent, Outcome) :-
    retractall(asked(Agent, _)),
    findall(Watcher, monitor(_, Watcher, Agent), Watchers),
    forall(member(Watcher, Watchers),
           unit_of_work(fire_monitor(Watcher, Agent, Outcome))).

fire_monitor(Watcher, Agent, Outcome) :-
    (   monitor_remove(Watcher, Agent)
    ->  notify(Watcher, Agent, Outcome)
    ;   true
    ).

notify(call(N), Agent, Outcome) :-
    !,
    scheduler_call(typhon_monitors:call_goal(N, Agent, Outcome)).
notify(ends(_), _, done) :-
    !.
notify(ends(Id), _, _) :-
    !,
    scheduler_call(typhon_monitors:dispose_follower(Id)).
notify(Id, Agent, Outcome) :-
    post_on(Id, [system-down(Agent, Outcome)]).

:- public dispose_follower/1, call_goal/3.

dispose_follower(Id) :-
    catch(agent_dispose(Id), error(_, _), true).

call_goal(N, Agent, Outcome) :-
    retract(goal(N, Goal)),
    !,
    call_cleanup(call_and_report(Goal, Agent, Outcome), release(N)).

call_and_report(Goal, Agent, Outcome) :-
    catch(ignore(call(Goal, Agent, Outcome)), Ball,
          ( is_abort(Ball) -> throw(Ball) ; print_error(warning, Ball) )).

%   The last release stops the workers, and a worker, which calls this, cannot
%   join itself.

release(N) :-
    atom_concat(typhon_monitor_, N, Alias),
    thread_create(runtime_release(monitor(N)), _,
                  [alias(Alias), detached(true)]).
