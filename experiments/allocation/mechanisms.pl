:- module(allocation_mechanisms,
          [ mechanism/2,                % ?Mechanism, ?Title
            mechanism_start/3,          % +Mechanism, +Hosts, +Options
            mechanism_allocate/4,       % +Mechanism, +Pairs, +Options, -Agents
            mechanism_account/3         % +Mechanism, +Hosts, -Total
          ]).
:- use_module('../../prolog/typhon', [agent_send/2]).
:- use_module('../../agents/allocation/auctions',
              [ auction_account/2, auction_counts/3, auction_post/3,
                auction_start/3 ]).
:- use_module('../../agents/allocation/operator', [task_allocate/4]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/2]).

/** <module> What is compared: ways to allocate tasks

*Threading*: no state; any thread, one at a time.
*/

%!  mechanism(?Mechanism, ?Title) is nondet.

mechanism(proposed, 'proposed').
mechanism(constant, 'constant back-off').
mechanism(murdoch, 'Murdoch').
mechanism(anta, 'ANTA').

auction(murdoch).
auction(anta).

%!  mechanism_start(+Mechanism, +Hosts, +Options) is det.
%
%   Hosts get what Mechanism needs beside robots.  Options: bi_min(S),
%   bi_max(S), slack(S), all required.

mechanism_start(Mechanism, Hosts, Options) :-
    auction(Mechanism),
    !,
    option(bi_min(Min), Options),
    option(bi_max(Max), Options),
    option(slack(Slack), Options),
    auction_start(Mechanism, Hosts,
                  [settings([bi_min-Min, bi_max-Max]), slack(Slack)]).
mechanism_start(_, _, _).

%!  mechanism_allocate(+Mechanism, +Pairs, +Options, -Agents) is det.
%
%   Pairs Task-Host: each Task is allocated from Host on, all from now on.
%   Agents are the allocators, none where it is nodes that allocate.
%   Options are those of mechanism_start/3 and seed(N).

mechanism_allocate(Mechanism, Pairs, _, []) :-
    auction(Mechanism),
    !,
    forall(member(Task-Host, Pairs), auction_post(Mechanism, Task, Host)).
mechanism_allocate(Mechanism, Pairs, Options, Agents) :-
    settings(Mechanism, Options, Settings),
    maplist(allocator(Settings), Pairs, Agents),
    forall(member(Agent, Agents), agent_send(Agent, begin)).

allocator(Settings, Task-Host, Agent) :-
    task_allocate(Task, Host, [settings([start-order|Settings])], Agent).

settings(Mechanism, Options, Settings) :-
    option(bi_min(Min), Options),
    option(bi_max(Max), Options),
    option(seed(Seed), Options),
    Settings0 = [bi_min-Min, bi_max-Max, seed-Seed],
    (   Mechanism == constant
    ->  append(Settings0, [backoff-constant], Settings)
    ;   Settings = Settings0
    ).

%!  mechanism_account(+Mechanism, +Hosts, -Total:integer) is det.
%
%   Once all is over: nodes log what they have sent, which is Total in all.
%   Allocators and their children have logged it themselves; Total is 0.

mechanism_account(Mechanism, Hosts, Total) :-
    auction(Mechanism),
    !,
    quiet(Mechanism, Hosts, Total),
    auction_account(Mechanism, Hosts).
mechanism_account(_, _, 0).

%   The last messages are still on their way when the last robot is free.

quiet(Mechanism, Hosts, Total) :-
    sent(Mechanism, Hosts, Total0),
    sleep(0.3),
    sent(Mechanism, Hosts, Total1),
    (   Total1 =:= Total0
    ->  Total = Total1
    ;   quiet(Mechanism, Hosts, Total)
    ).

sent(Mechanism, Hosts, Total) :-
    auction_counts(Mechanism, Hosts, Counts),
    aggregate_all(sum(Count), member(_-Count, Counts), Total).
