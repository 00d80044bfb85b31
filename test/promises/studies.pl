%   What doc/studies.md promises, see ../promises.pl.

promise(same_seed_same_run, study_run,
        'experiments/engine/run.pl',
        "    study_at_work(Study),\n\c
         \s   set_random(seed(Seed))."-
        "    study_at_work(Study).").
promise(seed_of_the_network, study_run,
        'experiments/engine/run.pl',
        "processes(Case.processes), seed(Case.seed),"-
        "processes(Case.processes),").
promise(medians_with_extremes, outcome,
        'experiments/engine/numbers.pl',
        "    Sorted = [Least|_],\n\c
         \s   last(Sorted, Most)."-
        "    Least = Median,\n\c
         \s   last(Sorted, Most).").
promise(first_parameter_varies_slowest, study_cases,
        'experiments/engine/cases.pl',
        "    member(Value, Values),\n\c
         \s   choice(Lists, Pairs)."-
        "    choice(Lists, Pairs),\n\c
         \s   member(Value, Values).").
promise(skipped_cases_are_left_out, study_cases,
        'experiments/engine/cases.pl',
        "    foldl(derive(Study), Derived, Case0, Case),\n\c
         \s   \\+ Study:skip(Case)."-
        "    foldl(derive(Study), Derived, Case0, Case).").
promise(set_overrides_a_parameter, study_cases,
        'experiments/engine/cases.pl',
        "counts(_, Given, Name, Value, given) :-\n\c
         \s   memberchk(Name-Value, Given),\n\c
         \s   !.\n"-
        "").
promise(a_list_is_varied, study_cases,
        'experiments/engine/cases.pl',
        "values(given, Values, Values) :- is_list(Values), !.\n"-
        "").
promise(own_definition_takes_precedence, study_cases,
        'experiments/engine/cases.pl',
        "    (   member(own-_, All)\n\c
         \s   ->  findall(Pair, member(own-Pair, All), Pairs)\n\c
         \s   ;   findall(Pair, member(_-Pair, All), Pairs)\n\c
         \s   ),"-
        "    findall(Pair, member(_-Pair, All), Pairs),").
promise(network_is_stopped, study_run,
        'experiments/engine/run.pl',
        "          still_there(Pids, Network) ),\n\c
         \s       network_stop(Network))."-
        "          still_there(Pids, Network) ),\n\c
         \s       true).").
promise(view_is_what_is_measured, study_run,
        'experiments/engine/run.pl',
        "    ->  must(Study, view(Log, View))"-
        "    ->  must(Study, view(Log, _)), View = Log").
promise(failed_measure_has_no_value, study_run,
        'experiments/engine/run.pl',
        "    findall(Name-Value, study_call(Study, measure(Name, View, Value)), Pairs0),"-
        "    findall(Name-Value, ( clause(Study:measure(Name, _, _), _), ( study_call(Study, measure(Name, View, Value)) -> true ; Value = 0 ) ), Pairs0),").
promise(only_labelled_measures_are_shown, outcome,
        'experiments/engine/report.pl',
        "    (   Labelled == []\n\c
         \s   ->  Measures = All\n\c
         \s   ;   list_to_set(Labelled, Measures)\n\c
         \s   )."-
        "    Measures = All.").
promise(share_of_the_known_seeds, outcome,
        'experiments/engine/outcome.pl',
        "    exclude(==(unknown), Verdicts, Known),"-
        "    Known = Verdicts,").
promise(missing_run_is_not_known, claims,
        'experiments/engine/expressions.pl',
        "    ;   Measures == missing,\n\c
         \s       Value = missing\n\c
         \s   )."-
        "    ).").
promise(undecided_claim_is_not_known, claims,
        'experiments/engine/claims.pl',
        "in_relation(_, Values, unknown) :-\n\c
         \s   memberchk(missing, Values),\n\c
         \s   !."-
        "in_relation(_, Values, true) :-\n\c
         \s   memberchk(missing, Values),\n\c
         \s   !.").
promise(decided_claim_has_failed, claims,
        'experiments/engine/claims.pl',
        "    member(Truth, [false, unknown]),"-
        "    member(Truth, [unknown, false]),").
promise(own_test_of_all_runs, claims,
        'experiments/engine/claims.pl',
        "    (   memberchk(_-missing, Points)\n\c
         \s   ->  Truth = unknown\n\c
         \s   ;   truth(call(M:Goal, Points), Truth)\n\c
         \s   )."-
        "    truth(call(M:Goal, Points), Truth).").
promise(medians_of_all_seeds, outcome,
        'experiments/engine/outcome.pl',
        "    points(Expected, median(Rows, SeedCount), Medians),"-
        "    points(Expected, median(Rows, 1), Medians),").
promise(claims_are_about_all_cases, outcome,
        'experiments/engine/outcome.pl',
        "    expected_cases(Study, Given, Expected),"-
        "    Expected = Cases,").
promise(claims_about_other_values, study_cases,
        'experiments/engine/cases.pl',
        "    subtract(Chosen, Own, Others),\n\c
         \s   Others \\== Chosen,"-
        "    subtract(Chosen, Own, Others),").
promise(not_of_the_medians, outcome,
        'experiments/engine/report.pl',
        "    Of > 1,\n\c
         \s   Held > 0,\n\c
         \s   !."-
        "    Of > 1,\n\c
         \s   Held =:= Of,\n\c
         \s   !.").
promise(comparison_holds_in_every_case, claims,
        'experiments/engine/claims.pl',
        "    member(Truth, [false, unknown]),\n\c
         \s   memberchk(Truth, Truths),\n\c
         \s   !."-
        "    member(Truth, [unknown]),\n\c
         \s   memberchk(Truth, Truths),\n\c
         \s   !.").
promise(near_includes_the_bound, claims,
        'experiments/engine/claims.pl',
        "abs(A - B) =< Within."-
        "abs(A - B) < Within.").
promise(between_includes_the_bounds, claims,
        'experiments/engine/claims.pl',
        "Least =< A, A =< Most."-
        "Least =< A, A < Most.").
promise(rises_from_each_value, claims,
        'experiments/engine/claims.pl',
        "leaf(rises(E, along(P)), <, steps(P), [E])."-
        "leaf(rises(E, along(P)), =<, steps(P), [E]).").
promise(falls_from_each_value, claims,
        'experiments/engine/claims.pl',
        "leaf(falls(E, along(P)), >, steps(P), [E])."-
        "leaf(falls(E, along(P)), >=, steps(P), [E]).").
promise(ends_from_first_to_last, claims,
        'experiments/engine/claims.pl',
        "    along(P, E, Context, [A|Values]),\n\c
         \s   last(Values, B)."-
        "    along(P, E, Context, [A|Values]),\n\c
         \s   Values = [B|_].").
promise(least_against_any_other, claims,
        'experiments/engine/claims.pl',
        "leaf(least(E, P=V), <, against(P, V), [E])."-
        "leaf(least(E, P=V), =<, against(P, V), [E]).").
promise(most_against_any_other, claims,
        'experiments/engine/claims.pl',
        "leaf(most(E, P=V), >, against(P, V), [E])."-
        "leaf(most(E, P=V), >=, against(P, V), [E]).").
promise(at_selects_cases, claims,
        'experiments/engine/claims.pl',
        "verdict(at(Where, Test), M, Context, Truth) :-\n\c
         \s   !,\n\c
         \s   selected(Where, Context, Selected),"-
        "verdict(at(_, Test), M, Context, Truth) :-\n\c
         \s   !,\n\c
         \s   Selected = Context,").
promise(some_case_is_enough, claims,
        'experiments/engine/claims.pl',
        "                 verdict(\\+ Test, M, context([Point], All, Follows), T) ),\n\c
         \s           Truths),\n\c
         \s   all_of(Truths, Truth0),\n\c
         \s   opposite(Truth0, Truth)."-
        "                 verdict(Test, M, context([Point], All, Follows), T) ),\n\c
         \s           Truths),\n\c
         \s   all_of(Truths, Truth).").
promise(at_in_an_expression, claims,
        'experiments/engine/expressions.pl',
        "        key(Free, Case1, Key)\n\c
         \s   ->  Point = Case1-Measures"-
        "        key(Free, Case1, _)\n\c
         \s   ->  Point = Case1-Measures").
promise(sum_of_all_cases, claims,
        'experiments/engine/expressions.pl',
        "    sum_list([V|Values], Sum)."-
        "    sum_list(Values, Sum0), Sum is Sum0 + 0*V.").
promise(mean_of_all_cases, claims,
        'experiments/engine/expressions.pl',
        "aggregate(mean(E), mean, E)."-
        "aggregate(mean(E), sum, E).").
promise(least_of_all_cases, claims,
        'experiments/engine/expressions.pl',
        "aggregate(least(E), min_list, E)."-
        "aggregate(least(E), max_list, E).").
promise(rise_from_first_to_last, claims,
        'experiments/engine/expressions.pl',
        "    of_known([Last,First], result(-), Rise)."-
        "    of_known([First,Last], result(-), Rise).").
promise(correlation_of_ranks, claims,
        'experiments/engine/expressions.pl',
        "    ;   rank_correlation(Xs, Ys, Value)\n\c
         \s   )."-
        "    ;   rank_correlation(Ys, Ys, Value)\n\c
         \s   ).").
promise(derived_parameters_may_differ, claims,
        'experiments/engine/expressions.pl',
        "              key([P|Follows], Case, Key) ),"-
        "              key([P], Case, Key) ),").
promise(numbers_are_in_order, claims,
        'experiments/engine/expressions.pl',
        "    (   Others == []\n\c
         \s   ->  keysort(Line0, Line)\n\c
         \s   ;   Line = Line0\n\c
         \s   )."-
        "    Line = Line0, Others = _.").
promise(nothing_to_compare_is_not_known, claims,
        'experiments/engine/claims.pl',
        "all_of([First|Truths], true) :-\n\c
         \s   \\+ memberchk(none, [First|Truths])."-
        "all_of(Truths, true) :-\n\c
         \s   \\+ memberchk(none, Truths).").
promise(negation_is_not_known, claims,
        'experiments/engine/claims.pl',
        "opposite(unknown, unknown)."-
        "opposite(unknown, true).").
promise(lines_from_least_to_greatest, study_pictures,
        'experiments/engine/lines.pl',
        "    ->  Row = [At, Median, Least, Most]\n\c
         \s   ;   Row = [At, 'NaN'"-
        "    ->  Row = [At, Median, Median, Most], Least = _\n\c
         \s   ;   Row = [At, 'NaN'").
promise(real_runs_within_the_range, outcome,
        'experiments/engine/cross_check.pl',
        "verdict(Least, Most, Real, inside) :-\n\c
         \s   Least =< Real,\n\c
         \s   Real =< Most,\n\c
         \s   !."-
        "verdict(Least, Most, Real, inside) :-\n\c
         \s   Least < Real,\n\c
         \s   Real < Most,\n\c
         \s   !.").
promise(design_has_this_many_points, sampling,
        'experiments/engine/sampling.pl',
        "    Last is Count - 1,\n\c
         \s   numlist(0, Last, Is),"-
        "    Last is max(0, Count - 2),\n\c
         \s   numlist(0, Last, Is),").
promise(loguniform_by_logarithm, sampling,
        'experiments/engine/sampling.pl',
        "    Value0 is A*(B/A)**Share,"-
        "    Value0 is A + Share*(B - A),").
promise(integers_include_both_ends, sampling,
        'experiments/engine/sampling.pl',
        "    Value is min(B, A + truncate(Share*(B - A + 1)))."-
        "    Value is min(B, A + truncate(Share*(B - A))).").
promise(sampled_parameters_are_independent, sampling,
        'experiments/engine/sampling.pl',
        "    chance_hash(Name-Seed, Hash),"-
        "    chance_hash(Seed, Hash),").
promise(hypercube_has_a_point_in_each_part, sampling,
        'experiments/engine/sampling.pl',
        "    Share is (Part + Inside)/Count."-
        "    Share is (Part*0 + Inside) + Count*0.").
promise(seed_of_the_points, sampling,
        'experiments/engine/sampling.pl',
        "design(random(Count, Seed), random, Count, Seed)."-
        "design(random(Count, _), random, Count, 1).").
promise(combinations_have_all_points, sampling,
        'experiments/engine/cases.pl',
        "    choice(Lists, Pairs0),\n\c
         \s   member(Point, Points),"-
        "    choice(Lists, Pairs0),\n\c
         \s   Points = [Point|_],").
promise(series_at_each_step, sampling,
        'experiments/engine/series.pl',
        "    (   Time > End\n\c
         \s   ->  Series = []"-
        "    (   Time >= End - Every\n\c
         \s   ->  Series = []").
promise(stepped_has_the_last_value, sampling,
        'experiments/engine/series.pl',
        "    At =< Time,\n\c
         \s   !,\n\c
         \s   up_to(Changes0, Time, Value1, Changes, Value)."-
        "    At < Time,\n\c
         \s   !,\n\c
         \s   up_to(Changes0, Time, Value1, Changes, Value).").
promise(counted_up_to_each_step, sampling,
        'experiments/engine/series.pl',
        "    findall(N, between(1, Count, N), Ns),"-
        "    Last is Count - 1, findall(N, between(0, Last, N), Ns),").
promise(idle_time_is_a_sum, measures,
        'experiments/sync/metrics.pl',
        "    aggregate_all(sum(Idle),\n\c
         \s                 ( member(task(_, _, _, _, _, Idle), Rows),"-
        "    aggregate_all(max(Idle),\n\c
         \s                 ( member(task(_, _, _, _, _, Idle), Rows),").
promise(least_gap_of_all, measures,
        'experiments/sync/ground.pl',
        "    aggregate_all(min(Idle), ( member"-
        "    aggregate_all(max(Idle), ( member").
promise(overlap_is_before_the_last_start, [measures, sync_metrics],
        'experiments/sync/metrics.pl',
        "    Start < LastStart,\n\c
         \s   !."-
        "    Start =< LastStart,\n\c
         \s   !.").
promise(early_is_before_the_last_end, pole,
        'experiments/robots/pole_metrics.pl',
        "                      End > Start )"-
        "                      End >= Start )").
promise(tau_counts_distinct_tasks, [measures, sync_metrics],
        'experiments/sync/metrics.pl',
        "    N is N0 + D,\n\c
         \s   put_assoc(Task, Counts0, N, Counts)."-
        "    N is max(0, N0 + D),\n\c
         \s   put_assoc(Task-N0, Counts0, N, Counts).").
promise(executing_host_requires_nothing, [measures, sync_metrics],
        'experiments/sync/metrics.pl',
        "changed(executing, Task, state(_, Done), state(Task, Done))."-
        "changed(executing, _, state(X, Done), state(X, Done)).").
promise(total_is_the_last_end, measures,
        'experiments/sync/ground.pl',
        "measure(total, View, Total) :-\n\c
         \s   aggregate_all(max(End),"-
        "measure(total, View, Total) :-\n\c
         \s   aggregate_all(min(End),").
promise(burst_within_one_second, [measures, sync_metrics],
        'experiments/sync/metrics.pl',
        "S < First + Seconds )"-
        "S =< First + Seconds )").
promise(missing_counts_pairs, measures,
        'experiments/sync/ground.pl',
        "    findall(H-T, member(execution(T, H, _, _), View.executions), Pairs0),\n\c
         \s   sort(Pairs0, Pairs),"-
        "    findall(H-T, member(execution(T, H, _, _), View.executions), Pairs),").
promise(order_is_that_of_the_host, [measures, sync_metrics],
        'experiments/sync/metrics.pl',
        "                      \\+ ( member(Earlier-Host-End, Ends),\n\c
         \s                          End =< Start ) )"-
        "                      \\+ ( member(Earlier-_-End, Ends), Host = Host,\n\c
         \s                          End =< Start ) )").
promise(lost_tasks_were_completed, [measures, sync_metrics],
        'experiments/sync/healing.pl',
        "    include(was_completed(Executions), Failures, Lost),"-
        "    Lost = Failures,").
promise(redone_after_the_loss, [measures, sync_metrics],
        'experiments/sync/healing.pl',
        "           Start >= Time ))."-
        "           Start =< Time + 1.0e9 )).").
promise(healing_from_the_first_loss, measures,
        'experiments/sync/ground.pl',
        "    memberchk(failed_at(From), View.healing),"-
        "    memberchk(failed_by(From), View.healing),").
promise(meanwhile_without_the_repeated, [measures, sync_metrics],
        'experiments/sync/healing.pl',
        "                    Start > From, Start < To,\n\c
         \s                   \\+ redone(Failures, E)"-
        "                    Start > From, Start < To").
promise(both_counts_pairs_of_executions, measures,
        'experiments/sync/beyond_several.pl',
        "                    Start1 < End2,\n\c
         \s                   Start2 < End1 ),"-
        "                    Start1 =< End2,\n\c
         \s                   Start2 < End1 ),").
promise(settled_rounds_have_the_same_hosts, measures,
        'experiments/hierarchy/beyond_lead.pl',
        "nth1(N, Rows, Same), Before is N - 1, nth1(Before, Rows, Same),"-
        "nth1(N, Rows, _), Before is N - 1, nth1(Before, Rows, _),").
promise(span_from_first_to_last, measures,
        'experiments/population/metrics.pl',
        "            ( member(task(_, First, _, End, _, _), Rows),\n\c
         \s             Span is End - First ),"-
        "            ( member(task(_, _, First, End, _, _), Rows),\n\c
         \s             Span is End - First ),").
promise(gap_may_be_negative, measures,
        'experiments/population/metrics.pl',
        "              Gap is Next - End ),"-
        "              Gap is max(0, Next - End) ),").
promise(peak_of_a_kind, [measures, population_metrics],
        'experiments/population/metrics.pl',
        "    sort(1, @>=, Counts, [Count-_|_]),"-
        "    sort(1, @=<, Counts, [Count-_|_]),").
promise(peak_total_of_all_kinds, measures,
        'experiments/population/metrics.pl',
        "    count(Kinds, Kind, D, Counts0, Counts),\n\c
         \s   sum_list(Counts, Total)."-
        "    count(Kinds, Kind, D, Counts0, Counts),\n\c
         \s   last(Counts, Total).").
promise(rise_from_the_crash, measures,
        'experiments/population/figure_6_4.pl',
        "    Rise is Peak - Before."-
        "    Rise is Peak - min(0, Before).").
promise(again_beside_the_first, measures,
        'experiments/population/figure_6_4.pl',
        "    subtract(Lost, Healed, Missing),"-
        "    subtract(Healed, Lost, Missing),").
promise(settled_when_one_of_each_is_left, [population_metrics, measures],
        'experiments/population/metrics.pl',
        "    length(Done, Alive),\n"-
        "").
promise(state_is_that_of_the_first_agent, [table_6_1, measures],
        'experiments/population/states.pl',
        "    sort(1, @<, Pairs0, Pairs),"-
        "    sort(1, @>, Pairs0, Pairs),").
promise(communications_of_all_kinds, [measures, allocation_metrics],
        'experiments/allocation/metrics.pl',
        "    aggregate_all(sum(Count), happened(Events, communications(_, Count)),"-
        "    aggregate_all(sum(Count), happened(Events, communications(migration, Count)),").
promise(time_until_the_last_task, measures,
        'experiments/allocation/ground.pl',
        "    aggregate_all(max(Seconds), member(_-Seconds, Completed), Time)."-
        "    aggregate_all(min(Seconds), member(_-Seconds, Completed), Time).").
promise(rate_for_each_robot, measures,
        'experiments/allocation/ground.pl',
        "    Rate is Time/View.case.required."-
        "    Rate is Time/View.case.eligible.").
promise(backoffs_of_an_allocator, measures,
        'experiments/allocation/ground.pl',
        "    Mean is Count/View.case.allocators."-
        "    Mean is Count/max(1, View.case.allocators - 1).").
promise(interval_is_a_mean, [measures, allocation_metrics],
        'experiments/allocation/metrics.pl',
        "    sum_list(Numbers, Sum),\n\c
         \s   Mean is Sum/Count."-
        "    max_list(Numbers, Sum),\n\c
         \s   Mean is Sum/max(1, Count - Count + 1).").
promise(upkeep_is_answers_and_renewals, measures,
        'experiments/allocation/ground.pl',
        "memberchk(Kind, [ack, renew]) ), Upkeep),"-
        "memberchk(Kind, [ack]) ), Upkeep),").
promise(others_without_the_last, measures,
        'experiments/allocation/beyond_urgent.pl',
        "                       Task \\== View.case.allocators ), All),"-
        "                       Task \\== none ), All),").
promise(free_when_the_last_robot_is, [allocation_metrics, measures],
        'experiments/allocation/metrics.pl',
        "    max_list([Missed|Times], Last),"-
        "    min_list([inf|Times], Last0), Last is min(Last0, Missed + 1.0e9) + 0,").
promise(faulty_is_not_exactly_once, [measures, allocation_metrics],
        'experiments/allocation/timetable.pl',
        "                            member(execution(Task, Robot, _, _), Executions),\n\c
         \s                           1))."-
        "                            member(execution(Task, Robot, _, _), Executions),\n\c
         \s                           _)).").
promise(catching_up_from_the_last_allocation, measures,
        'experiments/allocation/beyond_replacement.pl',
        "                              memberchk(Host, New) ), Last),"-
        "                              memberchk(Host, [Host|New]) ), Last),").
promise(executions_of_an_agent, measures,
        'experiments/learning/ground.pl',
        "    length(View.learners, Agents),\n\c
         \s   Mean is Count/Agents."-
        "    length(View.learners, Agents),\n\c
         \s   Mean is Count/(Agents + 1).").
promise(sharing_per_execution, measures,
        'experiments/learning/ground.pl',
        "    Ratio is Events/Count."-
        "    length(View.learners, Agents),\n\c
         \s   Ratio is Events/(Count*Agents).").
promise(duration_until_all_converged, [measures, learning_metrics],
        'experiments/learning/metrics.pl',
        "    max_list([0|Ts], Time)."-
        "    Ts = [Time|_].").
promise(overlap_of_paths, [measures, learning_metrics],
        'experiments/learning/metrics.pl',
        "    Share is Count/max(1, All)."-
        "    length(Way, Cells), All = All,\n\c
         \s   Share is Count/max(1, Cells).").
promise(distinct_sets_of_cells, measures,
        'experiments/learning/single.pl',
        "    maplist(sort, Ways0, Ways),\n\c
         \s   sort(Ways, Set),\n\c
         \s   length(Set, Count)."-
        "    Ways = Ways0,\n\c
         \s   length(Ways, Count).").
promise(spread_relative_to_the_mean, [measures, learning_metrics],
        'experiments/learning/metrics.pl',
        "    Share is Deviated/max(1, Length)."-
        "    Share is Deviated, Length = Length.").
promise(nearer_is_a_percentage, measures,
        'experiments/learning/single.pl',
        "    Percent is 100*Share."-
        "    Percent is 100*(1 - Share).").
promise(trend_relative_to_the_mean, measures,
        'experiments/learning/sets.pl',
        "    Percent is 100*(Last - Level)/(Count/30)."-
        "    Percent is 100*(Last - Level)/Count.").
promise(reached_is_a_percentage, measures,
        'experiments/algorithms/metrics.pl',
        "    Percent is 100*Some/Count."-
        "    Percent is Some/Count.").
promise(pages_until_the_last_agent, measures,
        'experiments/algorithms/metrics.pl',
        "    aggregate_all(max(T), member(first(_, T, _), Reached), Time)."-
        "    aggregate_all(min(T), member(first(_, T, _), Reached), Time).").
promise(population_is_births_less_deaths, [measures, sieve_rounds],
        'experiments/sieve/rounds.pl',
        "change(died(_, Kind), Kind, -1)."-
        "change(died(suppressed, Kind), Kind, -1).").
promise(response_is_a_mean_wait, [measures, sieve_rounds],
        'experiments/sieve/rounds.pl',
        "            ; member(generated(Antigen, _, Wait), Events)\n"-
        "").
promise(helped_is_a_share_of_hosts, measures,
        'experiments/sieve/beyond_memory.pl',
        "    Share is Served/All."-
        "    Share is Served/max(1, All - Served).").
promise(share_of_the_generic_kind, measures,
        'experiments/sieve/figure_3_4.pl',
        "    count(population, _, Rounds, 15, All),"-
        "    count(population, '11111', Rounds, 15, All),").
promise(leads_to_the_end, measures,
        'experiments/sieve/figure_3_4.pl',
        "    max_list([0|Not], Last),\n\c
         \s   From is Last + 1."-
        "    max_list([0|Not], From).").
promise(growth_of_a_round, measures,
        'experiments/sieve/figure_3_5.pl',
        "              More is N - N0 ),\n\c
         \s           Mores),\n\c
         \s   min_list(Mores, Least)."-
        "              More is N - N0 ),\n\c
         \s           Mores),\n\c
         \s   last(Mores, Least).").
promise(able_is_a_percentage_of_agents, measures,
        'experiments/sieve/beyond_programs.pl',
        "    Share is 100*Able/Total."-
        "    Share is 100*Able/max(1, Total - Able).").
promise(over_the_limit_in_seconds, pole,
        'experiments/robots/pole_metrics.pl',
        "                    Tilt > Limit ),"-
        "                    Tilt >= Limit ),").
promise(apart_first_to_last_start, pole,
        'experiments/robots/study_pole.pl',
        "    aggregate_all(max(S), starts_apart(View.executions, _, S), Most)."-
        "    aggregate_all(min(S), starts_apart(View.executions, _, S), Most).").
promise(alarms_within_two_minutes_are_one, measures,
        'experiments/applications/study_fire_alarm.pl',
        "    (   Time-Last < 115\n"-
        "    (   Time-Last < 15\n").
promise(lost_persons_count_as_limit, measures,
        'experiments/applications/study_fire_signs.pl',
        "    Mean is (Sum + (All-Out)*Log.case.limit)/All."-
        "    Mean is Sum/Out + 0*All.").
promise(fairness_is_jains_index, measures,
        'experiments/applications/study_solar.pl',
        "    Index is Sum*Sum/(Count*Squares)."-
        "    Index is Sum*Sum/Squares + 0*Count.").
promise(crossings_in_an_hour, measures,
        'experiments/applications/study_solar.pl',
        "    Hours is 24*Log.case.days - 6,"-
        "    Hours is 24*Log.case.days,").
promise(interval_by_students_distribution, statistics,
        'experiments/engine/statistics.pl',
        "    Freedom is Count - 1,"-
        "    Freedom is Count,").
promise(sample_deviation, statistics,
        'experiments/engine/statistics.pl',
        "    Variance is (Squares - Rest*Rest/Count)/(Count - 1),"-
        "    Variance is (Squares - Rest*Rest/Count)/Count,").
promise(pairs_of_cases_are_tested, sampling,
        'experiments/engine/evidence.pl',
        "alternative(<, less)."-
        "alternative(<, two_sided).").
promise(p_is_at_least_as_much, statistics,
        'experiments/engine/statistics.pl',
        "    Size is integer(U) + 1,"-
        "    Size is max(1, integer(U)),").
promise(exact_up_to_fifty_runs, statistics,
        'experiments/engine/statistics.pl',
        "        M =< 50,\n\c
         \s       N =< 50"-
        "        M < 3,\n\c
         \s       N < 3").
promise(corrected_for_continuity, statistics,
        'experiments/engine/statistics.pl',
        "        Z is (Distance - 0.5)/sqrt(Variance),"-
        "        Z is Distance/sqrt(Variance),").
promise(corrected_for_equal_numbers, statistics,
        'experiments/engine/statistics.pl',
        "    Variance is M*N/12*((All + 1) - Ties/(All*(All - 1))),"-
        "    Variance is M*N/12*(All + 1) + 0*Ties,").
promise(greatest_p_is_shown, [sampling, statistics],
        'experiments/engine/evidence.pl',
        "    max_list(Qs, P)."-
        "    Qs = [P|_].").
promise(holm_correction, statistics,
        'experiments/engine/statistics.pl',
        "    Q is min(1.0, max(Least, N*P)),"-
        "    Q is min(1.0, N*P) + 0*Least,").
promise(no_test_below_four_runs, sampling,
        'experiments/engine/evidence.pl',
        "              Xs = [_, _, _, _|_],"-
        "              Xs = [_, _, _|_],").
promise(no_line_for_a_number, sampling,
        'experiments/engine/evidence.pl',
        "    \\+ number(E1),\n\c
         \s   \\+ number(E2),\n"-
        "").
promise(effect_size_of_a_pair, outcome,
        'experiments/engine/tables.pl',
        "              Effect is U/(M*N),"-
        "              Effect is 1 - U/(M*N),").
promise(summary_of_case_and_measure, outcome,
        'experiments/engine/tables.pl',
        "    ->  mean_interval(Numbers, 0.95, Low, High)\n\c
         \s   ;   Deviation = '',"-
        "    ->  mean_interval(Numbers, 0.9, Low, High)\n\c
         \s   ;   Deviation = '',").
promise(claims_table_counts_unknown, outcome,
        'experiments/engine/tables.pl',
        "              Unknown is Outcome.seeds - Of,"-
        "              Unknown is Of - Of,").
promise(unknown_value_is_null, sampling,
        'experiments/engine/tables.pl',
        "json_value('', null) :-\n\c
         \s   !.\n"-
        "").
promise(hash_of_what_determines_the_run, kept_runs,
        'experiments/engine/sources.pl',
        "    reached([network, run, view, measure], Clauses, [], Mentioned, Used),"-
        "    reached([network, run, view], Clauses, [], Mentioned, Used),").
promise(agents_determine_the_run, kept_runs,
        'experiments/engine/sources.pl',
        "    memberchk(Kind, [agent, payload])."-
        "    memberchk(Kind, [payload]).").
promise(claims_do_not_repeat_runs, kept_runs,
        'experiments/engine/sources.pl',
        "    reached([network, run, view, measure], Clauses,"-
        "    reached([network, run, view, measure, claim], Clauses,").
promise(run_of_other_sources_is_another, kept_runs,
        'experiments/engine/store.pl',
        "    sources_hash(Study, Sources),\n\c
         \s   format(atom(Below)"-
        "    Sources = 0,\n\c
         \s   format(atom(Below)").
promise(all_parameters_determine_the_run, kept_runs,
        'experiments/engine/store.pl',
        "    dict_pairs(Case, _, Pairs),\n\c
         \s   format(string(Values), '~q', [Pairs-Seed]),"-
        "    format(string(Values), '~q', [Seed]),").
promise(failed_run_is_repeated, kept_runs,
        'experiments/engine/store.pl',
        "    part_remove(Failed),\n\c
         \s   rename_file(Part, Failed)."-
        "    part_remove(Failed),\n\c
         \s   rename_file(Part, Directory).").
promise(output_of_a_failed_run, kept_runs,
        'experiments/engine/store.pl',
        "        open(File, append, Out, [encoding(utf8)]),"-
        "        open(File, write, Out, [encoding(utf8)]),").
promise(logs_are_deleted, kept_runs,
        'experiments/engine/store.pl',
        "    (   Logs \\== true,\n\c
         \s       exists_file(Log)"-
        "    (   Logs == none,\n\c
         \s       exists_file(Log)").
promise(missing_log_repeats_the_run, kept_runs,
        'experiments/engine/store.pl',
        "    \\+ ( Logs == true, lacks_log(Directory) )."-
        "    Logs = Logs.").
promise(case_by_its_parameters, studies,
        'experiments/engine/plan.pl',
        "    msort(Parts, Sorted)."-
        "    Sorted = Parts.").
