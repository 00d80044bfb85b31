:- module(test_journal_guarded, []).

% The journal together with keys, trails and policies.

:- use_module('../../../lib/common').
:- use_module('../../../lib/authority').
:- use_module('../../../lib/peers').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

:- needs([openssl, journal]).

:- meta_predicate with_three(+, 0), with_three(+, 0, +).

%   cell_kind(-Kind): the kinds of cells that this machine can have.

cell_kind(none).
cell_kind(owner) :-
    missing([cells], []).

%   alpha is here; beta and gamma are processes with policies.

with_three(Kind, Goal) :-
    with_authority([alpha, beta, gamma], [], with_three(Kind, Goal)).

with_three(Kind, Goal, Authority) :-
    options(Authority, alpha, [], Alpha),
    options(Authority, beta, [policy(guarded), cell(Kind)], Beta),
    options(Authority, gamma, [policy(guarded), cell(Kind)], Gamma),
    with_peers([beta-[host(Beta)], gamma-[host(Gamma)]],
               setup_call_cleanup(
                   host_start(alpha, Alpha),
                   once(Goal),
                   host_stop(alpha))).

options(Authority, Name, More, [tls(Keys), journal(Journal)|More]) :-
    keys_of(Name, Authority, Keys),
    atom_concat(Keys, '-journal', Journal).

%   The agent moves to the hosts in turn, enters a result and waits at each,
%   and returns home.

tourist(clauses([ (:- agent(tourist, [state([to/1, seen/1])])),
                  (main :- to(_), tour),
                  (tour :- retract(to(Host)), !, move(Host), here(H),
                           assertz(seen(H)), enter(was(H)),
                           receive(_-on), tour),
                  (tour :- home(Home), move(Home)),
                  (on_message(_, _) :- true) ])).

tourist(Agent, Hosts) :-
    tourist(Program),
    findall(to(Host), ( member(Name, Hosts), peer_host(Name, Host) ), Facts),
    agent_create(Program, Agent, [facts(Facts)]).

%   dies(+Peer, +Point): Peer dies at its next step Point, and was restarted.

dies(Peer, Point) :-
    peer_do(Peer, ( current_prolog_flag(pid, Pid),
                    assertz((typhon_durable:reached(Point) :-
                                 process:process_kill(Pid, kill),
                                 thread_get_message(never))) )).

starts_again(Peer) :-
    wait_until(dead(Peer), 20),
    peer_kill(Peer),
    peer_restart(Peer).

dead(Peer) :-
    \+ catch(peer_do(Peer, true), error(_, _), fail).

waits_at(Agent, Peer) :-
    peer_host(Peer, Host),
    stands(Agent, Host, waiting).

stands(Agent, Host, State) :-
    wait_until(catch(( agent_property(Agent, host(Host)),
                       agent_property(Agent, state(State)) ),
                     error(_, _), fail),
               30).

:- begin_tests(journal_guarded).

test(trail_survives_the_death_of_its_hosts, [forall(cell_kind(Kind))]) :-
    no_leaks(with_three(Kind, test_journal_guarded:killed)).
test(agent_that_is_refused_at_restart_stays_in_the_journal) :-
    with_tmp_dir(refused_later).

:- end_tests(journal_guarded).

home_with_whole_trail(Agent) :-
    host_property(alpha, address(Alpha)),
    stands(Agent, Alpha, resident),
    agent_trail(Agent, Trail),
    verdict(Trail, Signed, Verdict),
    assertion(Verdict == whole),
    assertion(Signed == [ alpha-handed, beta-received, beta-entered,
                          beta-handed, gamma-received, gamma-entered,
                          gamma-handed, alpha-received ]),
    agent_property(Agent, facts(Facts)),
    findall(Host, member(seen(Host), Facts), Seen),
    peer_host(beta, Beta),
    peer_host(gamma, Gamma),
    assertion(Seen == [Beta, Gamma]).

%   The process is killed during a hop, and while the agent is there.

killed :-
    dies(beta, before_answer),
    tourist(Agent, [beta, gamma]),
    starts_again(beta),
    waits_at(Agent, beta),
    dies(beta, after_send),
    agent_send(Agent, on),
    starts_again(beta),
    waits_at(Agent, gamma),
    peer_kill(gamma),
    peer_restart(gamma),
    dies(gamma, after_commit),
    agent_send(Agent, on),
    starts_again(gamma),
    home_with_whole_trail(Agent).

%   A policy refuses the agent at first, and admits it later: then it has its
%   program, its messages, and its goals.

refused_later(Dir) :-
    directory_file_path(Dir, journal, Journal),
    directory_file_path(Dir, 'policy.pl', Policy),
    rules(Policy, [allow(variant_sha1/2)]),
    guest(Program),
    with_policy(Policy, Journal,
                ( agent_create(Program, Agent, []),
                  wait_until(agent_property(Agent, state(waiting)), 5),
                  agent_send(Agent, unwanted) )),
    nb_setval(test_guest, Agent),
    rules(Policy, []),
    with_policy(Policy, Journal, \+ agent_property(Agent, host(_))),
    rules(Policy, [allow(variant_sha1/2)]),
    with_policy(Policy, Journal,
                ( agent_send(Agent, go),
                  agent_result(Agent, Result, 5) )),
    variant_sha1(x, Hash),
    assertion(Result == [unwanted, Hash]).

guest(clauses([ (:- agent(guest, [])),
                (main :- receive(_-go), variant_sha1(x, Hash),
                         receive(_-Other), result([Other, Hash])) ])).

rules(File, Rules) :-
    setup_call_cleanup(open(File, write, Out),
                       forall(member(Rule, Rules), portray_clause(Out, Rule)),
                       close(Out)).

:- meta_predicate with_policy(+, +, 0).

with_policy(Policy, Journal, Goal) :-
    setup_call_cleanup(
        host_start(alpha, [policy(Policy), cell(none), journal(Journal)]),
        once(Goal),
        host_stop(alpha)).
