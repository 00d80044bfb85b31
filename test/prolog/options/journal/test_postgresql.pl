:- use_module('../../../lib/common').
:- use_module('../../../lib/journaled').
:- use_module('../../../lib/postgres').
:- use_module('../../../lib/stores').
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(process), [process_kill/2, process_wait/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/journal), [journal_place/2]).

:- needs([journal, postgresql]).

/** <module> Tests of a journal in PostgreSQL

The operations of the store, and hosts that are killed; the suite starts a
server.
*/

:- begin_tests(postgresql_url).

place(Url, Place) :-
    journal_place(postgresql(Url), Place).

test(urls_give_places_without_secrets, [ forall(member(Url-Place,
        [ 'postgresql://'-'postgresql://localhost:5432/postgres?schema=typhon',
          'postgres://db.example/x'-
              'postgresql://db.example:5432/x?schema=typhon',
          'postgresql://ann:s%3bcret@db:99/x?schema=alpha&sslmode=require'-no,
          'postgresql://ann:secret@db:99/x?schema=alpha&sslmode=require'-
              'postgresql://ann@db:99/x?schema=alpha',
          'postgresql:///x?host=/run/pg'-
              'postgresql:///run/pg:5432/x?schema=typhon',
          'postgresql://db/x?schema=A;drop'-no,
          'postgresql://db/x?colour=red'-no,
          'mysql://db/x'-no ])),
               true(Found == Place) ]) :-
    catch(place(Url, Found), error(domain_error(postgresql_url, Url), _),
          Found = no).

test(bare_url_is_accepted, true(A == B)) :-
    journal_place('postgresql://db/x', A),
    journal_place(postgresql('postgresql://db/x'), B).

test(missing_server, error(journal_unreachable(_, _))) :-
    with_store('postgresql://x@127.0.0.1:1/x', true).

:- end_tests(postgresql_url).

:- begin_tests(postgresql, [setup(postgres_start), cleanup(postgres_stop)]).

:- meta_predicate with_schema(+, 0).

with_schema(Schema, Goal) :-
    postgres_url(Schema, Url),
    with_store(Url, Goal).

sql(Sql) :-
    odbc:odbc_current_connection(Connection, _),
    typhon_sql:sql_do(Connection, Sql).

test(store_keeps_what_is_committed, [forall(stored(What)), nondet]) :-
    postgres_url(What, Url),
    store_keeps(What, Url).
test(other_process_is_locked_out_per_schema) :-
    postgres_url(locked, Url),
    while_open_elsewhere(Url, Pid,
               ( catch(with_schema(locked, true), error(Formal, _), true),
                 with_schema(not_locked, true),
                 process_kill(Pid, kill),
                 process_wait(Pid, _),
                 with_schema(locked, true) )),
    journal_place(Url, Place),
    Formal == permission_error(open, journal, Place).
test(damaged_term_is_detected) :-
    with_schema(damaged, ( commit([a-k-0-hello(world)]),
                          sql('update item set value=\'\\x00\'::bytea') )),
    catch(with_schema(damaged, items(a, _)), error(Formal, _), true),
    Formal = journal_damaged(_, a-k).
test(journal_of_another_version_is_refused) :-
    with_schema(version, sql('update about set version=99')),
    catch(with_schema(version, true), error(Formal, _), true),
    Formal = journal_version(_, 99),
    \+ odbc:odbc_current_connection(_, _).
test(synchronous_commit_is_optional) :-
    forall(member(Sync-Setting, [normal-off, full-on]),
           ( postgres_url(sync, Url),
             with_store(Url, Sync,
                        ( odbc:odbc_current_connection(C, _),
                          once(typhon_sql:sql_row(C, 'show synchronous_commit',
                                                  row(Setting), [atom])) ))
           )).
test(broken_connection_is_restored) :-
    with_schema(breaks,
               ( commit([a-k-0-first]),
                 postgres_cut(breaks),
                 commit([a-k-0-second, a-l-0-third]),
                 items(a, [k-0-second, l-0-third]) )).
test(commit_lost_by_the_server_is_repeated) :-
    postgres_url(died, Url),
    numlist(1, 40000, Long),
    with_store(Url,
               ( commit([a-k-0-first, a-l-0-Long, a-m-0-x]),
                 commit([a-k-0-second, drop(a, m, 0)]),
                 postgres_crash,
                 forall(between(1, 2, _), unreachable(commit([a-n-1-third]))),
                 postgres_restart,
                 commit([a-n-1-third]),
                 items(a, Items) )),
    Items = [_-0-_, _-0-_, n-1-third],
    memberchk(k-0-second, Items),
    memberchk(l-0-Long, Items).

unreachable(Goal) :-
    catch(Goal, error(Formal, _), true),
    Formal = journal_unreachable(_, _).

test(process_continues_when_the_server_returns) :-
    postgres_url(returns, Url),
    goes_on(Url, postgres_crash, postgres_restart).
test(process_continues_after_the_server_vanished) :-
    with_postgres_relay(vanishes, Url,
                        goes_on(Url, postgres_relay(vanish),
                                postgres_relay(return))).

test(journal_taken_over_by_another_process_is_refused) :-
    catch(with_schema(passed_on,
                     ( commit([a-k-0-first]),
                       sql('update about set opened=opened+1'),
                       postgres_cut(passed_on),
                       commit([a-k-0-second]) )),
          error(Formal, _), true),
    Formal = permission_error(open, journal, _),
    with_schema(passed_on, items(a, [k-0-first])).

%   The server still has the former connection, and its lock.

test(own_former_connection_is_no_other_process) :-
    with_postgres_relay(former, Url,
        with_store(Url,
                   ( commit([a-k-0-first]),
                     postgres_relay(break),
                     unreachable(commit([a-k-0-second])),
                     postgres_relay(return),
                     wait_until(plunit_postgresql:commits(a-k-0-second), 20),
                     items(a, [k-0-second]) ))).

commits(Spec) :-
    catch(( commit([Spec]), Formal = none ), error(Formal, _), true),
    (   Formal == none
    ->  true
    ;   assertion(Formal = journal_unreachable(_, _)),
        fail
    ).

test(agent_survives_a_killed_process) :-
    postgres_url(alpha, Url),
    agent_survives(backend(true, Url)).

test(network_survives_a_killed_process,
     Told = [node_back(_, 2)]) :-
    postgres_url(net, Url),
    in_network([processes(2), restart(true)], Url, first_time(A)),
    findall(node_back(N, P), retract(heard(node_back(N, P))), Told),
    in_network([], Url, second_time(A)),
    catch(network_start(ring(3), _, [journal(postgresql(Url))]),
          error(Formal, _), true),
    Formal = journal_of_another(_, _, _).

:- meta_predicate in_network(+, +, 1).

in_network(Options, Url, Goal) :-
    no_leaks(setup_call_cleanup(
                 network_start(ring(2), N, [journal(postgresql(Url))|Options]),
                 once(call(Goal, N)),
                 network_stop(N))).

first_time(A, N) :-
    network_property(N, hosts([_, Host])),
    network_property(N, processes([_, Pid])),
    agent_create(clauses([ (:- agent(waits, [])),
                           (main :- receive(_-X), receive(_-Y),
                                    result(X+Y)) ]), A, [host(Host)]),
    agent_send(A, 1),
    wait_until(agent_property(A, state(waiting)), 5),
    process_kill(Pid, kill),
    wait_until(heard(node_back(_, _)), 20).

second_time(A, N) :-
    network_property(N, hosts([_, Host])),
    agent_property(A, host(Host)),
    agent_send(A, 2),
    agent_result(A, 1+2, 10).

:- dynamic heard/1.
:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

user:message_hook(typhon(Message), _, _) :-
    memberchk(Message, [node_back(_, _), node_down(_, _, _, _, _)]),
    assertz(plunit_postgresql:heard(Message)).

:- meta_predicate goes_on(+, 0, 0).

%   A silent machine is given up soon.

goes_on(Url, Goes, Returns) :-
    Soon = set_setting(typhon_postgresql:silent_seconds, 4),
    agent_goes_on(backend(Soon, Url), Goes, Returns).

:- end_tests(postgresql).
