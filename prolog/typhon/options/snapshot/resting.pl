:- module(typhon_resting,
          [ agents_at_rest/2,           % +Seconds, +Peers
            agents_go_on/1              % +Agents
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/host', [schedule/2]).
:- use_module('../../kernel/agent',
              [ agent/5, agent_order/2, agent_ordered/1, agent_status/3,
                agents_passed/0, with_agent/2 ]).
:- use_module('../../kernel/travel', [news_carried/1, post_tried/0]).

/** <module> All agents of a process come to rest

When no agent gets a turn any more those that run stop at their next effect, as
they do for an order.  Agents under way arrive, or stay; messages and news
that are being handled find their way, or wait.

*Threading*: the thread that holds the process.
*/

%!  agents_at_rest(+Seconds, +Peers) is semidet.
%
%   No agent of this process runs or is under way any more, and nothing is
%   queued for the endpoints Peers; fails if that is not so in
%   Seconds.

agents_at_rest(Seconds, Peers) :-
    get_time(Now),
    Deadline is Now+Seconds,
    agents_passed,
    rest_before(Deadline, Peers).

%   Looks again every 10 ms: a notification would make each turn and each
%   departure check for a waiting caller.

rest_before(Deadline, Peers) :-
    forall(( agent_status(Id, running, _), \+ agent_ordered(Id) ),
           ignore(with_agent(Id, stops(Id)))),
    (   \+ restless(Peers),
        agents_passed,                  % messages follow agents that left
        \+ restless(Peers)
    ->  true
    ;   get_time(Now),
        Now < Deadline,
        thread_self(Me),
        \+ thread_get_message(Me, '$typhon_never', [timeout(0.01)]),
        rest_before(Deadline, Peers)
    ).

%   An order with which nothing is done.

stops(Id) :-
    agent_status(Id, running, _),
    agent_order(Id, asked(question(rest), queue(none))).

restless(_) :-
    agent_status(_, Status, _),
    moves(Status),
    !.
restless(_) :-
    post_tried,
    !.
restless(Peers) :-
    member(Peer, Peers),
    news_carried(Peer),
    !.

moves(running).
moves(obeying).
moves(arriving).
moves(transit(_, _)).
moves(cloning(_, _)).

%!  agents_go_on(+Agents:list) is det.
%
%   Agents have missed their turn.

agents_go_on(Agents) :-
    forall(( member(Id, Agents), agent(Id, Host, _, _, _) ),
           schedule(Host, Id)).
