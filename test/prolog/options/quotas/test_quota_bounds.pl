:- module(test_quota_bounds, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/quotas), []).
:- use_module(library(typhon/options/quotas/quota_table),
              [quota/3, quota_shared/4, quotas_drop/1, quotas_put/3]).

/** <module> Each quota is exact: at its bound an act is allowed, not beyond

Acts are counted for agents that are only on record: `a1` and `a2` of the owner
`a`, and `b` of the owner `b`, on the host `h`.

*Threading*: one test at a time.
*/

:- meta_predicate with_quotas(+, 0).

with_quotas(Quotas, Goal) :-
    setup_call_cleanup(
        ( quotas_put(h, Quotas, _),
          forall(member(Id-Owner, [a1-a,a2-a,b-b]),
                 assertz(typhon_quota_agents:admitted(Id, h, Owner, inf))) ),
        once(Goal),
        ( retractall(typhon_quota_agents:admitted(_, h, _, _)),
          typhon_usage:usage_forget(h),
          quotas_drop(h) )).

%   act(?What, -Act): What counts Act, as it happens in a second.

act(messages, send(x)).
act(log, log(x)).
act(facts, leave(x)).
act(facts, emit(x)).
act(hops, move).
act(calls(p/1), service(p/1)).

quota_of(agent, calls(PI), N, calls(PI, N)) :- !.
quota_of(agent, What, N, Quota) :- !, Quota =.. [What,N].
quota_of(Whose, What, N, Quota) :-
    quota_of(agent, What, N, Quota0),
    Quota =.. [Whose,Quota0].

%   acts(+Agents, +Act, -Results): each Agent acts once, all in one second.

acts(Agents, Act, Results) :-
    repeat,
    typhon_usage:this_second(Second),
    typhon_usage:usage_forget(h),
    forget_spent,
    maplist(acts_once(Act), Agents, Results),
    typhon_usage:this_second(Second),
    !.

forget_spent :-
    retractall(typhon_usage:spent(_, _, _, _)).

acts_once(Act, Agent, Result) :-
    catch(( typhon_usage:acts(h, Agent, Act), Result = ok ),
          error(resource_error(What), _), Result = over(What)).

:- begin_tests(quotas_in_a_second).

test(act_beyond_the_quota_of_an_agent_is_refused,
     [forall(act(What, Act)), Results == [ok,ok,ok,over(What),ok]]) :-
    quota_of(agent, What, 3, Quota),
    with_quotas([Quota], acts([a1,a1,a1,a1,a2], Act, Results)).
test(act_beyond_the_quota_of_an_owner_is_refused,
     [forall(act(What, Act)),
      Results == [ok,ok,ok,over(What),over(What),ok]]) :-
    quota_of(owner, What, 3, Quota),
    with_quotas([Quota], acts([a1,a2,a1,a2,a1,b], Act, Results)).
test(act_beyond_the_quota_of_a_host_is_refused_to_the_greatest_user,
     [forall(act(What, Act)),
      Results == [ok,ok,ok,ok,over(What),over(What)]]) :-
    quota_of(host, What, 3, Quota),
    with_quotas([Quota], acts([a1,a2,a1,b,a2,a1], Act, Results)).
test(act_counts_once_for_its_owner_and_its_host,
     Results == [ok,ok,ok,over(messages)]) :-
    with_quotas([owner(messages(3)), host(messages(9))],
                acts([a1,a2,a1,a2], send(x), Results)).
test(host_ends_owners_that_act_equally_often,
     Results == [ok,ok,ok,over(messages)]) :-
    with_quotas([host(messages(3))], acts([a1,a1,b,b], send(x), Results)).
test(one_act_does_not_count_as_another, Results == [ok,ok]) :-
    with_quotas([messages(1), log(1)],
                ( acts([a1], send(x), R1), acts_once(log(x), a1, R2),
                  append_result(R1, R2, Results) )).
test(each_second_counts_anew, Results == [ok,over(messages),ok]) :-
    with_quotas([messages(1)],
                ( acts([a1,a1], send(x), [R1,R2]),
                  an_earlier_second,
                  acts_once(send(x), a1, R3) )),
    Results = [R1,R2,R3].
test(shared_acts_count_anew_each_second, Results == [ok,over(messages),ok]) :-
    with_quotas([owner(messages(1))],
                ( acts([a1,a1], send(x), [R1,R2]),
                  an_earlier_second,
                  acts_once(send(x), a2, R3) )),
    Results = [R1,R2,R3].
test(goals_outside_of_agents_are_not_counted, Results == [ok,ok]) :-
    with_quotas([messages(1), owner(messages(1)), host(messages(1))],
                acts([none,none], send(x), Results)).
test(agents_of_other_hosts_are_not_counted, Results == [ok,ok]) :-
    with_quotas([owner(messages(1))], acts([c,c], send(x), Results)).
test(old_counts_are_dropped, true(Count < 10 010)) :-
    with_quotas([messages(1)],
                ( numlist(1, 10 001, Ns),
                  forall(member(N, Ns),
                         assertz(typhon_usage:spent(N, messages, 0, 1))),
                  acts_once(send(x), a1, _),
                  predicate_property(typhon_usage:spent(_, _, _, _),
                                     number_of_clauses(Count)),
                  assertion(Count =:= 1),
                  forget_spent )).

:- end_tests(quotas_in_a_second).

append_result([R1], R2, [R1,R2]).

%   What was counted is of the second before this one.

an_earlier_second :-
    forall(retract(typhon_usage:spent(A, W, S, C)),
           ( S1 is S-1, assertz(typhon_usage:spent(A, W, S1, C)) )),
    forall(retract(typhon_usage:shared(H, W, O, S, C)),
           ( S1 is S-1, assertz(typhon_usage:shared(H, W, O, S1, C)) )).

                /*******************************
                *             SIZES            *
                *******************************/

sized(send(T), T).
sized(log(T), T).
sized(leave(T), T).
sized(emit(T), T).
sized(say(T), T).

:- begin_tests(quotas_of_sizes).

test(terms_of_the_quota_are_allowed,
     [forall(sized(Act, Term)), Results == [ok,over(cells)]]) :-
    with_quotas([cells(21)],
                ( findall(R, ( member(N, [10,11]), numlist(1, N, Term),
                               acts_once(Act, a1, R) ), Results) )).
test(eight_characters_count_as_a_cell, Results == [ok,over(cells)]) :-
    with_quotas([cells(3)],
                findall(R, ( member(Text, ["12345678901234567890123",
                                           "123456789012345678901234"]),
                             acts_once(send(Text), a1, R) ), Results)).
test(goals_at_which_an_agent_stops_are_sized,
     Outcomes = [effect(_, _, _),over(cells)]) :-
    with_quotas([cells(31)],
                findall(O, ( member(N, [12,13]), numlist(1, N, L),
                             typhon_quota_enforcer:storable(
                                 effect(sleep(1), _, [g(L)]), h, O) ),
                        Outcomes)).
test(large_errors_exceed_the_quota, Outcomes = [raised(_),over(cells)]) :-
    typhon_quota_table:quota_begin,
    findall(O, ( member(N, [4 999,5 000]), numlist(1, N, L),
                 typhon_quota_enforcer:over(raised(L), user, O) ), Outcomes).
test(text_of_atoms_counts_as_stack,
     Results == [ok,over(stack)]) :-
    in_turn(( text_made(10, R1), text_made(1, R2) )),
    Results = [R1,R2].
test(turn_begins_without_text, Results == [ok,ok]) :-
    in_turn(( text_made(10, R1), typhon_usage:usage_begin,
              text_made(10, R2) )),
    Results = [R1,R2].
test(text_of_facts_counts_as_state, Results == [ok,ok,over(state)]) :-
    in_turn(( added(f(abc, x(de)), R1), added(f(12, "text", fghij), R2),
              assertz(test_quota_module:f(abcdefghij)),
              added(k, R3) )),
    abolish(test_quota_module:f/1),
    Results = [R1,R2,R3].
test(text_of_removed_facts_does_not_count, Results == [ok,ok,ok]) :-
    in_turn(( added(f(abcdefghij), R1), added(f(abcdefghij), R2),
              added(f(k), R3) )),
    Results = [R1,R2,R3].
test(quota_that_was_passed_is_told_once, Passed == [state,none]) :-
    typhon_quota_table:quota_begin,
    catch(typhon_quota_table:quota_passed(state), error(_, _), true),
    findall(W, ( member(_, [1,2]),
                 ( typhon_quota_table:quota_passed_now(W0) -> W = W0
                 ; W = none ) ), Passed).
test(agent_that_raises_the_error_has_passed_no_quota,
     Outcomes = [raised(_),raised(_)]) :-
    typhon_quota_table:quota_begin,
    findall(O, ( member(What, [messages,_]),
                 typhon_quota_enforcer:over(raised(error(resource_error(What),
                                                         _)), user, O) ),
            Outcomes).

:- end_tests(quotas_of_sizes).

:- meta_predicate in_turn(0).

in_turn(Goal) :-
    dynamic(test_quota_module:f/1),
    setup_call_cleanup(
        ( typhon_turns:context_set(h, a1, test_quota_module),
          typhon_usage:usage_begin ),
        once(Goal),
        ( typhon_turns:context_clear,
          retractall(typhon_quota_agents:text(_, _)) )).

text_made(N, Result) :-
    result(typhon_usage:atoms_made(10, N), Result).

added(Fact, Result) :-
    result(typhon_quota_agents:text_added(10, test_quota_module, Fact),
           Result).

:- meta_predicate result(0, -).

result(Goal, Result) :-
    catch(( call(Goal), Result = ok ), error(resource_error(What), _),
          Result = over(What)).

                /*******************************
                *        WHAT IS THERE         *
                *******************************/

%   leaves(+Agents, -Results): a fact of each Agent comes to the tuple space.

leaves(Agents, Results) :-
    maplist(leaves_one, Agents, Results).

leaves_one(Agent, Result) :-
    acts_once(leave(x), Agent, Result),
    ( Result == ok -> tuples_change(Agent, 1) ; true ).

tuples_change(Agent, Change) :-
    typhon_usage:by(h, Agent, _, By),
    forall(typhon_place:counted(By, Change), true).

:- begin_tests(quotas_of_amounts).

test(facts_of_an_agent, Results == [ok,ok,over(tuples),ok]) :-
    with_quotas([tuples(2)], leaves([a1,a1,a1,a2], Results)).
test(facts_of_an_owner, Results == [ok,ok,over(tuples),ok]) :-
    with_quotas([owner(tuples(2))], leaves([a1,a2,a1,b], Results)).
test(facts_on_a_host, Results == [ok,ok,over(tuples),ok,ok]) :-
    with_quotas([host(tuples(2))], leaves([a1,a2,a1,b,b], Results)).
test(facts_that_were_taken_do_not_count, Results == [ok,ok,over(tuples),ok]) :-
    with_quotas([tuples(2)],
                ( leaves([a1,a1,a1], Rs), tuples_change(a1, -1),
                  leaves([a1], [R]) )),
    Rs = [R1,R2,R3],
    Results = [R1,R2,R3,R].
test(clones_of_an_owner_and_of_a_host,
     [forall(member(Quota-Expected,
                    [ owner(clones(2))-[ok,ok],
                      owner(clones(1))-[over(clones),ok],
                      host(clones(3))-[ok,ok],
                      host(clones(2))-[over(clones),over(clones)] ])),
      Results == Expected]) :-
    with_quotas([Quota], acts([a1,b], clone, Results)).
test(clones_of_a_family, Results == [[ok,ok,over(clones)],[over(clones)]]) :-
    with_hosts([g-[quota([clones(2)])]],
               ( family(2, A), clones([A,A,A], R1),
                 family(1, B), clones([B], R2) )),
    Results = [R1,R2].
test(payloads_of_an_agent, Results == [ok,over(payloads)]) :-
    with_hosts([g-[quota([payloads(1)])]],
               findall(R, ( payload(Ps),
                            create([on_message(_, _)], A,
                                   [host(g), payloads(Ps)]),
                            result(typhon_usage:acts(g, A, attach), R) ),
                       Results)).
test(messages_that_fit_into_a_mailbox,
     Counts == [0-0,2-2,2-3]) :-
    setup_call_cleanup(
        assertz(typhon_quota_agents:refused(owner, [])),   % an alarm is set
        findall(Fits-N,
                ( member(N, [0,2,3]), length(Mail, N),
                  maplist(=(mail(x, y, z)), Mail),
                  typhon_quota_agents:fits(2, h, owner, Mail, Fitting),
                  length(Fitting, Fits) ), Counts),
        retractall(typhon_quota_agents:refused(owner, _))).
test(mail_that_an_agent_brings, Verdicts == [yes,refused(quota(mailbox))]) :-
    with_quotas([mailbox(2)],
                findall(V, ( member(Mail, [[x,y],[x,y,z]]),
                             ( typhon_quota_agents:forbids(
                                   from(p, x, y),
                                   entrant(id, hash, life, state, Mail), h, V0)
                             -> V = V0
                             ;  V = yes ) ), Verdicts)).
test(greatest_user_among_the_greatest_owner_ends,
     [forall(member(Whose-Most-Expected,
                    [ owner-5-none, owner-4-a2, host-8-none, host-7-a2 ])),
      Agent == Expected]) :-
    (   typhon_quota_enforcer:too_much(Whose, [a-(2-a1),b-(3-b),a-(3-a2)], Most,
                                       Agent0)
    ->  Agent = Agent0
    ;   Agent = none
    ).
test(seconds_of_a_turn, Acts == [none,stop_in(t, a1, seconds)]) :-
    with_quotas([seconds(5)],
                findall(Act, ( member(S, [5,5.001]), exceeds(t, S, Act) ),
                        Acts)).
test(agent_that_runs_for_long_pauses_if_another_does_not,
     [forall(member(Seconds-Expected, [0.1-[], 0.101-[pause_in(t, a1)]])),
      Acts == Expected]) :-
    with_quotas([seconds(5)],
                pauses(Seconds, Acts)).
test(stack_of_a_turn, Acts = [none,stop_in(_, a1, stack)]) :-
    setup_call_cleanup(
        thread_create(thread_get_message(go), Thread),
        ( wait_until(still(Thread, Used), 10),
          Less is Used-1,
          findall(Act, ( member(Most, [Used,Less]),
                         with_quotas([stack(Most)], exceeds(Thread, 0, Act)) ),
                  Acts) ),
        ( thread_send_message(Thread, go), thread_join(Thread) )).

:- end_tests(quotas_of_amounts).

payload([]).
payload([clauses([(:- payload(p, [provides([q/1])])), q(1)])]).

%   family(+N, -Agent): N more agents of one program are on the host g.

family(N, Agent) :-
    findall(A, ( between(1, N, _), create([on_message(_, _)], A, [host(g)]),
                 wait_state(A, resident) ), [Agent|_]).

clones(Agents, Results) :-
    repeat,
    typhon_usage:this_second(Second),
    typhon_usage:usage_forget(g),
    forall(member(A, Agents),
           assertion(agent_property(A, host(_)))),
    findall(R, ( member(A, Agents),
                 result(typhon_usage:may_clone(g, A), R) ), Results),
    typhon_usage:this_second(Second),
    !.

exceeds(Thread, Seconds, Act) :-
    (   typhon_quota_enforcer:exceeds(a1, h, Thread, Seconds, Act0),
        Act0 \= pause_in(_, _)
    ->  Act = Act0
    ;   Act = none
    ).

%   The turn of another agent begins in this thread. It counts as long if this
%   thread has to wait, so there are several attempts.

pauses(Seconds, Acts) :-
    findall(Act,
            ( between(1, 20, _),
              typhon_turns:turn_begins(a2),
              typhon_quota_enforcer:exceeds(a1, h, t, Seconds, Act) ),
            Acts0),
    sort(Acts0, Acts).

%   The thread waits, so that its stack does not change any more.

still(Thread, Used) :-
    thread_statistics(Thread, stack, Used),
    (   nb_current(test_quota_bounds, Used)
    ->  true
    ;   nb_setval(test_quota_bounds, Used),
        fail
    ).

                /*******************************
                *           IN FORCE           *
                *******************************/

%   allowed(?What, ?Whose): there is this quota.

allowed(What, Whose) :-
    member(What, [inferences,cells,payloads,mailbox,lifetime]),
    Whose = agent.
allowed(agents, owner).
allowed(What, Whose) :-
    member(What, [ clones,tuples,messages,log,facts,hops,calls(p/1),state,
                   seconds,stack ]),
    member(Whose, [agent,owner,host]).

what(What) :-
    member(What, [ inferences,cells,payloads,mailbox,lifetime,agents,clones,
                   tuples,messages,log,facts,hops,calls(p/1),state,seconds,
                   stack,bogus ]).

default(What, Most) :-
    member(What-Most,
           [ seconds-5, stack-67 108 864, state-16 777 216, cells-200 000,
             clones-100, payloads-100, tuples-10 000, mailbox-10 000,
             messages-10 000, facts-10 000, hops-10 000, log-1000 ]).

:- begin_tests(quotas_in_force).

test(there_are_the_documented_quotas, Given == Documented) :-
    findall(What-Whose,
            ( what(What), member(Whose, [agent,owner,host]),
              quota_of(Whose, What, 1, Quota),
              catch(quotas_put(h, [Quota], _), error(domain_error(_, _), _),
                    fail) ), Given0),
    quotas_drop(h),
    sort(Given0, Given),
    findall(What-Whose, allowed(What, Whose), Documented0),
    sort(Documented0, Documented).
test(quota_that_is_none_is_an_error,
     [forall(member(Quota, [ x, messages(0), messages(-1), calls(p, 1),
                             owner(x), owner(owner(messages(1))),
                             messages(1, 2),
                             other(messages(1)) ])),
      error(domain_error(quota, Quota))]) :-
    quotas_put(h, [Quota], _).
test(amounts_are_numbers,
     [forall(member(Quota-Error, [ messages(x)-type_error(number, x),
                                   messages(_)-instantiation_error,
                                   calls(_/_, 1)-instantiation_error ])),
      Formal = Error]) :-
    catch(quotas_put(h, [Quota], _), error(Formal, _), true).
test(first_quota_of_a_kind_applies,
     Mosts == [1,2,3]) :-
    quotas_put(h, [ messages(1), owner(messages(2)), host(messages(3)),
                    messages(9), owner(messages(9)), host(messages(9)) ], _),
    findall(M, ( quota(h, messages, M) ; quota_shared(h, _, messages, M) ),
            Mosts),
    quotas_drop(h).
test(equal_quotas_are_no_change, Changes == [true,false,true,true,true]) :-
    findall(C, ( member(Qs, [ [log(1),owner(log(2))], [log(1),owner(log(2))],
                              [log(1),owner(log(3))], [log(1)], [] ]),
                 quotas_put(h, Qs, C) ), Changes),
    quotas_drop(h).
test(host_that_guards_has_the_documented_quotas, Quotas == Defaults) :-
    with_hosts([g-[policy(guarded), cell(none), quota([log(7)])]],
               findall(W-M, ( quota(g, W, M)
                            ; quota_shared(g, host, W0, M), W = host(W0) ),
                       Quotas0)),
    sort(Quotas0, Quotas),
    findall(W-M, ( default(W, M), W \== log ), Defaults0),
    sort([log-7,host(tuples)-100 000|Defaults0], Defaults).
test(host_that_trusts_has_none, Quotas == []) :-
    with_hosts([g], findall(W, ( quota(g, W, _) ; quota_shared(g, W, _, _) ),
                            Quotas)).

:- end_tests(quotas_in_force).
