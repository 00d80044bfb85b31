:- module(typhon_snapshot,
          [ process_dump/2,             % +Hosts, -Items
            process_restore/2,          % +Kind, +Items
            process_go_on/3,            % +Kind, +Agents, +Scheduled
            agents_at_rest/2,           % +Seconds, +Peers
            agents_go_on/1              % +Agents
          ]).
:- use_module(library(error), [domain_error/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(ordsets), [ord_subtract/3]).
:- use_module('../kernel/base/monotonic', [poll_within/2]).
:- use_module('../kernel/base/durable',
              [durable/6, durable_dump/4, durable_kinds/2, durable_restore/4]).
:- use_module('../kernel/program', [code_receive/2, code_sent/2]).
:- use_module('../kernel/wire', [mobile_term/1]).
:- use_module('../kernel/host',
              [host/3, host_again/1, schedule/2, time_repeats/2]).
:- use_module('../kernel/agent',
              [ agent/5, agent_enter/3, agent_home/2, agent_module/5,
                agent_order/2, agent_ordered/1, agent_orders/2, agent_state/2,
                agent_status/3, agents_passed/0, with_agent/2 ]).
:- use_module('../kernel/travel',
              [ news_carried/1, news_hurry/0, post_tried/0,
                retries_go_on/0 ]).
:- use_module('../kernel/lifecycle', [agent_reschedule/1, held_parts/3]).

/** <module> Snapshots of the state of a process

A snapshot holds the items of all durable tables, see typhon_durable.  The
pending events of repeatable time are saved separately.

While time is paused no agent gets a new turn.  Running agents stop at their
next effect, as they do for an order.  Agents in transit arrive, or return to
their source.  Messages and news under way reach their destination, or wait.

*Threading*: any thread, while time is paused; the thread that paused it waits
until the agents rest.
*/

%   last(-Kinds): kinds that are restored after all others, as they depend on
%   them.

last([ payload, backlog, program, stands, mail, order, turns, counts ]).

%   repeated(?Kind): items of Kind are restored only where time is repeatable.
%   Other processes keep their own values of these counters.

repeated(flag).
repeated(turns).
repeated(counts).

%   journaled(?Kind): items of Kind are only in a journal.  A saved network has
%   the same facts in other items (agent, state, tuple, wait), or they make
%   sense only in the process that has recorded them.

journaled(agent).
journaled(done).
journaled(lasting).
journaled(letter).
journaled(logged).
journaled(monitor).
journaled(out).
journaled(seen).
journaled(state).
journaled(tuple).
journaled(wait).

kind(Kind) :-
    last(Last),
    durable_kinds(Last, Kinds),
    member(Kind, Kinds),
    \+ journaled(Kind).

%!  process_dump(+Hosts:list, -Items:list) is det.
%
%   Items are the state of this process, item(Kind, Key, N, Term).  Items that
%   concern a host not in Hosts, an agent on such a host, or an agent that left
%   from there, are excluded.
%
%   @error type_error(mobile_term, Culprit)
%   @error permission_error(save, agent, Id) the agent Id runs

process_dump(Hosts, Items) :-
    others(Hosts, Others),
    findall(item(Kind, Key, N, Term),
            ( kind(Kind),
              durable_dump(Kind, Key, N, Term),
              \+ is_of(Others, Kind, Key, Term),
              can_be_written(Kind, Key, Term) ),
            Items).

%   others(+Hosts, -Others): other hosts of this process, usually none.

others(Hosts, Others) :-
    findall(Host, ( host(Host, _, _), \+ memberchk(Host, Hosts) ), Others).

%   is_of(+Hosts, +Kind, +Key, +Term): the item concerns one of Hosts.

is_of([Host|Hosts], Kind, Key, Term) :-
    about(Kind, Key, Term, About),
    on_host(About, Other),
    memberchk(Other, [Host|Hosts]),
    !.

about(link, _, link(Host, _, _), host(Host)).
about(payload, _, payload(Host, _), host(Host)).
about(Kind, Host, _, host(Host)) :-
    memberchk(Kind, [place, fact, turns, counts]).
about(Kind, Id, _, agent(Id)) :-
    memberchk(Kind, [ birth, born, outcome, faulty, left, clone, gone, given_up,
                      backlog, stands, mail, order ]).

on_host(host(Host), Host).
on_host(agent(Id), Host) :-
    (   agent(Id, Host0, _, _, _)
    ->  Host = Host0
    ;   agent_home(Id, Home),
        host(Host, Home, _)
    ).

can_be_written(Kind, Key, Term) :-
    catch(mobile_term(Term), error(Formal, _),
          ( format(atom(Text), '~w of ~w', [Kind, Key]),
            throw(error(Formal, context(_, Text))) )).

%!  process_restore(+Kind, +Items:list) is det.
%
%   Restore Items in a process whose hosts have been started again.  Kind is the
%   kind of its time.  Facts about these agents that the process has collected
%   since the snapshot are dropped.
%
%   @error domain_error(saved_item, Item)

process_restore(Time, Items) :-
    forall(( member(item(Kind, Id, _, _), Items),
             memberchk(Kind, [born, outcome, gone]),
             typhon_identity:id_anew(Id) ),
           true),
    forall(( member(item(Kind, Key, N, Term), Items),
             is_restored(Kind, Time) ),
           restore_item(Kind, Key, N, Term)).

is_restored(Kind, Time) :-
    (   repeated(Kind)
    ->  time_repeats(Time, _)
    ;   true
    ).

restore_item(Kind, Key, N, Term) :-
    durable_restore(Kind, Key, N, Term),
    !.
restore_item(Kind, Key, N, Term) :-
    domain_error(saved_item, item(Kind, Key, N, Term)).

                /*******************************
                *            AGENTS            *
                *******************************/

:- durable(program, Hash, 0, Sent, program_item(Hash, Sent),
           code_receive(Hash, Sent)).

program_item(Hash, Sent) :-
    findall(Hash, agent(_, _, _, Hash, _), Hashes0),
    sort(Hashes0, Hashes),
    member(Hash, Hashes),
    code_sent(Hash, Sent).

:- durable(stands, Id, 0, Agent, agent_item(Id, Agent),
           agent_restore(Id, Agent)).

agent_item(Id, agent(Host, Hash, Life, State, Status, Goals)) :-
    agent(Id, Host, Module, Hash, Life),
    agent_status(Id, Status0, Goals0),
    resting(Status0, Goals0, Id, Status, Goals),
    agent_state(Module, State).

agent_restore(Id, agent(Host, Hash, Life, State, Status, Goals)) :-
    host(Host, _, Place),
    agent_module(Id, Place, Hash, State, Module),
    agent_enter(agent(Id, Host, Module, Hash, Life), Status, Goals),
    host_again(Host).

%   A held agent is stopped again at its next goal.

resting(running, _, Id, _, _) :-
    !,
    permission_error(save, agent, Id).
resting(_, Held, _, ready, Goals) :-
    held_parts(Held, _, Goals),
    !.
resting(Status, Goals, _, Status, Goals).

%   0.1.0 noted twice that an agent is kept because it is faulty.

:- durable(stays, _, 0, _, fail, true).

%   The callers of saved orders are gone, so no answer is sent.

:- durable(order, Id, 0, Order, order_item(Id, Order), agent_order(Id, Order)).

order_item(Id, Order) :-
    agent(Id, _, _, _, _),
    agent_orders(Id, Orders),
    member(Order0, Orders),
    Order0 \= asked(question(_), _),
    without_caller(Order0, Order).

without_caller(asked(Order, _), asked(Order, queue(none))) :-
    !.
without_caller(Order, Order).

%!  process_go_on(+Kind, +Agents:list, +Scheduled:list) is det.
%
%   Let Agents continue.  With repeatable time the runtime has restored the
%   alarms, and the agents in Scheduled are already scheduled.

process_go_on(Kind, Agents, Scheduled0) :-
    time_repeats(Kind, _),
    !,
    findall(Id, ( member(Id, Agents), agent_status(Id, ready, _) ), Ready0),
    sort(Ready0, Ready),
    sort(Scheduled0, Scheduled),
    ord_subtract(Ready, Scheduled, Others),
    forall(( member(Id, Others), agent(Id, Host, _, _, _) ),
           schedule(Host, Id)).
process_go_on(_, Agents, _) :-
    forall(member(Id, Agents), agent_reschedule(Id)),
    retries_go_on.

                /*******************************
                *           AT REST            *
                *******************************/

%!  agents_at_rest(+Seconds, +Peers) is semidet.
%
%   Wait until no agent of this process runs or is in transit, and nothing is
%   queued for the endpoints Peers.  Fails if that takes longer than Seconds.

agents_at_rest(Seconds, Peers) :-
    agents_passed,
    poll_within(Seconds, at_rest(Peers)).

%   Polling every 10 ms costs less than a notification, for which each turn and
%   each departure would have to check for a waiting caller.

at_rest(Peers) :-
    forall(( agent_status(Id, running, _), \+ agent_ordered(Id) ),
           ignore(with_agent(Id, order_rest(Id)))),
    news_hurry,
    \+ is_busy(Peers),
    agents_passed,                      % a message may have followed an agent
    \+ is_busy(Peers).

%   An order without effect stops a running agent.

order_rest(Id) :-
    agent_status(Id, running, _),
    agent_order(Id, asked(question(rest), queue(none))).

is_busy(_) :-
    agent_status(_, Status, _),
    is_moving(Status),
    !.
is_busy(_) :-
    post_tried,
    !.
is_busy(Peers) :-
    member(Peer, Peers),
    news_carried(Peer),
    !.

is_moving(running).
is_moving(obeying).
is_moving(arriving).
is_moving(transit(_, _)).
is_moving(cloning(_, _)).

%!  agents_go_on(+Agents:list) is det.
%
%   Schedule Agents, whose turns were dropped while time was paused.

agents_go_on(Agents) :-
    forall(( member(Id, Agents), agent(Id, Host, _, _, _) ),
           schedule(Host, Id)).
