:- module(course_election, []).

% Lesson 3: hosts that elect a leader.

:- use_module(course).
:- use_module('../../../prolog/typhon').
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), 
              [append/3, max_list/2, member/2, memberchk/2, sum_list/2]).

:- multifile course:criterion/3.

                /*******************************
                *          RING LEADER         *
                *******************************/

course:criterion(ring_leader, 'each host knows the highest rank as leader',
                 course_election:ring_elects).
course:criterion(ring_leader, 'n(n+1)/2 hops and a round are enough',
                 course_election:ring_is_cheap).

ring_elects(File) :-
    forall(member(Ranks, [[4, 1, 5, 2, 3], [1, 2, 3], [7, 6, 5, 4, 3, 2, 1]]),
           ( length(Ranks, N),
             in_network(ring(N), [], elects(File, Ranks, _)) )).

ring_is_cheap(File) :-
    Ranks = [6, 5, 4, 3, 2, 1],         % the worst of all orders
    in_network(ring(6), [], elects(File, Ranks, Hops)),
    (   Hops =< 6*7//2 + 6
    ->  true
    ;   expect('the number of hops', Hops, at_most(27))
    ).

%   Each host knows the next one in the ring, by the fact next(Host).

elects(File, Ranks, Hops, Hosts) :-
    maplist(put_rank, Hosts, Ranks),
    Hosts = [First|Rest],
    append(Rest, [First], Nexts),
    maplist(put_next, Hosts, Nexts),
    all_start(File, Hosts, Agents),
    maplist(comes_to_its_end, Agents),
    max_list(Ranks, Highest),
    maplist(leader_is(Highest), Hosts),
    maplist(arrived, Hosts, Counts),
    sum_list(Counts, Hops).

put_rank(Host, Rank) :-
    remote(Host, leave(rank(Rank))).

put_next(Host, Next) :-
    remote(Host, leave(next(Next))).

all_start(File, Hosts, Agents) :-
    findall(Agent, ( member(Host, Hosts), on_host(File, Host, Agent) ),
            Agents).

comes_to_its_end(Agent) :-
    agent_join(Agent, Outcome, 10_000),
    (   memberchk(Outcome, [done, disposed])
    ->  true
    ;   expect('how a candidate ends', Outcome, done)
    ).

leader_is(Rank, Host) :-
    facts_on(Host, leader(_), Leaders),
    expect('the leader that a host knows', Leaders, [leader(Rank)]).

                /*******************************
                *            LEADER            *
                *******************************/

course:criterion(leader, 'a tree knows its leader',
                 course_election:elects_in(tree(7), [3, 1, 7, 2, 6, 5, 4])).
course:criterion(leader, 'a grid knows its leader',
                 course_election:elects_in(grid(2, 3), [3, 1, 2, 6, 5, 4])).
course:criterion(leader, 'any network knows its leader',
                 course_election:elects_in(random(8, 0.3),
                                           [3, 1, 8, 2, 6, 5, 4, 7])).

elects_in(Topology, Ranks, File) :-
    in_network(Topology, [], anywhere(File, Ranks)).

anywhere(File, Ranks, Hosts) :-
    maplist(put_rank, Hosts, Ranks),
    all_start(File, Hosts, Agents),
    maplist(comes_to_its_end, Agents),
    max_list(Ranks, Highest),
    maplist(leader_is(Highest), Hosts).
