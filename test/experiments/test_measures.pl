:- module(test_measures, []).

/** <module> Each measure of the project's studies, on a log made by hand

The values that are expected were calculated from the log, by the definitions in
doc/studies.md. No number is missing: each number that a study measures in its
example is expected, and each of its measures occurs in an example. For robots
see test_pole and test_boxes.
*/

:- use_module('../lib/common', []).
:- use_module('../lib/project_studies',
              [log_measures/5, project_study/2, study_names/1]).
:- use_module(library(apply), [exclude/3, maplist/3]).
:- use_module(library(lists),
              [append/2, append/3, member/2, memberchk/2, nth1/3,
               subtract/3]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(library(plunit)).

%   example(-Name, -Given, -Hosts, -Events, -Expected): the study in file Name
%   with parameters Given. Expected has the numbers, Measure-Value; a value
%   that is not known exactly is Least..Most.

:- discontiguous example/5.
:- op(150, xfx, ..).

%   entries(+Whats, -Events): Whats are Time:Host:Agent:What.

entries(Whats, Events) :-
    findall(event(Time, Host, Agent, What),
            member(Time:Host:Agent:What, Whats), Events0),
    sort(1, @=<, Events0, Events).

%   executed(+Executions, -Whats): Executions are
%   Sequence/Task/Host/(Start-End).

executed(Executions, Whats) :-
    findall(Time:Host:w:What,
            ( member(Sequence/Task/Host/(Start-End), Executions),
              (   Time = Start,
                  What = executing(Sequence, Task)
              ;   Time = End,
                  What = completed(Sequence, Task)
              ) ),
            Whats).

log_of(Executions, More, Events) :-
    executed(Executions, Whats),
    append(Whats, More, All),
    entries(All, Events).

                /*******************************
                *           CHAPTER 3          *
                *******************************/

%   rounds(+Whats, -Events): Whats are Round-Count*What; a round takes 10 s.

rounds(Whats, Events) :-
    findall(Time:h:x:What,
            ( member(Round-Count*What, Whats), between(1, Count, _),
              Time is 10*(Round - 1) + 1 ),
            All),
    entries(All, Events).

bits(Name, Bits) :-
    atom_chars(Name, Chars),
    maplist(atom_number, Chars, Bits).

born(How, Name, born(How, Bits)) :-
    bits(Name, Bits).

died(How, Name, died(How, Bits)) :-
    bits(Name, Bits).

waited(Name, Wait, served(Bits, [1], Wait, 1)) :-
    bits(Name, Bits).

made(Name, Wait, generated(Bits, [1], Wait)) :-
    bits(Name, Bits).

%   told(+Goals, -Whats): Round-Count*What of Round-Count*Goal, where What is
%   the last argument that Goal lacks.

told(Goals, Whats) :-
    findall(Round-Count*What,
            ( member(Round-Count*Goal, Goals), call(Goal, What) ), Whats).

complements([ 1-5*born(host, '11111'), 1-4*born(host, '00000'),
              1-3*born(host, '01010'), 2-2*born(host, '11110'),
              7-2*born(clone, '11111'), 7-1*born(clone, '11110'),
              8-1*born(host, '00000'), 8-1*born(host, '10000'),
              9-1*died(suppressed, '10000'), 9-1*died(aged, '11110') ]).

generic([ 1-3*born(host, '11111'), 1-1*born(host, '11110'),
          3-3*born(clone, '11110'), 9-1*born(clone, '11110'),
          11-1*born(clone, '11111'), 12-1*born(host, '11111'),
          13-2*born(host, '01110'), 15-3*died(aged, '11110')
        | Clones ]) :-
    findall(R-2*born(clone, '11110'), ( between(4, 15, R), R =\= 9 ), Clones).

others([ 1-6*born(host, '11110'), 1-2*born(host, '01110'),
         1-1*born(host, '00010'), 5-1*died(aged, '11110'),
         6-2*died(aged, '11110'), 6-3*born(clone, '00010'),
         7-1*died(suppressed, '11110'), 7-1*born(clone, '00010'),
         8-2*born(clone, '00010'), 9-2*born(clone, '00010'),
         10-4*born(clone, '00010'), 10-1*died(suppressed, '01110') ]).

returning([ 1-1*made('00000', 3), 1-1*made('00000', 5), 1-1*made('11100', 9),
            1-2*born(host, '11111'), 2-1*born(host, '11110'),
            2-4*born(host, '11100'), 3-1*'='(memory_cell([1,1,1,1,1])),
            9-1*waited('00000', 2), 9-1*waited('00001', 3),
            9-1*made('00001', 4), 9-1*made('11011', 7),
            9-1*died(aged, '11111') ]).

remembered([ 1-1*made('00000', 3), 1-1*made('00000', 5),
             3-1*'='(memory_cell([1,1,1,1,1])),
             5-1*'='(memory_cell([1,1,1,1,0])),
             14-1*waited('00000', 1), 14-1*waited('00000', 2),
             14-1*made('00000', 6), 15-1*waited('00000', 1) ]).

%   The second program goes round the obstacle.

programs([ 1-3*born(host, []), 1-1*born(host, Along),
           1-1*generated(block(left), [], 4),
           2-1*generated(block(left), Along, 4),
           12-1*born(clone, Along), 12-1*served(block(left), Along, 3, 2),
           12-1*served(block(left), [], 3, 2) ]) :-
    Along = [(right :- free(right), after(forward)), (left :- wall(ahead))].

example('sieve/figure_3_3', [round-10], [h], Events,
        [ least_complement-3, other_most-2, kinds-5, last_new-8,
          clones_of_complements-Clones, share-0.6 ]) :-
    complements(Goals),
    told(Goals, Whats),
    rounds(Whats, Events),
    Clones is 2/3.
example('sieve/study_comparisons', [round-10], [h], Events,
        [ complements-3, not_complements-2, generic-Share, new-0, not_new-7
        ]) :-
    complements(Goals),
    told(Goals, Whats),
    rounds(Whats, Events),
    Share is 2/17.
example('sieve/figure_3_4', [round-10], [h], Events,
        [ leads_from-3, share-Share, cloned_least-1, second-5, other_most-2,
          traces-2 ]) :-
    generic(Goals),
    told(Goals, Whats),
    rounds(Whats, Events),
    Share is 24/31.
example('sieve/figure_3_5', [round-10], [h], Events,
        [ generic_5-5, other_5-2, generic_10-2, aged-2, suppressed-1, new_5-1,
          new_10-13, growth_least-1, other_10-2 ]) :-
    others(Goals),
    told(Goals, Whats),
    rounds(Whats, Events).
example('sieve/beyond_memory', [round-10], [h], Events,
        [first-4, second-3, helped-0.75, cells-2]) :-
    remembered(Goals),
    told(Goals, Whats),
    rounds(Whats, Events).
example('sieve/beyond_return', [round-10, others-2], [h], Events,
        [first-4, second-2, similar-3.5, stranger-7, left-3, cells-1]) :-
    returning(Goals),
    told(Goals, Whats),
    rounds(Whats, Events).
example('sieve/beyond_programs', [round-10], [h], Events,
        [drawn-1..15.5, brought-1..15.5, able_first-25, able_last-40]) :-
    programs(Whats),
    rounds(Whats, Events).

                /*******************************
                *           CHAPTER 4          *
                *******************************/

%   In a maze of 3 by 3; a goes forth and back once, b near the diagonal, c
%   through the cells of a.

learning(Events) :-
    A = [ forward, backward, forward, forward, turn_left, forward, forward ],
    B = [ turn_left, forward, turn_right, forward, turn_left, forward,
          turn_right, forward ],
    C = [forward, forward, turn_left, forward, forward],
    entries([ 10:h1:a:executed(1, 0, 1, unreached),
              11:h2:b:executed(1, 0, 2, unreached), 12:h3:a:shared(b, 2),
              13:h4:c:executed(1, 0, 2, unreached),
              15:h3:a:executed(2, 4, 3, unreached), 16:h3:b:shared(a, 1),
              18:h4:c:executed(2, 6, 2, reached),
              20:h3:b:executed(2, 2, 3, reached), 22:h3:a:shared(b, 1),
              25:h4:a:executed(3, 6, 4, reached),
              30:h4:a:converged(3, 12, A), 35:h4:c:converged(2, 5, C),
              40:h5:b:converged(2, 20, B) ],
            Events).

learnt([executions-Mean, total-7, sharing-Sharing, duration-30, hops-Hops]) :-
    Mean is 7/3,
    Sharing is 3/7,
    Hops is 37/3.

%   30 parts, of which those with the numbers 2, 6 and 12, or 3, 9 and 18, have
%   an event: the sum of squares of 30 numbers around their mean is 2247.5.

trends([trend-Trend, early_trend-Early]) :-
    Trend is 100*(-23.5/2247.5*30)/(3/30),
    Early is 100*(-13.5/2247.5*30)/(3/30).

learnt(Own, Measures) :-
    learnt(Common),
    append(Common, Own, Measures).

example('learning/figure_4_7', [size-2, network-50, sharing-true], [h],
        Events, Measures) :-
    learning(Events),
    Spread is sqrt(8/3)/4,
    Aside is (5/7 + 2/5 + 4/5)/3/sqrt(2),
    Detour is 2/3,
    learnt([ agents-3, distinct-2, overlap-0.5, spread-Spread, aside-Aside,
             nearer-(60..74), detour-Detour ], Measures).
example('learning/figure_4_9', [size-2, network-10], [h], Events, Measures) :-
    learning(Events),
    trends(Trends),
    Mean is 7/3,
    learnt([no_obstacle-Mean|Trends], Measures).
example('learning/figure_4_13', [size-2], [h], Events, Measures) :-
    learning(Events),
    trends(Trends),
    learnt([least_degree-(0..20), most_degree-(21..49)|Trends], Measures).
example('learning/study_light', [size-2], [h], Events, Measures) :-
    learning(Events),
    learnt(Measures).

%   16 vectors, 5 actions: 38,146,972,655 sequences; a single agent.

example('learning/study_bounds', [size-2], [h], Events, Measures) :-
    learning(Events),
    learnt([beta_digits-11, gamma_digits-11, theta_digits-1], Measures).

%   Algorithms beyond the thesis: two agents, a clone, and what comes after the
%   last of the two has reached the goal.

crew(Events) :-
    L1 = 'learner.1',
    L2 = 'learner.2',
    entries([ 0:h:L1:created, 0:h:L2:created,
              1:h:L1:executed(1, 0, 4, unreached),
              3:h:L2:executed(1, 0, 3, reached), 4:h:'learner.3':cloned,
              5:h:L1:shared(L2, 1), 6:h:L1:executed(2, 1, 5, reached),
              7:h:'learner.3':executed(1, 0, 9, reached),
              7:h:'learner.3':shared(L2, 1), 8:h:L1:ended(exit) ], Events).

example(Name, [agents-2], [h], Events, Measures) :-
    member(Name-Pages,
           [ 'algorithms/beyond_settings'-[pages-8],
             'algorithms/beyond_islands'-[pages-8],
             'algorithms/beyond_mixed'-[], 'algorithms/beyond_exchange'-[],
             'algorithms/beyond_cloning'-[],
             'algorithms/beyond_crews'-[] ]),
    crew(Events),
    append(Pages,
           [ agents-2, reached-100, mean-1.5, executions-3, first-2, shared-1,
             time-6, clones-1, most-3 ], Measures).

%   The second settings lose more than a whole page, whatever the printer; three
%   of four agents carry them.

example('algorithms/beyond_contest', [agents-1], [h], Events,
        [ found-2, share-75, chosen-0, best-(0.89..1), mean-(0.44..0.5),
          rank-2 ]) :-
    Good = [3,photo,glossy,6,6,1],
    Bad = [1,draft,thin,9,9,5],
    entries([ 0:h:'learner.1':created, 1:h:'learner.2':created,
              2:h:'learner.1':converged(1, 1, [use(Good), again]),
              3:h:'learner.2':converged(1, 1, [use(Good), use(Bad)]),
              4:h:g:born(host, found(climb, Good)),
              5:h:g:born(host, found(genetic, Bad)),
              6:h:g:born(clone, found(genetic, Bad)),
              7:h:g:born(clone, found(genetic, Bad)),
              8:h:g:born(clone, found(climb, Good)),
              9:h:g:died(suppressed, found(climb, Good)) ], Events).

                /*******************************
                *           CHAPTER 5          *
                *******************************/

%   Four tasks on three hosts: c executes task 3 before task 2 has ended there,
%   a before task 2 has begun on c; task 4 is executed twice on b and never on
%   c.

in_step(Events) :-
    log_of([ m/1/a/(10-13), m/1/b/(10.5-13.5), m/1/c/(10.9-15),
             m/2/a/(18-21), m/2/b/(19-22), m/2/c/(22-25),
             m/3/a/(21.5-24.5), m/3/b/(26-29), m/3/c/(24-30),
             m/4/a/(32-35), m/4/b/(32.5-36), m/4/b/(37-38) ],
           [10:a:t:begun], Events).

stepped(Own, Measures) :-
    append([ idle-5, least_gap-0, overlaps-2, premature-1, tau-2,
             total-28, burst-3,
             later_burst-2, executions-12, missing-1, out_of_order-1 ],
           Own, Measures).

example(Name, [tasks-4], [a, b, c], Events, Measures) :-
    member(Name-Own,
           [ 'sync/figure_5_5'-[ serviced-0.9, unrequired-0.9, second-8,
                                 pause-1 ],
             'sync/figure_5_6'-[], 'sync/figure_5_7'-[], 'sync/figure_5_8'-[],
             'sync/figure_5_9'-[], 'sync/study_choices'-[serviced-0.9],
             'sync/study_demo'-[], 'sync/beyond_guarantee'-[],
             'sync/study_links'-[],
             'sync/study_onset'-[overlapped-1],
             'sync/study_long_tasks'-[busy-3, tau_least-0],
             'sync/study_surface'-[second-8, spread-0.9] ]),
    in_step(Events),
    stepped(Own, Measures).

%   Both hosts lose task 1, b while it waits for task 2.

example('sync/figure_5_11', [tasks-2, failure-atomic(1, 2, 2)], [a, b],
        Events,
        [ idle-4.5, least_gap-4.5, overlaps-0, premature-0, tau-1, total-17,
          burst-2, later_burst-1, executions-6, missing-0, out_of_order-0,
          healing_time-7.5, failed_at-9.5, failed_by-10, lost-2, lost_hosts-2,
          redone-2, healed_at-17, meanwhile-1, healing_tau-1, later_tau-0 ]) :-
    log_of([ m/1/a/(0-3), m/1/b/(0.5-3.5), m/2/a/(8-11), m/2/b/(10.5-13.5),
             m/1/b/(14-15), m/1/a/(14-17) ],
           [ 0:a:t:begun, 9.5:b:w:failed(m, 1), 10:a:w:failed(m, 1) ],
           Events).

%   a loses two tasks, b one.

example('sync/figure_5_12', [tasks-2, failure-cascaded(1, 2, 2)], [a, b],
        Events,
        [ idle-7.5, least_gap-3, overlaps-0, premature-0, tau-2, total-21,
          burst-2, later_burst-1, executions-7, missing-0, out_of_order-0,
          healing_time-7, failed_at-12, failed_by-12.5, lost-3, lost_hosts-2,
          redone-3, healed_at-19, meanwhile-0, healing_tau-1, later_tau-0 ]) :-
    log_of([ m/1/a/(0-3), m/1/b/(0.5-3.5), m/2/a/(8-11), m/1/a/(13-14),
             m/1/b/(13.5-15), m/2/a/(18-19), m/2/b/(19-21) ],
           [ 0:a:t:begun, 12:a:w:failed(m, 1), 12:a:w:failed(m, 2),
             12.5:b:w:failed(m, 1) ], Events).

%   Two sequences: b executes both at once twice, the second time before the
%   task for which it should wait; c executes only task 2 of the first.

two_sequences(Events) :-
    A-B = sequence1-sequence2,
    log_of([ A/1/a/(0-3), A/1/b/(1-4), A/2/c/(0.5-2), A/2/a/(5-8),
             A/2/b/(6-9), B/1/b/(3-6), B/2/b/(7-10), B/2/b/(11-12) ],
           [0:a:t:begun], Events).

example('sync/beyond_several',
        [hosts-3, tasks-2, sequences-2, share-1, dependent-true], [a, b, c],
        Events,
        [ wanted-12, executions-8, missing-5, total-12, idle-0.5, overlaps-1,
          premature-1, out_of_order-1, both-2, early-1 ]) :-
    two_sequences(Events).
example('sync/beyond_selected', [hosts-3, tasks-2, share-1], [a, b, c],
        Events,
        [ wanted-6, executions-5, missing-1, total-9, idle-0, overlaps-1,
          premature-1, out_of_order-1 ]) :-
    two_sequences(Events).

%   Three rewards of a full potential, which raise nothing, a penalty, a reward,
%   a penalty that uses up the rest.

example('sync/figure_5_2', [maximum-4, theta-2, delta-1], [], [],
        [ visits-6, first_penalty-3, last_theta-1.7459375, early-1.7459375,
          not_raised-3 ]).
example('sync/study_readings', [reading-agents, delta-0.2], [], [],
        [visits-76]).

                /*******************************
                *           CHAPTER 6          *
                *******************************/

agent(Kind, Number, Agent) :-
    format(atom(Agent), 'agent~w.x.~w@a', [Kind, Number]).

%   alive(+Kind, +Number, +From, +To, -Whats)

alive(Kind-Lives, Whats) :-
    findall(Time:a:Agent:What,
            ( nth1(N, Lives, From-To),
              agent(Kind, N, Agent),
              ( Time = From, What = created
              ; Time = To, number(To), What = ended(disposed) ) ),
            Whats).

%   Five tasks on two hosts, in times after the start, which is at 100: task 2
%   begins on b before task 1 has ended there, task 3 on a before task 2 has
%   begun there. Both lose task 2; b executes it again, and a task 1.

population(Events) :-
    executed([ m/1/a/(100-104), m/1/b/(102-107), m/2/a/(109-112),
               m/2/b/(106-115), m/3/a/(108-120), m/3/b/(118.5-122),
               m/2/b/(124-125), m/1/a/(128-129), m/4/a/(131-133),
               m/4/b/(135-136), m/5/a/(134-135) ], Executed),
    maplist(alive, [ 1-[98-none, 114-117],
                     2-[98-none, 111-116, 112.5-118, 113-118, 126-129.5,
                        126.5-129.6],
                     3-[98-none, 119-123, 119.5-124, 120-125, 120.5-126],
                     4-[98-none], 5-[98-none] ], Lives),
    append([Executed, [ 100:a:t:begun, 121:b:w:failed(m, 2),
                        121.5:a:w:failed(m, 2) ]|Lives], All),
    entries(All, Events).

populated([ missing-1, out_of_order-2, overlapped-3, premature-2, span_least-1,
            span_most-14, gap_least-(-7), gap_most-9, peak_least-1,
            peak_most-5, peak_total-9, peaks_out_of_order-3, end-36 ]).

example('population/figure_6_3', [hosts-2, tasks-5], [a, b], Events,
        Measures) :-
    population(Events),
    populated(Measures).
example('population/figure_6_4', [hosts-2, tasks-5], [a, b], Events,
        Measures) :-
    population(Events),
    populated(Common),
    append(Common,
           [ lost-2, crash_time-21, healed-25, rise-2, rise_time-26.5,
             first_peak-4, second_peak-3, not_healed-1, again-2,
             later_overlapped-1 ], Measures).

%   The third agent is excited too early, and once more at the end.

example('population/table_6_1', [], [a], Events,
        [ excited_1-1, active_1-3, excited_2-5, active_2-9, excited_3-7,
          active_3-11, lapses-1, rows-6, others-1, wrong-1 ]) :-
    findall(Time:a:Agent:What,
            ( member(Kind-States, [ 1-[1-excited, 3-active],
                                    2-[5-excited, 9-active],
                                    3-[7-excited, 11-active, 12-excited] ]),
              agent(Kind, 1, Agent),
              ( Time-What = 0-begun
              ; member(Time-State, [0-dormant|States]),
                What = state(State) ) ),
            All),
    entries(All, Events).

                /*******************************
                *           CHAPTER 7          *
                *******************************/

%   a backs off twice, b once; b is completed first.

allocation(Events) :-
    entries([ 5:h:a1:begun(a), 5.5:h:b1:begun(b),
              6:r1:r:reserved(r1, a1, a), 7:h:a1:backoff(2),
              7:r1:r:released(r1, a1, a), 8:r1:r:reserved(r1, b1, b),
              9:h:b1:backoff(4), 10:h:a1:backoff(9), 13:h:b1:completed(b),
              13:r1:r:released(r1, b1, b), 13:h:b1:communications(migration, 7),
              14:h:c1:communications(child, 2), 14:h:n:communications(ack, 4),
              14:h:n:communications(renew, 5), 14:h:n:communications(start, 2),
              15:h:a1:completed(a), 15:h:a1:communications(migration, 30) ],
            Events).

example(Name, [allocators-2, required-2], [h], Events,
        [ communications-50, time-10, rate-5, backoffs-1.5, interval-5,
          upkeep-0.18, migration-37, child-2, ack-4, renew-5, start-2 ]) :-
    member(Name, [ 'allocation/figure_7_1_to_7_3', 'allocation/figure_7_4',
                   'allocation/figure_7_5', 'allocation/study_contention',
                   'allocation/beyond_sharing' ]),
    allocation(Events).

%   Of five tasks 3 and 4 miss their deadline; 3 has a robot.

example('allocation/beyond_urgent', [deadline-10], [h], Events,
        [late-9.5, others-10, done-3, missed-2, reported-1, free-4]) :-
    entries([ 0:h:x:begun(1), 0:h:x:begun(2), 0:h:x:begun(3), 0:h:x:begun(4),
              3:h:x:begun(5), 6:r:r:reserved(r, x, 3), 8:h:x:completed(1),
              10.5:h:x:missed(3, 10), 11:h:x:missed(4, 10),
              12:h:x:completed(2), 12.5:h:x:completed(5),
              14:r:r:released(r, x, 3) ], Events).

%   r2 lacks task 2 of the first sequence, which r4 executes without being
%   allocated; r2 executes both sequences at once, and task 2 of the second
%   before r3 has begun task 1.

example('allocation/beyond_integrated', [length-2], [r1], Events,
        [ found-4, completed-11, communications-7, faulty-1, strangers-1,
          overlaps-1, disorder-1, both-1 ]) :-
    A-B = sequence1-sequence2,
    log_of([ A/1/r1/(4-5), A/1/r2/(4-6), A/2/r1/(7-8), A/2/r4/(7-9),
             B/1/r2/(5-7), B/1/r3/(8-9), B/2/r2/(7.5-10), B/2/r3/(10-11) ],
           [ 1:h:x:begun(A), 2:h:y:begun(B), 3:h:x:allocated(A, [r1, r2]),
             5:h:y:allocated(B, [r2, r3]), 10:h:x:completed(A),
             12:h:y:completed(B), 12:h:x:communications(migration, 4),
             12:h:y:communications(message, 3) ], Events).

%   r3 replaces r2, which begins task 2 after its loss.

example('allocation/beyond_replacement', [length-2], [r1], Events,
        [ completed-20, overlaps-1, faulty-0, disorder-0, replaced-1,
          catching_up-7, after-1 ]) :-
    log_of([ main/1/r1/(4-5), main/1/r2/(4-6), main/2/r1/(15-20),
             main/2/r2/(8-9), main/1/r3/(11-13), main/2/r3/(14-17) ],
           [ 1:h:x:begun(main), 3:h:x:allocated(main, [r1, r2]),
             6.5:h:x:lost(r2, failed), 10:h:x:allocated(main, [r1, r3]),
             21:h:x:completed(main) ], Events).

                /*******************************
                *       BEYOND THE THESIS      *
                *******************************/

%   Rounds 2 and 3 have the same hosts.

example('hierarchy/beyond_lead', [rows-[[1, 2, 2]], parts-1, tasks-2], [a, b],
        Events,
        [overlaps-3, settled-2, total-28, idle-2, missing-47]) :-
    R1-R2-R3 = round1-round2-round3,
    log_of([ R1/1/a/(0-3), R1/1/b/(1-4), R1/2/a/(6-9), R1/2/b/(7-10),
             R2/1/a/(20-23), R2/1/b/(22-25), R2/2/a/(21.5-24),
             R2/2/b/(27-30),
             R3/1/a/(40-43), R3/1/b/(44-46), R3/2/a/(43-45),
             R3/2/c/(43.5-44), R3/2/b/(47-48) ],
           [ 0:a:t:begun, 0:a:l:leads(R1, [delta-0.5]),
             19:a:l:leads(R2, [delta-0.4]), 39:a:l:leads(R3, [delta-0.3]) ],
           Events).

%   The work moves to the second part in round 3.

example('hierarchy/beyond_lead_learning', [rounds-4], [h], Events,
        [time-42, settled-15, executions-3]) :-
    Leader-Other = 'leader.1@p1n1@x'-'leader.2@p2n1@x',
    Converged = converged(1, 1, []),
    Executed = executed(1, 0, 1, reached),
    entries([ 0:h:c:asks(round1), 0:h:Leader:leads(round1, [workers-4]),
              7:h:x:Executed, 8:h:x:Converged, 12:h:y:Converged,
              20:h:c:served(round1),
              30:h:c:asks(round2), 30:h:Leader:leads(round2, [workers-6]),
              36:h:x:Converged, 50:h:c:served(round2),
              60:h:c:asks(round3), 60:h:Other:leads(round3, [workers-3]),
              70:h:x:Executed, 75:h:x:Converged, 90:h:c:served(round3),
              100:h:c:asks(round4), 100:h:Other:leads(round4, [workers-6]),
              105:h:x:Executed, 109:h:x:Converged, 120:h:c:served(round4) ],
            Events).

%   The second alarm belongs to the first.

example('applications/study_fire_alarm', [], [h], Events,
        [false_alarms-2, delay-12]) :-
    entries([ 100:h:x:alarm(1), 200:h:x:alarm(1), 230:h:x:alarm(2),
              1812:h:x:alarm(1), 1850:h:x:alarm(2) ], Events).

%   Of four persons two are out.

example('applications/study_fire_signs', [], [h], Events,
        [time-335, last-600, smoke-1, lost-0.5]) :-
    entries([ 100:h:x:out(1, 0.5), 160:h:x:out(2, 1.5),
              660:h:x:people(2, 1, 1) ], Events).
example('applications/study_irrigation', [], [h], Events,
        [water-15, drained-3, stress-3]) :-
    entries([9:h:x:totals([f-totals(10, 2, 48), g-totals(20, 4, 96)])],
            Events).

%   Houses have totals(_, _, Bought, Wasted, Taken, Sold, Paid); houses 3 and 9
%   of ten are three links and two from the battery.

example('applications/study_solar', [strategy-Strategy], [h], Events,
        [ bought-40, wasted-3, fairness-Fairness, reward-Reward,
          crossings-Crossings ]) :-
    member(Strategy-Crossings0, [auction-660, first-10]),
    Crossings is Crossings0/330,
    Fairness is 1.75**2/(3*(0.25 + 0.0625 + 1)),
    Reward is 950/3/sqrt(26/3*35000/3),
    entries([ 5:h:x:cleared(1, 1, 330), 6:h:x:cleared(1, 1, 660),
              7:h:x:granted(3, 1), 8:h:x:granted(9, 1),
              9:h:x:totals(b, [ h1-totals(0, 0, 10, 1, 10, 5, 100),
                                h2-totals(0, 0, 30, 2, 10, 1, 250),
                                h3-totals(0, 0, 0, 0, 10, 2, 200) ]) ],
            Events).

%   a lifts before b has ended its approach; a robot is not released.

example('applications/study_warehouse', [], [a, b], Events,
        [time-30, delivered-4, falls-1, early-1, held-1, backoffs-2]) :-
    log_of([ o/approach/a/(0-3), o/approach/b/(1-6), o/lift/a/(4-8),
             o/lift/b/(7-9) ],
           [ 0:a:r:reserved(r, x, o), 1:a:x:backoff(5), 2:a:x:backoff(6),
             20:a:x:completed(o), 30:a:x:completed(p),
             31:a:x:orders(4, 2, 1) ], Events).

%   b does not return, and works on a robot twice.

example('fleet/study_away', [agents-2, limit-100], [h, r], Events,
        [done-1, time-60, tries-1.5, twice-1]) :-
    entries([ 0:h:a:sent, 0:h:a:tries, 5:r:a:begins, 9:r:a:tries,
              20:h:a:delivered, 30:h:b:sent, 31:h:b:tries, 40:r:b:begins,
              50:r:b:begins ], Events).

%   differing(+Name, +Given, -Wrong, -Missing): in the example; Wrong are
%   Measure-Value, with another value than is expected, or not expected.

differing(Name, Given, Wrong, Missing) :-
    once(example(Name, Given, Hosts, Events, Expected)),
    measured(Name, Given, Hosts, Events, Numbers),
    findall(Number, ( member(Number, Numbers),
                      \+ as_expected(Expected, Number) ), Wrong),
    maplist(pairs_keys, [Expected, Numbers], [Wanted, Found]),
    subtract(Wanted, Found, Missing).

measured(Name, Given, Hosts, Events, Numbers) :-
    project_study(Name, Study),
    log_measures(Study, Given, Hosts, Events, Measures),
    findall(Measure-Value, ( member(Measure-Value, Measures), number(Value) ),
            Numbers).

as_expected(Expected, Measure-Value) :-
    memberchk(Measure-Is, Expected),
    (   Is = (Least..Most)
    ->  Least =< Value,
        Value =< Most
    ;   abs(Value - Is) < 1.0e-9*max(1, abs(Is))
    ).

%   studies(-Names): all but those of robots.

studies(Names) :-
    study_names(All),
    exclude(of_robots, All, Names).

of_robots(Name) :-
    file_directory_name(Name, robots).

%   a_measure(+Name, -Measure): Measure is the name in a clause of measure/3.

a_measure(Name, Measure) :-
    project_study(Name, Study),
    clause(Study:measure(Measure, _, _), _),
    atom(Measure).

:- begin_tests(measures).

test(measure_of_a_log, [ forall(example(Name, Given, _, _, _)),
                         true(Wrong-Missing == []-[]) ]) :-
    differing(Name, Given, Wrong, Missing).
test(every_study_has_an_example, Missing == []) :-
    studies(Names),
    findall(Name, ( member(Name, Names),
                    \+ example(Name, _, _, _, _) ), Missing).

%   Measures that are no numbers, for pictures; the quality of printers.

beside([ table, steps, rows, started, final, moves, plans, times, drawn,
         deltas, overlaps_by_round, by_round, workers, seconds, able, served,
         generated, most_short, healing_time ]).

test(every_measure_is_in_an_example, Missing == []) :-
    studies(Names),
    beside(Beside),
    findall(Name-Measure,
            ( member(Name, Names),
              a_measure(Name, Measure),
              \+ memberchk(Measure, Beside),
              \+ ( example(Name, _, _, _, Expected),
                   memberchk(Measure-_, Expected) ) ),
            Missing).

:- end_tests(measures).
