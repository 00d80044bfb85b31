:- module(test_restored, []).

/** <module> The journal is a snapshot of the process, and output follows it

*Threading*: one test at a time; agents run in workers.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures', [capturing/2, was_printed/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists),
              [append/2, append/3, delete/3, member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/durable)).
:- use_module(library(typhon/options/identity/birth), []).
:- use_module(library(typhon/kernel/wire),
              [endpoint_address/1, endpoint_process/1]).
:- use_module(library(typhon/kernel/travel/outcomes),
              [clone_born/2, results_keep/2]).

:- needs([journal]).

:- dynamic entry/1.                     % Changes, as they were queued

:- meta_predicate running(+, +, 0).

running(Dir, Sync, Goal) :-
    setup_call_cleanup(host_start(alpha, [journal(Dir), sync(Sync)]),
                       once(Goal),
                       host_stop(alpha)).

                /*******************************
                *         THE SNAPSHOT         *
                *******************************/

%   Tables of which the journal has the same items as a saved network.

kinds([ backlog, born, clone, done, faulty, left, link, mail, monitor, offer,
        out, outcome, payload, tuple, wait ]).

filled([ born, clone, faulty, left, link, mail, monitor, offer, out, outcome,
         payload, tuple ]).

:- meta_predicate items(3, -).

items(Source, Items) :-
    kinds(Kinds),
    findall(Kind-Key-Term,
            ( member(Kind, Kinds), call(Source, Kind, Key, Term) ), Items0),
    sort(Items0, Items).

dumped(Kind, Key, Term) :-
    durable_dump(Kind, Key, _, Term).

stored(Kind, Key, Term) :-
    durable_item(Kind, any, Key, _, Term).

%   A life that leaves something in each of these tables.

life(Dir) :-
    atom_concat(Dir, '/greeting.pl', File),
    setup_call_cleanup(open(File, write, Out),
                       format(Out, ':- payload(greeting, [provides([hi/1])]).~n\c
                                    hi(there).~n', []),
                       close(Out)),
    host_start(beta),
    link(alpha, beta),
    remote(alpha, ( leave(a(1)), leave(a(2)), leave(f(X, X)), take(a(1)) )),
    agent_create(clauses([ (:- agent(brings, [])), (main :- deliver(greeting)) ]),
                 Brings, [payloads([File])]),
    agent_join(Brings, done, 20),
    agent_create(clauses([ (:- agent(clones, [])),
                           (main :- clone(W), result(W)) ]), Clones, []),
    agent_join(family(Clones), [_, _], 20),
    agent_create(clauses([ (:- agent(fails, [])), (main :- fail) ]), Fails, []),
    agent_join(Fails, failed, 20),
    resting(rests, [(main :- receive(_-never))], [], Rests),
    resting(waits, [ to(Rests),
                     (main :- offer(shop(tea), [price(1)]), to(To), monitor(To),
                              send('a.b.0@far@127.0.0.1:1', hello),
                              receive(_-never)) ], [state([to/1])], _),
    agent_send(Rests, one),
    agent_send(Rests, two),
    wait_until(agent_property(Rests, mailbox([_, _])), 20).

resting(Name, Clauses, Options, Id) :-
    agent_create(clauses([(:- agent(Name, Options))|Clauses]), Id),
    wait_until(agent_property(Id, state(waiting)), 20).

%   As if the process had been killed: what it has written is what another finds.

copied(Dir, Copy) :-
    process_create(path(cp), ['-a', file(Dir), file(Copy)], [process(Pid)]),
    process_wait(Pid, exit(0)).

:- begin_tests(restored).

test(journal_holds_what_the_process_has_and_restores_it) :-
    no_leaks(with_tmp_dir(snapshot)).

snapshot(Dir) :-
    atom_concat(Dir, '/journal', Journal),
    atom_concat(Dir, '/copy', Copy),
    running(Journal, normal,
        ( capturing(life(Dir), _),
          wait_until(( agents(Agents), \+ memberchk(_-[running|_], Agents) ),
                     20),
          sync_changes,
          items(dumped, Before),
          items(stored, Stored),
          copied(Journal, Copy),
          host_stop(beta) )),
    forall(( filled(Kinds), member(Kind, Kinds) ),
           assertion(memberchk(Kind-_-_, Before))),
    assertion(Stored =@= Before),
    running(Copy, normal,
        ( items(dumped, After),
          wait_until(( agents(Again), Again =@= Agents ), 20),
          host_stop(beta) )),
    assertion(After =@= Before).

agents(Agents) :-
    findall(Id-[State, Facts, Goals],
            ( agent_property(Id, state(State)),
              agent_property(Id, facts(Facts)),
              agent_property(Id, goals(Goals)) ),
            Agents0),
    sort(Agents0, Agents).

%   The process has its id and its port again, not its number.

test(what_was_forgotten_is_not_restored,
     [ forall(forgotten(Kind, Setting, I, Add)), true(Kept =< 50) ]) :-
    with_settings([Setting=50],
        no_leaks(with_tmp_dir(kept(Kind, I, Add, Kept)))).

forgotten(left, typhon_outcomes:results, I,
          ( elsewhere(I, Id),
            results_keep(Id, [result(I)]) )).
forgotten(clone, typhon_outcomes:clones, I,
          ( elsewhere(I, Id), clone_born(parent, Id) )).
forgotten(birth, typhon_birth:births, I,
          ( elsewhere(I, Id),
            typhon_birth:remember(Id, birth(Id, hash, certificate, "00")) )).

elsewhere(I, Id) :-
    format(atom(Id), 'x.~d@far@127.0.0.1:1', [I]).

kept(Kind, I, Add, Kept, Dir) :-
    running(Dir, normal,
            forall(between(1, 150, I), Add)),
    running(Dir, normal,
            aggregate_all(count, durable_dump(Kind, _, _, _), Kept)).
test(process_keeps_its_id_and_its_port,
     [First, j] == [Second, Letter]) :-
    no_leaks(with_tmp_dir(itself(First, Second, Letter))).

itself(P1-A1, P2-A2, Letter, Dir) :-
    running(Dir, normal, is_process(P1, A1, S1)),
    running(Dir, normal, is_process(P2, A2, S2)),
    assertion(S2 > S1),
    sub_atom(P1, 0, 1, _, Letter).

is_process(Process, Address, Start) :-
    endpoint_process(Process),
    endpoint_address(Address),
    sync_changes,
    durable_item(endpoint, any, _, _, endpoint(_, Start, _, _)).

test(host_that_stops_beside_others_is_not_restored,
     [Hosts, Agents] == [[alpha], [stays]]) :-
    no_leaks(with_tmp_dir(beside(Hosts, Agents))).

beside(Hosts, Agents, Dir) :-
    running(Dir, normal,
        ( host_start(beta),
          resting(stays, [(main :- receive(_-never))], [], _),
          agent_create(clauses([ (:- agent(goes, [])),
                                 (main :- receive(_-never)) ]), Goes,
                       [host(beta)]),
          wait_until(agent_property(Goes, state(waiting)), 20),
          host_stop(beta) )),
    running(Dir, normal,
        ( findall(Host, host_property(Host, load(_)), Hosts),
          findall(Name,
                  ( agent_property(Id, state(_)),
                    atomic_list_concat([Name|_], '.', Id) ), Agents) )).

%   The predicate stays wrapped: threads execute it.

test(effects_of_a_step_and_its_next_goals_are_one_entry,
     [ setup(retractall(test_restored:entry(_))) ]) :-
    no_leaks(with_tmp_dir(one_entry)).

one_entry(Dir) :-
    wrap_predicate(typhon_committing:queue_entry(Changes), noted, Wrapped,
                   ( assertz(test_restored:entry(Changes)), Wrapped )),
    running(Dir, normal,
        ( resting(rests, [(main :- receive(_-never))], [], To),
          remote(alpha, leave(taken)),
          agent_create(clauses([ (:- agent(acts, [state([to/1])])),
                                 (main :- to(To1), leave(left), take(taken),
                                          send(To1, hello), sleep(0)) ]), A,
                       [facts([to(To)])]),
          agent_join(A, done, 20) )),
    findall(Entry, ( entry(Entry), memberchk(put(letter, _, _, _), Entry) ),
            [Step]),
    forall(member(Change, [put(agent, A, 0, _), put(tuple, alpha, _, _),
                           drop(tuple, alpha, _)]),
           assertion(memberchk(Change, Step))).

%   An agent sees at once what it leaves, others when it stops; what it takes is
%   gone at once.

test(facts_of_a_step_are_visible_to_others_at_its_end,
     Seen == [own([left]), others([]), after([left])]) :-
    no_leaks(with_tmp_dir(in_step(Seen))).

in_step([own(Own), others(Others), after(After)], Dir) :-
    running(Dir, normal,
        ( remote(alpha, leave(taken)),
          setup_call_cleanup(
              message_queue_create(_, [alias(restored_gate)]),
              ( agent_create(clauses([ (:- agent(acts, [])),
                                       (main :- leave(left), take(taken),
                                                findall(F, sense(F), Fs),
                                                gate(own(Fs)), sleep(0)),
                                       (gate(Own) :-
                                            thread_send_message(restored_gate,
                                                                Own),
                                            thread_get_message(restored_gate,
                                                               on)) ]), A),
                thread_get_message(restored_gate, own(Own)),
                facts(Others),
                thread_send_message(restored_gate, on),
                agent_join(A, done, 20),
                facts(After) ),
              message_queue_destroy(restored_gate)) )).

facts(Facts) :-
    remote(alpha, findall(F, sense(F), Facts)).

:- end_tests(restored).

                /*******************************
                *        UNITS OF WORK         *
                *******************************/

%   unit(How, Changes): a unit of work that makes Changes, and then succeeds,
%   fails or raises an error.  Changes are put(Key, Value), drop(Key), or
%   `enqueue`, which keeps those before.

random_units(Units) :-
    random_between(1, 12, Count),
    findall(unit(How, Changes),
            ( between(1, Count, _),
              random_member(How, [succeeds, succeeds, fails, raises]),
              random_between(0, 5, Length),
              findall(Change, ( between(1, Length, _), random_change(Change) ),
                      Changes) ),
            Units).

random_change(Change) :-
    random_between(1, 4, Key),
    random_between(1, 1000, Value),
    random_member(Change, [put(Key, Value), put(Key, Value), drop(Key),
                           enqueue]).

:- dynamic value/2.                     % Key, Value

:- durable(restored_value, Key, 0, Value, value(Key, Value)).

make(unit(How, Changes)) :-
    catch(ignore(unit_of_work(( forall(member(Change, Changes), change(Change)),
                                ends(How) ))),
          error(stop, _), true).

change(put(Key, Value)) :-
    name_of(Key, Name),
    durable_put(restored_value, Name, 0, Value).
change(drop(Key)) :-
    name_of(Key, Name),
    durable_drop(restored_value, Name, 0).
change(enqueue) :-
    enqueue_changes.

name_of(Key, Name) :-
    atom_concat(key, Key, Name).

ends(succeeds).
ends(fails) :-
    fail.
ends(raises) :-
    throw(error(stop, _)).

%   model(+Units, +Values0, -Values): what a restart finds.

model([], Values, Values).
model([unit(How, Changes)|Units], Values0, Values) :-
    kept(How, Changes, Kept),
    foldl(changed, Kept, Values0, Values1),
    model(Units, Values1, Values).

kept(succeeds, Changes, Changes) :-
    !.
kept(_, Changes, Kept) :-
    (   append(Kept0, [enqueue|Rest], Changes),
        \+ memberchk(enqueue, Rest)
    ->  Kept = Kept0
    ;   Kept = []
    ).

changed(enqueue, Values, Values).
changed(drop(Key), Values0, Values) :-
    name_of(Key, Name),
    delete(Values0, Name-_, Values).
changed(put(Key, Value), Values0, Values) :-
    changed(drop(Key), Values0, Values1),
    name_of(Key, Name),
    sort([Name-Value|Values1], Values).

%   sent(Item, Items): when Item was sent, the journal had Items.

:- dynamic sent/2.

:- multifile typhon_durable:committed/1.

typhon_durable:committed(Items) :-
    Items = [restored(_)|_],
    forall(member(Item, Items),
           ( values(Values), assertz(test_restored:sent(Item, Values)) )).

values(Values) :-
    findall(Key-Value, durable_item(restored_value, any, Key, _, Value),
            Values0),
    sort(Values0, Values).

units(Sync, Dir) :-
    findall(Units, ( between(1, 20, _), random_units(Units) ), All0),
    append(All0, All),
    running(Dir, Sync, forall(member(Unit, All), make(Unit))),
    retractall(value(_, _)),
    running(Dir, Sync,
        ( findall(Key-Value, value(Key, Value), Found0),
          sort(Found0, Found) )),
    retractall(value(_, _)),
    model(All, [], Expected),
    assertion(Found == Expected).

output(Sync, Dir) :-
    retractall(sent(_, _)),
    running(Dir, Sync,
        ( forall(between(1, 100, N),
                 ( change(put(1, N)),
                   send_after_commit(restored(N), now) )),
          wait_until(sent(restored(100), _), 20) )),
    findall(N, sent(restored(N), _), Ns),
    numlist(1, 100, Expected),
    assertion(Ns == Expected),
    forall(sent(restored(N), Values),
           ( memberchk(key1-Value, Values), assertion(Value >= N) )).

failing(Sync, Before, After, Dir) :-
    retractall(sent(_, _)),
    running(Dir, Sync,
        ( setup_call_cleanup(
              wrap_predicate(typhon_store:store_commit(_), restored, _,
                             throw(error(resource_error(journal_space), _))),
              capturing(( change(put(1, 1)),
                          send_after_commit(restored(1), now),
                          wait_until(was_printed(error, error(_, _)), 20),
                          catch(sync_changes, error(Formal, _), true) ), _),
              unwrap_predicate(typhon_store:store_commit/1, restored)),
          findall(N, sent(restored(N), _), Before),
          change(put(1, 2)),
          send_after_commit(restored(2), now),
          wait_until(sent(restored(2), [key1-2]), 20),
          sync_changes )),
    assertion(Formal == resource_error(journal_space)),
    findall(N, sent(restored(N), _), After).

synced(Sync, Dir) :-
    running(Dir, Sync,
        forall(between(1, 20, N),
               ( change(put(1, N)),
                 sync_changes,
                 with_mutex(typhon_commit, values(Values)),
                 assertion(Values == [key1-N]) ))).

numbered(First, Second, Dir) :-
    running(Dir, normal,
        ( forall(between(1, 30000, _), durable_number(_)),
          durable_number(First) )),
    flag(typhon_durable_number, _, 0),
    running(Dir, normal, durable_number(Second)).

:- begin_tests(units_of_work, [setup(set_random(seed(3)))]).

test(restart_finds_what_succeeded_and_nothing_else,
     [ forall(member(Sync, [normal, full, normal, normal, full])) ]) :-
    no_leaks(with_tmp_dir(units(Sync))).

test(output_follows_the_commit_of_all_changes_before_it,
     [ forall(member(Sync, [normal, full])) ]) :-
    no_leaks(with_tmp_dir(output(Sync))).

%   While commits fail nothing is sent; it is when they succeed again.

test(output_waits_while_commits_fail,
     [ forall(member(Sync, [normal, full])), Before-After == []-[1, 2] ]) :-
    no_leaks(with_tmp_dir(failing(Sync, Before, After))).

%   The answer to a hop, which the next frame takes along.

test(answer_that_is_sent_later_waits_for_the_commit, Written == 0) :-
    no_leaks(with_tmp_dir(answered_later(Written))).

answered_later(Written, Dir) :-
    running(Dir, normal,
        ( endpoint_address(Me),
          typhon_connection_manager:manager_connect(Me),
          typhon_session:session(self_server, Session),
          typhon_session:session_later_begin(Session),
          sync_changes,
          typhon_session:session_pending(Session, Before),
          with_mutex(typhon_commit,     % no other thread commits
                     ( change(put(1, 1)),
                       typhon_session:session_send_later(Session, bundle([])),
                       typhon_session:session_pending(Session, After) )),
          Written is After-Before,
          nb_delete(typhon_later) )).

test(sync_returns_after_the_commit, [ forall(member(Sync, [normal, full])) ]) :-
    no_leaks(with_tmp_dir(synced(Sync))).

test(change_that_no_caller_waits_for_is_committed_soon) :-
    no_leaks(with_tmp_dir(soon)).

soon(Dir) :-
    running(Dir, normal,
        ( change(put(1, 1)),
          wait_until(with_mutex(typhon_commit, values([key1-1])), 20) )).

test(numbers_grow_over_a_restart, true(Second > First)) :-
    no_leaks(with_tmp_dir(numbered(First, Second))).

:- end_tests(units_of_work).
