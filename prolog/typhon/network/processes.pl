:- module(typhon_processes,
          [ nodes_start/5,              % +Network, +P, +Machines, +At,
                                        % :Options
            nodes_restart/3,            % +Network, :Options, :Restore
            nodes_stop/1                % +Network
          ]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/monotonic', [wait_within/2]).
:- use_module('../kernel/base/names', [names_some/3]).
:- use_module('../kernel/wire', [peer_expect/1, peer_expect_no_more/1]).
:- use_module('../kernel/travel', [home_agents_at/2]).
:- use_module(children,
              [child_close/1, child_kill/1, child_release/1, child_start/6]).
:- use_module(node_program, [node_programs/1]).
:- use_module(machines, [machine_error/3]).
:- use_module(nodes,
              [ node/3, node/4, node_again/2, node_came/4,
                node_gone/2, node_order/4, node_went/3, nodes_ask/6,
                nodes_forget/1, nodes_gone/3, nodes_peers/2, unwatched/1 ]).
:- use_module(restarts,
              [ restarts_absent/2, restarts_begin/3, restarts_end/1,
                restarts_notify/3 ]).
:- autoload(slurm, [slurm_nodes/3, slurm_release/1]).
:- use_module(wiring, [wired_host/3]).

/** <module> Starting and stopping the processes of a network

Module `children` describes the children, `node_process` their orders.

*Threading*: the threads that follow the children report their events as facts,
and as messages to a queue from which the thread reads that starts or stops the
network. In between, the messages go to the server of module `restarts`, if
there is one.
*/

:- multifile
    prolog:error_message//1,
    prolog:message//1.

:- setting(start_seconds, number, 60,
           "Seconds for the processes of a network to start").
:- setting(answer_seconds, number, 2,
           "Seconds of silence after which a stopping process is killed").
:- setting(kill_seconds, number, 10,
           "Seconds for a killed process to end").

:- meta_predicate
    nodes_start(+, +, +, +, 2),
    nodes_restart(+, 2, 1),
    order_children(+, +, 1).

:- dynamic
    queue/2,                    % Network, Queue
    wanted/1,                   % Network: its processes must stay
    child/3,                    % Network, P, Child
    lasting/1,                  % Network: its processes have journals
    start/4,                    % Network, P, Machine, At
    at/3.                       % Network, P, Endpoint: where it listens

%   A warning names at most so many hosts, and so many agents.

most_named(10).

                /*******************************
                *           STARTING           *
                *******************************/

%!  nodes_start(+Network, +P, +Machines, +At, :Options) is det.
%
%   Start P processes; each of Machines, or of the nodes of slurm(Options), runs
%   a block of them. With `[local]` and
%   P = 1 the hosts run in this process. call(Options, I, List) returns the
%   options of child_start/6 for process I. After an exception nodes_stop/1
%   stops the processes that were started.
%
%   @error timeout_error(start, Network)
%   @error system_error(process_ended(Status))
%   @error the error of a child that cannot start, and those of child_start/6

nodes_start(Network, 1, [local], _, _) :-
    !,
    current_prolog_flag(pid, Pid),
    node_came(Network, 1, local, Pid).
nodes_start(Network, P, Machines0, At, Options) :-
    message_queue_create(Queue),
    assertz(queue(Network, Queue)),
    machines(Machines0, Network, Machines),
    ( memberchk(local, Machines) -> node_programs(P) ; true ),
    length(Machines, M),
    forall(between(1, P, I),
           ( Nth is (I - 1) * M // P + 1,
             nth1(Nth, Machines, Machine),
             assertz(start(Network, I, Machine, At)),
             call(Options, I, ChildOptions),
             note_lasting(Network, ChildOptions),
             start(Network, I, ChildOptions) )),
    setting(start_seconds, Seconds),
    atom_concat(typhon_starting_, Network, Alias),
    setup_call_cleanup(
        thread_create(alarm(Seconds, Queue), Alarm, [alias(Alias)]),
        wait_up(P, Network, Queue),
        ( thread_send_message(Alarm, done),
          thread_join(Alarm, _)
        )),
    assertz(wanted(Network)).

machines(slurm(Options), Network, Machines) :-
    !,
    slurm_nodes(Network, Options, Machines).
machines(Machines, _, Machines).

%   Networks are often started in the setup of a cleanup, where a wait with a
%   deadline may hang, see typhon_own_thread.  So another thread waits and sends
%   `late`.

alarm(Seconds, Queue) :-
    thread_self(Me),
    (   wait_within(Seconds, thread_get_message(Me, done))
    ->  true
    ;   thread_send_message(Queue, late),
        thread_get_message(done)        % the queue of a thread ends with it
    ).

note_lasting(Network, Options) :-
    (   memberchk(journal(_, _), Options),
        \+ lasting(Network)
    ->  assertz(lasting(Network))
    ;   true
    ).

start(Network, P, Options) :-
    start(Network, P, Machine, At),
    catch(child_start(Network-P, Machine, At, Options,
                      typhon_processes:event, Child),
          error(Formal, Context),
          not_started(Network, P, error(Formal, Context))),
    assertz(child(Network, P, Child)).

event(up(Network-P, Endpoint, Pid)) :-
    node_came(Network, P, Endpoint, Pid),
    retractall(at(Network, P, _)),
    assertz(at(Network, P, Endpoint)),
    notify(Network, up(P)).
event(failed(Network-P, Error)) :-
    notify(Network, failed(P, Error)).
event(down(Network-P, Status)) :-
    (   wanted(Network)
    ->  report_lost_process(Network, P, Status)
    ;   true
    ),
    node_went(Network, P, Status),
    notify(Network, down(P, Status)).

report_lost_process(Network, P, Status) :-
    restarts_absent(Network, P),
    (   node(Network, P, Pid, Endpoint)
    ->  findall(Name, wired_host(Network, P, Name), Names),
        home_agents_at(Endpoint, Agents),
        print_message(warning, typhon(node_down(Network, Pid, Status,
                                                   Names, Agents)))
    ;   true
    ).

notify(Network, Event) :-
    queue(Network, Queue),
    restarts_notify(Network, Queue, Event).

wait_up(0, _, _) :-
    !.
wait_up(P, Network, Queue) :-
    thread_get_message(Queue, Event),
    (   Event = up(_)
    ->  P1 is P - 1,
        wait_up(P1, Network, Queue)
    ;   failed_start(Event, Network, I, Error),
        not_started(Network, I, Error)
    ).

failed_start(failed(I, Error), _, I, Error).
failed_start(down(I, Status), _, I,
             error(system_error(process_ended(Status)), _)).
failed_start(late, Network, I, error(timeout_error(start, Network), _)) :-
    once(( start(Network, I, _, _), \+ node(Network, I, _) )).

not_started(Network, I, Error0) :-
    start(Network, I, Machine, _),
    machine_error(Machine, Error0, Error),
    throw(Error).

                /*******************************
                *         STARTING AGAIN       *
                *******************************/

%!  nodes_restart(+Network, :Options, :Restore) is det.
%
%   From now on restart processes that die, see module `restarts`. A restarted
%   process P gets its former port and the options of call(Options, P, List);
%   then call(Restore, P) is called. Has no effect if the hosts are in this
%   process.

nodes_restart(Network, Options, Restore) :-
    (   queue(Network, Queue)
    ->  findall(P, at(Network, P, _), Ps),
        forall(member(P, Ps), expect(Network, P)),
        forall(at(Network, _, Endpoint), peer_expect(Endpoint)),
        restarts_begin(Network, Queue,
                       typhon_processes:restart(Network, Options, Restore))
    ;   true
    ).

%   Tell P that the other processes are restarted if they end.

expect(Network, P) :-
    findall(Endpoint, at(Network, _, Endpoint), Endpoints),
    node_order(Network, P, expect(Endpoints), ok).

expect_no_more(Network, P) :-
    forall(at(Network, P, Endpoint), peer_expect_no_more(Endpoint)).

:- public restart/4.

restart(Network, Options, _, start(P)) :-
    retract(child(Network, P, Child)),
    !,
    child_close(Child),
    child_release(Child),
    node_again(Network, P),
    at(Network, P, Endpoint),
    atomic_list_concat([_, Text], :, Endpoint),
    atom_number(Text, Port),
    call(Options, P, More),
    start(Network, P, [port(Port)|More]).
restart(Network, _, _, kill(P)) :-
    child(Network, P, Child),
    !,
    child_kill(Child).
restart(Network, _, Restore, restore(P)) :-
    expect(Network, P),
    call(Restore, P).
restart(Network, _, _, give_up(P)) :-
    expect_no_more(Network, P),
    at(Network, P, Endpoint),
    forall(node(Network, Other, _),
           catch(node_order(Network, Other, expect_no_more([Endpoint]), _),
                 error(existence_error(carrier, _), _), true)).

                /*******************************
                *           STOPPING           *
                *******************************/

%!  nodes_stop(+Network) is det.
%
%   End the child processes of Network: in order if possible, else by force.
%
%   First all children pause their agents, so that no agent observes the end of
%   another process. Children that hang are killed, so that others need not wait
%   for them. Then the hosts of the children stop, and their messages arrive,
%   for example at the log. Only then do the children end, so that none waits
%   for a child that has ended. With journals the hosts stop only when their
%   child ends: the journals keep their contents, and no event reports the end.

nodes_stop(Network) :-
    retractall(wanted(Network)),
    restarts_end(Network),
    rest_children(Network),
    (   retract(lasting(Network))
    ->  Watch = kill_hanging(Network)
    ;   order_children(Network, stop, kill_hanging(Network)),
        Watch = unwatched
    ),
    nodes_peers(Network, Peers),
    order_children(Network, flush(2, Peers), Watch),
    forall(child(Network, _, Child), child_close(Child)),
    (   queue(Network, Queue)
    ->  end_children(Network),
        release_children(Network),
        retractall(queue(Network, _)),
        message_queue_destroy(Queue)
    ;   true
    ),
    retractall(start(Network, _, _, _)),
    expect_no_more(Network, _),
    retractall(at(Network, _, _)),
    nodes_forget(Network),
    slurm_release(Network).

%   An agent on its way to a dead process, or in a long goal, does not come to
%   rest. A journal keeps its last recorded state.

rest_children(Network) :-
    order_children(Network, hold(0), kill_hanging(Network)),
    setting(typhon_node_process:rest_seconds, Rest),
    Seconds is Rest+1,
    children_up(Network, Ps),
    nodes_ask(Network, Ps, rest(Rest, []), Seconds, kill_hanging(Network),
                 _).

%   Facts are retracted one by one, as other threads may add children meanwhile:
%   typhon_mailbox describes the fault of findall/3 with retract/1.

release_children(Network) :-
    retract(child(Network, _, Child)),
    !,
    child_release(Child),
    release_children(Network).
release_children(_).

%   Called repeatedly, as a child may begin to hang after it has answered once.

kill_hanging(Network, Ps) :-
    setting(answer_seconds, Seconds),
    nodes_ask(Network, Ps, alive, Seconds, unwatched, Results),
    findall(P, member(P-late, Results), Hanging),
    (   Hanging == []
    ->  true
    ;   ignore(kill_all(Network, Hanging))
    ).

%   kill_all(+Network, +Ps): fails if not all Ps have ended in time.

kill_all(Network, Ps) :-
    forall(( member(P, Ps), child(Network, P, Child) ),
           ( print_message(warning, typhon(node_killed(Network, P))),
             child_kill(Child) )),
    setting(kill_seconds, Seconds),
    nodes_gone(Network, Ps, Seconds).

children_up(Network, Ps) :-
    findall(P, ( child(Network, P, _), node(Network, P, _) ), Ps).

%   Send Order to all children that are up; for Watch see nodes_ask/6. Errors
%   are only reported: a child that cannot carry out Order ends later.

order_children(Network, Order, Watch) :-
    setting(typhon_children:stop_seconds, Seconds),
    children_up(Network, Ps),
    nodes_ask(Network, Ps, Order, Seconds, Watch, Results),
    forall(( member(P-Result, Results), Result \== answer(done(ok)) ),
           print_message(warning, typhon(node_order(P, Order, Result)))).

%   A child that cannot end in order within stop_seconds kills itself. So
%   children that are left after that are stuck.

end_children(Network) :-
    setting(typhon_children:stop_seconds, Seconds),
    findall(P, child(Network, P, _), Ps),
    Longest is Seconds+1,
    nodes_gone(Network, Ps, Longest),
    !.
end_children(Network) :-
    findall(P, remains(Network, P), Ps),
    kill_all(Network, Ps),
    !.
end_children(Network) :-
    forall(( remains(Network, P), retract(child(Network, P, _)) ),
           print_message(error, typhon(node_stays(Network, P)))).

remains(Network, P) :-
    child(Network, P, _),
    \+ node_gone(Network, P).

prolog:message(typhon(node_down(Network, Pid, Status, Hosts, Agents))) -->
    [ 'Process ~w of ~w ended: ~p'-[Pid, Network, Status] ],
    gone_with_it('its hosts', Hosts),
    gone_with_it('agents of this process that were there', Agents).
prolog:message(typhon(node_order(P, Order, Result))) -->
    [ 'Process ~w of the network did not do ~q: ~p'-[P, Order, Result] ].
prolog:message(typhon(node_killed(Network, P))) -->
    [ 'Process ~w of ~w does not end, and is killed'-[P, Network] ].
prolog:message(typhon(node_stays(Network, P))) -->
    [ 'Process ~w of ~w could not be ended'-[P, Network] ].

gone_with_it(_, []) -->
    !.
gone_with_it(What, Names) -->
    { most_named(Most),
      names_some(Names, Most, Text) },
    [ nl, '  ~w: ~w'-[What, Text] ].

prolog:error_message(system_error(process_ended(Status))) -->
    [ 'A process of the network ended before it was ready: ~p'-[Status] ].
prolog:error_message(timeout_error(start, Network)) -->
    [ 'The processes of ~w were not ready in time'-[Network] ].
