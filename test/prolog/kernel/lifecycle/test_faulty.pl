:- module(test_faulty, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

/** <module> Agents that fail or raise an error can be inspected

They report the goal, are kept unchanged, accept orders, and are resumed.

*Threading*: tests run one at a time.
*/

%   with_program(+Lines, -File, :Goal): Lines are an agent file trip.pl.

:- meta_predicate with_program(+, -, 0).

with_program(Lines, File, Goal) :-
    with_tmp_dir(Dir, ( directory_file_path(Dir, 'trip.pl', File),
                        atomic_list_concat(Lines, '\n', Text),
                        write_file(File, '~w~n', [Text]),
                        call(Goal) )).

%   saved(+Agent, -Copy): by way of a restore point.

saved(Agent, Copy) :-
    with_tmp_dir(Dir, ( directory_file_path(Dir, 'point.txt', File),
                        agent_save(Agent, File),
                        agent_load(File, Copy) )).

%   prints(+Lines, -Text): the message about an agent of that program, after its
%   id.

prints(Lines, Text) :-
    with_program([':- agent(trip, []).'|Lines], File,
                 with_hosts([alpha,beta],
                            capturing(( agent_create(File, A,
                                                     [host(alpha)]),
                                        joined(A, _) ), Messages))),
    once(printed_text(Messages, Text)).

printed_text(Messages, Text) :-
    member(Kind-Message, Messages),
    memberchk(Kind, [warning,error]),
    Message = typhon(_),
    !,
    message_text(Message, Line),
    sub_string(Line, Before, _, _, " at "),
    sub_string(Line, Before, _, 0, Text).

%   faulty(+Clauses, -Agent): an agent that has become faulty on alpha.

faulty(Clauses, Agent) :-
    create(Clauses, Agent, [host(alpha)]),
    joined(Agent, Outcome),
    ( Outcome == failed -> true ; Outcome = raised(_) ).

%   on(+Hosts, :Goal): messages are not printed.

:- meta_predicate on(+, 0).

on(Hosts, Goal) :-
    with_hosts(Hosts, capturing(Goal, _)).

stands(Agent, Host) :-
    address(Host, Address),
    agent_property(Agent, host(Address)).

load(Host, Load) :-
    host_property(Host, load(Load)).

%   printed(-Behaviour, -Lines, -Text): the message about an agent of a program
%   that begins with trip/0 and has Lines from its second line on has Text.

printed(error_in_a_native_goal,
        [ '', 'main :-', '    move(beta),', '    add(1, X),', '    log(X).',
          'add(X, Y) :-', '    Y is X+z.' ],
        " at beta (hop 1): is/2: Arithmetic: evaluable z/0 does not exist, \c
         in add/2 (trip.pl:7), called from main/0 (trip.pl:3)").
printed(error_deep_in_native_goals,
        [ 'main :- move(beta), sum([1], S), log(S).',
          'sum([N|_], S) :- add(N, S), log(S).',
          'add(X, Y) :- integer(X), Y is X+z.' ],
        ", in add/2 (trip.pl:4), called from sum/2 (trip.pl:3)").
printed(failing_goal,
        [ 'main :- tour([beta,alpha]), log(end).',
          'tour([H|Hs]) :- move(H), member(q, [a]), tour(Hs).',
          'tour([]) :- move(alpha), log(x), member(q, [a]).' ],
        " at beta (hop 1): failed: the goal that failed last was \c
         member(q, [a]), in tour/1 (trip.pl:3), called from main/0 \c
         (trip.pl:2)").
printed(no_clause_matches,
        [ 'main :- log(a), go(c), log(b).', 'go(a) :- move(beta).',
          'go(b) :- move(alpha).' ], ", in main/0 (trip.pl:2)").
printed(all_clauses_of_main_fail, [ '', 'main :-', '    X = 1, X > 2.' ],
        " at alpha (hop 0): failed: the goal that failed last was main, in \c
         main/0 (trip.pl:3)").
printed(condition_without_else,
        ['', 'main :- ( member(q, [a]) -> move(beta) ), log(x).' ],
        " at alpha (hop 0): failed: the goal that failed last was \c
         ( member(q, [a]) -> ... ) without else, in main/0 (trip.pl:3)").
printed(receive_times_out, ['main :- receive(user-_, 0.01), log(x).' ],
        " at alpha (hop 0): failed: the goal that failed last was \c
         receive(user-_, 0.01), in main/0 (trip.pl:2)").
printed(unknown_procedure_has_a_hint, ['main :- log(a), sleep(1, now).'],
        " at alpha (hop 0): Unknown procedure: sleep/2 (did you mean \c
         sleep/1? If not, a place or a payload must offer it), in main/0 \c
         (trip.pl:2)").
printed(unbound_argument_of_a_control_predicate, ['main :- move(_).'],
        " at alpha (hop 0): Arguments are not sufficiently instantiated, at \c
         move(_), in main/0 (trip.pl:2)").
printed(refused_move, ['main :- log(a), move(atlantis), log(b).'],
        ", in main/0 (trip.pl:2)").
printed(inside_catch_and_condition,
        [ 'main :- catch(( p(_), move(beta) -> true ; true ), ball, true).',
          'p(X) :- atom_length(X, _), move(alpha).' ],
        ", in p/1 (trip.pl:3), called from main/0 (trip.pl:2)").

:- begin_tests(fault_locations).

test(printed, [ forall(printed(_, Lines, Expected)),
                true(sub_string(Text, _, _, 0, Expected)) ]) :-
    prints(Lines, Text0),
    in_words_of_now(Text0, Text).
test(hint_is_in_the_outcome,
     [ forall(member(Goal-Words,
                     [ hepler(1)-'did you mean helper/1? If not, a place or \c
                                  a payload must offer it',
                       agent_create(x, _, [])
                       -':- use_module(library(typhon))' ])),
       true(sub_atom(Hint, _, _, _, Words)) ]) :-
    on([alpha],
       ( faulty([(main :- Goal), helper(_)], A),
         joined(A, raised(error(existence_error(procedure, _),
                                context(_, Hint)))) )).
test(clause_in_an_included_file, true(P = inc:2)) :-
    with_program([ ':- agent(trip, []).', ':- include(inc).',
                   'main :- p.' ], File,
                 ( file_directory_name(File, Dir),
                   directory_file_path(Dir, 'inc.pl', Inc),
                   write_file(Inc, "~np :- move(beta), fail.~n", []),
                   on([alpha,beta],
                      ( agent_create(File, A, [host(alpha)]),
                        joined(A, failed),
                        agent_property(A, fault(fault(_, _, P0, _))) )) )),
    P0 = File1:Line,
    file_base_name(File1, Base),
    file_name_extension(Name, pl, Base),
    P = Name:Line.
test(clause_number_where_there_is_no_file,
     true(F == fault(failed, fail, p/0:2, B))) :-
    on([alpha,beta],
       ( address(beta, B),
         faulty([ (main :- p), (p :- s(x), move(alpha)),
                  (p :- move(beta), fail) ], A),
         agent_property(A, fault(F)) )).
test(healthy_agent_has_no_fault, fail) :-
    on([alpha], ( create([on_message(_, _)], A),
                  agent_property(A, fault(_)) )).
test(goals_with_large_terms_are_kept, true(G == [foo(L),s(L)])) :-
    numlist(1, 5000, L),
    on([alpha,beta],
       ( faulty([foo(x), (main :- move(beta), numlist(1, 5000, X), foo(X),
                                  s(X))], A),
         agent_property(A, goals(G)) )).

:- end_tests(fault_locations).

%   9.0.4 and 10.1 do not use the same words.

in_words_of_now(Text0, Text) :-
    split_string(Text0, "", "\n", [Text1]),
    re_evaluable(Text1, Text).

re_evaluable(Text0, Text) :-
    sub_string(Text0, B, _, A, "`z/0' is not a function"),
    !,
    sub_string(Text0, 0, B, _, Before),
    sub_string(Text0, _, A, 0, After),
    atomics_to_string([Before,"evaluable z/0 does not exist",After],
                      Text).
re_evaluable(Text0, Text) :-
    split_string(Text0, "`'", "", Parts),
    atomics_to_string(Parts, Text).

:- begin_tests(faulty_agents).

test(goals_begin_with_the_failed_one,
     true(G-S == [s(2),foo]-[s(1)])) :-
    on([alpha,beta],
       ( faulty([s(1), (main :- move(beta), s(2), foo), foo], A),
         agent_property(A, goals(G)),
         facts(A, S) )).
%   Often enough that its home is not notified before.

test(resumed_after_a_fact_was_added) :-
    on([alpha,beta],
       forall(between(1, 500, _),
              ( faulty([(main :- move(beta), s(2), move(alpha))], A),
                agent_change(A, facts([s(2)])),
                facts(A, [s(2)]),
                agent_resume(A),
                joined(A, done) ))).
test(resumed_with_another_program, true(O == done)) :-
    on([alpha,beta],
       ( faulty([(main :- p, move(beta)), (p :- _ is a+1)], A),
         agent_change(A, program(clauses([ (:- agent(new, [state([t/1])])),
                                           main, (p :- \+ t(_)) ]))),
         agent_property(A, program(new)),
         agent_resume(A),
         joined(A, O) )).
test(failed_move_is_retried, true(O == done)) :-
    on([alpha],
       ( faulty([(main :- move(beta))], A),
         host_start(beta),
         agent_resume(A),
         joined(A, O),
         host_stop(beta) )).
test(fails_repeatedly, true(Os == [failed,failed,failed])) :-
    on([alpha],
       ( faulty([(main :- receive(_-x, 0), s(1))], A),
         findall(O, ( between(1, 3, _), agent_resume(A), joined(A, O) ),
                 Os) )).
test(join_after_resume_waits, true(O1-O2 == timeout-done)) :-
    on([alpha],
       ( faulty([(main :- s(1), receive(_))], A),
         agent_change(A, facts([s(1)])),
         agent_resume(A),
         agent_join(A, O1, 0.1),
         agent_send(A, go),
         joined(A, O2) )).
test(moved_agent_stays_faulty) :-
    on([alpha,beta],
       ( faulty([(main :- move(alpha), s(1))], A),
         agent_move(A, beta),
         wait_until(( stands(A, beta), state_of(A, faulty(failed)) ), 10),
         agent_property(A, fault(fault(failed, s(1), _, H))),
         address(alpha, H),
         wait_until(maplist(load, [alpha,beta], [0,0]), 10),
         agent_dispose(A),
         joined(A, failed),
         \+ agent_property(A, state(_)),
         load(beta, 0) )).
test(refused_move_of_a_faulty_agent, true(L == 0)) :-
    on([alpha,beta-[capacity(0)]],
       ( faulty([(main :- move(alpha), s(1))], A),
         agent_move(A, beta),
         wait_until(( load(alpha, 0), state_of(A, faulty(failed)) ), 10),
         stands(A, alpha),
         load(alpha, L) )).
test(copies_of_a_faulty_agent_are_faulty, true(Os == [failed,failed])) :-
    on([alpha],
       ( faulty([(main :- receive(_, 0), s(1))], A),
         agent_clone(A, B),
         saved(A, C),
         maplist(joined, [B,C], Os),
         forall(member(X, [A,B,C]),
                ( wait_until(state_of(X, faulty(failed)), 10),
                  agent_property(X, goals([receive(_, 0),s(1)])) )),
         wait_until(load(alpha, 0), 10),
         agent_resume(C),
         joined(C, failed) )).
test(place_in_a_restore_point, true(Line == 2)) :-
    with_program([':- agent(trip, []).', 'main :- receive(_, 0).'], File,
                 on([alpha],
                    ( agent_create(File, A), joined(A, failed),
                      saved(A, B),
                      joined(B, failed),
                      agent_resume(B),
                      joined(B, failed),
                      agent_property(B, fault(fault(_, _, _:Line, _))) ))).
test(mail_is_kept_for_a_faulty_agent, true(M-O == [user-1,user-2]-done)) :-
    on([alpha],
       ( faulty([(main :- s(1), receive(_-1), receive(_-2))], A),
         maplist(agent_send(A), [1,2]),
         agent_property(A, mailbox(M)),
         agent_change(A, facts([s(1)])),
         agent_resume(A),
         joined(A, O) )).
test(mail_of_a_faulty_agent_is_bounded, true(M-W == [user-1,user-2]-1)) :-
    with_settings([typhon_creation:faulty_mail=2],
        with_hosts([alpha],
                   capturing(( faulty([(main :- s(1))], A),
                               maplist(agent_send(A), [1,2,3,4]),
                               agent_property(A, mailbox(M)) ), Told))),
    aggregate_all(count, member(_-typhon(mailbox_full(_, 2)), Told), W).
test(faulty_agent_takes_no_capacity, true(O == done)) :-
    on([alpha-[capacity(1)]],
       ( faulty([(main :- receive(_, 0))], _),
         create([main], B), joined(B, O) )).
%   invalid(-Agent, -Order, -Error): Agent is resident.

invalid(A, agent_resume(A), permission_error(resume, agent, A)).
invalid(_, agent_resume(foo), existence_error(agent, foo)).
invalid(A, agent_change(A, age(3)), domain_error(agent_change, age(3))).
invalid(A, agent_change(A, facts([p(2)])),
        permission_error(attach, procedure, p/1)).
invalid(A, agent_change(A, program(clauses([(:- agent(new)), main, s(2)]))),
        permission_error(attach, procedure, s/1)).

test(invalid_order, [forall(invalid(A, Order, Error)), error(Error)]) :-
    on([alpha], ( create([on_message(_, _), p(1), s(1)], A),
                  wait_state(A, resident),
                  Order )).
test(resume_running_agent, error(permission_error(resume, agent, _))) :-
    on([alpha], ( create([(main :- sleep(0.01), main)], A),
                  agent_resume(A) )).
test(healthy_agent_is_changed, true(F == [s(new),s(old)])) :-
    on([alpha], ( create([s(old), on_message(_, x)], A),
                  agent_change(A, program(clauses(
                      [ (:- agent(new, [state([s/1])])),
                        (on_message(_, x) :- asserta(s(new))) ]))),
                  agent_send(A, x),
                  wait_until(fact_of(A, s(new)), 10),
                  facts(A, F) )).
test(goals_of_a_waiting_agent_survive_a_change_of_program,
     true(Gs-F =@= [receive(_-go),p(1),p(2),receive(_-end)]-[s(1),s(2)])) :-
    on([alpha], ( create([ (main :- receive(_-go), p(1), p(2),
                                    receive(_-end)),
                           p(_) ], A),
                  wait_until(agent_property(A, state(waiting)), 10),
                  agent_property(A, goals(Gs)),
                  agent_change(A, program(clauses(
                      [ (:- agent(new, [state([s/1])])),
                        main, (p(X) :- assertz(s(X))) ]))),
                  agent_send(A, go),
                  wait_until(fact_of(A, s(2)), 10),
                  facts(A, F) )).
test(order_before_the_end_is_executed, true(O == failed)) :-
    on([alpha,beta],
       setup_call_cleanup(
           message_queue_create(Queue, [alias(queue_of_test)]),
           ( create([(main :- thread_get_message(queue_of_test, _), fail)], A,
                    [host(alpha)]),
             agent_move(A, beta),
             thread_send_message(Queue, go),
             joined(A, O),
             wait_until(( stands(A, beta), load(beta, 0) ), 10) ),
           message_queue_destroy(Queue))).

:- end_tests(faulty_agents).

:- begin_tests(printable_outcomes).

test(term_that_cannot_travel,
     [ forall(member(Goal-Begin,
                     [ freeze(X, true)-'an attributed variable (freeze/2)',
                       current_output(X)-'a stream (' ])),
       true(sub_atom(Words, 0, _, _, Begin)) ]) :-
    on([alpha,beta],
       ( faulty([(main :- Goal, move(beta), s(X))], A),
         joined(A, raised(error(type_error(mobile_term, Words), _))) )).
test(cyclic_term,
     true(E-Gs == type_error(mobile_term, 'a cyclic term')-
                  [move(beta), s(1, 'a cyclic term')])) :-
    on([alpha,beta],
       ( faulty([(main :- X = f(X, 1), move(beta), s(1, X))], A),
         joined(A, raised(error(E, _))),
         agent_property(A, goals(Gs)) )).
test(ball_with_an_unprintable_term,
     true(E-Gs == oops(a, 'a cyclic term', b)-[main])) :-
    on([alpha],
       ( faulty([(main :- X = [1|X], throw(oops(a, X, b)))], A),
         joined(A, raised(E)),
         agent_property(A, goals(Gs)) )).
test(error_with_an_unprintable_term,
     true(E == type_error(expression, 'a cyclic term'))) :-
    on([alpha],
       ( faulty([(main :- X = f(X), _ is X)], A),
         joined(A, raised(error(E, _))) )).

:- end_tests(printable_outcomes).

:- begin_tests(failing_on_message).

after_mail(Clauses, Message, Told) :-
    with_hosts([alpha,beta],
               capturing(( create(Clauses, A, [host(alpha)]),
                           wait_state(A, resident),
                           agent_send(A, Message),
                           wait_until(was_printed(warning, _), 10),
                           wait_state(A, resident) ), Told)).

test(no_clause_for_the_message,
     true(T = [warning-typhon(message_failed(_, user,
                                              ask))])) :-
    after_mail([on_message(_, say)], ask, T).
test(failing_clause,
     [ forall(member(Clauses-Place,
                     [ [ on_message(_, say),
                         (on_message(_, ask(X)) :- s(X), move(beta)) ]-2,
                       [(on_message(_, ask(X)) :- integer(X), s(X), true)]
                       -1 ])),
       true(Text == Expected) ]) :-
    after_mail(Clauses, ask(1), T),
    once(printed_text(T, Text)),
    format(string(Expected),
           " at alpha (hop 0): on_message/2 for ask(1) from user failed: \c
            the goal that failed last was s(1), in on_message/2, clause ~d~n",
           [Place]).

:- end_tests(failing_on_message).

                /*******************************
                *   STEPS THAT ARE NOT DONE    *
                *******************************/

%   While broken/0 is true, the engine that replaces the machine fails.

:- dynamic broken/0.

:- multifile typhon_turn:engine/3.

typhon_turn:engine(_, _, test_faulty:broken_engine) :-
    broken.

:- public broken_engine/4.

broken_engine(_, _, _, _) :-
    fail.

broken_once(Agent, Error, Goals) :-
    setup_call_cleanup(
        assertz(broken),
        ( faulty([(main :- true)], Agent),
          joined(Agent, raised(error(Error, _))),
          agent_property(Agent, goals(Goals)) ),
        retractall(broken)).

:- begin_tests(incomplete_steps).

test(agent_is_faulty_and_reported,
     true(Told-Error-Goals == true-step_not_completed-[main])) :-
    with_hosts([alpha], capturing(broken_once(A, Error, Goals), Messages)),
    ( member(error-typhon(faulty(A, _, _)), Messages) -> Told = true
    ; Told = Messages
    ).
test(agent_runs_when_it_is_resumed, Outcome == done) :-
    on([alpha],
       ( broken_once(A, _, _),
         agent_resume(A),
         wait_until(\+ agent_property(A, host(_)), 10),
         joined(A, Outcome) )).

test(fault_that_a_program_makes_up_is_an_error_of_the_agent,
     true(Error == domain_error(fault, x))) :-
    on([alpha], ( faulty([(main :- '$fault'(x))], A),
                  joined(A, raised(error(Error, _))) )).

:- end_tests(incomplete_steps).
