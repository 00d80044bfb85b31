:- module(test_host, []).
:- use_module(library(plunit)).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(socket)).
:- use_module(library(thread)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/own_thread),
              [in_own_thread/1, own_thread_start/0, own_thread_stop/0]).
:- use_module(library(typhon/kernel/host), [place_deliver/3]).

/** <module> Tests of hosts: places, admission, and cleanup

Modules that serve as services and places are made by the tests.
*/

stays(Clauses, Agent) :-
    create([on_message(_, _)|Clauses], Agent),
    wait_state(Agent, resident).

%   lives(+Hosts, +Clauses, -Facts): the final state of an agent of Clauses.

lives(Hosts, Clauses, Facts) :-
    with_hosts(Hosts, ( stays(Clauses, Agent), facts(Agent, Facts) )).

%   hold(+N, -Agents): N agents that hold their worker until go_on/1.

hold(N, Agents) :-
    findall(A, ( between(1, N, _),
                 create([(main :- test_host:in_turn)], A) ),
            Agents).

in_turn :-
    thread_send_message(here, here),
    thread_get_message(go, go).

%   began(+N): so many more agents have a turn, and no others.

began(N) :-
    forall(between(1, N, _),
           thread_get_message(here, here, [timeout(10)])),
    \+ thread_get_message(here, here, [timeout(0.05)]).

go_on(Agents) :-
    forall(member(_, Agents), thread_send_message(go, go)),
    forall(member(A, Agents), joined(A, done)).

:- meta_predicate with_queues(0).

with_queues(Goal) :-
    setup_call_cleanup(
        ( message_queue_create(_, [alias(here)]),
          message_queue_create(_, [alias(go)]) ),
        once(Goal),
        ( message_queue_destroy(here), message_queue_destroy(go) )).

:- begin_tests(host_options).

test(loopback_by_default, true(sub_atom(A, 0, _, _, 'alpha@127.0.0.1:'))) :-
    with_hosts([alpha], address(alpha, A)).
test(port, true(P2 == P1)) :-
    free_port(P1),
    with_hosts([alpha-[port(P1)]], port(alpha, P2)).

port(Host, Port) :-
    address(Host, Address),
    atomic_list_concat([_,P], :, Address),
    atom_number(P, Port).

listened_to(Port) :-
    catch(setup_call_cleanup(tcp_connect('127.0.0.1':Port, S, []),
                             true,
                             close(S)),
          error(socket_error(econnrefused, _), _), fail).

%   with_another(+Options, :Goal): beta runs, too, with these options.

:- meta_predicate with_another(+, 0).

with_another(Options, Goal) :-
    setup_call_cleanup(host_start(beta, Options), once(Goal), host_stop(beta)).

test(same_port_again, true(P1 == P2)) :-
    with_hosts([alpha],
               ( port(alpha, P1),
                 with_another([port(P1), bind('127.0.0.1')],
                              port(beta, P2)) )).
test(own_port, true([P2,Q] == [P,P])) :-
    free_port(P),
    with_hosts([alpha],
               with_another([port(P)], ( port(beta, P2),
                                         \+ port(alpha, P),
                                         host_start(gamma, [port(P)]),
                                         port(gamma, Q),
                                         host_stop(gamma),
                                         listened_to(P) ))),
    \+ listened_to(P).
test(own_port_is_reused_at_once) :-
    free_port(P),
    with_hosts([alpha],
               forall(between(1, 3, _),
                      with_another([port(P)], listened_to(P)))).
test(port_in_use, [ forall(member(Hosts, [[],[alpha]])),
                    true(sub_atom(Advice, _, _, _, 'port(0)')) ]) :-
    with_hosts(Hosts,
               setup_call_cleanup(
                   ( tcp_socket(S), tcp_bind(S, '127.0.0.1':P),
                     tcp_listen(S, 5) ),
                   catch(host_start(beta, [port(P)]),
                         error(socket_error(eaddrinuse, _),
                               context(_, Advice)), true),
                   tcp_close_socket(S))).
test(agents_hop_between_ports_of_a_process, true(O-Hops == done-2)) :-
    free_port(P),
    with_hosts([alpha, beta-[port(P)]],
               ( address(beta, B),
                 create([(main :- move(B), move(alpha), hops(N), leave(n(N)))],
                        A),
                 joined(A, O),
                 remote(alpha, sense(n(Hops))) )).

invalid_start(alpha, [O], type_error(_, _)) :-
    member(O, [ port(x), capacity(-1), capacity(many), tokens(t),
                concurrency(0), log(1), log('events.pl'),
                log('events.pl', [hops]), remote(maybe), clock(0, x),
                hop_time(uniform(a, b)), seed(x), bind(1) ]).
invalid_start(alpha, [O], existence_error(_, _)) :-
    member(O, [ consult(no_such_file_anywhere),
                services([library(no_such_service)]) ]).
invalid_start(alpha, [colour(red)], domain_error(host_option, colour(red))).
invalid_start(alpha, [clock(0, 0)], domain_error(clock_rate, 0)).
invalid_start(Name, [], domain_error(host_name, Name)) :-
    member(Name, ['a@b', '']).
invalid_start(_, [], instantiation_error).

test(invalid_start_leaves_nothing,
     [ forall(invalid_start(Name, Options, Error)), error(Error) ]) :-
    no_leaks(host_start(Name, Options)).
test(second_start, [ forall(member(Name-Options-Error,
                                   [ alpha-[]
                                     -permission_error(start, host, alpha),
                                     beta-[bind('127.0.0')]
                                     -permission_error(change, endpoint, _),
                                     beta-[bind('127.0.0.10')]
                                     -permission_error(change, endpoint, _)
                                   ])),
                     error(Error) ]) :-
    with_hosts([alpha], host_start(Name, Options)).
test(started_after_a_failed_start) :-
    catch(host_start(alpha, [consult(no_such_file_anywhere)]),
          error(existence_error(_, _), _), true),
    with_hosts([alpha], true).
test(stop_of_a_missing_host, error(existence_error(host, alpha))) :-
    host_stop(alpha).
test(stop_by_address) :-
    with_hosts([alpha], ( address(alpha, A), host_stop(A) )).
test(start_and_stop_in_several_threads) :-
    numlist(1, 8, Is),
    no_leaks(concurrent_maplist(plunit_host_options:churn, Is)).

churn(I) :-
    atom_concat(host, I, Name),
    forall(between(1, 10, _), ( host_start(Name), host_stop(Name) )).

:- end_tests(host_options).

:- begin_tests(host_property).

test(all, true(Ps == [ address(A), capacity(7), load(1), neighbours([B]),
                       state(running), hop_time(in, S) ])) :-
    S = stats(0, 0.0, 0.0, 0.0),
    with_hosts([alpha-[capacity(7)],beta],
               ( address(alpha, A), address(beta, B),
                 link(alpha, beta),
                 stays([], _),
                 findall(P, ( host_property(alpha, P),
                              P \= place(_), P \= hop_time(out, _) ), Ps0),
                 sort(Ps0, Ps) )).
test(by_address, true(S == running)) :-
    with_hosts([alpha], ( address(alpha, A), host_property(A, state(S)) )).
test(all_hosts, [ forall(member(Hosts, [[], [alpha,beta,gamma]])),
                  true(Hs == Hosts) ]) :-
    reverse(Hosts, Started),
    with_hosts(Started, findall(H, host_property(H, state(running)), Hs0)),
    sort(Hs0, Hs).
test(unknown, error(existence_error(host, nowhere))) :-
    with_hosts([alpha], host_property(nowhere, load(_))).
test(properties_are_deterministic,
     [ forall(member(P, [ address(_), state(_), capacity(_), load(_),
                          neighbours(_), place(_), hop_time(in, _),
                          hop_time(out, _) ])),
       true(Det == true) ]) :-
    with_hosts([alpha],
               call_cleanup(host_property(alpha, P), Det = true)).
test(hop_times, true((C == 3, Min =< Mean, Mean =< Max, Min > 0))) :-
    with_hosts([alpha,beta],
               ( create([(main :- move(beta), move(alpha), move(beta),
                                  move(alpha), move(beta))], A),
                 joined(A, done),
                 wait_until(host_property(alpha, hop_time(out, stats(3,_,_,_))),
                            5),
                 host_property(beta, hop_time(in, stats(C,Min,Mean,Max))) )).

:- end_tests(host_property).

:- begin_tests(host_change).

%   visits(+Token, -Outcome): done, or why beta refused the agent.

visits(Token, Outcome) :-
    create([(main :- catch(move(beta), error(move_refused(_, Why), _), true),
                     note(Why)),
            (note(Why) :- var(Why)),
            (note(Why) :- nonvar(Why), leave(refused(Why)))],
           A, [tokens([Token])]),
    joined(A, done),
    (   remote(alpha, take(refused(Why)))
    ->  Outcome = Why
    ;   Outcome = done
    ).

%   admits(-Options, -Change, -Before, -After): outcomes of visits with token 7.

admits([], tokens([8]), done, token).
admits([], tokens([7]), done, done).
admits([tokens([8])], tokens([]), token, done).
admits([], capacity(0), done, capacity).
admits([capacity(0)], capacity(3), capacity, done).

test(admission_can_be_changed,
     [ forall(admits(Options, Change, Before, After)),
       true([O1,O2] == [Before,After]) ]) :-
    with_hosts([alpha,beta-Options],
               ( visits(7, O1), host_change(beta, Change), visits(7, O2) )).
test(changed_property, true(C == 3)) :-
    with_hosts([alpha], ( host_change(alpha, capacity(3)),
                          host_property(alpha, capacity(C)) )).
test(concurrency_can_be_raised) :-
    with_queues(with_hosts([alpha-[concurrency(1)]],
                           ( hold(6, Agents),
                             began(1),
                             host_change(alpha, concurrency(3)),
                             began(2),
                             host_change(alpha, concurrency(inf)),
                             began(3),
                             go_on(Agents) ))).
test(concurrency_can_be_lowered) :-
    with_queues(with_hosts([alpha-[concurrency(3)]],
                           ( hold(6, Agents),
                             began(3),
                             host_change(alpha, concurrency(1)),
                             thread_send_message(go, go),
                             thread_send_message(go, go),
                             began(0),
                             thread_send_message(go, go),
                             began(1),
                             Agents = [_,_,_|Rest],
                             go_on(Rest),
                             maplist([A]>>joined(A, done), Agents) ))).
test(services, F == [s(12)]) :-
    with_hosts([alpha],
               ( host_change(alpha, services(library(dcg/basics))),
                 stays([(main :- phrase(integer(X), `12`), assertz(s(X)))], A),
                 facts(A, F) )).

invalid_change(alpha, colour(red), domain_error(host_option, colour(red))).
invalid_change(alpha, capacity(-1), type_error(_, -1)).
invalid_change(alpha, O, permission_error(change, host_option, O)) :-
    member(O, [port(1), place(user), clock(virtual)]).
invalid_change(nowhere, capacity(1), existence_error(host, nowhere)).

test(invalid_change, [ forall(invalid_change(Host, Option, Error)),
                       error(Error) ]) :-
    with_hosts([alpha], host_change(Host, Option)).

:- end_tests(host_change).

:- begin_tests(links).

%   neighbours(-Goal, -OfAlpha, -OfBeta): after Goal.

neighbours(link(alpha, beta), [beta], [alpha]).
neighbours(( address(beta, B), link(alpha, B) ), [beta], [alpha]).
neighbours(( link(alpha, beta), link(beta, alpha), link(alpha, beta) ),
           [beta], [alpha]).
neighbours(( link(alpha, beta), unlink(beta, alpha), unlink(alpha, beta) ),
           [], []).

test(neighbours, [ forall(neighbours(Goal, As, Bs)),
                   true([A,B] == [As,Bs]) ]) :-
    with_hosts([alpha,beta],
               ( Goal, maplist(neighbours_of, [alpha,beta], [A,B]) )).
test(stopped_hosts_are_no_neighbours, true(A == [])) :-
    with_hosts([alpha,beta],
               ( link(alpha, beta), host_stop(beta), neighbours_of(alpha, A) )).

neighbours_of(Host, Names) :-
    host_property(Host, neighbours(Addresses)),
    findall(Name, ( member(Address, Addresses),
                    host_property(Name, address(Address)) ), Names).

test(invalid_link, [ forall(member(H-Error,
                                   [ alpha-domain_error(other_host, alpha),
                                     nowhere-existence_error(host, nowhere) ])),
                     error(Error) ]) :-
    with_hosts([alpha], link(alpha, H)).
test(links_made_by_many_threads, true(L == 8)) :-
    findall(H, ( between(1, 8, I), atom_concat(h, I, H) ), Hs),
    with_hosts([hub|Hs],
               ( concurrent_maplist([H]>>forall(between(1, 20, _),
                                                link(hub, H)), Hs),
                 host_property(hub, neighbours(Ns)), length(Ns, L) )).

:- end_tests(links).

:- begin_tests(admission).

try(Tokens, Result) :-
    catch(( create([on_message(_, _)], _, [tokens(Tokens)]), Result = ok ),
          error(move_refused(_, Result), _), true).

tries(N, Results) :-
    findall(R, ( between(1, N, _), try([], R) ), Results).

test(capacity_is_never_exceeded, true(Ok-Refused-L == 10-70-10)) :-
    with_hosts([alpha-[capacity(10)]],
               ( concurrent_maplist(plunit_admission:tries,
                                    [10,10,10,10,10,10,10,10], Rss),
                 append(Rss, Rs),
                 aggregate_all(count, member(ok, Rs), Ok),
                 aggregate_all(count, member(capacity, Rs), Refused),
                 host_property(alpha, load(L)) )).
test(capacity_is_freed, [R1,R2] == [capacity,ok]) :-
    with_hosts([alpha-[capacity(1)]],
               ( stays([], A),
                 try([], R1),
                 agent_dispose(A),
                 wait_until(host_property(alpha, load(0)), 5),
                 try([], R2) )).
test(agents_queue_at_a_small_host) :-
    with_hosts([alpha,beta-[capacity(1)]],
               ( findall(A, ( between(1, 5, _),
                              create([(main :- catch(move(beta), error(E, _),
                                                     again(E)),
                                               move(alpha)),
                                      (again(move_refused(_, capacity)) :-
                                           sleep(0.005), main)], A) ),
                         As),
                 forall(member(A, As), joined(A, done)),
                 host_property(beta, hop_time(in, stats(5,_,_,_))) )).
test(tokens, true(Rs == [ok,ok,ok,token,token])) :-
    with_hosts([alpha-[tokens([red,blue,key(1)])]],
               maplist(plunit_admission:try,
                       [[red], [green,blue], [key(1)], [green,key(2)], []],
                       Rs)).

:- end_tests(admission).

:- begin_tests(concurrency).

%   Agents that work without stopping, and record the times.

intervals(Options, Intervals) :-
    with_hosts([alpha-Options],
               ( findall(A, ( between(1, 6, _),
                              create([(main :- now(T0), work(20 000), now(T1),
                                               leave(interval(T0, T1)),
                                               sleep(0.001),
                                               now(T2), work(20 000), now(T3),
                                               leave(interval(T2, T3))),
                                      (work(N) :- N =< 0, !),
                                      (work(N) :- N1 is N-1, work(N1))], A) ),
                         As),
                 forall(member(A, As), joined(A, done)),
                 remote(alpha, findall(T-U, sense(interval(T, U)), Is)),
                 sort(Is, Intervals) )).

overlap(Intervals) :-
    nextto(_-U, T-_, Intervals),
    T < U,
    !.

test(one_agent_at_a_time, true((\+ overlap(Is), length(Is, 12)))) :-
    intervals([concurrency(1)], Is).
test(blocking_goals_overlap_up_to_the_limit,
     [ forall(member(Options-N, [ []-8, [concurrency(1)]-1,
                                  [concurrency(2)]-2 ])) ]) :-
    with_queues(with_hosts([alpha-Options], ( hold(8, Agents),
                                              began(N),
                                              go_on(Agents) ))).
test(limited_host_does_not_delay_others, O == done) :-
    with_hosts([alpha-[concurrency(1)],beta],
               ( create([(main :- take(stop), !), (main :- main)], Busy),
                 create([main], A, [host(beta)]),
                 joined(A, O),
                 remote(alpha, leave(stop)),
                 joined(Busy, done) )).
test(waiting_agents_do_not_count, O == done) :-
    with_hosts([alpha-[concurrency(1)]],
               ( stays([], _),
                 create([(main :- receive(_))], W),
                 wait_state(W, waiting),
                 create([(main :- sleep(1000))], S),
                 wait_state(S, sleeping),
                 create([main], A),
                 joined(A, O) )).
test(arrivals_from_a_host_without_limit_wait) :-
    with_queues(with_hosts([alpha-[concurrency(1)],beta],
                           ( hold(1, Agents),
                             began(1),
                             create([(main :- receive(_), move(alpha),
                                              test_host:in_turn)],
                                    A, [host(beta)]),
                             agent_send(A, go),
                             wait_until(agent_property(A, host(alpha)), 10),
                             began(0),
                             go_on([A|Agents]) ))).
test(faulty_agent_frees_its_turn, O == done) :-
    with_hosts([alpha-[concurrency(1)]],
               ( create([(main :- throw(x))], A0),
                 capturing(joined(A0, raised(x)), _),
                 create([main], A1), joined(A1, O) )).

:- end_tests(concurrency).

:- begin_tests(places).

%   consults(-Behaviour, -Lines, -Clauses, -Facts): Facts are the final state of
%   an agent of Clauses on alpha, whose place consults a file of Lines.

consults(facts, ['height(1).', 'height(2).'],
         [(main :- forall(height(X), assertz(s(X))))], [s(1),s(2)]).
consults(vocabulary, ['busy :- host_load(N), N > 0.'],
         [(main :- busy, assertz(s(1)))], [s(1)]).
consults(elsewhere_it_is_invisible, ['height(1).'],
         [(main :- height(_), move(beta),
                   catch(height(_), error(E, _), assertz(s(E))))],
         [s(existence_error(procedure, _))]).
consults(the_agent_comes_first, ['height(theirs).'],
         [height(mine), (main :- forall(height(X), assertz(s(X))))],
         [s(mine)]).

:- meta_predicate in_file(+, -, 0).

in_file(Lines, File, Goal) :-
    with_tmp_dir(Dir, ( directory_file_path(Dir, 'facts.pl', File),
                        atomic_list_concat(Lines, '\n', Text),
                        write_file(File, '~w~n', [Text]),
                        call(Goal) )).

test(consult, [ forall(consults(_, Lines, Clauses, Facts)),
                true(subsumes_term(Facts, F)) ]) :-
    in_file(Lines, File, lives([alpha-[consult([File])],beta], Clauses, F)).
test(each_host_has_its_own_place, F == [s(1),s(2)]) :-
    in_file([':- dynamic count/1.', 'count(0).'], File,
            with_hosts([alpha-[consult(File)],beta-[consult(File)]],
                       ( forall(member(H-N, [alpha-1,beta-2]),
                                remote(H, ( retract(count(_)),
                                            assertz(count(N)) ))),
                         stays([(main :- count(X), assertz(s(X)), move(beta),
                                         count(Y), assertz(s(Y)))], A),
                         facts(A, F) ))).

%   offers(-Option, -Goal, -Facts): of an agent that notes X of Goal, on a host
%   with Option. The module has the exported answer/1 and hidden/1.

offers(services(test_place), answer(X), X, [s(42)]).
offers(services([test_place]), hidden(X), X,
       [s(existence_error(procedure, _))]).
offers(services([library(dcg/basics)]), phrase(integer(X), `12`), X, [s(12)]).
offers(place(test_place), hidden(X), X, [s(1)]).

test(offers, [ forall(offers(Option, Goal, X, Facts)),
               setup(offered(answer(42), hidden(1))),
               true(( subsumes_term(Facts, F),
                      call(test_place:hidden(1)) )) ]) :-
    lives([alpha-[Option]],
          [(main :- catch(( Goal, Y = X ), error(Y, _), true), assertz(s(Y)))],
          F).

offered(Exported, Hidden) :-
    forall(member(Fact, [Exported,Hidden]),
           ( retractall(test_place:Fact), assertz(test_place:Fact) )),
    functor(Exported, Name, Arity),
    test_place:export(test_place:Name/Arity).

test(refused_payload_changes_nothing,
     true(Ps-Es == [1]-[permission_error(modify, static_procedure, write/1),
                        type_error(callable, 1)])) :-
    with_place(P, ( place_deliver(P, payload(x, [p/1], [p(1)]), _),
                    findall(E, ( bad_payload(New),
                                 catch(place_deliver(P, New, _),
                                       error(E, _), true) ), Es),
                    findall(X, P:p(X), Ps),
                    \+ catch(P:r(_), error(existence_error(_, _), _),
                             fail) )).
test(payload_is_replaced_atomically, true(S == true)) :-
    with_place(P, ( place_deliver(P, payload(x, [p/1, q/0], [p(0), q]), _),
                    thread_create(test_host:reads_some(P, 0, 0), T),
                    forall(between(1, 5000, I),
                           place_deliver(P, payload(x, [p/1], [p(I)]), _)),
                    thread_send_message(T, stop),
                    thread_join(T, S),
                    catch(P:q, error(existence_error(_, _), _), true) )).

bad_payload(payload(x, [p/1,write/1], [p(2),write(2)])).
bad_payload(payload(x, [p/1,r/1], [p(2),(r(1) :- 1)])).

:- meta_predicate with_place(-, 0).

with_place(Place, Goal) :-
    with_hosts([alpha], ( host_property(alpha, place(Place)), Goal )).

:- end_tests(places).

%   reads_some(+Place, +Reads, +Empty): once in some hundred thousand reads
%   9.0.4 overlooks a clause that is about to be collected.

reads_some(Place, Reads0, Empty0) :-
    Reads is Reads0+1,
    (   Place:p(_)
    ->  Empty = Empty0
    ;   Empty is Empty0+1
    ),
    (   thread_peek_message(stop)
    ->  Empty < 5+Reads/50 000
    ;   reads_some(Place, Reads, Empty)
    ).

:- begin_tests(tuple_space).

%   tuples(-Behaviour, -Main, -Facts): of an agent with this body of main/0.

tuples(leave_sense_take,
       ( leave(p(1)), leave(p(2)), findall(X, sense(p(X)), L), assertz(s(L)),
         take(p(A)), assertz(s(A)), take(p(B)), assertz(s(B)),
         ( take(p(_)) -> true ; assertz(s(none)) ) ),
       [s([1,2]),s(1),s(2),s(none)]).
tuples(tuple_stays_on_its_host,
       ( leave(p(1)), move(beta),
         ( sense(p(_)) -> true ; assertz(s(none)) ) ), [s(none)]).
tuples(empty_tuple_space, ( sense(_) -> true ; assertz(s(none)) ), [s(none)]).
tuples(terms_that_cannot_be_left,
       ( current_output(S),
         catch(leave(p(S)), error(E, _), assertz(s(E))),
         catch(leave(_), error(E2, _), assertz(s(E2))) ),
       [s(type_error(mobile_term, _)),s(instantiation_error)]).

test(tuples, [ forall(tuples(_, Main, Facts)),
               true(subsumes_term(Facts, F)) ]) :-
    lives([alpha,beta], [(main :- Main)], F).
test(fifty_agents_contend, true(Taken-Left == 1000-[])) :-
    with_hosts([alpha],
               ( remote(alpha, forall(between(1, 1000, I), leave(coin(I)))),
                 findall(A, ( between(1, 50, _),
                              create([on_message(_, _),
                                      (main :- receive(_-go), collect),
                                      (collect :- take(coin(X)), !,
                                                  assertz(s(X)), collect),
                                      collect], A) ), As),
                 forall(member(A, As), wait_state(A, waiting)),
                 forall(member(A, As), agent_send(A, go)),
                 forall(member(A, As), wait_state(A, resident)),
                 findall(X, ( member(A, As), fact_of(A, s(X)) ), Xs),
                 sort(Xs, Set),
                 length(Xs, Taken),
                 assertion(length(Set, Taken)),
                 remote(alpha, findall(X, sense(coin(X)), Left)) )).
test(one_token_for_fifty_agents, true(N == 1000)) :-
    with_hosts([alpha],
               ( remote(alpha, ( leave(token), leave(count(0)) )),
                 findall(A, ( between(1, 50, _),
                              create([(main :- turn(20)),
                                      (turn(0) :- !),
                                      (turn(K) :- ( take(token)
                                                  -> take(count(C)),
                                                     C1 is C+1,
                                                     leave(count(C1)),
                                                     leave(token),
                                                     K1 is K-1
                                                  ;  sleep(0.001), K1 = K ),
                                                  turn(K1))], A) ), As),
                 maplist(joined, As, _),
                 remote(alpha, sense(count(N))) )).

:- end_tests(tuple_space).

:- begin_tests(host_clock).

test(time_of_day_by_default, true(abs(T-Now) < 5)) :-
    with_hosts([alpha], ( remote(alpha, now(T)), get_time(Now) )).
test(hosts_share_epoch_and_rate,
     true(( A >= 0, D >= 10, D < 1000, abs(A-B) < 500 ))) :-
    get_time(Now),
    with_hosts([alpha-[clock(Now, 100)],beta-[clock(Now, 100)]],
               ( remote(alpha, now(A)), remote(beta, now(B)),
                 create([(main :- sleep(10))], Agent), joined(Agent, done),
                 remote(alpha, now(T1)), D is T1-A )).

%   Counted twice, the clock rate would give a hundred times the hop time.

test(hop_time_in_host_seconds, true((Min >= 5.0, Max < 490))) :-
    get_time(Now),
    O = [clock(Now, 100),hop_time(uniform(5, 6))],
    with_hosts([alpha-O,beta-O],
               ( create([(main :- move(beta), move(alpha))], A),
                 joined(A, done),
                 host_property(beta, hop_time(in, stats(1,Min,_,Max))) )).

:- end_tests(host_clock).

                /*******************************
                *        START AND STOP        *
                *******************************/

%   Walkers that were in flight when n1 got the order to stop.

ended_elsewhere(Elsewhere, Dir) :-
    atom_concat(Dir, '/events.pl', Log),
    setup_call_cleanup(
        network_start(ring(3), Network, [log(Log)]),
        ( network_property(Network, hosts(Hosts)),
          forall(between(1, 300, _), walker(Hosts)),
          host_stop(n1),
          wait_until(all_logged(Network, Log, Events), 20) ),
        network_stop(Network)),
    findall(At, ( member(event(_, At, _, ended(_)), Events),
                  \+ sub_atom(At, 0, _, _, 'n1@') ), Elsewhere).

%   Agents that have not ended still walk.

all_logged(Network, Log, Events) :-
    network_property(Network, agents(Left)),
    length(Left, Walking),
    Ended is 300-Walking,
    log_events(Log, Events),
    aggregate_all(count, member(event(_, _, _, ended(_)), Events), Ended).

walker([Home|_]) :-
    agent_create(clauses([ (:- agent(walker)),
                           (main :- go(n2), go(n3), go(n1), main),
                           (go(H) :- catch(move(H), error(_, _), true)) ]), _,
                 [host(Home)]).

%   The state of an agent when its wait deadline is computed: once the agent
%   rests, a stop of its host may go unnoticed.

asked_in(Caller, Goal) :-
    findall(State, agent_property(_, state(State)), States),
    thread_send_message(Caller, asked_in(States)),
    call(Goal).

:- begin_tests(stopping).

test(three_hundred_starts_and_stops, true((T1 == T0, Q1 == Q0, M1 =< M0+2))) :-
    with_hosts([alpha], true),
    footprint(T0, Q0, M0, F0),
    forall(between(1, 300, _), ( host_start(alpha), host_stop(alpha) )),
    garbage_collect_clauses,
    garbage_collect_atoms,
    footprint(T1, Q1, M1, F1),
    assertion(F1 =< F0+2).

footprint(Threads, Queues, Modules, Files) :-
    aggregate_all(count, thread_property(_, status(_)), Threads),
    garbage_collect_clauses,
    garbage_collect_atoms,
    aggregate_all(count, message_queue_property(_, size(_)), Queues),
    aggregate_all(count, current_module(_), Modules),
    (   exists_directory('/proc/self/fd')
    ->  directory_files('/proc/self/fd', Fds),
        length(Fds, Files)
    ;   Files = 0
    ).

%   The threads get the order to end before they have started.

test(helper_threads_of_a_stop_have_ended, true(Threads == Before)) :-
    footprint(Before, _, _, _),
    forall(between(1, 300, _), ( own_thread_start, own_thread_stop )),
    aggregate_all(count, thread_property(_, status(_)), Threads).
test(a_thousand_residents) :-
    with_hosts([alpha],
               ( findall(A, ( between(1, 1000, _),
                              create([on_message(_, _)], A) ), As),
                 host_stop(alpha) )),
    forall(member(A, As), joined(A, disposed)).
test(agent_that_has_left_continues, true(Elsewhere == [])) :-
    with_tmp_dir(test_host:ended_elsewhere(Elsewhere)).
test(one_of_two_hosts, true(S == resident)) :-
    with_hosts([alpha,beta],
               ( create([on_message(_, _)], A, [host(beta)]),
                 stays([], _),
                 host_stop(alpha),
                 agent_property(A, state(S)) )).
test(with_every_kind_of_agent) :-
    with_hosts([alpha-[hop_time(uniform(1000, 1001))],beta],
               capturing(( stays([], _),
                           create([(main :- sleep(1000))], S),
                           create([(main :- receive(_))], W),
                           create([(main :- move(beta))], T),
                           create([(main :- throw(x))], F),
                           wait_state(S, sleeping),
                           wait_state(W, waiting),
                           wait_state(T, in_transit),
                           wait_state(F, faulty(_)),
                           host_stop(alpha) ), _)).

%   Agents that reach no effect are interrupted, here after a short time.

:- meta_predicate impatient(0).

impatient(Goal) :-
    with_settings([typhon_hosting:stop_seconds=0.2], Goal).

stubborn([(main :- main)]).
stubborn([(main :- between(1, inf, _), fail)]).
stubborn([(main :- catch(repeat, _, true), fail)]).
stubborn([(main :- catch(loop, _, true), main), (loop :- repeat, fail)]).
stubborn([(main :- message_queue_create(Q),
                   call_cleanup(thread_get_message(Q, _),
                                message_queue_destroy(Q)))]).
stubborn([(main :- thread_self(Me),
                   thread_get_message(Me, never, [timeout(1000)]))]).

%   stopped(+Options, +Clauses, -Outcome): of an agent that runs when its host
%   is stopped.

stopped(Options, Clauses, Outcome) :-
    impatient(with_hosts([alpha-Options],
                         ( create(Clauses, A),
                           wait_state(A, running),
                           host_stop(alpha),
                           joined(A, Outcome) ))).

test(stubborn, [ forall(( stubborn(Clauses),
                          member(Options, [[], [concurrency(1)]]) )),
                 O == disposed ]) :-
    stopped(Options, Clauses, O).
test(agent_has_ended_when_its_host_has_stopped, O == disposed) :-
    setup_call_cleanup(
        wrap_predicate(typhon_hosts:host_uncount(_), slow, Left,
                       ( sleep(0.4), Left )),
        stopped([], [(main :- between(1, inf, _), fail)], O),
        unwrap_predicate(typhon_hosts:host_uncount/1, slow)).
test(deadline_is_set_before_the_agent_rests,
     [ forall(member(Wait, [sleep(60), receive(_, 60), move(beta)])),
       States == [running] ]) :-
    thread_self(Me),
    setup_call_cleanup(
        wrap_predicate(typhon_time:real_time(_, _, _), seen, Until,
                       test_host:asked_in(Me, Until)),
        with_hosts([alpha-[hop_time(uniform(60, 60))], beta],
                   ( create([(main :- Wait)], _),
                     thread_get_message(Me, asked_in(States), [timeout(30)]) )),
        unwrap_predicate(typhon_time:real_time/3, seen)).
test(stubborn_reader, O == disposed) :-
    setup_call_cleanup(
        ( tcp_socket(L), tcp_bind(L, localhost:P), tcp_listen(L, 5),
          tcp_connect(localhost:P, Out, []),
          tcp_accept(L, C, _), tcp_open_socket(C, In),
          assertz(test_place_pipe:typhon_test_pipe(In)) ),
        stopped([place(test_place_pipe)],
                [(main :- typhon_test_pipe(In1), read(In1, _))], O),
        ( retractall(test_place_pipe:typhon_test_pipe(_)),
          close(In), close(Out), tcp_close_socket(L) )).
test(stubborn_agent_and_one_without_a_turn, true(Os == [disposed,disposed])) :-
    impatient(with_hosts(
                  [alpha-[concurrency(1)]],
                  ( findall(A, ( member(_, [a,b]),
                                 create([(main :- main)], A) ), As),
                    host_stop(alpha),
                    maplist(joined, As, Os) ))).
test(others_go_on_when_one_host_is_stopped, O == done) :-
    impatient(with_hosts([alpha,beta],
               ( create([(main :- receive(_), work(1 000 000)),
                         (work(N) :- N =< 0, !),
                         (work(N) :- N1 is N-1, work(N1))], A, [host(beta)]),
                 create([(main :- main)], B),
                 wait_state(B, running),
                 agent_send(A, go),
                 host_stop(alpha),
                 joined(A, O) ))).
test(agents_in_flight_are_not_harmed) :-
    with_hosts([alpha,beta],
               forall(between(1, 20, _),
                      ( create([(main :- move(beta), receive(_-go))], A),
                        wait_until(( agent_property(A, host(H)),
                                     sub_atom(H, 0, _, _, beta) ), 5),
                        host_stop(alpha),
                        agent_send(A, go),
                        joined(A, O),
                        assertion(O == done),
                        host_start(alpha) ))).
test(stop_while_agents_come_and_go) :-
    with_hosts([beta],
               forall(between(1, 10, _),
                      ( host_start(alpha),
                        findall(A, ( between(1, 10, _),
                                     create([(main :- catch(hop, _, true),
                                                      main),
                                             (hop :- move(beta), move(alpha))],
                                            A, [host(alpha)]) ), As),
                        capturing(host_stop(alpha), _),
                        forall(member(A, As),
                               catch(agent_dispose(A),
                                     error(existence_error(_, _), _), true)),
                        maplist(joined, As, _) ))).
test(every_thread_has_a_name) :-
    with_hosts([alpha], in_own_thread(\+ nameless(_))).

nameless(Thread) :-
    thread_property(Thread, status(_)),
    catch(\+ thread_property(Thread, alias(_)),
          error(existence_error(thread, _), _), fail).

:- end_tests(stopping).
