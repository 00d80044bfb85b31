:- module(allocation_mechanisms,
          [ mechanism_allocate/4,       % +Mechanism, +Pairs, +Case, +Network
            task_start/3,               % +Task, +Host, +Case
            allocators_end/2            % +Network, +Limit
          ]).
:- use_module('../../prolog/typhon',
              [agent_join/3, network_advance/2, network_property/2]).
:- use_module('../../agents/allocation/auctions',
              [auction_account/2, auction_counts/3, auction_open/3,
               auction_post/3, auction_start/3]).
:- use_module('../../agents/allocation/operator',
              [robot_status/2, task_allocate/4]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(pairs), [pairs_values/2]).

/** <module> The mechanisms to compare

  | proposed | the allocators of the thesis                       |
  | constant | the same, with equation 7.7 instead of 7.6         |
  | murdoch, anta | auctions                                      |

*Threading*: one thread, which waits.
*/

%!  mechanism_allocate(+Mechanism, +Pairs, +Case, +Network) is semidet.
%
%   Pairs are Task-Host: the allocation of each Task begins at Host, at the
%   same time.  Waits until all tasks have ended, robots are free, and the log
%   has all counts; fails at Case.limit.  Case has also `bi_min`, `bi_max` and
%   `seed`.

mechanism_allocate(Mechanism, Pairs, Case, Network) :-
    memberchk(Mechanism, [murdoch, anta]),
    !,
    network_property(Network, hosts(Hosts)),
    auction_start(Mechanism, Hosts,
                  [ settings([ bi_min-Case.bi_min, bi_max-Case.bi_max,
                               beta-Case.beta, sending-Case.sending ]),
                    slack(0) ]),
    forall(member(Task-Host, Pairs), auction_post(Mechanism, Task, Host)),
    pairs_values(Pairs, Auctioneers),
    auctions_end(auctions(Mechanism, Auctioneers, Hosts), Network,
                 Case.limit),
    log_counts(Mechanism, Hosts, Network).
mechanism_allocate(Mechanism, Pairs, Case, Network) :-
    backoff(Mechanism, Backoff),
    forall(member(Task-Host, Pairs), start(Backoff, Task, Host, Case)),
    allocators_end(Network, Case.limit).

backoff(proposed, adaptive).
backoff(constant, constant).

%!  task_start(+Task, +Host, +Case) is det.
%
%   The proposed mechanism allocates Task, beginning at Host.

task_start(Task, Host, Case) :-
    start(adaptive, Task, Host, Case).

start(Backoff, Task, Host, Case) :-
    task_allocate(Task, Host,
                  [ settings([ backoff-Backoff, seed-Case.seed,
                               bi_min-Case.bi_min, bi_max-Case.bi_max,
                               beta-Case.beta, sharing-Case.sharing ]) ],
                  _).

%   Nodes do not end, so nodes and robots are polled. A robot that misses the
%   release message, because it has no link at the time, is free when its
%   contract lapses. The message takes less time than the polling interval.

auctions_end(Auctions, Network, Limit) :-
    Limit > 0,
    network_advance(Network, 10),
    (   over(Auctions)
    ->  network_advance(Network, 10)
    ;   Left is Limit - 10,
        auctions_end(Auctions, Network, Left)
    ).

over(auctions(Mechanism, Auctioneers, Hosts)) :-
    auction_open(Mechanism, Auctioneers, []),
    forall(member(Host, Hosts), robot_status(Host, free)).

%   Waits until the nodes have logged everything.

log_counts(Mechanism, Hosts, Network) :-
    auction_account(Mechanism, Hosts),
    network_advance(Network, 0),
    (   auction_counts(Mechanism, Hosts, [])
    ->  true
    ;   log_counts(Mechanism, Hosts, Network)
    ).

%!  allocators_end(+Network, +Limit) is semidet.
%
%   Waits until all allocators and their children have ended; fails after Limit
%   seconds.

allocators_end(Network, Limit) :-
    network_property(Network, agents(Agents)),
    findall(Agent,
            ( member(Agent, Agents), sub_atom(Agent, 0, _, _, 'allocator.') ),
            Allocators),
    (   Allocators == []
    ->  true
    ;   forall(member(Agent, Allocators),
               ( agent_join(Agent, Outcome, Limit), Outcome \== timeout )),
        allocators_end(Network, Limit)
    ).
