%   What doc/equations.md promises, see ../promises.pl.

promise(endurance_of_a_winner, sieve,
        'agents/sieve/idiotypic.pl',
        "    Gamma is Gamma0 + Squashed."-
        "    Gamma is Gamma0 * (1 + Squashed).").
promise(feedback_between_0_and_1, sieve,
        'agents/sieve/idiotypic.pl',
        "    Squashed is 1/(1 + exp(Alpha - Beta*Xi))."-
        "    Squashed is 1/(1 + exp(Alpha - Xi)) + 0*Beta.").
promise(interaction_from_the_potentials_before, sieve,
        'agents/sieve/idiotypic.pl',
        "    effects(All, Reading, Constants, Cell, All, Gamma0, Gamma),\n\c
         \s   gammas(Cells"-
        "    effects(Cells, Reading, Constants, Cell, All, Gamma0, Gamma),\n\c
         \s   gammas(Cells").
promise(stimulation_by_kt, sieve,
        'agents/sieve/idiotypic.pl',
        "        Gamma1 is Gamma0 + Kt*Influence"-
        "        Gamma1 is Gamma0 + Ku*Influence").
promise(suppression_by_ku, sieve,
        'agents/sieve/idiotypic.pl',
        "        Gamma1 is Gamma0 - Ku*Influence"-
        "        Gamma1 is Gamma0 - Kt*Influence").
promise(affinity_counts_differing_bits, sieve,
        'payloads/sieve/bits.pl',
        "    Psi1 is Psi0 + (X xor Y),"-
        "    Psi1 is Psi0 + 1 - (X xor Y),").
promise(bag_weighs_the_sum, learning,
        'agents/learning/resources.pl',
        "    Pi1 is Pi0 + Weight,"-
        "    Pi1 is max(Pi0, Weight),").
promise(hop_costs_by_the_weight, learning,
        'agents/learning/resources.pl',
        "    Rho is Rho0 * exp(-Pi)."-
        "    Rho is Rho0 * exp(-Pi/2).").
promise(reward_in_proportion_to_the_gain, learning,
        'agents/learning/resources.pl',
        "Rho0 + C*Gain*Maximum)."-
        "Rho0 + C*Gain).").
promise(gain_relative_to_the_weight_before, learning,
        'agents/learning/resources.pl',
        "    Gain is (After - Before)/Before."-
        "    Gain is (After - Before)/After.").
promise(action_costs_kd, learning,
        'agents/learning/resources.pl',
        "    Xi is Xi0 - Kd."-
        "    Xi is Xi0 - 1 + 0*Kd.").
promise(positive_feedback_gives_kr, learning,
        'agents/learning/resources.pl',
        "    Xi is Xi0 + Kr."-
        "    Xi is Xi0 + 1 + 0*Kr.").
promise(weight_is_a_difference, learning_maze,
        'payloads/learning/maze.pl',
        "    Weight is Light - Light0."-
        "    Weight is abs(Light - Light0).").
promise(penalty_lowers_a_potential, sync,
        'agents/sync/potential.pl',
        "    Potential is max(0, Potential0 - Theta)."-
        "    Potential is Potential0 - Theta.").
promise(theta_is_a_mean, sync,
        'agents/sync/potential.pl',
        "    Theta is Sum/Count * Potential/Maximum + Bias."-
        "    Theta is Sum * Potential/Maximum + Bias + 0*Count.").
promise(pressure_is_free_slots, population,
        'agents/population/resource.pl',
        "    Pressure is max(0, Capacity - Length)."-
        "    Pressure is max(0, Capacity - Length + 1).").
promise(clones_in_proportion, population,
        'agents/population/resource.pl',
        "    Count is floor(Pressure * Resource/Maximum)."-
        "    Count is floor(Pressure * (Resource + 1)/Maximum).").
promise(each_clone_takes_its_share, population,
        'agents/population/resource.pl',
        "    Resource is Resource0 - Count*Minimum,"-
        "    Resource is Resource0 - min(1, Count)*Minimum,").
promise(recharge_is_bounded, population,
        'agents/population/resource.pl',
        "    Resource is min(Maximum,\n\c
         \s                   Resource0"-
        "    Resource is min(2*Maximum,\n\c
         \s                   Resource0").
promise(reward_prolongs_the_life, population,
        'agents/population/resource.pl',
        "    Lifetime is Lifetime0 + Extension*Reward."-
        "    Lifetime is Lifetime0 + Extension + 0*Reward.").
promise(stimulation_lowers_the_potential, specialist,
        'agents/sync/stimulation.pl',
        "    Psi1 is Psi0 - (1 - exp(-Sigma))*Psi0,"-
        "    Psi1 is Psi0 - Sigma*Psi0,").
promise(negative_stimulation_raises_it, specialist,
        'agents/sync/stimulation.pl',
        "    Psi is Psi0 + (1 - exp(-Sigma))*Psi0."-
        "    Psi is Psi0 + Sigma*Psi0.").
promise(history_of_the_last_values, specialist,
        'agents/sync/stimulation.pl',
        "    Excess is max(0, Count - Window),"-
        "    Excess is max(0, Count - Window - 1),").
promise(first_is_0_and_last_is_1, specialist,
        'agents/sync/stimulation.pl',
        "    Y is (X - First)/Span,"-
        "    Y is X/Span + 0*First,").
promise(mean_of_the_history, specialist,
        'agents/sync/stimulation.pl',
        "    Mean is Sum/Count,"-
        "    Mean is Sum/(Count + 1),").
promise(dispersion_by_kappa, specialist,
        'agents/sync/stimulation.pl',
        "    Sigma is Kappa * Deviation."-
        "    Sigma is Deviation + 0*Kappa.").
promise(reward_by_the_missing_robots, allocation,
        'agents/allocation/allocator/mobility_resource.pl',
        "(1 + Frequency*(Required - Reserved)/Required)."-
        "(1 + Frequency*(Required - Reserved - 1)/Required).").
promise(penalty_by_its_share, allocation,
        'agents/allocation/allocator/mobility_resource.pl',
        "    Share is Penalties/(Penalties + Required - Reserved),"-
        "    Share is Penalties/(Penalties + Required) + 0*Reserved,").
promise(decay_of_known_hosts, allocation,
        'agents/allocation/allocator/mobility_resource.pl',
        "    Decay is tan(pi/(4 + Found - Visited))."-
        "    Decay is tan(pi/(4 + Found)) + 0*Visited.").
promise(restart_is_the_inverse_of_decay, allocation,
        'agents/allocation/allocator/mobility_resource.pl',
        "    Chi1 is Chi0 * Cd/(Cd - Decay),"-
        "    Chi1 is Chi0 * (1 + Decay/Cd),").
promise(interval_is_theta_and_a_share, allocation,
        'agents/allocation/common/backoff_interval.pl',
        "    Interval is Theta + Turn*Range."-
        "    Interval is Theta + Range + 0*Turn.").
promise(reach_time_of_all_robots, allocation,
        'agents/allocation/common/backoff_interval.pl',
        "    Theta is Found*HopTime."-
        "    Theta is (Found - 1)*HopTime.").
promise(bid_time_of_the_bids, allocation,
        'agents/allocation/common/backoff_interval.pl',
        "    Theta is max(1, Bids)*Minimum."-
        "    Theta is max(1, Bids - 1)*Minimum.").
promise(learning_in_four_states, learning,
        'agents/learning/learner.pl',
        "after(unreached) :-\n\c
         \s   retractall(solution(_)),\n\c
         \s   collector."-
        "after(unreached) :-\n\c
         \s   retractall(solution(_)),\n\c
         \s   assimilator.").
promise(synchronising_agent_to_the_end, sync,
        'agents/sync/traveller.pl',
        "    !,\n\c
         \s   visit(Task),\n\c
         \s   travel,\n\c
         \s   patrol."-
        "    !,\n\c
         \s   visit(Task),\n\c
         \s   travel.").
promise(first_missing_task_is_serviced, sync,
        'agents/sync/traveller.pl',
        "    ->  heal(Missing, Task),\n\c
         \s       current(Next),"-
        "    ->  heal(Missing, Task),\n\c
         \s       Next = Task,").
promise(printed_idle_times, sync_studies,
        'experiments/sync/figure_5_5.pl',
        "printed(idle, [topology=ring],     32)."-
        "printed(idle, [topology=ring],     33).").
promise(printed_task_times, sync_studies,
        'experiments/sync/figure_5_8.pl',
        "4.5-5.2, 6.0-8.0],"-
        "4.5-5.2, 6.0-8.1],").
promise(printed_states_of_agents, table_6_1,
        'experiments/population/states.pl',
        "    append(Active, [excited|Dormant], Row),\n\c
         \s   all(Active, active),"-
        "    append(Active, [excited|Dormant], Row),\n").
