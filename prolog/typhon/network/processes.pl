:- module(typhon_processes,
          [ nodes_start/5,              % +Network, +P, +Machines, +Interface,
                                        % :Options
            nodes_restart/3,            % +Network, :Options, :Restore
            nodes_stop/1                % +Network
          ]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/names', [names_some/3]).
:- use_module('../kernel/wire', [contact_expect/1, contact_expect_no_more/1]).
:- use_module('../kernel/travel', [home_agents_at/2]).
:- use_module(children,
              [child_close/1, child_kill/1, child_release/1, child_start/6]).
:- use_module(nodes,
              [ node/3, node/4, node_again/2, node_came/4,
                node_gone/2, node_order/4, node_went/3,
                nodes_ask/6, nodes_forget/1, nodes_peers/2,
                deadline/2, message_before/3, unwatched/1 ]).
:- use_module(restarts,
              [ restarts_absent/2, restarts_begin/3, restarts_end/1,
                restarts_tell/3 ]).
:- use_module(wiring, [wired_host/3]).

/** <module> Starting and stopping the processes of a network

Module `children` describes the children, `node_process` their orders.

*Threading*: the threads that follow the children report their events: as
facts, and as messages to a queue on which starting and stopping wait; in
between, to the server of module `restarts`, if there is one.
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
    start/4,                    % Network, P, Machine, Interface
    at/3.                       % Network, P, Endpoint: where it listens

%   The most hosts, and the most agents, that a warning names.

most_named(10).

                /*******************************
                *           STARTING           *
                *******************************/

%!  nodes_start(+Network, +P, +Machines, +Interface, :Options) is det.
%
%   Starts P processes, blocks of them on each of Machines. With `[local]` and
%   P = 1 the hosts are in this process. Options(P, List) are those of
%   child_start/6 for each process. If this throws, nodes_stop/1 stops the
%   processes that were started.
%
%   @error timeout_error(start, Network),
%   system_error(process_ended(Status)), the error of a child that cannot
%   start, and as child_start/6

nodes_start(Network, 1, [local], _, _) :-
    !,
    current_prolog_flag(pid, Pid),
    node_came(Network, 1, local, Pid).
nodes_start(Network, P, Machines, Interface, Options) :-
    message_queue_create(Queue),
    assertz(queue(Network, Queue)),
    length(Machines, M),
    forall(between(1, P, I),
           ( At is (I - 1) * M // P + 1,
             nth1(At, Machines, Machine),
             assertz(start(Network, I, Machine, Interface)),
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

%   An alarm, as networks are often started in the setup of a cleanup, where a
%   wait with a deadline of its own would hang: see typhon_own_thread.

alarm(Seconds, Queue) :-
    thread_self(Me),
    (   thread_get_message(Me, done, [timeout(Seconds)])
    ->  true
    ;   thread_send_message(Queue, late)
    ).

note_lasting(Network, Options) :-
    (   memberchk(journal(_, _), Options),
        \+ lasting(Network)
    ->  assertz(lasting(Network))
    ;   true
    ).

start(Network, P, Options) :-
    start(Network, P, Machine, Interface),
    child_start(Network-P, Machine, Interface, Options,
                typhon_processes:event, Child),
    assertz(child(Network, P, Child)).

event(up(Network-P, Endpoint, Pid)) :-
    node_came(Network, P, Endpoint, Pid),
    retractall(at(Network, P, _)),
    assertz(at(Network, P, Endpoint)),
    tell(Network, up(P)).
event(failed(Network-P, Error)) :-
    tell(Network, failed(P, Error)).
event(down(Network-P, Status)) :-
    (   wanted(Network)
    ->  is_missed(Network, P, Status)
    ;   true
    ),
    node_went(Network, P, Status),
    tell(Network, down(P, Status)).

is_missed(Network, P, Status) :-
    restarts_absent(Network, P),
    (   node(Network, P, Pid, Endpoint)
    ->  findall(Name, wired_host(Network, P, Name), Names),
        home_agents_at(Endpoint, Agents),
        print_message(warning, typhon(node_down(Network, Pid, Status,
                                                   Names, Agents)))
    ;   true
    ).

tell(Network, Event) :-
    queue(Network, Queue),
    restarts_tell(Network, Queue, Event).

wait_up(0, _, _) :-
    !.
wait_up(P, Network, Queue) :-
    thread_get_message(Queue, Event),
    (   Event = up(_)
    ->  P1 is P - 1,
        wait_up(P1, Network, Queue)
    ;   Event = failed(_, Error)
    ->  throw(Error)
    ;   Event = down(_, Status)
    ->  throw(error(system_error(process_ended(Status)), _))
    ;   throw(error(timeout_error(start, Network), _))
    ).

                /*******************************
                *         STARTING AGAIN       *
                *******************************/

%!  nodes_restart(+Network, :Options, :Restore) is det.
%
%   From now on processes that die are restarted, see module `restarts`, with
%   the options Options(P, List) and the port that they had; then Restore(P) is
%   called. Does nothing where the hosts are in this process.

nodes_restart(Network, Options, Restore) :-
    (   queue(Network, Queue)
    ->  findall(P, at(Network, P, _), Ps),
        forall(member(P, Ps), expect(Network, P)),
        forall(at(Network, _, Endpoint), contact_expect(Endpoint)),
        restarts_begin(Network, Queue,
                       typhon_processes:restart(Network, Options, Restore))
    ;   true
    ).

%   Tell P that the other processes are restarted if they end.

expect(Network, P) :-
    findall(Endpoint, at(Network, _, Endpoint), Endpoints),
    node_order(Network, P, expect(Endpoints), ok).

expect_no_more(Network, P) :-
    forall(at(Network, P, Endpoint), contact_expect_no_more(Endpoint)).

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
%   Ends the processes that nodes_start/5 began to start: in order if possible,
%   else by force. This process goes on.
%
%   First agents are stopped in all children, so that none observes that others
%   are gone, and children that hang are killed: the others need not wait for
%   them. Then the hosts of the children stop, and all that they have sent
%   arrives, for example at the log. Only then do the children end: so none
%   waits for another that is gone. Where there are journals their contents
%   stay, and no event reports the end: a child stops its hosts when it ends.

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
    nodes_forget(Network).

%   An agent on its way to a dead process, or in a goal that takes longer, does
%   not come to rest. It stays in that state in a journal.

rest_children(Network) :-
    order_children(Network, hold(0), kill_hanging(Network)),
    setting(typhon_node_process:rest_seconds, Rest),
    Seconds is Rest+1,
    children_up(Network, Ps),
    nodes_ask(Network, Ps, rest(Rest, []), Seconds, kill_hanging(Network),
                 _).

%   One by one: other threads may start children meanwhile. For the fault of
%   findall/3 with retract/1 see typhon_mailbox.

release_children(Network) :-
    retract(child(Network, _, Child)),
    !,
    child_release(Child),
    release_children(Network).
release_children(_).

%   Asked again and again: a child may begin to hang after an answer.

kill_hanging(Network, Ps) :-
    setting(answer_seconds, Seconds),
    nodes_ask(Network, Ps, alive, Seconds, unwatched, Results),
    findall(P, member(P-late, Results), Hanging),
    (   Hanging == []
    ->  true
    ;   ignore(kill_all(Network, Hanging))
    ).

%   kill_all(+Network, +Ps): fails when not all have ended in time.

kill_all(Network, Ps) :-
    forall(( member(P, Ps), child(Network, P, Child) ),
           ( print_message(warning, typhon(node_killed(Network, P))),
             child_kill(Child) )),
    setting(kill_seconds, Seconds),
    wait_down(Network, Ps, Seconds).

children_up(Network, Ps) :-
    findall(P, ( child(Network, P, _), node(Network, P, _) ), Ps).

%   Send Order to all children that are up, watched by Watch. Errors are
%   ignored: a child that cannot do it is ended later.

order_children(Network, Order, Watch) :-
    setting(typhon_children:stop_seconds, Seconds),
    children_up(Network, Ps),
    nodes_ask(Network, Ps, Order, Seconds, Watch, Results),
    forall(( member(P-Result, Results), Result \== answer(done(ok)) ),
           print_message(warning, typhon(node_order(P, Order, Result)))).

%   The children kill themselves when they cannot end in order within
%   stop_seconds, so those that are left after that are really stuck.

end_children(Network) :-
    setting(typhon_children:stop_seconds, Seconds),
    findall(P, child(Network, P, _), Ps),
    wait_down(Network, Ps, Seconds + 1),
    !.
end_children(Network) :-
    findall(P, left(Network, P), Ps),
    kill_all(Network, Ps),
    !.
end_children(Network) :-
    forall(( left(Network, P), retract(child(Network, P, _)) ),
           print_message(error, typhon(node_stays(Network, P)))).

left(Network, P) :-
    child(Network, P, _),
    \+ node_gone(Network, P).

%   wait_down(+Network, +Ps, +Seconds): fails when one of Ps is left.

wait_down(Network, Ps, Seconds) :-
    queue(Network, Queue),
    deadline(Seconds, Deadline),
    await_down(Network, Ps, Queue, Deadline).

await_down(Network, Ps, Queue, Deadline) :-
    (   member(P, Ps),
        left(Network, P)
    ->  message_before(Queue, down(_, _), Deadline),
        await_down(Network, Ps, Queue, Deadline)
    ;   true
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

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
