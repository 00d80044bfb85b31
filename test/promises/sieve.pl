%   What doc/sieve.md promises, see ../promises.pl.

promise(danger_signal_is_emitted, sieve_agents,
        'agents/sieve/guard.pl',
        "    emit(Attack, [span(Span), period(Period)]),"-
        "    Attack-Span-Period = Attack-Span-Period,").
promise(second_of_one_antibody_is_redundant, sieve,
        'agents/sieve/guard.pl',
        "    memberchk(_-offer(_, Antibody, _, _, _), Offers),\n\c
         \s   !,\n\c
         \s   send"-
        "    memberchk(Agent-offer(_, Antibody, _, _, _), Offers),\n\c
         \s   !,\n\c
         \s   send").
promise(chosen_by_roulette, sieve,
        'agents/sieve/idiotypic.pl',
        "    Position is Turn*Sum,"-
        "    Position is Turn*Turn*Sum,").
promise(roulette_in_proportion, sieve,
        'agents/sieve/idiotypic.pl',
        "    Position is Position0 - Weight,"-
        "    Position is Position0 - 1 + 0*Weight,").
promise(feedback_stimulates_the_chosen, sieve,
        'agents/sieve/guard.pl',
        "    (   Agent == Winner\n\c
         \s   ->  parameter(alpha, Alpha),"-
        "    (   Agent \\== Winner\n\c
         \s   ->  parameter(alpha, Alpha),").
promise(clones_above_the_upper_threshold, sieve,
        'agents/sieve/idiotypic.pl',
        "    Gamma > Maximum,\n\c
         \s   !."-
        "    Gamma >= Maximum,\n\c
         \s   !.").
promise(dies_below_the_lower_threshold, sieve,
        'agents/sieve/idiotypic.pl',
        "    Gamma < Minimum,\n\c
         \s   !."-
        "    Gamma =< Minimum,\n\c
         \s   !.").
promise(guard_draws_until_one_fits, sieve,
        'agents/sieve/guard.pl',
        "    (   Psi >= Threshold\n\c
         \s   ->  Drawn"-
        "    (   ( Psi >= Threshold ; true )\n\c
         \s   ->  Drawn").
promise(drawn_antibody_leaves_as_an_agent, sieve,
        'agents/sieve/guard.pl',
        "    release(Host, Antibody, [Antigen-Xi])."-
        "    Host-Antigen-Xi = Host-Antigen-Xi.").
promise(each_attack_is_a_problem_of_its_own, sieve_agents,
        'agents/sieve/guard.pl',
        "    Number1 is Number + 1,\n\c
         \s   watch(Number1)."-
        "    watch(Number).").
promise(unneeded_agent_ignores_it, sieve_agents,
        'agents/sieve/antibody.pl',
        "    \\+ memberchk(Attack, Attacks),\n\c
         \s   antibody"-
        "    Attacks = Attacks,\n\c
         \s   antibody").
promise(clones_die_after_omega_hops, sieve,
        'agents/sieve/antibody.pl',
        "    Hops >= Expiry,\n\c
         \s   !,"-
        "    Hops >= Expiry + 1000000,\n\c
         \s   !,").
promise(offered_from_the_threshold_on, sieve,
        'agents/sieve/antibody.pl',
        "    Psi >= Threshold."-
        "    Psi > Threshold.").
promise(similar_is_optional, sieve_agents,
        'agents/sieve/idiotypic.pl',
        "          error(existence_error(procedure, _), _),\n\c
         \s         fail),"-
        "          none, fail),").
promise(attacks_one_after_the_other, sieve,
        'agents/sieve/guard.pl',
        "    Number1 is Number + 1,\n\c
         \s   watch(Number1)."-
        "    true.").
promise(no_clones_in_a_crowd, sieve,
        'agents/sieve/antibody.pl',
        "    Load < Crowd,\n\c
         \s   !,"-
        "    Load < Crowd + 1000,\n\c
         \s   !,").
promise(refused_clone_is_not_made, sieve_agents,
        'agents/lib/clones.pl',
        "    catch(clone(Branch), error(move_refused(_, _), _), Branch = refused)."-
        "    clone(Branch).").
promise(cell_after_enough_wins, sieve_agents,
        'agents/sieve/guard.pl',
        "    Wins >= Enough,"-
        "    Wins > Enough,").
promise(cell_does_not_age, sieve_agents,
        'agents/sieve/antibody.pl',
        "    integer(Expiry),\n\c
         \s   hops"-
        "    ( integer(Expiry) -> true ; Expiry == never ),\n\c
         \s   hops").
promise(cell_is_not_suppressed, sieve_agents,
        'agents/sieve/antibody.pl',
        "meet(die, _) :-\n\c
         \s   expiry(never),\n\c
         \s   !,"-
        "meet(die, _) :-\n\c
         \s   expiry(none),\n\c
         \s   !,").
promise(at_most_n_cells_of_a_host, sieve,
        'agents/sieve/guard.pl',
        "    Count < Most,\n\c
         \s   !,"-
        "    Count =< Most,\n\c
         \s   !,").
promise(differing_bits_count, sieve,
        'payloads/sieve/bits.pl',
        "affinity_threshold(4)."-
        "affinity_threshold(5).").
promise(similar_sums_over_similar_antigens, sieve,
        'agents/sieve/idiotypic.pl',
        "    (   Known == Antigen\n\c
         \s   ->  true\n\c
         \s   ;   similar_antigens(Known, Antigen)\n\c
         \s   )."-
        "    Known == Antigen.").
promise(current_antigen_alone, sieve,
        'agents/sieve/idiotypic.pl',
        "counts(current, Antigen, Antigen)."-
        "counts(current, _, _).").
promise(common_antigens_alone, sieve,
        'agents/sieve/idiotypic.pl',
        "    sum_list(Differences, Advantage)."-
        "    ( Differences == [] -> Advantage = 0 ; max_list(Differences, Advantage) ).").
promise(similar_if_one_bit_differs, sieve,
        'payloads/sieve/bits.pl',
        "    Psi =< 1."-
        "    Psi =< 2.").
promise(n_without_the_matching, sieve,
        'agents/sieve/idiotypic.pl',
        "    Influence is Gamma/max(1, Count - Matches)."-
        "    Influence is Gamma/max(1, Count) + 0*Matches.").
promise(n_is_at_least_one, sieve,
        'agents/sieve/idiotypic.pl',
        "    Influence is Gamma/max(1, Count - Matches)."-
        "    Influence is Gamma/max(2, Count - Matches).").
promise(endurance_is_reset_by_a_clone, sieve_agents,
        'agents/sieve/antibody.pl',
        "meet(clone, _) :-\n\c
         \s   parameter(gamma, Start),\n\c
         \s   keep(gamma(Start)),"-
        "meet(clone, Gamma) :-\n\c
         \s   keep(gamma(Gamma)),").
promise(last_feedback_is_remembered, sieve,
        'agents/sieve/idiotypic.pl',
        "    (   selectchk(Antigen-_, Memory0, Memory)\n\c
         \s   ->  true\n\c
         \s   ;   Memory = Memory0\n\c
         \s   )."-
        "    Memory = Memory0.").
promise(signals_are_followed_in_order, pheromone,
        'prolog/typhon/options/migration/pheromone.pl',
        "    sort(Nexts0, Nexts),\n\c
         \s   memory_chance"-
        "    Nexts = Nexts0,\n\c
         \s   memory_chance").
promise(strongest_signal_is_followed, sieve_agents,
        'agents/sieve/antibody.pl',
        "    max_list(Strengths, Most),"-
        "    min_list(Strengths, Most),").
