:- module(test_disposal, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(settings), [set_setting/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/tools/administration/properties), []).

/** <module> Agents that do not stop are reported, and ended by force

*Threading*: one test at a time.
*/

%   runaway(?Kind, -Clauses): goals that never reach an effect.

runaway(loops, [ (main :- lp), (lp :- lp) ]).
runaway(loops_in_the_machine,
        [ (main :- again), (again :- again), (again :- move(nowhere)) ]).
runaway(catches_all, [ (main :- lp),
                       (lp :- catch(lp(0), _, true), lp),
                       (lp(N) :- N1 is N+1, lp(N1)) ]).
runaway(waits, [ (main :- thread_self(Me),
                          thread_get_message(Me, '$never')) ]).
runaway(cleans_up, [ (main :- setup_call_cleanup(true, lp, true)),
                     (lp :- lp) ]).

%   running_for(+Agent, +Seconds)

running_for(Agent, Seconds) :-
    agent_property(Agent, busy(Busy)),
    Busy >= Seconds.

start(Kind, Agent) :-
    start(Kind, Agent, []).

start(Kind, Agent, Options) :-
    runaway(Kind, Clauses),
    create(Clauses, Agent, Options),
    wait_until(running_for(Agent, 0.02), 10).

%   ending_when_asked(+Clauses, -Agent, :Goal): Agent, which runs until over/0
%   is true, is running; Goal gives it an order, and then over/0 becomes true.

:- meta_predicate ending_when_asked(+, -, 0).

ending_when_asked(Clauses, Agent, Goal) :-
    create([ (over :- sense(over)) |Clauses], Agent),
    wait_until(running_for(Agent, 0.02), 10),
    setup_call_cleanup(
        thread_create(( wait_until(typhon_mailbox:agent_ordered(Agent), 10),
                        remote(alpha, leave(over)) ), Ends),
        once(Goal),
        thread_join(Ends, Ended)),
    assertion(Ended == true).

gone(Agent) :-
    \+ agent_property(Agent, state(_)).

:- meta_predicate disposing(+, 0).

%   disposing(+Seconds, :Goal): on alpha; agents have so many seconds to stop.

disposing(Seconds, Goal) :-
    with_settings([typhon_disposal:heed_seconds=Seconds],
                  with_hosts([alpha], Goal)).

:- begin_tests(disposal).

test(running_agent_is_reported, Ms == [warning-typhon(runs_on(A, 0.1))]) :-
    disposing(0.1, ( start(loops, A),
                     capturing(agent_dispose(A), Ms),
                     agent_property(A, state(running)),
                     agent_dispose(A, [force(0)]) )).

%   ends_in_time(-Clauses, -Outcome): over/0 becomes true when it has the order.

ends_in_time([ (main :- busy, sleep(100)), (busy :- over -> true ; busy) ],
             disposed).
ends_in_time([(main :- over -> true ; main)], done).

test(waits_for_an_agent_that_ends, [ forall(ends_in_time(Clauses, Outcome)),
                                     Ms-O == []-Outcome ]) :-
    disposing(60, ( ending_when_asked(Clauses, A,
                                      capturing(agent_dispose(A), Ms)),
                    gone(A),
                    agent_join(A, O, 5) )).
test(agent_that_raises_during_disposal) :-
    disposing(60, ( ending_when_asked([(main :- over -> throw(oops) ; main)],
                                      A, capturing(agent_dispose(A), Ms)),
                    \+ memberchk(warning-typhon(runs_on(_, _)), Ms),
                    gone(A) )).
test(disposal_in_a_cleanup_handler, Ms == [warning-typhon(runs_on(A, 0.3))]) :-
    disposing(0.3, ( start(loops, A),
                     capturing(setup_call_cleanup(true, true,
                                                  agent_dispose(A)), Ms),
                     agent_dispose(A, [force(0)]) )).
test(disposing_agent_does_not_wait, Ms == []) :-
    disposing(60, ( start(loops, A),
                    capturing(( create([ (main :- s(X),
                                                  typhon:agent_dispose(X)) ],
                                       B, [facts([s(A)])]),
                                joined(B, done) ), Ms),
                    agent_dispose(A, [force(0)]) )).
test(agent_that_disposes_of_itself, Ms == []) :-
    with_hosts([alpha],
               capturing(( create([ (main :- self(X), typhon:agent_dispose(X),
                                             sleep(100)) ], A),
                           joined(A, disposed) ), Ms)).

test(force, [forall(runaway(Kind, _)), O == disposed]) :-
    with_hosts([alpha],
               ( start(Kind, A),
                 agent_dispose(A, [force(0.1)]),
                 gone(A),
                 host_property(alpha, load(0)),
                 agent_join(A, O, 5) )).
test(negative_seconds_are_zero, O == disposed) :-
    with_hosts([alpha],
               ( start(waits, A),
                 agent_dispose(A, [force(-1000)]),
                 agent_join(A, O, 0) )).
test(agent_that_stops_in_time_is_not_forced, Ms == []) :-
    with_hosts([alpha],
               ( create([(main :- sleep(0.01), main)], A),
                 capturing(agent_dispose(A, [force(10)]), Ms),
                 gone(A) )).

%   The process from which an agent was under way answers so if it cannot
%   forward the order.

test(only_its_end_counts_as_the_end,
     [ forall(member(Answer, [none, error(timeout_error(order, agent))])) ]) :-
    with_hosts([alpha],
               ( create([ (main :- over -> true ; main),
                          (over :- sense(over)) ], A),
                 wait_until(running_for(A, 0.02), 10),
                 thread_create(agent_dispose(A, [force(1000)]), T),
                 urged(A, 1, Asker),
                 typhon_questions:question_answered(Asker, Answer),
                 urged(A, 2, _),
                 remote(alpha, leave(over)),
                 thread_join(T, true),
                 gone(A) )).

urged(Agent, Times, Asker) :-
    wait_until(( typhon_mailbox:agent_orders(Agent, Orders),
                 findall(By, member(asked(end, By), Orders), Askers),
                 length(Askers, Times) ), 10),
    last(Askers, Asker).

test(no_choice_point_is_left, Det == [true,true]) :-
    disposing(0.1, ( start(loops, A),
                     capturing(call_cleanup(agent_dispose(A), D1 = true), _),
                     call_cleanup(agent_dispose(A, [force(0)]), D2 = true) )),
    Det = [D1,D2].
test(resting_agent_is_gone_at_once) :-
    with_hosts([alpha],
               ( create([(main :- receive(_))], A),
                 wait_state(A, waiting),
                 agent_dispose(A, [force(1 000 000)]),
                 gone(A) )).
test(constantly_hopping_agent) :-
    with_hosts([alpha,beta],
               ( create([(main :- move(beta), move(alpha), main)], A),
                 agent_dispose(A, [force(0)]),
                 gone(A) )).
test(host_with_limited_concurrency, O == done) :-
    with_hosts([alpha-[concurrency(1)]],
               ( start(loops, A),
                 create([main], B),
                 agent_join(B, timeout, 0.1),
                 agent_dispose(A, [force(0)]),
                 joined(B, O) )).

%   Other busy agents on the same host continue and end.

test(other_agents_are_not_disturbed, Os == [done,done,done]) :-
    with_hosts([alpha],
               ( findall(B, ( member(_, [1,2,3]),
                              create([ (main :- count(2000000)),
                                       count(0),
                                       (count(N) :- N > 0, N1 is N-1,
                                                    count(N1)) ], B) ),
                         Bs),
                 findall(A, ( member(K, [loops,catches_all,waits]),
                              start(K, A) ), As),
                 forall(member(A, As), agent_dispose(A, [force(0)])),
                 maplist(gone, As),
                 findall(O, ( member(B, Bs), joined(B, O) ), Os) )).
test(many_disposals_at_once) :-
    with_hosts([alpha],
               ( findall(A, ( between(1, 6, _), start(loops, A) ), As),
                 findall(T, ( member(A, As),
                              thread_create(agent_dispose(A, [force(0)]),
                                            T) ), Ts),
                 forall(member(T, Ts), thread_join(T, true)),
                 maplist(gone, As),
                 create([main], B), joined(B, done) )).
test(result_before_the_disposal_is_kept, X == 1) :-
    with_hosts([alpha],
               ( create([ (main :- result(1), lp), (lp :- lp) ], A),
                 wait_until(running_for(A, 0.02), 10),
                 agent_dispose(A, [force(0)]),
                 agent_result(A, X, 5) )).
%   A caller that has stopped waiting does not keep the next from its answer.

test(waiting_callers_get_the_outcome,
     [ forall(member(Before, [true, agent_dispose(A)])),
       true(E = existence_error(agent, _)) ]) :-
    disposing(0.01, ( start(loops, A),
                      capturing(Before, _),
                      clone_in_vain(A, E) )).

clone_in_vain(A, E) :-
    thread_self(Me),
    thread_create(( catch(agent_clone(A, _), error(F, _), true),
                    thread_send_message(Me, cloned(F)) ), T),
    wait_until(( typhon_mailbox:agent_orders(A, Orders),
                 memberchk(asked(clone, _), Orders) ), 5),
    agent_dispose(A, [force(0)]),
    thread_get_message(cloned(E)),
    thread_join(T, true).

%   Virtual time continues for the others.

test(virtual_time, Now-O == 100.0-done) :-
    with_hosts([alpha-[clock(virtual)]],
               ( create([(main :- sleep(100))], B),
                 create([ (main :- sleep(1), lp), (lp :- lp) ], A),
                 thread_create(agent_join(B, _, inf), T),
                 wait_until(running_for(A, 0.02), 10),
                 agent_dispose(A, [force(0.1)]),
                 gone(A),
                 thread_join(T, true),
                 agent_join(B, O, 10),
                 remote(alpha, now(Now)) )).
%   looping(-Agent, -Thread): in virtual time, while Thread waits for its end.

looping(Agent, Thread) :-
    create([ (main :- lp), (lp :- lp) ], Agent),
    thread_create(agent_join(Agent, _, inf), Thread),
    wait_until(running_for(Agent, 0.02), 10).

test(warning_in_virtual_time, Ms == [warning-typhon(runs_on(A, 0.1))]) :-
    with_settings([typhon_disposal:heed_seconds=0.1],
                  with_hosts([alpha-[clock(virtual)]],
                             ( looping(A, T),
                               capturing(agent_dispose(A), Ms),
                               agent_dispose(A, [force(0)]),
                               thread_join(T, true) ))).
test(virtual_host_is_stopped, O == done) :-
    with_settings([typhon_hosting:stop_seconds=0.1],
                  with_hosts([alpha-[clock(virtual)],beta-[clock(virtual)]],
                             ( looping(_, T),
                               host_stop(alpha),
                               thread_join(T, true),
                               create([(main :- sleep(5))], B, [host(beta)]),
                               agent_join(B, O, 10) ))).

%   B rests, and so ends first; A still runs, and sends it a message.

test(no_false_warning_during_host_stop, Ms == []) :-
    setup_call_cleanup(
        message_queue_create(Queue, [alias(disposal_test)]),
        with_settings([typhon_hosting:stop_seconds=60],
                      with_hosts([alpha], capturing(says_in_vain, Ms))),
        message_queue_destroy(Queue)).

says_in_vain :-
    create([(main :- receive(_))], B),
    wait_state(B, waiting),
    create([ (main :- say, sleep(60)),
             (say :- thread_get_message(disposal_test, ended, [timeout(50)]),
                     send(B, hello),
                     thread_send_message(disposal_test, said)) ], A),
    wait_until(running_for(A, 0.02), 20),
    thread_create(host_stop(alpha), T),
    joined(B, disposed),
    thread_send_message(disposal_test, ended),
    thread_get_message(disposal_test, said, [timeout(20)]),
    thread_join(T, true).

test(invalid_option,
     [ forall(member(Option-Error, [ soon-domain_error(dispose_option, soon),
                                     force(now)-type_error(number, now) ])),
       error(Error) ]) :-
    with_hosts([alpha], ( create([(main :- receive(_))], A),
                          agent_dispose(A, [Option]) )).
test(no_such_agent, error(existence_error(agent, _))) :-
    with_hosts([alpha], ( create([main], A), joined(A, done),
                          agent_dispose(A, [force(1)]) )).

:- end_tests(disposal).

:- begin_tests(disposal_elsewhere).

%   The agent moves to b by itself and runs on there; other agents there
%   continue.

test(force, True-O == disposed-done) :-
    with_peers([a, b],
               ( peer_host(b, B),
                 runaway_to(B, Id),
                 peer_agent(b, [ (:- agent(o)),
                                 (main :- receive(_-go)) ], [], Other),
                 peer_do(a, agent_dispose(Id, [force(0.1)])),
                 peer_do(a, agent_join(Id, True, 10)),
                 peer_do(b, \+ agent_here(Id)),
                 peer_do(b, agent_send(Other, go)),
                 peer_do(b, agent_join(Other, O, 10)),
                 % the reading thread has handed its connection over
                 again(B) )).
test(warning, true(sub_string(All, _, _, _, "runs on"))) :-
    with_peers([a, b],
               ( peer_host(b, B),
                 runaway_to(B, Id),
                 peer_do(a, set_setting(typhon_disposal:heed_seconds, 0.2)),
                 peer_do(a, agent_dispose(Id)),
                 peer_messages(a, Lines),
                 atomics_to_string(Lines, All),
                 peer_do(a, agent_dispose(Id, [force(0)])) )).

%   The home of the agent would not answer.

test(agent_that_ends_during_a_listing_is_not_queried_elsewhere, Found == []) :-
    with_peers([a, b],
               ( peer_host(b, B),
                 peer_agent(a, [ (:- agent(r)),
                                 (main :- move(B)),
                                 on_message(_, _) ], [], Id),
                 peer_do(b, wait_until(agent_property(Id, state(resident)), 10)),
                 peer_signal(a, stop),
                 peer_do(b, \+ \+ prolog_wrap:wrap_predicate(
                                typhon_questions:agent_ask_here(I, _, _, _),
                                ends, Asked,
                                ( typhon:agent_dispose(I), Asked ))),
                 peer_do(b, findall(A, agent_property(A, state(_)), Found)),
                 peer_signal(a, cont) )).

%   runaway_to(+Host, -Id): Id runs on Host, of the process b.  Before its move
%   it may be busy on a, while the code that runs it is loaded.

runaway_to(Host, Id) :-
    peer_agent(a, [ (:- agent(r)),
                    (main :- move(Host), lp),
                    (lp :- lp) ], [], Id),
    peer_do(b, wait_until(( agent_here(Id),
                            agent_property(Id, busy(S)),
                            S > 0.05 ), 10)).

again(B) :-
    peer_agent(a, [ (:- agent(r)), (main :- move(B)) ], [], Id),
    peer_do(a, agent_join(Id, done, 10)).

:- end_tests(disposal_elsewhere).

:- begin_tests(top_level).

%   Text typed before the interrupt is read after it.

test(typed_ahead_input_is_kept,
     [ forall(member(End, ["agent_dispose(A, [force(0)])",
                           "host_stop(alpha)"])),
       Said == "typed ahead" ]) :-
    project_file('prolog/typhon.pl', Typhon),
    with_swipl(['-q', '-f', none, Typhon], _, In, Out,
               ( format(In, "host_start(alpha), \c
agent_create(clauses([(:-agent(r)), (main:-lp), (lp:-lp)]), A), \c
sleep(0.1), ~s.~nwriteln('typed ahead').~n", [End]),
                 flush_output(In),
                 set_stream(Out, timeout(30)),
                 repeat,
                 read_line_to_string(Out, Said),
                 memberchk(Said, ["typed ahead", end_of_file]) )).

:- end_tests(top_level).

:- begin_tests(busy_time).

test(busy_time_of_a_running_agent) :-
    with_hosts([alpha],
               ( start(loops, A),
                 agent_property(A, busy(S1)),
                 wait_until(running_for(A, 0.3), 10),
                 S1 < 5,
                 with_output_to(string(Table), agents),
                 sub_string(Table, _, _, _, "running, "),
                 agent_dispose(A, [force(0)]) )).
test(busy_time_of_a_resting_agent, fail) :-
    with_hosts([alpha],
               ( create([(main :- receive(_))], A), wait_state(A, waiting),
                 agent_property(A, busy(_)) )).

:- end_tests(busy_time).
