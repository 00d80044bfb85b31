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

seconds(10).
seed(9749).

:- dynamic report/2.                    % Scenario, Findings

attack(Dir) :-
    seconds(Seconds),
    seed(Seed),
    chaos([ seconds(Seconds), seed(Seed), processes(3), agents(16), settle(60),
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

%   sitter(+State, +Facts, -Changes), traveller(+State, +Hops, +Facts, -Changes)

sitter(State, Facts, [ less(standing, agent(_, ids, _, _, _)),
                       more(standing, agent(a, ids, State, 0, Facts)) ]).

traveller(State, Hops, Facts,
          [ less(standing, agent(_, idt, _, _, _)),
            more(standing, agent(a, idt, State, Hops, [me(t)|Facts])) ]).

%   finds(-Run, -Killed, -Changes, -Kinds): the kinds of findings; those after
%   `with` may be among them.

finds(correct_run, false, [], []).
finds(lost, false, [less(standing, agent(_, idt, _, _, _))],
      [lost,token_lost]).
finds(died, true, [less(standing, agent(_, idt, _, _, _))],
      [died,token_died]).
finds(doubled, Killed, [more(standing, agent(b, idt, resident, 1, []))],
      [doubled]) :-
    member(Killed, [false,true]).
finds(doubled_for_a_while, false,
      [more(events, e(t, 3, at('a1@x:1'), 49, a-1))], [doubled]).
finds(repeated_after_a_death, true,
      [more(events, e(t, 3, at('a1@x:1'), 52, a-1))], [again]).
finds(rolled_back, false, [more(events, e(t, 4, at('a1@x:1'), 49, a-1))],
      [count]).
finds(gap, false, [less(events, e(t, 2, _, _, _))], [count]).
finds(in_doubt, false, Sitter, [stuck]) :-
    sitter(in_doubt, [tick(2)], Sitter).
finds(in_doubt_after_the_death_of_the_returning_process, true,
      [ less(lives, life(b, 2, _, _)),
        more(events, e(t, 4, go('a1@x:1'), 49, b-1)) | Traveller ],
      [in_doubt]-with([again])) :-
    traveller(in_doubt, 1, [tick(3), steps(1), token(-1)], Traveller).
finds(in_doubt_at_a_dead_process_where_it_ended, true,
      [ less(lives, life(b, 2, _, _)),
        more(events, e(t, 4, drops(-1), 48, b-1)),
        more(events, e(t, 5, end, 48, b-1)),
        more(tuples, token(-1)) | Traveller ],
      [in_doubt]-with([again,count])) :-
    traveller(in_doubt, 0, [tick(1), steps(0), token(-1)], Traveller).
finds(born_elsewhere, false,
      [ more(events, e(s, 3, clone(1, idc), 60, a-1)),
        more(events, e('s+1', 1, at('b1@x:1'), 61, b-1)),
        more(standing, agent(b, idc, resident, Hops,
                             [me('s+1'), tick(1), steps(1)])) | Sitter ],
      Kinds) :-
    member(Hops-Kinds, [1-[], 2-[], 3-[count]]),
    sitter(resident, [me(s), tick(3), steps(0)], Sitter).
finds(clone_reported_as_refused, true, Changes, [Kind]) :-
    member(Told/Seen/Kind, [ 52/[b-1]/died, 49.5/[b-1]/doubled,
                             60/[b-2]/doubled, 52/[a-1,b-1]/doubled ]),
    findall(more(events, e('s+1', Tick, at('b1@x:1'), 49, Life)),
            nth1(Tick, Seen, Life), More),
    sitter(resident, [me(s), tick(3), steps(0)], Sitter),
    append([more(events, e(s, 3, no_clone(1, refused), Told, a-1))|Sitter],
           More, Changes).
finds(end_without_notice, true,
      [ more(agents, agent(e, sprinter, ide, a-1, 1)),
        more(events, e(e, 1, end, 49, Life)),
        more(outcomes, ide-timeout) ], Kinds) :-
    member(Life/Kinds, [(b-1)/[], (a-1)/[outcome]]).
finds(message_lost, false, [more(mail, sent(a, s, 2, 60))], [message_lost]).
finds(message_lost_after_the_death, true, [more(mail, sent(a, s, 2, 60))],
      [message_lost]).
finds(message_died, true, [more(mail, sent(a, s, 2, 49))], [message_died]).
finds(message_died_long_after_it_was_sent, true,
      [ less(events, e(s, 1, got(t, 1), _, _)),
        less(events, e(s, 2, got(a, 1), _, _)),
        less(events, e(t, 3, said(s, 1), _, _)),
        less(mail, sent(a, s, 1, _)),
        more(mail, sent(a, s, 2, 10)),
        more(events, e(s, 1, at('a1@x:1'), Acted, a-1)) | Sitter ],
      [Kind]-with([count])) :-
    member(Acted-Kind, [45-message_lost, 20-message_died]),
    sitter(resident, [me(s), tick(1), steps(0)], Sitter).
finds(message_twice, false, [more(events, e(s, 3, got(a, 1), 61, a-1))],
      [count,message_twice]).
finds(out_of_order_from_a_moving_sender, false,
      [ more(events, e(t, 0, said(s, 2), 47, a-1)),
        more(events, e(s, 0, got(t, 2), 47, a-1)) ], [order_moving]).
finds(out_of_order, false,
      [ more(agents, agent(r, sitter, idr, a-1, 1)),
        more(standing, agent(a, idr, resident, 0,
                             [me(r), tick(2), steps(0)])),
        more(events, e(r, 1, said(s, 1), 46, a-1)),
        more(events, e(r, 2, said(s, 2), 47, a-1)),
        more(events, e(s, -1, got(r, 2), 47, a-1)),
        more(events, e(s, 0, got(r, 1), 47, a-1)) ], [order_still]).
finds(token_lost, false, [less(tuples, token(7))], [token_lost]).
finds(token_twice, true, [more(tuples, token(-1))], [token_twice]).
finds(token_dropped_and_carried_before_a_rollback, true,
      [ more(events, e(t, 3, drops(-1), 49, b-1)),
        less(events, e(t, 3, said(_, _), _, _)),
        more(events, e(t, 3, said(s, 1), 52, a-1)),
        more(tuples, token(-1)) ], [again]).
finds(token_duplicated_after_the_death_of_the_dropping_process, true,
      [ more(events, e(t, 4, drops(-1), 49, b-1)),
        more(tuples, token(-1)) | Traveller ], [token_twice]) :-
    traveller(resident, 1, [tick(4), steps(1), token(-1)], Traveller).
finds(message_repeated, true,
      [ less(events, e(s, 1, got(_, _), _, _)),
        more(events, e(s, 1, got(t, 1), 49, a-1)),
        more(events, e(t, 3, said(s, 1), 52, a-1)),
        more(events, e(s, 3, got(t, 1), 53, a-1)) | Sitter ], [again]) :-
    sitter(resident, [me(s), tick(3), steps(0)], Sitter).
finds(victim_with_a_dead_home, true,
      [ more(agents, agent(v, victim, idv, b-1, 1)),
        more(events, e(v, 1, at('a1@x:1'), 60, a-1)) ], [died]).
finds(alive_after_its_end, false,
      [ more(disposed, t-10), less(standing, agent(_, idt, _, _, _)),
        more(tuples, token(-1)) ], [undead]).
finds(late, false,
      [ more(disposed, t-10), less(standing, agent(_, idt, _, _, _)),
        more(events, e(idt, 0, ended_in_doubt, 9, a-1)),
        more(tuples, token(-1)) ], [late]).
finds(hung, true, [more(calls, call(look, a, hung))], [hung]).
finds(denied, false, [more(calls, call(look, a, no))], [denied]).
finds(left_behind, false, [more(left, a-[thread(1)])], [left]).

:- begin_tests(chaos_verdict).

test(finds, [ forall(finds(_, Killed, Changes, Expected)),
              Others == [] ]) :-
    kinds(Killed, Changes, Kinds),
    ( Expected = Sure-with(May) -> true ; Sure = Expected, May = [] ),
    subtract(Sure, Kinds, Missing),
    subtract(Kinds, Sure, More),
    subtract(More, May, Wrong),
    append(Missing, Wrong, Others).

:- end_tests(chaos_verdict).
