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
:- use_module(library(settings)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/own_thread),
              [in_own_thread/1, own_thread_start/0, own_thread_stop/0]).
:- use_module(library(typhon/kernel/host), [place_deliver/3]).

/** <module> Tests of hosts: places, admission, and cleanup

Modules that serve as services and places are made by the tests.
*/

%   in_tmp_file(+Lines, :Goal): Goal(File) for a file of these lines.

:- meta_predicate in_tmp_file(+, 1).

in_tmp_file(Lines, Goal) :-
    with_tmp_dir(test_host:in_dir(Lines, Goal)).

in_dir(Lines, Goal, Dir) :-
    directory_file_path(Dir, 'facts.pl', File),
    atomic_list_concat(Lines, '\n', Text),
    write_file(File, '~w~n', [Text]),
    call(Goal, File).

stays(Clauses, Agent) :-
    create([on_message(_, _)|Clauses], Agent),
    wait_state(Agent, resident).

:- begin_tests(host_options).

test(address, true(A == Whole)) :-
    with_hosts([alpha],
               ( address(alpha, A),
                 typhon_endpoint:endpoint_address(E),
                 atomic_list_concat([alpha,@,E], Whole) )).
test(loopback_by_default, true(sub_atom(A, _, _, _, '@127.0.0.1:'))) :-
    with_hosts([alpha], address(alpha, A)).
test(port, true(P2 == P1)) :-
    free_port(P1),
    with_hosts([alpha-[port(P1)]], port(P2)).

port(Port) :-
    address(alpha, A),
    atomic_list_concat([_,P], :, A),
    atom_number(P, Port).

port_of(Host, Port) :-
    address(Host, Address),
    atomic_list_concat([_,P], :, Address),
    atom_number(P, Port).

listened_to(Port) :-
    catch(setup_call_cleanup(tcp_connect('127.0.0.1':Port, S, []),
                             true,
                             close(S)),
          error(socket_error(econnrefused, _), _), fail).

test(same_port_again, true(P1 == P2)) :-
    with_hosts([alpha],
               ( port(P1),
                 setup_call_cleanup(host_start(beta, [port(P1)]),
                                    address(beta, B),
                                    host_stop(beta)),
                 atomic_list_concat([_,P], :, B), atom_number(P, P2) )).
test(own_port, true([P2,Q] == [P,P])) :-
    free_port(P),
    with_hosts([alpha],
               setup_call_cleanup(host_start(beta, [port(P)]),
                                  ( port_of(beta, P2),
                                    \+ port_of(alpha, P),
                                    host_start(gamma, [port(P)]),
                                    port_of(gamma, Q),
                                    host_stop(gamma),
                                    listened_to(P) ),
                                  host_stop(beta))),
    \+ listened_to(P).
test(own_port_is_reused_at_once) :-
    free_port(P),
    with_hosts([alpha],
               forall(between(1, 3, _),
                      ( host_start(beta, [port(P)]),
                        listened_to(P),
                        host_stop(beta) ))).
test(own_port_in_use, error(socket_error(eaddrinuse, _))) :-
    with_hosts([alpha],
               setup_call_cleanup(
                   ( tcp_socket(S), tcp_bind(S, '127.0.0.1':P),
                     tcp_listen(S, 5) ),
                   host_start(beta, [port(P)]),
                   tcp_close_socket(S))).
test(agents_hop_between_ports_of_a_process, true(O-Hops == done-2)) :-
    free_port(P),
    with_hosts([alpha, beta-[port(P)]],
               ( address(beta, B),
                 create([(main :- move(B), move(alpha), hops(N), leave(n(N)))],
                        A),
                 joined(A, O),
                 remote(alpha, sense(n(Hops))) )).
test(same_interface_again) :-
    with_hosts([alpha],
               ( setup_call_cleanup(host_start(beta, [bind('127.0.0.1')]),
                                    true,
                                    host_stop(beta)) )).
test(another_interface, [ forall(member(I, ['127.0.0', '127.0.0.10'])),
                          error(permission_error(change, endpoint, _)) ]) :-
    with_hosts([alpha], host_start(beta, [bind(I)])).
test(port_in_use, error(socket_error(eaddrinuse, _))) :-
    no_leaks(setup_call_cleanup(
                 ( tcp_socket(S), tcp_bind(S, localhost:P), tcp_listen(S, 5) ),
                 host_start(alpha, [port(P)]),
                 tcp_close_socket(S))).
test(error_for_a_port_in_use_suggests_a_fix,
     true(sub_atom(Text, _, _, _, 'port(0)'))) :-
    setup_call_cleanup(
        ( tcp_socket(S), tcp_bind(S, localhost:P), tcp_listen(S, 5) ),
        catch(host_start(alpha, [port(P)]), error(_, context(_, Text)), true),
        tcp_close_socket(S)).
test(twice, error(permission_error(start, host, alpha))) :-
    with_hosts([alpha], host_start(alpha)).
test(unknown_option, error(domain_error(host_option, colour(red)))) :-
    host_start(alpha, [colour(red)]).
test(wrong_types,
     [forall(member(O, [port(x), capacity(-1), capacity(many), tokens(t),
                        concurrency(0), log(1), log('events.pl'),
                        log('events.pl', [hops]), remote(maybe), clock(0,x),
                        hop_time(uniform(a,b)), seed(x), bind(1)])),
      error(type_error(_, _))]) :-
    host_start(alpha, [O]).
test(address_is_not_accepted_as_a_name,
     [ forall(member(Name, ['a@b', ''])),
       error(domain_error(host_name, Name)) ]) :-
    host_start(Name).
test(name_unbound, error(instantiation_error)) :-
    host_start(_).
test(failed_start_leaves_nothing, error(existence_error(_, _))) :-
    no_leaks(host_start(alpha, [consult(no_such_file_anywhere)])).
test(started_after_a_failed_start) :-
    catch(host_start(alpha, [consult(no_such_file_anywhere)]),
          error(existence_error(_, _), _), true),
    with_hosts([alpha], true).
test(stop_of_a_missing_host, error(existence_error(host, alpha))) :-
    host_stop(alpha).
test(stop_by_address) :-
    with_hosts([alpha], ( address(alpha, A), host_stop(A) )).
test(start_and_stop_in_several_threads) :-
    no_leaks(( findall(T, ( between(1, 8, I),
                            thread_create(plunit_host_options:churn(I), T) ),
                       Ts),
               forall(member(T, Ts), thread_join(T, true)) )).

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
test(all_hosts, true(Hs == [alpha,beta,gamma])) :-
    with_hosts([gamma,alpha,beta],
               ( findall(H, host_property(H, state(running)), Hs0),
                 sort(Hs0, Hs) )).
test(no_hosts, true(Hs == [])) :-
    findall(H, host_property(H, _), Hs).
test(unknown, error(existence_error(host, nowhere))) :-
    with_hosts([alpha], host_property(nowhere, load(_))).
test(place_is_a_module, true(current_module(M))) :-
    with_hosts([alpha],
               ( host_property(alpha, place(M)), assertion(current_module(M)) )),
    set_module(M:class(temporary)).
test(properties_are_deterministic,
     [ forall(member(P, [ address(_), state(_), capacity(_), load(_),
                          neighbours(_), place(_), hop_time(in, _),
                          hop_time(out, _) ])) ]) :-
    with_hosts([alpha],
               ( call_cleanup(host_property(alpha, P), Det = true),
                 assertion(Det == true) )).
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

visit(Host, Options, Outcome) :-
    create([(main :- catch(move(Host), error(move_refused(_, Why), _),
                           throw(refused(Why))))],
           A, Options),
    agent_join(A, Outcome0, 10),
    (   Outcome0 = raised(refused(Why))
    ->  Outcome = refused(Why)
    ;   Outcome = Outcome0
    ).

%   hold(+N, -Agents): N agents that hold their worker until go_on/1.

hold(N, Agents) :-
    findall(A, ( between(1, N, _),
                 create([(main :- plunit_host_change:in_turn)], A) ),
            Agents).

in_turn :-
    thread_send_message(here, here),
    thread_get_message(go, go).

%   began(+N): so many more agents have a turn, and no others.

began(N) :-
    forall(between(1, N, _),
           thread_get_message(here, here, [timeout(10)])),
    \+ thread_peek_message(here, here).

go_on(Agents) :-
    forall(member(_, Agents), thread_send_message(go, go)),
    forall(member(A, Agents), joined(A, done)).

:- meta_predicate with_queues(0).

with_queues(Goal) :-
    setup_call_cleanup(
        ( message_queue_create(_, [alias(here)]),
          message_queue_create(_, [alias(go)]) ),
        Goal,
        ( message_queue_destroy(here), message_queue_destroy(go) )).

test(tokens, true([O1,O2] == [refused(token), done])) :-
    with_hosts([alpha,beta],
               ( host_change(beta, tokens([7])),
                 visit(beta, [], O1),
                 visit(beta, [tokens([7])], O2) )).
test(tokens_can_be_removed, true([O1,O2] == [refused(token), done])) :-
    with_hosts([alpha, beta-[tokens([7])]],
               ( visit(beta, [], O1),
                 host_change(beta, tokens([])),
                 visit(beta, [], O2) )).
test(capacity, true([O1,O2,C] == [refused(capacity), done, 3])) :-
    with_hosts([alpha,beta],
               ( host_change(beta, capacity(0)),
                 visit(beta, [], O1),
                 host_change(beta, capacity(3)),
                 visit(beta, [], O2),
                 host_property(beta, capacity(C)) )).
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
test(unknown_option, error(domain_error(host_option, colour(red)))) :-
    with_hosts([alpha], host_change(alpha, colour(red))).
test(wrong_type, error(type_error(_, -1))) :-
    with_hosts([alpha], host_change(alpha, capacity(-1))).
test(options_that_cannot_change,
     [ forall(member(O, [port(1), place(user), clock(virtual)])),
       error(permission_error(change, host_option, O)) ]) :-
    with_hosts([alpha], host_change(alpha, O)).
test(unknown_host, error(existence_error(host, nowhere))) :-
    with_hosts([alpha], host_change(nowhere, capacity(1))).

:- end_tests(host_change).

:- begin_tests(links).

test(link_is_symmetric, true(A-B == [BA]-[AA])) :-
    with_hosts([alpha,beta],
               ( address(alpha, AA), address(beta, BA),
                 link(alpha, BA),
                 host_property(alpha, neighbours(A)),
                 host_property(beta, neighbours(B)) )).
test(second_link_has_no_effect, true(L == 1)) :-
    with_hosts([alpha,beta],
               ( link(alpha, beta), link(beta, alpha), link(alpha, beta),
                 host_property(alpha, neighbours(Ns)), length(Ns, L) )).
test(unlink, true(A-B == []-[])) :-
    with_hosts([alpha,beta],
               ( link(alpha, beta), unlink(beta, alpha), unlink(alpha, beta),
                 host_property(alpha, neighbours(A)),
                 host_property(beta, neighbours(B)) )).
test(link_to_itself, error(domain_error(other_host, alpha))) :-
    with_hosts([alpha], link(alpha, alpha)).
test(link_to_a_missing_host, error(existence_error(host, nowhere))) :-
    with_hosts([alpha], link(alpha, nowhere)).
test(stopped_hosts_are_no_neighbours, true(A == [])) :-
    with_hosts([alpha,beta],
               ( link(alpha, beta), host_stop(beta),
                 host_property(alpha, neighbours(A)) )).
test(links_made_by_many_threads, true(L == 8)) :-
    findall(H, ( between(1, 8, I), atom_concat(h, I, H) ), Hs),
    with_hosts([hub|Hs],
               ( concurrent_maplist([H]>>forall(between(1, 20, _),
                                                link(hub, H)), Hs),
                 host_property(hub, neighbours(Ns)), length(Ns, L) )).

:- end_tests(links).

:- begin_tests(admission).

test(capacity, true(Admitted-Refused-L == 3-2-3)) :-
    with_hosts([alpha-[capacity(3)]],
               ( findall(R, ( between(1, 5, _), try(R) ), Rs),
                 aggregate_all(count, member(ok, Rs), Admitted),
                 aggregate_all(count, member(capacity, Rs), Refused),
                 host_property(alpha, load(L)) )).

try(Result) :-
    catch(( create([on_message(_, _)], _), Result = ok ),
          error(move_refused(_, Result), _), true).

test(capacity_is_freed, R == ok) :-
    with_hosts([alpha-[capacity(1)]],
               ( stays([], A),
                 try(capacity),
                 agent_dispose(A),
                 wait_until(host_property(alpha, load(0)), 5),
                 try(R) )).
test(capacity_is_never_exceeded, true(Ok-L == 10-10)) :-
    with_hosts([alpha-[capacity(10)]],
               ( findall(x, between(1, 8, _), Xs),
                 concurrent_maplist([_,N]>>( findall(R,
                                                ( between(1, 10, _),
                                                  plunit_admission:try(R) ),
                                                Rs),
                                             aggregate_all(count,
                                                member(ok, Rs), N) ),
                                    Xs, Ns),
                 sum_list(Ns, Ok),
                 host_property(alpha, load(L)) )).
test(agents_queue_at_a_small_host, true(Os == [done,done,done,done,done])) :-
    with_hosts([alpha,beta-[capacity(1)]],
               ( findall(A, ( between(1, 5, _),
                              create([(main :- catch(move(beta),
                                                     error(move_refused(_, capacity), _),
                                                     again),
                                               move(alpha)),
                                      (again :- sleep(0.005), main)], A) ),
                         As),
                 maplist(joined, As, Os),
                 host_property(beta, hop_time(in, stats(5,_,_,_))) )).
test(tokens, true(Rs == [ok,ok,token,token])) :-
    with_hosts([alpha-[tokens([red,blue])]],
               findall(R, ( member(Ts, [[red],[green,blue],[green],[]]),
                            catch(( create([on_message(_, _)], _, [tokens(Ts)]),
                                    R = ok ),
                                  error(move_refused(_, R), _), true) ), Rs)).
test(tokens_that_are_terms, O == done) :-
    with_hosts([alpha-[tokens([key(1)])]],
               ( create([main], A, [tokens([key(1)])]), joined(A, O) )).

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
                 maplist(joined, As, Os),
                 assertion(forall(member(O, Os), O == done)),
                 remote(alpha, findall(T-U, sense(interval(T, U)), Is)),
                 sort(Is, Intervals) )).

overlap([_-U|Is]) :-
    Is = [T-_|_],
    (   T < U
    ->  true
    ;   overlap(Is)
    ).

test(one_agent_at_a_time, true((\+ overlap(Is), length(Is, 12)))) :-
    intervals([concurrency(1)], Is).
test(blocking_goals_overlap_without_a_limit) :-
    with_queue(here, with_queue(go, with_hosts([alpha], meet(8)))).
test(blocking_goals_are_serialized_by_the_limit, true(S >= 0.4)) :-
    elapsed(blocked([concurrency(1)], 8), S).
test(blocking_goals_two_at_a_time, true(S >= 0.2)) :-
    elapsed(blocked([concurrency(2)], 8), S).

blocked(Options, N) :-
    message_queue_create(Q),
    with_hosts([alpha-Options],
               ( findall(A, ( between(1, N, _),
                              create([(main :- plunit_concurrency:block)], A) ),
                         As),
                 maplist(joined, As, Os),
                 assertion(forall(member(O, Os), O == done)) )),
    message_queue_destroy(Q).

%   Each agent continues only when all have arrived.

meet(N) :-
    findall(A, ( between(1, N, _),
                 create([(main :- plunit_concurrency:wait_for_all)], A) ),
            As),
    forall(between(1, N, _),
           thread_get_message(here, here, [timeout(10)])),
    forall(between(1, N, _), thread_send_message(go, go)),
    maplist(joined, As, Os),
    forall(member(O, Os), O == done).

wait_for_all :-
    thread_send_message(here, here),
    thread_get_message(go, go).

with_queue(Alias, Goal) :-
    setup_call_cleanup(
        message_queue_create(_, [alias(Alias)]),
        once(Goal),
        message_queue_destroy(Alias)).

block :-
    thread_self(Me),
    \+ thread_get_message(Me, never, [timeout(0.05)]).

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
test(limit_holds_after_an_abort, true((O1 == done, \+ overlap(Is)))) :-
    with_hosts([alpha-[concurrency(1)]],
               ( create([(main :- throw(x))], A0),
                 capturing(joined(A0, raised(x)), _),
                 create([main], A1), joined(A1, O1) )),
    intervals([concurrency(1)], Is).

:- end_tests(concurrency).

:- begin_tests(places).

test(consult, F == [s(1),s(2)]) :-
    in_tmp_file(['height(1).', 'height(2).'], plunit_places:heights(F)).

heights(F, File) :-
    with_hosts([alpha-[consult(File)]],
               ( stays([(main :- forall(height(X), assertz(s(X))))], A),
                 facts(A, F) )).

test(consult_calls_the_vocabulary, F == [s(1)]) :-
    in_tmp_file(['busy :- host_load(N), N > 0.'], plunit_places:busy(F)).

busy(F, File) :-
    with_hosts([alpha-[consult([File])]],
               ( stays([(main :- busy, assertz(s(1)))], A), facts(A, F) )).

test(each_host_has_its_own_place, F == [s(1),s(2)]) :-
    in_tmp_file([':- dynamic count/1.', 'count(0).'], plunit_places:counts(F)).

counts(F, File) :-
    with_hosts([alpha-[consult(File)],beta-[consult(File)]],
               ( remote(alpha, ( retract(count(_)), assertz(count(1)) )),
                 remote(beta, ( retract(count(_)), assertz(count(2)) )),
                 stays([(main :- count(X), assertz(s(X)), move(beta),
                                 count(Y), assertz(s(Y)))], A),
                 facts(A, F) )).

test(place_is_invisible_on_other_hosts,
     true(F = [s(existence_error(procedure, _))])) :-
    in_tmp_file(['height(1).'], plunit_places:elsewhere(F)).

elsewhere(F, File) :-
    with_hosts([alpha-[consult(File)],beta],
               ( stays([(main :- height(_), move(beta),
                                 catch(height(_), error(E, _),
                                       assertz(s(E))))], A),
                 facts(A, F) )).

test(predicates_of_the_agent_come_first, F == [s(mine)]) :-
    in_tmp_file(['height(theirs).'], plunit_places:first(F)).

first(F, File) :-
    with_hosts([alpha-[consult(File)]],
               ( stays([height(mine), (main :- forall(height(X),
                                                      assertz(s(X))))], A),
                 facts(A, F) )).

test(services, F == [s(42)]) :-
    service(test_service_1),
    with_hosts([alpha-[services(test_service_1)]],
               ( stays([(main :- answer(X), assertz(s(X)))], A),
                 facts(A, F) )).

service(M) :-
    assertz(M:answer(42)),
    assertz(M:hidden(1)),
    M:export(M:answer/1).

test(only_exported_predicates_are_services,
     true(F = [s(existence_error(procedure, _))])) :-
    service(test_service_2),
    with_hosts([alpha-[services([test_service_2])]],
               ( stays([(main :- catch(hidden(_), error(E, _),
                                       assertz(s(E))))], A),
                 facts(A, F) )).
test(library_as_a_service, F == [s(12)]) :-
    with_hosts([alpha-[services([library(dcg/basics)])]],
               ( stays([(main :- phrase(integer(X), `12`), assertz(s(X)))], A),
                 facts(A, F) )).
test(no_such_service, error(existence_error(_, _))) :-
    no_leaks(host_start(alpha, [services([library(no_such_service)])])).
test(place, F == [s(1)]) :-
    service(test_place_1),
    with_hosts([alpha-[place(test_place_1)]],
               ( stays([(main :- hidden(X), assertz(s(X)))], A),
                 facts(A, F) )).
test(place_module_outlives_the_host, true(X == 1)) :-
    service(test_place_2),
    with_hosts([alpha-[place(test_place_2)]], true),
    call(test_place_2:hidden(X)).

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

%   reads_some(+Place, +Reads, +Empty): once in some hundred thousand reads 9.0.4
%   overlooks a clause that is about to be collected.

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

test(leave_sense_take, F == [s([1,2]),s(1),s(2),s(none)]) :-
    with_hosts([alpha],
               ( stays([(main :- leave(p(1)), leave(p(2)),
                                 findall(X, sense(p(X)), L), assertz(s(L)),
                                 take(p(A)), assertz(s(A)),
                                 take(p(B)), assertz(s(B)),
                                 ( take(p(_)) -> true ; assertz(s(none)) ))],
                       Agent),
                 facts(Agent, F) )).
test(tuple_stays_on_its_host, F == [s(none)]) :-
    with_hosts([alpha,beta],
               ( stays([(main :- leave(p(1)), move(beta),
                                 ( sense(p(_)) -> true ; assertz(s(none)) ))],
                       Agent),
                 facts(Agent, F) )).
test(sense_in_an_empty_tuple_space, F == [s(none)]) :-
    with_hosts([alpha],
               ( stays([(main :- ( sense(_) -> true ; assertz(s(none)) ))],
                       Agent),
                 facts(Agent, F) )).
test(terms_that_cannot_be_left, true(F = [s(type_error(mobile_term, _)),
                                          s(instantiation_error)])) :-
    with_hosts([alpha],
               ( stays([(main :- current_output(S),
                                 catch(leave(p(S)), error(E, _),
                                       assertz(s(E))),
                                 catch(leave(_), error(E2, _),
                                       assertz(s(E2))))], Agent),
                 facts(Agent, F) )).
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
test(one_token_for_fifty_agents, true(N == 50*20)) :-
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
                 remote(alpha, sense(count(N0))) )),
    N = 50*20, N0 =:= N.

:- end_tests(tuple_space).

:- begin_tests(host_clock).

test(time_of_day_by_default, true(abs(T-Now) < 5)) :-
    with_hosts([alpha], ( remote(alpha, now(T)), get_time(Now) )).
test(rate, true((D >= 10, D < 1000))) :-
    get_time(Now),
    with_hosts([alpha-[clock(Now, 100)]],
               ( remote(alpha, now(T0)),
                 create([(main :- sleep(10))], A), joined(A, done),
                 remote(alpha, now(T1)), D is T1-T0 )).
test(epoch, true((T >= 0, T < 100))) :-
    get_time(Now),
    with_hosts([alpha-[clock(Now, 1)]], remote(alpha, now(T))).
test(hosts_share_a_clock, true(abs(A-B) < 500)) :-
    get_time(Now),
    with_hosts([alpha-[clock(Now, 100)],beta-[clock(Now, 100)]],
               ( remote(alpha, now(A)), remote(beta, now(B)) )).
test(rate_must_be_positive, error(domain_error(clock_rate, 0))) :-
    no_leaks(host_start(alpha, [clock(0, 0)])).

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
test(with_residents, true(Os == [disposed,disposed,disposed])) :-
    with_hosts([alpha],
               ( findall(A, ( between(1, 3, _), stays([], A) ), As),
                 host_stop(alpha) )),
    maplist([A,O]>>agent_join(A, O, 10), As, Os).
test(a_thousand_residents, true(N == 1000)) :-
    with_hosts([alpha],
               ( findall(A, ( between(1, 1000, _),
                              create([on_message(_, _)], A) ), As),
                 host_stop(alpha) )),
    aggregate_all(count, ( member(A, As), agent_join(A, disposed, 10) ), N).
test(agent_that_has_left_continues, true(Elsewhere == [])) :-
    with_tmp_dir(test_host:ended_elsewhere(Elsewhere)).
test(one_of_two_hosts, true(S == resident)) :-
    with_hosts([alpha,beta],
               ( create([on_message(_, _)], A, [host(beta)]),
                 stays([], _),
                 host_stop(alpha),
                 wait_state(A, resident),
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

stubborn(loop, [(main :- main)]).
stubborn(native_loop, [(main :- between(1, inf, _), fail)]).
stubborn(catch_all, [(main :- catch(repeat, _, true), fail)]).
stubborn(catch_again, [(main :- catch(loop, _, true), main),
                       (loop :- repeat, fail)]).
stubborn(blocked, [(main :- message_queue_create(Q),
                            call_cleanup(thread_get_message(Q, _),
                                         message_queue_destroy(Q)))]).
stubborn(reading, [(main :- typhon_test_pipe(In), read(In, _))]).
stubborn(waiting, [(main :- thread_self(Me),
                            thread_get_message(Me, never, [timeout(1000)]))]).

test(stubborn, [ forall(( stubborn(Kind, Clauses), Kind \== reading )),
                 true((O == disposed, S < 20)) ]) :-
    impatient(with_hosts([alpha],
                         ( create(Clauses, A),
                           wait_state(A, running),
                           elapsed(host_stop(alpha), S),
                           agent_join(A, O, 10) ))).
test(agent_has_ended_when_its_host_has_stopped, O == disposed) :-
    setup_call_cleanup(
        wrap_predicate(typhon_hosts:host_leave(_), slow, Left,
                       ( sleep(0.4), Left )),
        impatient(with_hosts([alpha],
                             ( create([(main :- between(1, inf, _), fail)], A),
                               wait_state(A, running),
                               host_stop(alpha),
                               agent_join(A, O, 10) ))),
        unwrap_predicate(typhon_hosts:host_leave/1, slow)).
test(deadline_is_set_before_the_agent_rests,
     [ forall(member(Wait, [sleep(60), receive(_, 60), move(beta)])),
       States == [running] ]) :-
    thread_self(Me),
    setup_call_cleanup(
        wrap_predicate(typhon_clocks:real_time(_, _, _), seen, Until,
                       test_host:asked_in(Me, Until)),
        with_hosts([alpha-[hop_time(uniform(60, 60))], beta],
                   ( create([(main :- Wait)], _),
                     thread_get_message(Me, asked_in(States), [timeout(30)]) )),
        unwrap_predicate(typhon_clocks:real_time/3, seen)).
test(stubborn_reader, [ setup(stubborn(reading, Clauses)),
                        true((O == disposed, S < 20)) ]) :-
    setup_call_cleanup(
        ( tcp_socket(L), tcp_bind(L, localhost:P), tcp_listen(L, 5),
          tcp_connect(localhost:P, Out, []),
          tcp_accept(L, C, _), tcp_open_socket(C, In),
          assertz(test_place_pipe:typhon_test_pipe(In)) ),
        impatient(with_hosts([alpha-[place(test_place_pipe)]],
                             ( create(Clauses, A),
                               wait_state(A, running),
                               elapsed(host_stop(alpha), S),
                               agent_join(A, O, 10) ))),
        ( retractall(test_place_pipe:typhon_test_pipe(_)),
          close(In), close(Out), tcp_close_socket(L) )).
test(stubborn_under_a_limit, true(Os == [disposed,disposed])) :-
    impatient(with_hosts(
                  [alpha-[concurrency(1)]],
                  ( findall(A, ( member(_, [a,b]),
                                 create([(main :- main)], A) ), As),
                    host_stop(alpha),
                    maplist([A,O]>>agent_join(A, O, 10), As, Os) ))).
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
                                     create([(main :- catch(hop, _, true), main),
                                             (hop :- move(beta), move(alpha))],
                                            A, [host(alpha)]) ), As),
                        capturing(host_stop(alpha), _),
                        forall(member(A, As),
                               catch(agent_dispose(A),
                                     error(existence_error(_, _), _), true)),
                        maplist(joined, As, _) ))).
test(host_stop_in_a_cleanup_handler) :-
    no_leaks(setup_call_cleanup(host_start(alpha),
                                stays([], _),
                                host_stop(alpha))).
test(every_thread_has_a_name) :-
    with_hosts([alpha], in_own_thread(\+ nameless(_))).

nameless(Thread) :-
    thread_property(Thread, status(_)),
    catch(\+ thread_property(Thread, alias(_)),
          error(existence_error(thread, _), _), fail).

:- end_tests(stopping).
