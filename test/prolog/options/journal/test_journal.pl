:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_kill/2, process_wait/2]).
:- use_module(library(prolog_wrap), [wrap_predicate/4]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/durable),
              [durable/5, durable_assertz/1, durable_retractall/1]).

:- needs([journal]).

:- begin_tests(journal).

%   with_journal(:First, :Second): in a process with a journal, and after its
%   restart.

:- meta_predicate with_journal(0, 0).

with_journal(First, Second) :-
    no_leaks(with_tmp_dir(twice(First, Second))).

:- meta_predicate twice(0, 0, +).

twice(First, Second, Dir) :-
    started(Dir, First),
    started(Dir, Second).

:- meta_predicate started(+, 0).

started(Dir, Goal) :-
    setup_call_cleanup(host_start(alpha, [journal(Dir)]),
                       once(Goal),
                       host_stop(alpha)).   % it rests

keeper(clauses([ (:- agent(keeper, [state([got/1])])),
                 (on_message(_, M) :- assertz(got(M))) ])).

test(agents_and_their_state_are_restored) :-
    with_journal(
        ( keeper(P),
          agent_create(P, Id, []),
          forall(between(1, 3, I), agent_send(Id, m(I))),
          got(Id, [m(1), m(2), m(3)]) ),
        ( wait_until(agent_property(Id, state(resident)), 5), % m(3) again
          agent_send(Id, m(4)),
          got(Id, [m(1), m(2), m(3), m(4)]) )).

got(Id, Expected) :-
    wait_until(( agent_property(Id, facts(Facts)),
                 findall(M, member(got(M), Facts), Expected) ), 5).

test(waiting_agents_receive_and_sleeping_agents_wake) :-
    with_journal(
        ( agent_create(clauses([ (:- agent(waits, [])),
                                 (main :- receive(_-X), result(X)) ]), A, []),
          agent_create(clauses([ (:- agent(sleeps, [])),
                                 (main :- sleep(3), result(awake)) ]), B, []),
          wait_until(( agent_property(A, state(waiting)),
                       agent_property(B, state(sleeping)) ), 5) ),
        ( agent_property(A, state(waiting)),
          agent_send(A, hello),
          agent_result(A, hello, 5),
          agent_result(B, awake, 20) )).

%   A table that the journal knows only by its declaration.

:- dynamic visit/2.

:- durable(visit, Id, N, _, visit(Id, N)).

test(declared_facts_are_restored_in_order, [cleanup(retractall(visit(_, _)))]) :-
    with_journal(
        ( forall(member(N, [10, 9, 11]), durable_assertz(visit(alice, N))),
          durable_assertz(visit(bob, 1)),
          durable_retractall(visit(bob, _)),
          retractall(visit(_, _)) ),
        ( findall(Id-N, visit(Id, N), Visits),
          Visits == [alice-9, alice-10, alice-11] )).

test(other_hosts_are_restored_and_requested_once,
     [error(permission_error(start, host, beta))]) :-
    with_tmp_dir(other_hosts).

other_hosts(Dir) :-
    keeper(P),
    killed(Dir, Host,
        ( atom_concat(alpha, There, Host),
          atom_concat(beta, There, Beta),
          remote(Host, typhon:host_start(beta, [capacity(1)])),
          link(Host, Beta),
          agent_create(P, Id, [host(Beta)]) ),
        ( remote(Host, typhon:host_property(alpha, neighbours([Beta]))),
          remote(Host, typhon:host_property(beta, load(1))),
          agent_property(Id, host(Beta)),
          catch(agent_create(P, _, [host(Beta)]), Refused, true),
          remote(Host, typhon:host_start(beta)),
          catch(remote(Host, typhon:host_start(beta)), Error, true) )),
    Refused = error(move_refused(Beta, capacity), _),
    throw(Error).

%   Otherwise the id would be tried repeatedly, and nothing else be committed.

test(too_long_id_is_refused) :-
    no_leaks(with_tmp_dir(long_ids)).

long_ids(Dir) :-
    Visitor = clauses([ (:- agent(visitor, [])),
                        (main :- receive(_-go(Host)),
                                 catch(move(Host), error(E, _), true),
                                 result(E)) ]),
    keeper(Keeper),
    with_peers([p], started(Dir,
        ( host_property(alpha, address(Alpha)),
          format(atom(Name), '~`xt~6000|', []),
          peer_do(p, agent_create(Visitor, A, [name(Name)])),
          agent_send(A, go(Alpha)),
          agent_result(A, E, 10),
          assertion(E = move_refused(Alpha, error(type_error(_, _)))),
          catch(agent_create(Keeper, _, [name(Name)]),
                error(Formal, _), true),
          assertion(Formal == representation_error(agent_name)),
          agent_create(Keeper, Id),
          agent_send(Id, one),
          got(Id, [one]) ))),
    started(Dir, got(Id, [one])).

test(journal_needs_the_first_host,
     [error(permission_error(open, journal, _))]) :-
    setup_call_cleanup(host_start(gamma),
                       host_start(alpha, [journal('/tmp/none')]),
                       host_stop(gamma)).

test(journal_is_refused_in_virtual_time,
     [error(permission_error(open, journal, _))]) :-
    host_start(alpha, [clock(virtual), journal('/tmp/none')]).

test(faulty_agents_are_restored_and_resumed) :-
    with_journal(
        ( agent_create(clauses([ (:- agent(fails, [state([ok/0])])),
                                 (main :- ok, result(fine)) ]), A, []),
          agent_join(A, failed, 5) ),
        ( wait_until(agent_property(A, state(faulty(_))), 5),
          agent_change(A, facts([ok])),
          agent_resume(A),
          agent_result(A, fine, 5) )).

%   The worker of the agent is held while it sends posts, when it learns that
%   one message finds no agent. If the agent rests at that moment, another
%   worker overtakes it.

test(messages_of_an_answering_agent_stay_in_order) :-
    with_tmp_dir(in_order).

in_order(Dir) :-
    started(Dir,
        ( keeper(P),
          agent_create(P, K, []),
          agent_create(clauses([(:- agent(gone, [])), main]), Gone, []),
          agent_join(Gone, done, 5),
          counter(C),
          agent_create(C, A, [facts([to(K), gone(Gone)])]),
          setup_call_cleanup(
              asserta((user:message_hook(typhon(undeliverable(_, _, A, _)),
                                         _, _) :-
                           plunit_journal:stands_still(A, K)), Hook),
              ( agent_send(A, go),
                wait_until(( agent_property(A, facts(Facts)),
                             memberchk(said(1), Facts),
                             agent_property(A, state(resident)) ), 5),
                agent_send(A, go),
                got(K, [1, 2]) ),
              erase(Hook)) )).

counter(clauses([ (:- agent(counter, [state([said/1, to/1, gone/1])])),
                  said(0),
                  (on_message(_, go) :-
                       retract(said(N0)), N is N0+1, assertz(said(N)),
                       ( N =:= 1 -> gone(Gone), send(Gone, hello) ; true ),
                       to(To), send(To, N)) ])).

:- public stands_still/2.

stands_still(Agent, Keeper) :-
    (   agent_property(Agent, state(resident))
    ->  got(Keeper, [2])
    ;   true
    ).

%   Peers are admitted before agents continue: two messages arrive just before
%   the check whether the agent is to be woken, and it has taken the first.

test(messages_during_a_restart_are_handled_in_sequence) :-
    no_leaks(with_tmp_dir(one_after_the_other)).

one_after_the_other(Dir) :-
    started(Dir,
        ( agent_create(clauses([ (:- agent(listens, [state([got/1])])),
                                 (on_message(_, M) :- hears(M), assertz(got(M))),
                                 (hears(first) :-
                                      !,
                                      thread_send_message(journal_gate, in),
                                      thread_get_message(journal_gate, on)),
                                 hears(second) ]), A, []),
          wait_until(agent_property(A, state(resident)), 5) )),
    message_queue_create(Gate, [alias(journal_gate)]),
    assertz(speaks_to(A)),
    wrap_predicate(typhon_identity:with_agent(Id, _), spoken_to, Wrapped,
                   ( plunit_journal:spoken_to(Id), Wrapped )),
    host_start(alpha, [journal(Dir)]),
    call_cleanup(
        ( catch(wait_until(( agent_property(A, facts(Facts)),
                             memberchk(got(second), Facts) ), 0.5), _, true),
          thread_send_message(Gate, on),
          got(A, [first, second]) ),
        ( host_stop(alpha), message_queue_destroy(Gate) )).

%   The predicate stays wrapped: unwrapping a predicate that a thread executes
%   is not safe.

:- dynamic speaks_to/1.
:- public spoken_to/1.

spoken_to(Id) :-
    thread_self(main),
    retract(speaks_to(Id)),
    !,
    agent_send(Id, first),
    thread_get_message(journal_gate, in),
    agent_send(Id, second).
spoken_to(_).

%   An agent with a new program is not admitted after all: this must not keep
%   the program from agents that bring it later.

test(program_is_recorded_after_a_failed_unit_of_work) :-
    with_journal(
        ( keeper(P),
          agent_create(P, First, []),
          typhon_agents:agent(First, _, _, Hash, _),
          retractall(typhon_journaled_agents:code_noted(Hash)),
          typhon_durable:durable_drop(code, Hash, 0),
          \+ typhon_durable:unit_of_work(
                 ( typhon_journaled_agents:note_code(Hash), fail )),
          agent_create(P, Id, []) ),
        ( agent_property(Id, state(resident)) )).

%   killed(+Dir, -Host, :Before, :After): beside a process with Host that is
%   killed, and beside the next one.

:- meta_predicate killed(+, -, 0, 0), node(+, +, 0).

killed(Dir, Host, Before, After) :-
    node_host(Port, Host),
    setup_call_cleanup(
        host_start(driver),
        ( node(Dir, Port, Before), node(Dir, Port, After) ),
        host_stop(driver)).

node_host(Port, Host) :-
    free_port(Port),
    format(atom(Host), 'alpha@127.0.0.1:~d', [Port]).

node(Dir, Port, Goal) :-
    project_file('test/chaos/lasting/node.pl', File),
    with_swipl([File, '--', alpha, Port, Dir, normal, 1], Pid, In, Out,
               ( format(In, 'orders([]).~n', []),
                 flush_output(In),
                 read_line_to_string(Out, "ready"),
                 call(Goal),
                 process_kill(Pid, kill),
                 process_wait(Pid, _) )).

test(unfinished_step_is_repeated_with_one_effect) :-
    with_tmp_dir(half_a_step).

half_a_step(Dir) :-
    keeper(Keeper),
    atom_concat(Dir, '/go', Go),
    atom_concat(Dir, '/begun', Begun),
    killed(Dir, Host,
        ( agent_create(Keeper, K, [host(Host)]),
          remote(Host, leave(token)),
          agent_create(clauses([ (:- agent(steps, [state([to/1])])),
                                 (main :- take(token), to(To),
                                          send(To, begun), leave(changed),
                                          ( exists_file(Go) -> true
                                          ; open(Begun, write, S), close(S),
                                            thread_self(T), thread_get_message(T, never)
                                          ),
                                          sleep(0),
                                          result(done)) ]), _,
                       [host(Host), facts([to(K)])]),
          wait_until(exists_file(Begun), 10),
          remote(Host, findall(F, sense(F), [])),
          open(Go, write, Out),
          close(Out) ),
        ( wait_until(remote(Host, sense(changed)), 5),
          remote(Host, findall(F, sense(F), [changed])),
          got(K, [begun]) )).

%   The process is killed in the middle of a step that has written a log entry.

test(log_entries_are_written_once_with_their_step) :-
    with_tmp_dir(logs).

logs(Dir) :-
    atom_concat(Dir, '/go', Go),
    atom_concat(Dir, '/log', Log),
    atom_concat(Dir, '/alpha', Journal),
    setup_call_cleanup(
        log_server_start([file(Log)], Server),
        killed(Journal, Host,
               ( remote(Host, typhon:host_change(alpha, log(Server))),
                 logger(Go, Program),
                 agent_create(Program, A, [host(Host)]),
                 wait_until(logged(Log, A, [before]), 5),
                 setup_call_cleanup(open(Go, write, Out), true, close(Out)) ),
               ( wait_until(logged(Log, A, [_, _, _, after]), 10),
                 logged(Log, A, [before, step(1), step(2), after]) )),
        log_server_stop(Server)).

logger(Go, clauses([ (:- agent(logs, [])),
                     (main :- log(before), sleep(0), log(step(1)), log(step(2)),
                              wait, sleep(0), log(after)),
                     (wait :- exists_file(Go), !),
                     (wait :- thread_self(T), thread_get_message(T, never)) ])).

logged(File, Agent, Logged) :-
    exists_file(File),
    log_events(File, Events),
    findall(What,
            ( member(event(_, _, Agent, What), Events),
              memberchk(What, [before, step(_), after]) ),
            Logged).

test(host_with_peers_rests_and_is_restored) :-
    with_tmp_dir(rests).

rests(Dir) :-
    atom_concat(Dir, '/here', Here),
    atom_concat(Dir, '/there', There),
    node_host(Port, Host),
    forall(between(1, 2, _),
           setup_call_cleanup(
               host_start(beta, [journal(Here)]),
               node(There, Port, ( keeper(P),
                                   agent_create(P, A, [host(Host)]),
                                   agent_send(A, hello),
                                   got(A, [hello]),
                                   host_stop(beta) )),
               ignore(catch(host_stop(beta), error(_, _), fail)))).

%   The thread that has admitted a visitor leaves its answer in the buffer of
%   the connection, and the next write to that process sends it. Here another
%   thread is about to write, and nothing is committed any more.

test(arrival_is_acknowledged_after_its_commit) :-
    with_tmp_dir(taken_along).

taken_along(Dir) :-
    atom_concat(Dir, '/there', There),
    killed(Dir, Host,
        ( host_property(driver, address(Driver)),
          atom_concat(Dir, '/hooks.pl', Hooks),
          setup_call_cleanup(
              open(Hooks, write, Out),
              forall(about_to_say(Clause), portray_clause(Out, Clause)),
              close(Out)),
          remote(Host, ( load_files(user:Hooks, []),
                         debug(typhon(frame)),
                         thread_create(typhon:remote(Driver, true), _,
                                       [alias(says)]) )),
          wait_until(remote(Host, user:is_about_to), 5),
          visitor(Program),
          agent_create(Program, A, [facts([to(Host), there(There)])]),
          wait_until(exists_file(There), 5),
          ignore(catch(wait_until(\+ agent_property(A, host(driver)), 1),
                       _, true)) ),
        ( agent_result(A, was_there, 10) )).

about_to_say((:- dynamic(nothing_is_committed/0))).
about_to_say((:- dynamic(is_about_to/0))).
about_to_say((prolog:debug_print_hook(_, _, _:[from, _, request(_, hop), _]) :-
                  assertz(user:nothing_is_committed))).
about_to_say((prolog:debug_print_hook(_, _, _:[to, _, request(_, _), _]) :-
                  thread_self(says),
                  assertz(user:is_about_to),
                  thread_get_message(visitor_is_here))).
about_to_say(prolog:debug_print_hook(_, _, _)).
about_to_say((typhon_durable:reached(before_commit) :-
                  user:nothing_is_committed,
                  thread_self(Me),
                  thread_get_message(Me, never))).

visitor(clauses([ (:- agent(visitor, [state([to/1,there/1])])),
                  (main :- to(Host), move(Host), visit, result(was_there)),
                  (visit :-
                      catch(thread_send_message(says, visitor_is_here), _,
                            fail),
                      !,
                      there(File),
                      open(File, write, Out),
                      close(Out),
                      thread_self(Me),
                      thread_get_message(Me, never)),
                  visit ])).

%   A large state is recorded by its changes. The process is killed while the
%   agent changes it; afterwards the state must equal a model that makes the
%   same changes, clauses in their order.

test(large_changing_state_survives_any_kill,
     [forall(member(Messages, [40, 400, 1500]))]) :-
    with_tmp_dir(changing(Messages)).

changing(Messages, Dir) :-
    Begun is Messages//2,
    killed(Dir, Host,
        ( changer(Program, Facts),
          agent_create(Program, A, [host(Host), facts(Facts)]),
          forall(between(1, Messages, I), agent_send(A, I)),
          wait_until(( changes_done(A, Done), Done >= Begun ), 30) ),
        ( agent_send(A, last),
          wait_until(( agent_property(A, state(resident)),
                       agent_property(A, mailbox([])) ), 30),
          agent_property(A, facts(Clauses)),
          changes_done(A, N),
          model(N, Model),
          by_predicate(Clauses, Model) )).

%   The unit of work that would have recorded a change fails: the change is
%   recorded with the next one.

test(change_of_a_failed_unit_of_work_is_kept) :-
    with_journal(
        ( changer(Program, Facts),
          agent_create(Program, A, [facts(Facts)]),
          agent_send(A, one),
          wait_until(rests_after(A, 1), 5),
          typhon_agents:agent(A, _, Module, _, _),
          \+ typhon_durable:unit_of_work(
                 ( assertz(Module:item(new, change)),
                   typhon_agents:agent_note(A, resident, []),
                   fail )),
          agent_send(A, two),
          wait_until(rests_after(A, 2), 5) ),
        ( changes_done(A, 2),
          agent_property(A, facts(Kept)),
          memberchk(item(new, change), Kept) )).

changes_done(A, N) :-
    agent_property(A, facts(Facts)),
    memberchk(done(N), Facts).

%   The rest of a message arrives after done(N).

rests_after(A, N) :-
    changes_done(A, N),
    agent_property(A, state(resident)).

changer(clauses([ (:- agent(changes, [state([done/1,item/2,rule/1,other/1])])),
                  (on_message(_, _) :- retract(done(N0)), N is N0+1,
                                       assertz(done(N)), K is N mod 9,
                                       change(K, N))
                | Changes ]), [done(0)|Items]) :-
    findall(Change, change(Change), Changes),
    findall(item(I, first), between(1, 1000, I), Items).

change((change(0, N) :- assertz(item(N, x)))).
change((change(1, N) :- asserta(item(N, y)))).
change((change(2, _) :- (retract(item(_, x)) -> true ; true))).
change((change(3, N) :- K is N mod 11,
                        assertz((rule(K) :- item(K, _), \+ item(_, K))))).
change((change(4, _) :- (retract((rule(_) :- _)) -> true ; true))).
change((change(5, N) :- K is N mod 300, retractall(item(K, _)))).
change((change(6, N) :- abolish(other/1), assertz(other(N)), assertz(other(N)))).
change((change(7, N) :- (clause(item(_, first), true, R) -> erase(R) ; true),
                        assertz(item(N, x)), assertz(item(1, x)))).
change((change(8, N) :- catch(snapshot(assertz(item(N, no))), _, true))).

model(N, Clauses) :-
    gensym(test_model_, Module),
    set_module(Module:class(temporary)),
    changer(clauses([_, _|Changes]), Facts),
    dynamic([Module:item/2, Module:rule/1, Module:other/1]),
    forall(( member(Clause, Changes) ; member(Clause, Facts) ),
           assertz(Module:Clause)),
    forall(( between(1, N, I), K is I mod 9 ), Module:change(K, I)),
    retractall(Module:done(_)),
    assertz(Module:done(N)),
    findall(Clause,
            ( member(Head, [done(_), item(_, _), rule(_), other(_)]),
              clause(Module:Head, Body),
              ( Body == true -> Clause = Head ; Clause = (Head:-Body) ) ),
            Clauses),
    '$destroy_module'(Module).

by_predicate(Clauses, Model) :-
    forall(member(Name, [done, item, rule, other]),
           ( of(Name, Clauses, Some),
             of(Name, Model, Others),
             Some =@= Others )).

of(Name, Clauses, Some) :-
    findall(Clause,
            ( member(Clause, Clauses),
              ( Clause = (Head:-_) -> true ; Head = Clause ),
              functor(Head, Name, _) ),
            Some).

:- end_tests(journal).
