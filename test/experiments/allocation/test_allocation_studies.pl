:- use_module('../../lib/common', [with_tmp_dir/1, with_tmp_dir/2]).
:- use_module('../../lib/project_studies').
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(readutil)).
:- use_module('../../../experiments/engine/cases').

/** <module> The studies of chapter 7: their claims, and small runs
*/

study(Name, Study) :-
    atom_concat('allocation/', Name, File),
    project_study(File, Study).

name(figure_7_1_to_7_3).
name(figure_7_4).
name(figure_7_5).
name(beyond_integrated).
name(beyond_urgent).
name(beyond_replacement).
name(study_contention).
name(beyond_sharing).

%   texts(+Name, +World, +Held, -Texts): of the claims that hold, or do not,
%   in a World made up of numbers: made(Name, World, Case, Measures).

texts(Name, World, Held, Texts) :-
    study(Name, Study),
    study_cases(Study, [], Cases),
    findall(Case-Measures,
            ( member(Case, Cases), made(Name, World, Case, Measures) ),
            Points),
    same_length(Cases, Points),
    verdicts(Study, Points, Verdicts),
    findall(Text, member(Text-Held, Verdicts), Texts).

made(figure_7_1_to_7_3, World, Case, ms{communications:C, time:T,
                                         backoffs:B, interval:I}) :-
    competing(World, Case.mechanism, Case.links, Case.allocators, C, T, B, I).
made(figure_7_4, World, Case, ms{communications:C, time:T,
                                 backoffs:B, interval:I}) :-
    E = Case.eligible,
    dense(World, Case.mechanism, E, C, T, B, I).
made(figure_7_5, thesis, Case, ms{communications:C, time:T, rate:R}) :-
    T is 10*Case.hosts + 100,
    R is T/Case.required,
    (   Case.mechanism == proposed
    ->  C is 90*Case.hosts
    ;   C = 90000
    ).
made(figure_7_5, reverse, Case, ms{communications:C, time:T, rate:R}) :-
    T is 1000 - Case.hosts,
    R = Case.hosts,
    (   Case.mechanism == proposed
    ->  C is 30000 - Case.hosts
    ;   C = 9000
    ).
made(beyond_integrated, thesis, _, ms{faulty:0, strangers:0, overlaps:0,
                                     disorder:0, both:0}).
made(beyond_integrated, reverse, _, ms{faulty:1, strangers:1, overlaps:1,
                                      disorder:1, both:1}).
made(study_contention, World, Case, ms{time:T, interval:I}) :-
    (   Case.mechanism == proposed
    ->  memberchk(World-T/I, [thesis-20/5, reverse-90/50])
    ;   T = 50,
        I = 50
    ).
made(beyond_sharing, World, Case, ms{communications:C, time:C}) :-
    nth1(N, [shared, own, none], Case.sharing),
    memberchk(World-C, [thesis-N, reverse-(-N)]).
made(beyond_replacement, thesis, Case, ms{replaced:R, faulty:0, disorder:0,
                                         after:0, overlaps:0,
                                         completed:300}) :-
    R = Case.failures.
made(beyond_replacement, reverse, Case, ms{replaced:R, faulty:1, disorder:1,
                                          after:1, overlaps:1,
                                          completed:T}) :-
    R is Case.failures + 1,
    T is 300*(Case.failures + 1).
made(beyond_urgent, World, Case, Measures) :-
    urgent(World, Case.priority, Case.deadline, Measures).

%   competing(World, Mechanism, Links, Allocators, Communications, Time,
%   Backoffs, Interval)

competing(thesis, proposed, _, K, C, T, 2.6, I) :-
    C is 900*K, T is 20*K, I is 3.16 + 2*K.
competing(thesis, constant, _, K, C, T, 1, 50) :-
    C is 800*K, T is 22*K.
competing(thesis, murdoch, _, K, C, T, 1, 50) :-
    C is 20000*K, T is 40*K.
competing(thesis, anta, dynamic, K, C, T, 1, 50) :-
    C is 15000*K, T is 40*K.
competing(thesis, anta, static, K, C, T, 1, 50) :-
    C is 7490*K, T is 40*K.
competing(reverse, proposed, dynamic, K, C, 100, 0, I) :-
    C is 20000 - 100*K, I is 200 - K.
competing(reverse, proposed, static, K, C, 201, 0, I) :-
    C is 40200 - 201*K, I is 200 - K.
competing(reverse, constant, _, _, 1000000, 100, 1, 50).
competing(reverse, murdoch, dynamic, K, C, 10, 1, 50) :-
    C is 10000 - 1000*K.
competing(reverse, murdoch, static, K, C, 10, 1, 50) :-
    C is 20100 - 2010*K.
competing(reverse, anta, _, K, C, 10, 1, 50) :-
    C is 10000 - 1000*K.

%   Three claims compare the static network with the dynamic one, a fourth the
%   two ways of backing off: World is ratio(R), in which the former have R times
%   the costs of the latter.

competing(ratio(R), Mechanism, Links, K, C, T, 1, 50) :-
    competing(thesis, Mechanism, dynamic, K, C0, T0, _, _),
    (   ( Links == static ; Mechanism == constant )
    ->  C is R*C0, T is R*20*K
    ;   C = C0, T = T0
    ).

%   dense(World, Mechanism, Eligible, Communications, Time, Backoffs,
%   Interval)

dense(thesis, proposed, E, C, T, B, I) :-
    C is 9000 - 100*E, T is 200 - E, B is 60 - E, I is 60 - E.
dense(thesis, murdoch, E, C, T, B, I) :-
    C is 90000 + 100*E, T is 300 - E, B is 90 - E, I is 50 + E mod 20.
dense(thesis, anta, E, C, T, B, I) :-
    C is 90000 - 100*E, T is 400 - E, B is 90 - E, I is 50 + E mod 20.
dense(reverse, proposed, E, C, T, E, E) :-
    C is 90000 + 100*E, T is 300 + E.
dense(reverse, murdoch, E, C, E, E, I) :-
    C is 9000 - 100*E, I is 60 - E.
dense(reverse, anta, E, E, E, E, I) :-
    I is 60 - E.

urgent(thesis, 0, 0, ms{late:150, others:90, done:5}).
urgent(thesis, 1, 0, ms{late:30, others:110, done:5}).
urgent(thesis, 0, 30, ms{done:0, reported:0.1, free:20}).
urgent(thesis, 0, 60, ms{done:1, reported:0.1, free:20}).
urgent(thesis, 0, 120, ms{done:3, reported:0.1, free:20}).
urgent(reverse, 0, 0, ms{late:30, others:90, done:5}).
urgent(reverse, 1, 0, ms{late:150, others:190, done:5}).
urgent(reverse, 0, 30, ms{done:3, reported:3, free:70}).
urgent(reverse, 0, 60, ms{done:1, reported:3, free:70}).
urgent(reverse, 0, 120, ms{done:0, reported:3, free:70}).

:- begin_tests(allocation_claims).

test(well_formed, [forall(name(Name)), Problems == []]) :-
    study(Name, Study),
    invalid_claims(Study, Problems).
test(all_claims_can_hold, [forall(name(Name)), Failing == []]) :-
    texts(Name, thesis, false, Failing).
test(each_claim_can_fail, [forall(name(Name)), Holding == []]) :-
    texts(Name, reverse, true, Holding).

test(half_to_twice_is_exact,
     [ forall(member(R-Held, [0.4999-[], 0.5-[_,_,_,_], 2-[_,_,_,_],
                              2.0001-[]])),
       Texts = Held ]) :-
    texts(figure_7_1_to_7_3, ratio(R), true, All),
    findall(T, ( member(T, All),
                 member(Part, ["as on the dynamic", "equally well",
                               "almost the same trend"]),
                 sub_string(T, _, _, _, Part) ), Texts).

:- end_tests(allocation_claims).

:- begin_tests(allocation_cases).

test(counts, Counts == [35, 15, 6, 1, 5, 5, 72, 11]) :-
    findall(Count,
            ( name(Name), study(Name, Study), case_count(Study, Count) ),
            Counts).
test(sizes, Sizes == [50-10-5, 100-20-10, 150-30-15, 200-40-20]) :-
    study(figure_7_5, Study),
    study_cases(Study, [mechanism-proposed], Cases),
    findall(N-E-R, ( member(Case, Cases), N = Case.hosts,
                     E = Case.eligible, R = Case.required ), Sizes).

:- end_tests(allocation_cases).

                /*******************************
                *              RUNS            *
                *******************************/

%   measures(+Name, +Given, +Dir, -Measures): of the first such case.

measures(Name, Given, Dir, Measures) :-
    study(Name, Study),
    first_run(Study, Given, 1, Dir, _-Measures).

small([ hosts-8, probability-0.4, eligible-3, required-2, allocators-2,
        duration-1 ]).

mechanism_run(Mechanism, Time, Dir) :-
    small(Small),
    append([links-(dynamic), mechanism-Mechanism|Time], Small, Given),
    measures(figure_7_1_to_7_3, Given, Dir, Ms),
    Ms.time > 1,
    Ms.communications > 0,
    Ms.rate =:= Ms.time/2,
    Ms.backoffs >= 0.

integrated_run(Dir) :-
    measures(beyond_integrated,
             [hosts-6, probability-0.5, eligible-3, required-2, task_time-1],
             Dir, Ms),
    forall(member(Name, [faulty, strangers, overlaps, disorder, both]),
           get_dict(Name, Ms, 0)),
    Ms.found < Ms.completed,
    Ms.timetable = timetable(3, [_, _], _).

replacement_run(Dir) :-
    measures(beyond_replacement,
             [ failures-1, hosts-6, probability-0.5, eligible-3, required-2,
               task_time-1 ],
             Dir, Ms),
    forall(member(Name-Value, [replaced-1, faulty-0, disorder-0, after-0]),
           get_dict(Name, Ms, Value)),
    Ms.catching_up > 0.

%   Every mechanism finds the same robots.

robots(Mechanism, Robots) :-
    with_tmp_dir(robots_in(Mechanism, Robots)).

robots_in(Mechanism, Robots, Dir) :-
    small(Small),
    measures(figure_7_1_to_7_3, [links-(dynamic), mechanism-Mechanism|Small],
             Dir, _),
    directory_file_path(Dir, 'events.pl', File),
    read_file_to_terms(File, Events, []),
    findall(Robot, member(event(_, _, _, reserved(Robot, _, _)), Events),
            Robots0),
    sort(Robots0, Robots).

:- begin_tests(allocation_runs).

test(mechanism, [forall(member(M, [proposed, constant, murdoch, anta]))]) :-
    with_tmp_dir(mechanism_run(M, [])).
test(run_on_sockets) :-
    with_tmp_dir(mechanism_run(proposed, [clock-20, processes-2])).
test(integrated) :-
    with_tmp_dir(integrated_run).
test(replacement) :-
    with_tmp_dir(replacement_run).
test(sharing, [forall(member(Sharing, [own, shared]))]) :-
    with_tmp_dir(Dir,
        ( small(Small),
          measures(beyond_sharing, [sharing-Sharing|Small], Dir, Ms) )),
    assertion(Ms.time > 1).
test(urgent) :-
    with_tmp_dir(Dir,
        ( small(Small),
          measures(beyond_urgent, [priority-0, deadline-1|Small], Dir, Ms),
          Ms.done + Ms.missed =:= 2,
          Ms.missed > 0,
          Ms.reported =< 2 )).
test(same_robots) :-
    robots(murdoch, Robots),
    robots(anta, Others),
    append(Robots, Others, All),
    sort(All, Able),
    length(Able, Count),
    Count =< 3.

:- end_tests(allocation_runs).
