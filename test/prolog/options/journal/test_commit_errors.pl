:- module(test_commit_errors, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2, nth0/3]).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/on_demand), [on_demand_load/2]).

/** <module> Commits that fail, and then succeed again

Whichever commit of a process fails, everything arrives once when commits succeed
again, and all its threads go on.

*Threading*: one test at a time.
*/

:- needs([journal]).

:- on_demand_load(host_option, journal).

%   The store fails with Formal after N more commits.  Changed with the mutex
%   `commit_errors`: a commit removes the fact before it adds it again.

:- dynamic failing/2.                   % N, Formal

:- public commit_or_fail/1.

:- meta_predicate commit_or_fail(0).

commit_or_fail(Commit) :-
    with_mutex(commit_errors, next_fails(Formal)),
    (   var(Formal)
    ->  call(Commit)
    ;   throw(error(Formal, _))
    ).

next_fails(Formal) :-
    failing(0, Formal),
    !.
next_fails(_) :-
    (   retract(failing(N, Formal))
    ->  N1 is N-1,
        assertz(failing(N1, Formal))
    ;   true
    ).

error_of(N, Formal) :-
    Formals = [ journal_unreachable(there, why), journal_damaged(there, why),
                journal_unwritten(there, why), resource_error(journal_space),
                permission_error(open, journal, there) ],
    I is N mod 5,
    nth0(I, Formals, Formal).

:- meta_predicate
    with_failing_commits(0),
    with_journal(0, +).

with_failing_commits(Goal) :-
    setup_call_cleanup(
        ( wrap_predicate(typhon_store:store_commit(_), commit_errors, Commit,
                         test_commit_errors:commit_or_fail(Commit)),
          wrap_predicate(typhon_committing:again_seconds(S), commit_errors, _,
                         S = 0.02) ),
        no_leaks(with_tmp_dir(test_commit_errors:with_journal(Goal))),
        ( unwrap_predicate(typhon_store:store_commit/1, commit_errors),
          unwrap_predicate(typhon_committing:again_seconds/1,
                           commit_errors) )).

with_journal(Goal, Dir) :-
    with_peers([beta],
               setup_call_cleanup(( host_start(alpha, [journal(Dir)]),
                                    host_start(gamma) ),
                                  call(Goal),
                                  ( host_stop(gamma), host_stop(alpha) ))).

%   Rounds in which all commits after the N-th fail for a while, until a round has
%   fewer commits; then everything has arrived once.

each_commit_fails :-
    peer_host(beta, Beta),
    agent_create(clauses([ (:- agent(listener, [state([got/1])])),
                           (on_message(_, M) :- assertz(got(M))) ]),
                 Listener, [host(Beta)]),
    rounds(0, Beta, Listener, Count),
    arrived(Listener, Arrived),
    findall(M, ( between(0, Count, N), of_round(N, M) ), Ms),
    msort(Arrived, All),
    msort(Ms, All),
    wait_until(\+ sending, 20),
    \+ ( thread_property(Thread, status(Status)), Status \== running,
         Thread \== gc ).

of_round(N, M) :-
    member(M, [there(N), back(N), down(N)]).

sending :-
    typhon_news:courier(_).
sending :-
    typhon_channel:courier(_).

arrived(Listener, Arrived) :-
    agent_property(Listener, facts(Facts)),
    findall(M, member(got(M), Facts), Arrived).

rounds(N, Beta, Listener, Count) :-
    round(N, Beta, Listener, Failed),
    (   Failed == false
    ->  Count = N
    ;   N1 is N+1,
        rounds(N1, Beta, Listener, Count)
    ).

%   An agent goes to beta, sends from there, and sends when it is back; another
%   monitors an agent of beta; a guest of beta goes from alpha
%   to gamma, another host of this process, and ends.  A move is repeated
%   after an error of the journal.

round(N, Beta, Listener, Failed) :-
    host_property(alpha, address(Alpha)),
    host_property(gamma, address(Gamma)),
    facts(N, Listener, Facts),
    traveller(Traveller),
    watcher(Watcher),
    agent_create(clauses(Traveller), T, [host(alpha)|Facts]),
    agent_create(clauses(Watcher), W, [host(alpha)|Facts]),
    agent_create(clauses([ (:- agent(child, [])),
                           (main :- receive(_-end)) ]), M, [host(Beta)]),
    agent_create(clauses([ (:- agent(guest, [])),
                           (main :- receive(_-to(A)), move(A),
                                    receive(_-to(B)), move(B),
                                    receive(_-end)) ]), G, [host(Beta)]),
    agent_send(G, to(Alpha)),
    wait_until(agent_property(G, host(Alpha)), 20),
    error_of(N, Formal),
    assertz(failing(N, Formal)),
    sent(W, watch(M)),
    sent(T, go(Beta)),
    wait_until(fails_if_due, 20),
    sent(G, to(Gamma)),
    wait_until(agent_property(G, host(Gamma)), 20),
    wait_until(\+ typhon_news:pauses(_), 20),
    with_mutex(commit_errors, retract(failing(Left, _))),
    sent(G, end),
    wait_until(got(Listener, back(N)), 30),
    sent(M, end),
    wait_until(got(Listener, down(N)), 30),
    forall(member(Agent, [T, W, M]), agent_join(Agent, done, 30)),
    peer_do(beta, agent_join(G, done, 30)),
    ( Left =:= 0 -> Failed = true ; Failed = false ).

%   A message that raises an error of the journal leaves later.

sent(Id, Message) :-
    catch(agent_send(Id, Message), error(_, _), true).

%   Commits do not fail yet, or are known to fail.

fails_if_due :-
    (   failing(0, _)
    ->  typhon_durable:commit_error(_)
    ;   true
    ).

got(Listener, Message) :-
    arrived(Listener, Arrived),
    memberchk(Message, Arrived).

facts(N, Listener, [facts([n(N), to(Listener)])]).

traveller([ (:- agent(traveller, [state([n/1, to/1])])),
            (main :- receive(_-go(Beta)), go(Beta), to(L), n(N),
                     send(L, there(N)), home(Home), go(Home),
                     send(L, back(N))),
            (go(Host) :- catch(move(Host), error(E, _), true), went(E, Host)),
            (went(E, _) :- var(E), !),
            (went(_, Host) :- sleep(0.01), go(Host)) ]).

watcher([ (:- agent(watcher, [state([n/1, to/1])])),
          (main :- receive(_-watch(M)), monitor(M),
                   receive(system-down(M, done)), to(L), n(N),
                   send(L, down(N))) ]).

:- begin_tests(commit_errors).

test(whichever_commit_fails_everything_arrives_once) :-
    with_failing_commits(each_commit_fails).

:- end_tests(commit_errors).
