:- module(test_chaos, []).
:- use_module(library(plunit)).
:- use_module('../lib/common').
:- use_module(attack).
:- use_module(faults, [scenario/3, schedule/5]).
:- use_module(verdict, [finding_kind/3, verdict/3]).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(solution_sequences)).

/** <module> A short run of the chaos suite

The long form is `make chaos`, see doc/chaos.md.
*/

%   Few events, but with this seed every kind of fault is among them.

seconds(16).
seed(3600).

:- dynamic report/2.                    % Scenario, Findings

attack(Dir) :-
    seconds(Seconds),
    seed(Seed),
    chaos([ seconds(Seconds), seed(Seed), processes(3), agents(24), settle(60),
            out(Dir) ],
          Reports),
    forall(member(report(Scenario, _, Findings), Reports),
           assertz(report(Scenario, Findings))).

:- begin_tests(chaos).

test(chaos_run) :-
    no_leaks(with_tmp_dir(test_chaos:attack)).
test(no_violation,
     [ forall(( scenario(Scenario, _, _), finding_kind(Kind, wrong, _) )),
       true(Found == []) ]) :-
    report(Scenario, Findings),
    findall(What, limit(3, member(finding(Kind, What), Findings)), Found).

:- end_tests(chaos).

:- begin_tests(chaos_schedule).

test(follows_from_the_seed, [forall(scenario(Scenario, _, _)), nondet]) :-
    schedule(Scenario, 7, 30, [a,b,c], Events),
    schedule(Scenario, 7, 30, [a,b,c], Again),
    schedule(Scenario, 8, 30, [a,b,c], Other),
    assertion(Events == Again),
    assertion(Events \== Other).
test(has_every_fault,
     [ forall(faults(Scenario, Kinds)), true(Missing == []), nondet ]) :-
    scenario(Scenario, Share, _),
    seconds(Total),
    seed(Seed),
    Seconds is Total*Share/100,
    schedule(Scenario, Seed, Seconds, [a,b,c], Events),
    findall(Kind,
            ( member(_-Event, Events), functor(Event, Kind, _) ),
            Found),
    subtract(Kinds, Found, Missing).

faults(cuts,   [cut,after,hold,release,delay]).
faults(stops,  [cut,after,stop,cont,busy]).
faults(kills,  [cut,after,hold,stop,kill,start]).
faults(deaths, [cut,after,kill]).

:- end_tests(chaos_schedule).

%   Two processes, of which b was killed at the time 50 if Killed is true; a
%   traveller with the token -1, a sitter, and what is different in Changes:
%   less(Key, Term) and more(Key, Term).

evidence(Killed, Changes, Evidence) :-
    (   Killed == true
    ->  Lives = [life(a, 1, 0, inf), life(b, 1, 0, 50), life(b, 2, 51, inf)]
    ;   Lives = [life(a, 1, 0, inf), life(b, 1, 0, inf)]
    ),
    numlist(1, 18, Ks),
    findall(token(K), member(K, Ks), Tuples),
    Parts = [ lives-Lives,
              agents-[ agent(t, traveller, idt, a-1, 1),
                       agent(s, sitter, ids, a-1, 1) ],
              standing-[ agent(a, idt, resident, 1,
                               [ me(t), tick(3), steps(1), token(-1) ]),
                         agent(a, ids, resident, 0,
                               [ me(s), tick(2), steps(0) ]) ],
              tuples-Tuples,
              events-[ e(s, 1, got(t, 1), 49, a-1),
                       e(s, 2, got(a, 1), 60, a-1),
                       e(t, 1, go('b1@x:1'), 48, a-1),
                       e(t, 2, at('b1@x:1'), 48, b-1),
                       e(t, 3, said(s, 1), 48, b-1) ],
              mail-[sent(a, s, 1, 60)],
              disposed-[], outcomes-[], calls-[], left-[] ],
    foldl(change, Changes, Parts, Changed),
    dict_pairs(Evidence, evidence, Changed).

change(Change, Parts0, [Part-Things|Parts]) :-
    arg(1, Change, Part),
    arg(2, Change, Thing),
    selectchk(Part-Things0, Parts0, Parts),
    (   functor(Change, less, _)
    ->  selectchk(Thing, Things0, Things)
    ;   Things = [Thing|Things0]
    ).

kinds(Killed, Changes, Kinds) :-
    evidence(Killed, Changes, Evidence),
    verdict(cuts, Evidence, Findings),
    findall(Kind, member(finding(Kind, _), Findings), Kinds0),
    sort(Kinds0, Kinds).

:- begin_tests(chaos_verdict).

test(correct_run, true(Kinds == [])) :-
    kinds(false, [], Kinds).
test(lost, true(Kinds == [lost,token_lost])) :-
    kinds(false, [less(standing, agent(_, idt, _, _, _))], Kinds).
test(died, true(Kinds == [died,token_died])) :-
    kinds(true, [less(standing, agent(_, idt, _, _, _))], Kinds).
test(doubled, true(Kinds == [doubled])) :-
    kinds(false, [more(standing, agent(b, idt, resident, 1, []))], Kinds).
test(doubled_though_one_was_killed, true(Kinds == [doubled])) :-
    kinds(true, [more(standing, agent(b, idt, resident, 1, []))], Kinds).
test(doubled_for_a_while, true(Kinds == [doubled])) :-
    kinds(false, [more(events, e(t, 3, at('a1@x:1'), 49, a-1))], Kinds).
test(repeated_after_a_death, true(Kinds == [again])) :-
    kinds(true, [more(events, e(t, 3, at('a1@x:1'), 52, a-1))], Kinds).
test(rolled_back, true(Kinds == [count])) :-
    kinds(false, [more(events, e(t, 4, at('a1@x:1'), 49, a-1))], Kinds).
test(gap, true(Kinds == [count])) :-
    kinds(false, [less(events, e(t, 2, _, _, _))], Kinds).
test(in_doubt, true(Kinds == [stuck])) :-
    kinds(false, [ less(standing, agent(_, ids, _, _, _)),
                   more(standing, agent(a, ids, in_doubt, 0, [tick(2)])) ],
          Kinds).
test(in_doubt_after_the_death_of_the_returning_process,
     true(Kinds == [in_doubt])) :-
    kinds(true, [ less(lives, life(b, 2, _, _)),
                  less(standing, agent(_, idt, _, _, _)),
                  more(standing, agent(a, idt, in_doubt, 1,
                                       [me(t), tick(3), steps(1), token(-1)])),
                  more(events, e(t, 4, go('a1@x:1'), 49, b-1)) ],
          Kinds0),
    subtract(Kinds0, [again], Kinds).
test(in_doubt_at_a_dead_process_where_it_ended,
     true(Kinds == [in_doubt])) :-
    kinds(true, [ less(lives, life(b, 2, _, _)),
                  less(standing, agent(_, idt, _, _, _)),
                  more(standing, agent(a, idt, in_doubt, 0,
                                       [me(t), tick(1), steps(0), token(-1)])),
                  more(events, e(t, 4, drops(-1), 48, b-1)),
                  more(events, e(t, 5, end, 48, b-1)),
                  more(tuples, token(-1)) ],
          Kinds0),
    subtract(Kinds0, [again,count], Kinds).
test(born_elsewhere, [forall(member(Hops-Wrong, [1-[], 2-[], 3-[count]])),
                      true(Kinds == Wrong)]) :-
    kinds(false, [ more(events, e(s, 3, clone(1, idc), 60, a-1)),
                   less(standing, agent(_, ids, _, _, _)),
                   more(standing, agent(a, ids, resident, 0,
                                        [me(s), tick(3), steps(0)])),
                   more(events, e('s+1', 1, at('b1@x:1'), 61, b-1)),
                   more(standing, agent(b, idc, resident, Hops,
                                        [me('s+1'), tick(1), steps(1)])) ],
          Kinds).
test(clone_reported_as_refused,
     [ forall(member(Told/Seen/Kind,
                     [ 52/[b-1]/died, 49.5/[b-1]/doubled, 60/[b-2]/doubled,
                       52/[a-1,b-1]/doubled ])),
       true(Kinds == [Kind]) ]) :-
    findall(more(events, e('s+1', Tick, at('b1@x:1'), 49, Life)),
            nth1(Tick, Seen, Life), More),
    kinds(true, [ more(events, e(s, 3, no_clone(1, refused), Told, a-1)),
                  less(standing, agent(_, ids, _, _, _)),
                  more(standing, agent(a, ids, resident, 0,
                                       [me(s), tick(3), steps(0)]))
                | More ], Kinds).
test(end_without_notice,
     [ forall(member(Life-Wrong, [(b-1)-[],(a-1)-[outcome]])),
                            true(Kinds == Wrong) ]) :-
    kinds(true, [ more(agents, agent(e, sprinter, ide, a-1, 1)),
                  more(events, e(e, 1, end, 49, Life)),
                  more(outcomes, ide-timeout) ], Kinds).
test(message_lost, true(Kinds == [message_lost])) :-
    kinds(false, [more(mail, sent(a, s, 2, 60))], Kinds).
test(message_lost_after_the_death, true(Kinds == [message_lost])) :-
    kinds(true, [more(mail, sent(a, s, 2, 60))], Kinds).
test(message_died, true(Kinds == [message_died])) :-
    kinds(true, [more(mail, sent(a, s, 2, 49))], Kinds).
test(message_died_long_after_it_was_sent,
     [ forall(member(Acted-Wrong, [45-[message_lost],20-[message_died]])),
       true(Kinds == Wrong) ]) :-
    kinds(true, [ less(events, e(s, 1, got(t, 1), _, _)),
                  less(events, e(s, 2, got(a, 1), _, _)),
                  less(events, e(t, 3, said(s, 1), _, _)),
                  less(mail, sent(a, s, 1, _)),
                  more(mail, sent(a, s, 2, 10)),
                  less(standing, agent(_, ids, _, _, _)),
                  more(standing, agent(a, ids, resident, 0,
                                       [me(s), tick(1), steps(0)])),
                  more(events, e(s, 1, at('a1@x:1'), Acted, a-1)) ],
          Kinds0),
    subtract(Kinds0, [count], Kinds).
test(message_twice, true(Kinds == [count,message_twice])) :-
    kinds(false, [more(events, e(s, 3, got(a, 1), 61, a-1))], Kinds).
test(out_of_order_from_a_moving_sender, true(Kinds == [order_moving])) :-
    kinds(false, [ more(events, e(t, 0, said(s, 2), 47, a-1)),
                   more(events, e(s, 0, got(t, 2), 47, a-1)) ], Kinds).
test(out_of_order, true(Kinds == [order_still])) :-
    kinds(false, [ more(agents, agent(r, sitter, idr, a-1, 1)),
                   more(standing, agent(a, idr, resident, 0,
                                        [me(r), tick(2), steps(0)])),
                   more(events, e(r, 1, said(s, 1), 46, a-1)),
                   more(events, e(r, 2, said(s, 2), 47, a-1)),
                   more(events, e(s, -1, got(r, 2), 47, a-1)),
                   more(events, e(s, 0, got(r, 1), 47, a-1)) ], Kinds).
test(token_lost, true(Kinds == [token_lost])) :-
    kinds(false, [less(tuples, token(7))], Kinds).
test(token_twice, true(Kinds == [token_twice])) :-
    kinds(true, [more(tuples, token(-1))], Kinds).
test(token_dropped_and_carried_before_a_rollback,
     true(Kinds == [again])) :-
    kinds(true, [ more(events, e(t, 3, drops(-1), 49, b-1)),
                  less(events, e(t, 3, said(_, _), _, _)),
                  more(events, e(t, 3, said(s, 1), 52, a-1)),
                  more(tuples, token(-1)) ], Kinds).
test(token_duplicated_after_the_death_of_the_dropping_process,
     true(Kinds == [token_twice])) :-
    kinds(true, [ more(events, e(t, 4, drops(-1), 49, b-1)),
                  less(standing, agent(_, idt, _, _, _)),
                  more(standing, agent(a, idt, resident, 1,
                                       [me(t), tick(4), steps(1), token(-1)])),
                  more(tuples, token(-1)) ], Kinds).
test(message_repeated, true(Kinds == [again])) :-
    kinds(true, [ less(events, e(s, 1, got(_, _), _, _)),
                  more(events, e(s, 1, got(t, 1), 49, a-1)),
                  more(events, e(t, 3, said(s, 1), 52, a-1)),
                  more(events, e(s, 3, got(t, 1), 53, a-1)),
                  less(standing, agent(_, ids, _, _, _)),
                  more(standing, agent(a, ids, resident, 0,
                                       [me(s), tick(3), steps(0)])) ], Kinds).
test(victim_with_a_dead_home, true(Kinds == [died])) :-
    kinds(true, [ more(agents, agent(v, victim, idv, b-1, 1)),
                  more(events, e(v, 1, at('a1@x:1'), 60, a-1)) ], Kinds).
test(alive_after_its_end, true(Kinds == [undead])) :-
    kinds(false, [more(disposed, t-10), less(standing, agent(_, idt, _, _, _)),
                  more(tuples, token(-1))], Kinds).
test(late, true(Kinds == [late])) :-
    kinds(false, [more(disposed, t-10), less(standing, agent(_, idt, _, _, _)),
                  more(events, e(idt, 0, ended_in_doubt, 9, a-1)),
                  more(tuples, token(-1))], Kinds).
test(hung, true(Kinds == [hung])) :-
    kinds(true, [more(calls, call(look, a, hung))], Kinds).
test(denied, true(Kinds == [denied])) :-
    kinds(false, [more(calls, call(look, a, no))], Kinds).
test(left_behind, true(Kinds == [left])) :-
    kinds(false, [more(left, a-[thread(1)])], Kinds).

:- end_tests(chaos_verdict).
