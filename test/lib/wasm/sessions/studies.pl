?- study_played('examples/studies/coverage.pl', [], Measures).
?- study_played('experiments/sync/study_demo.pl', [limit-20, hosts-30], Measures).
?- study_played('experiments/sieve/figure_3_3.pl', [round-1, attacked-1, omega-20], Measures).
?- study_played('experiments/population/figure_6_3.pl', [limit-20], Measures).
?- study_played('experiments/allocation/figure_7_4.pl', [hosts-30, required-3, allocators-2], Measures).
?- study_played('experiments/learning/figure_4_7.pl', [network-obstacle, obstacle_hosts-8, sharing-true, size-5], Measures).
?- study_played('experiments/hierarchy/beyond_lead.pl', [limit-20], Measures).
