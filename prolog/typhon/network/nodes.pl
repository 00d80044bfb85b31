:- module(typhon_nodes,
          [ node_came/4,                % +Network, +P, +Where, +Pid
            node_went/3,                % +Network, +P, +Status
            node_again/2,               % +Network, +P
            nodes_forget/1,             % +Network
            node/3,                     % ?Network, ?P, ?Pid
            node/4,                     % ?Network, ?P, ?Pid, ?Where
            node_gone/2,                % +Network, +P
            nodes_gone/3,               % +Network, +Ps, +Seconds
            node_order/4,               % +Network, +P, +Order, -Answer
            nodes_order/5,              % +Network, +Ps, +Order, +Seconds,
                                        % -Answers
            nodes_ask/6,                % +Network, +Ps, +Order, +Seconds,
                                        % :Watch, -Results
            nodes_send/3,               % +Network, +Ps, +Order
            nodes_peers/2,              % +Network, -Peers
            unwatched/1                 % +Ps
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(lists), [member/2, selectchk/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/fifo', [fifo_send/2]).
:- use_module('../kernel/base/monotonic',
              [ deadline/2, monotonic_time/1, poll_within/2, wait_within/2 ]).
:- use_module('../kernel/base/error_lines', [harmless_error/2]).
:- use_module('../kernel/wire', [endpoint_address/1, endpoint_request/4]).
:- use_module(children, [child_secret/1]).
:- use_module(node_process, [order_do/2]).

/** <module> The processes of a network, and orders to them

The processes of a network are numbered from 1. Either this process is the only
one, or each is a child. Orders (see module `node_process`) are carried out here
in the first case and sent over the wire in the second.

*Threading*: any thread may give orders. The thread that follows a child records
its end as a fact, and reports it to callers that wait for an answer.
*/

:- multifile
    prolog:error_message//1.

:- setting(typhon_processes:order_seconds, number, 60,
           "Seconds for a process to answer an order").

:- meta_predicate
    nodes_ask(+, +, +, +, 1, -).

:- dynamic
    up/4,                       % Network, P, local or Endpoint, Pid
    down/3,                     % Network, P, Status
    waiting/3.                  % Network, P, Queue: for an answer of P

                /*******************************
                *          PROCESSES           *
                *******************************/

%!  node_came(+Network, +P, +Where, +Pid) is det.
%
%   Process P is up. Where is `local`, or the endpoint of a child.

node_came(Network, P, Where, Pid) :-
    assertz(up(Network, P, Where, Pid)),
    debug(typhon(network), 'process ~w of ~w is up: ~w, ~w',
          [P, Network, Where, Pid]).

%!  node_went(+Network, +P, +Status) is det.
%
%   Process P is down.

node_went(Network, P, Status) :-
    assertz(down(Network, P, Status)),
    debug(typhon(network), 'process ~w of ~w is down: ~p',
          [P, Network, Status]),
    forall(waiting(Network, P, Queue), answered(Queue, P, down)).

%!  node_again(+Network, +P) is det.
%
%   Process P, which was down, is about to be started again.

node_again(Network, P) :-
    retractall(up(Network, P, _, _)),
    retractall(down(Network, P, _)).

%!  nodes_forget(+Network) is det.

nodes_forget(Network) :-
    retractall(up(Network, _, _, _)),
    retractall(down(Network, _, _)).

%!  node(?Network, ?P, ?Pid) is nondet.
%!  node(?Network, ?P, ?Pid, ?Where) is nondet.
%
%   Process P of Network is up; Pid is its process id on its machine.

node(Network, P, Pid) :-
    node(Network, P, Pid, _).

node(Network, P, Pid, Where) :-
    up(Network, P, Where, Pid),
    \+ down(Network, P, _).

%!  node_gone(+Network, +P) is semidet.
%!  nodes_gone(+Network, +Ps, +Seconds) is semidet.
%
%   Process P has ended, whether it was up or not.  nodes_gone/3 waits until all
%   of Ps have ended, at most for so many Seconds.

node_gone(Network, P) :-
    down(Network, P, _),
    !.

nodes_gone(Network, Ps, Seconds) :-
    poll_within(Seconds, forall(member(P, Ps), node_gone(Network, P))).

                /*******************************
                *            ORDERS            *
                *******************************/

%!  node_order(+Network, +P, +Order, -Answer) is det.
%
%   Process P carries out Order and returns Answer.
%
%   @error existence_error(carrier, Network-P) P is not up, or ends before it
%   has answered
%   @error timeout_error(answer, Network-P)
%   @error the errors of order_do/2 in P

node_order(Network, P, Order, Answer) :-
    setting(typhon_processes:order_seconds, Seconds),
    nodes_order(Network, [P], Order, Seconds, [Answer]).

%!  nodes_order(+Network, +Ps, +Order, +Seconds, -Answers) is det.
%
%   As node_order/4, for all processes Ps at the same time. Answers are in the
%   order of Ps. Each process must answer within Seconds.

nodes_order(Network, [P], Order, _, [Answer]) :-
    up(Network, P, local, _),
    !,
    order_do(Order, Answer).
nodes_order(Network, Ps, Order, Seconds, Answers) :-
    nodes_ask(Network, Ps, Order, Seconds, unwatched, Results),
    maplist(result_of(Network, Results), Ps, Answers).

result_of(Network, Results, P, Answer) :-
    memberchk(P-Result, Results),
    result(Result, Network-P, Answer).

result(answer(done(Answer)), _, Answer).
result(answer(raised(Formal, Text)), _, _) :-
    harmless_error(error(Formal, context(_, Text)), Ball),
    throw(Ball).
result(answer(not_permitted(Right)), Node, _) :-
    permission_error(Right, process, Node).
result(down, Node, _) :-
    existence_error(carrier, Node).
result(unreachable, Node, _) :-
    existence_error(carrier, Node).
result(lost, Node, _) :-
    existence_error(carrier, Node).
result(late, Node, _) :-
    throw(error(timeout_error(answer, Node), _)).

%!  nodes_ask(+Network, +Ps, +Order, +Seconds, :Watch, -Results) is det.
%
%   Send Order to the children Ps. Results are pairs P-Result, in the order of
%   their arrival. Result is a result of endpoint_request/4, `down` if the child
%   has ended, which the endpoint alone cannot know, or `late`. Before each
%   wait for an answer call(Watch, Waiting) is called with the children that
%   have not answered. A wait is of at most a second, unless Watch is
%   `unwatched`: networks are often started in the setup of a cleanup, where a
%   wait that expires may hang, see typhon_own_thread.

nodes_ask(Network, Ps, Order, Seconds, Watch, Results) :-
    functor(Order, What, _),            % arguments may contain secrets
    debug(typhon(network), 'processes ~w of ~w: ~w', [Ps, Network, What]),
    deadline(Seconds, Deadline),
    setup_call_cleanup(
        message_queue_create(Queue),
        ( forall(member(P, Ps), send(Network, P, Order, Queue)),
          answers(Ps, Queue, Deadline, Watch, Results)
        ),
        ( retractall(waiting(_, _, Queue)),
          message_queue_destroy(Queue)
        )).

%!  nodes_send(+Network, +Ps, +Order) is det.
%
%   Send Order to processes Ps, and do not wait for answers.

nodes_send(Network, Ps, Order) :-
    forall(( member(P, Ps), node(Network, P, _, Where) ),
           send_order(Where, Order)).

send_order(local, Order) :-
    !,
    order_do(Order, _).
send_order(Endpoint, Order) :-
    ask(Endpoint, Order, typhon_nodes:unwatched).

ask(Endpoint, Order, OnAnswer) :-
    child_secret(Secret),
    endpoint_request(Endpoint, node, order(Secret, Order), OnAnswer).

%!  nodes_peers(+Network, -Peers:list) is det.
%
%   Peers are the endpoints of this process, and of the children that are up.

nodes_peers(Network, Peers) :-
    findall(Peer,
            ( endpoint_address(Peer)
            ; node(Network, _, _, Peer) ),
            Peers).

%!  unwatched(+Ps) is det.
%
%   A Watch for nodes_ask/6 that does nothing.

unwatched(_).

send(Network, P, Order, Queue) :-
    assertz(waiting(Network, P, Queue)),
    (   node(Network, P, _, Endpoint)
    ->  ask(Endpoint, Order, typhon_nodes:answered(Queue, P))
    ;   answered(Queue, P, down)
    ).

answered(Queue, P, Result) :-
    ignore(fifo_send(Queue, P-Result)). % the caller may have stopped waiting

answers([], _, _, _, []) :-
    !.
answers(Ps, Queue, Deadline, Watch, Results) :-
    call(Watch, Ps),
    monotonic_time(Now),
    Left is max(0, Deadline-Now),
    slice(Watch, Left, Slice),
    (   wait_within(Slice, thread_get_message(Queue, Answer))
    ->  take(Answer, Ps, Rest, Results, Others)
    ;   Slice < Left
    ->  Rest = Ps,
        Results = Others
    ;   take(_-late, Ps, Rest, Results, Others)
    ),
    answers(Rest, Queue, Deadline, Watch, Others).

slice(_:unwatched, Left, Left) :-
    !.
slice(_, Left, Slice) :-
    Slice is min(1, Left).

take(P-Result, Ps, Rest, [P-Result|Others], Others) :-
    selectchk(P, Ps, Rest),
    !.
take(_, Ps, Ps, Others, Others).

prolog:error_message(existence_error(carrier, Network-P)) -->
    [ 'Process ~w of ~w is not running'-[P, Network] ].
