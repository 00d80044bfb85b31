:- module(typhon_processes,
          [ carriers_start/4,           % +Network, +P, +Machines, +Interface
            carriers_stop/1,            % +Network
            carrier/3,                  % ?Network, ?P, ?Pid
            carrier_order/4             % +Network, +P, +Order, -Answer
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [member/2, nth1/3, selectchk/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../wire', [endpoint_address/1, endpoint_request/4]).
:- use_module(children,
              [child_close/1, child_kill/1, child_release/1, child_start/5]).
:- use_module(carrier, [order_do/2]).

/** <module> The processes that carry a network

The carriers of a network are numbered from 1. Either there is one, this
process, or each is a child (see room `children`). Orders (see room
`orders`) are done here in the first case and go over the wire in the
second.

*Threading*: any thread may give orders. The threads that follow the
children tell what happens to them: as facts, and as messages to a queue
that starting and stopping wait on.
*/

:- multifile
    prolog:error_message//1,
    prolog:message//1.

:- setting(start_seconds, number, 60,
           "The processes of a network have so long to start").
:- setting(order_seconds, number, 60,
           "A process has so long to answer an order").
:- setting(answer_seconds, number, 2,
           "A process that is to end and says nothing for so long is killed").
:- setting(kill_seconds, number, 10,
           "A process that was killed has so long to be gone").

:- meta_predicate
    ask(+, +, +, +, 1, -),
    order_children(+, +, 1).

:- dynamic
    queue/2,                    % Network, Queue
    wanted/1,                   % Network: its carriers are to stay
    child/3,                    % Network, P, Child
    up/4,                       % Network, P, local or Endpoint, Pid
    down/3,                     % Network, P, Status
    waiting/3.                  % Network, P, Queue: for an answer of P

                /*******************************
                *           STARTING           *
                *******************************/

%!  carriers_start(+Network, +P, +Machines, +Interface) is det.
%
%   Starts P carriers, blocks of them on each of Machines. With `[local]`
%   and P = 1 this process is the carrier. When this throws, what was
%   started waits for carriers_stop/1.
%
%   @error timeout_error(start, Network),
%   system_error(process_ended(Status)), and as child_start/5

carriers_start(Network, 1, [local], _) :-
    !,
    current_prolog_flag(pid, Pid),
    assertz(up(Network, 1, local, Pid)).
carriers_start(Network, P, Machines, Interface) :-
    message_queue_create(Queue),
    assertz(queue(Network, Queue)),
    length(Machines, M),
    forall(between(1, P, I),
           ( At is (I - 1) * M // P + 1,
             nth1(At, Machines, Machine),
             start(Network, I, Machine, Interface) )),
    setting(start_seconds, Seconds),
    setup_call_cleanup(
        thread_create(alarm(Seconds, Queue), Alarm),
        wait_up(P, Network, Queue),
        ( thread_send_message(Alarm, done),
          thread_join(Alarm, _)
        )),
    assertz(wanted(Network)).

%   Networks are often started in the setup of a cleanup, where a wait with
%   a deadline of its own would not do: see typhon_own_thread.

alarm(Seconds, Queue) :-
    thread_self(Me),
    (   thread_get_message(Me, done, [timeout(Seconds)])
    ->  true
    ;   thread_send_message(Queue, late)
    ).

start(Network, P, Machine, Interface) :-
    child_start(Network-P, Machine, Interface, typhon_processes:event, Child),
    assertz(child(Network, P, Child)).

event(up(Network-P, Endpoint, Pid)) :-
    assertz(up(Network, P, Endpoint, Pid)),
    tell(Network, up).
event(down(Network-P, Status)) :-
    (   wanted(Network),
        up(Network, P, _, Pid)
    ->  print_message(warning, typhon(carrier_down(Network, Pid, Status)))
    ;   true
    ),
    assertz(down(Network, P, Status)),
    forall(waiting(Network, P, Queue), answered(Queue, P, down)),
    tell(Network, down(Status)).

tell(Network, Event) :-
    queue(Network, Queue),
    thread_send_message(Queue, Event).

wait_up(0, _, _) :-
    !.
wait_up(P, Network, Queue) :-
    thread_get_message(Queue, Event),
    (   Event == up
    ->  P1 is P - 1,
        wait_up(P1, Network, Queue)
    ;   Event = down(Status)
    ->  throw(error(system_error(process_ended(Status)), _))
    ;   throw(error(timeout_error(start, Network), _))
    ).

deadline(Seconds, Deadline) :-
    get_time(Now),
    Deadline is Now + Seconds.

next(Queue, Event, Deadline) :-
    get_time(Now),
    Wait is max(0, Deadline - Now),
    thread_get_message(Queue, Event, [timeout(Wait)]).

                /*******************************
                *            ORDERS            *
                *******************************/

%!  carrier(?Network, ?P, ?Pid) is nondet.
%
%   Carrier P of Network is up; Pid is its process on its machine.

carrier(Network, P, Pid) :-
    up(Network, P, _, Pid),
    \+ down(Network, P, _).

%!  carrier_order(+Network, +P, +Order, -Answer) is det.
%
%   Carrier P does Order.
%
%   @error existence_error(carrier, Network-P) when it is not up, or ends
%   before it has answered; timeout_error(answer, Network-P); what order_do/2
%   throws there

carrier_order(Network, P, Order, Answer) :-
    up(Network, P, local, _),
    !,
    order_do(Order, Answer).
carrier_order(Network, P, Order, Answer) :-
    setting(order_seconds, Seconds),
    ask([P], Network, Order, Seconds, unwatched, [_-Result]),
    result(Result, Network-P, Answer).

result(answer(done(Answer)), _, Answer).
result(answer(raised(Formal, Text)), _, _) :-
    throw(error(Formal, context(_, Text))).
result(down, Carrier, _) :-
    existence_error(carrier, Carrier).
result(unreachable, Carrier, _) :-
    existence_error(carrier, Carrier).
result(lost, Carrier, _) :-
    existence_error(carrier, Carrier).
result(late, Carrier, _) :-
    throw(error(timeout_error(answer, Carrier), _)).

%   ask(+Ps, +Network, +Order, +Seconds, :Watch, -Results): what children Ps
%   answer, P-Result in order of arrival. While some have not answered,
%   call(Watch, Those) again and again. Result is one of endpoint_request/4,
%   `down` or `late`. The endpoint alone cannot tell a peer that is dead from
%   one that will be back.

ask(Ps, Network, Order, Seconds, Watch, Results) :-
    deadline(Seconds, Deadline),
    setup_call_cleanup(
        message_queue_create(Queue),
        ( forall(member(P, Ps), send(Network, P, Order, Queue)),
          answers(Ps, Queue, Deadline, Watch, Results)
        ),
        ( retractall(waiting(_, _, Queue)),
          message_queue_destroy(Queue)
        )).

unwatched(_).

send(Network, P, Order, Queue) :-
    assertz(waiting(Network, P, Queue)),
    (   carrier(Network, P, _),
        up(Network, P, Endpoint, _)
    ->  endpoint_request(Endpoint, node, Order,
                         typhon_processes:answered(Queue, P))
    ;   answered(Queue, P, down)
    ).

answered(Queue, P, Result) :-
    catch(thread_send_message(Queue, P-Result),
          error(existence_error(_, _), _),
          true).                % nobody waits any more

answers([], _, _, _, []) :-
    !.
answers(Ps, Queue, Deadline, Watch, Results) :-
    call(Watch, Ps),
    deadline(1, Soon),
    Slice is min(Soon, Deadline),
    (   next(Queue, Answer, Slice)
    ->  take(Answer, Ps, Rest, Results, Others)
    ;   Soon < Deadline
    ->  Rest = Ps,
        Results = Others
    ;   take(_-late, Ps, Rest, Results, Others)
    ),
    answers(Rest, Queue, Deadline, Watch, Others).

take(P-Result, Ps, Rest, [P-Result|Others], Others) :-
    selectchk(P, Ps, Rest),
    !.
take(_, Ps, Ps, Others, Others).

                /*******************************
                *           STOPPING           *
                *******************************/

%!  carriers_stop(+Network) is det.
%
%   Ends the carriers that carriers_start/4 began to start, in order if
%   they can, else by force. This process stays, of course.
%
%   First the hosts of all children stop, and those that hang are killed:
%   the others need not wait for them. Then what the children have sent
%   arrives, at the log for one, and only then they end: so none waits for
%   another that is gone.

carriers_stop(Network) :-
    retractall(wanted(Network)),
    order_children(Network, stop, kill_hanging(Network)),
    peers(Network, Peers),
    order_children(Network, flush(2, Peers), unwatched),
    forall(child(Network, _, Child), child_close(Child)),
    (   queue(Network, Queue)
    ->  end_children(Network),
        release_children(Network),
        retractall(queue(Network, _)),
        message_queue_destroy(Queue)
    ;   true
    ),
    retractall(up(Network, _, _, _)),
    retractall(down(Network, _, _)).

%   One by one: other threads may start children meanwhile, see
%   typhon_mailbox.

release_children(Network) :-
    retract(child(Network, _, Child)),
    !,
    child_release(Child),
    release_children(Network).
release_children(_).

%   This process, and the children that are left.

peers(Network, Peers) :-
    findall(Peer,
            ( endpoint_address(Peer)
            ; carrier(Network, P, _), up(Network, P, Peer, _) ),
            Peers).

%   One may begin to hang after it has said that it is alive.

kill_hanging(Network, Ps) :-
    setting(answer_seconds, Seconds),
    ask(Ps, Network, alive, Seconds, unwatched, Results),
    findall(P, member(P-late, Results), Hanging),
    (   Hanging == []
    ->  true
    ;   ignore(kill_all(Network, Hanging))
    ).

%   kill_all(+Network, +Ps) fails when not all are gone in time.

kill_all(Network, Ps) :-
    forall(( member(P, Ps), child(Network, P, Child) ),
           ( print_message(warning, typhon(carrier_killed(Network, P))),
             child_kill(Child) )),
    setting(kill_seconds, Seconds),
    wait_down(Network, Ps, Seconds).

children_up(Network, Ps) :-
    findall(P, ( child(Network, P, _), carrier(Network, P, _) ), Ps).

%   All children that are up do Order, watched by Watch; one that cannot is
%   left to later.

order_children(Network, Order, Watch) :-
    setting(typhon_children:stop_seconds, Seconds),
    children_up(Network, Ps),
    ask(Ps, Network, Order, Seconds, Watch, Results),
    forall(( member(P-Result, Results), Result \== answer(done(ok)) ),
           print_message(warning, typhon(carrier_order(P, Order, Result)))).

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
           print_message(error, typhon(carrier_stays(Network, P)))).

left(Network, P) :-
    child(Network, P, _),
    \+ down(Network, P, _).

%   wait_down(+Network, +Ps, +Seconds) fails when one of Ps is left.

wait_down(Network, Ps, Seconds) :-
    queue(Network, Queue),
    deadline(Seconds, Deadline),
    await_down(Network, Ps, Queue, Deadline).

await_down(Network, Ps, Queue, Deadline) :-
    (   member(P, Ps),
        left(Network, P)
    ->  next(Queue, down(_), Deadline),
        await_down(Network, Ps, Queue, Deadline)
    ;   true
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(carrier_down(Network, Pid, Status))) -->
    [ 'Process ~w of ~w ended: ~p'-[Pid, Network, Status] ].
prolog:message(typhon(carrier_order(P, Order, Result))) -->
    [ 'Process ~w of the network did not do ~q: ~p'-[P, Order, Result] ].
prolog:message(typhon(carrier_killed(Network, P))) -->
    [ 'Process ~w of ~w does not end, and is killed'-[P, Network] ].
prolog:message(typhon(carrier_stays(Network, P))) -->
    [ 'Process ~w of ~w could not be ended'-[P, Network] ].

prolog:error_message(system_error(process_ended(Status))) -->
    [ 'A process of the network ended before it was ready: ~p'-[Status] ].
prolog:error_message(timeout_error(start, Network)) -->
    [ 'The processes of ~w were not ready in time'-[Network] ].
prolog:error_message(existence_error(carrier, Network-P)) -->
    [ 'Process ~w of ~w is not there'-[P, Network] ].
