%   What doc/limits.md promises, see ../promises.pl.

promise(pheromones_are_bounded, pheromone,
        'prolog/typhon/options/migration/pheromone.pl',
        "    Sum < Most,\n"-"    Sum =< Most,\n").
promise(half_of_the_pheromones_are_of_a_neighbour, pheromone,
        'prolog/typhon/options/migration/pheromone.pl',
        "2*Count < Most ; true"-"Count < Most ; true").
promise(size_of_a_pheromone_is_bounded, pheromone,
        'prolog/typhon/options/migration/pheromone.pl',
        "    setting(cells, Most),\n    is_tree(Problem, Most)."-
        "    setting(cells, Most),\n    \c
         ( is_tree(Problem, Most) ; Most > 0 ).").
promise(offers_of_an_agent_are_bounded, directory,
        'prolog/typhon/options/directory/offers.pl',
        "    (   Count < Most\n"-"    (   Count =< Most\n").
promise(size_of_an_offer_is_bounded, directory,
        'prolog/typhon/options/directory/offers.pl',
        "    ( is_tree(Service-Properties, Most) -> true"-
        "    ( is_tree(Service-Properties, Most) -> true ; true -> true").
promise(limit_of_a_mailbox, full_mailbox,
        'prolog/typhon/kernel/agent/mailbox.pl',
        "    Count >= Max,\n"-"    Count > Max,\n").
promise(message_to_a_full_mailbox_is_not_delivered, full_mailbox,
        'prolog/typhon/kernel/agent/mailbox.pl',
        "        Space is max(0, Max-Count),"-
        "        Space is max(1, Max-Count),").
promise(mail_of_a_faulty_agent_is_bounded, faulty,
        'prolog/typhon/kernel/agent/mailbox.pl',
        "    (   Count < Max\n    ->  mail_put"-
        "    (   Count =< Max\n    ->  mail_put").
promise(backlog_is_bounded, message,
        'prolog/typhon/kernel/travel/backlog.pl',
        "    Count+More =< Most."-"    Count+More =< Most+1.").
promise(kinds_of_warnings_are_bounded, reports,
        'prolog/typhon/kernel/base/reports.pl',
        "    ( Count < Most -> Kind = Kind0 ; Kind = others )."-
        "    ( Count < 10*Most -> Kind = Kind0 ; Kind = others ).").
promise(groups_of_warnings_are_bounded, reports,
        'prolog/typhon/kernel/base/reports.pl',
        "    (   ( Groups < Most ; Group == others )"-
        "    (   ( Groups < 10*Most ; Group == others )").
promise(limit_of_outcomes, bounds,
        'prolog/typhon/kernel/travel/home.pl',
        "    bounded(outcome(_, _, _), typhon_whereabouts:outcomes,\n            \c
         durable_assertz(outcome(Id, Outcome, Hops))),"-
        "    durable_assertz(outcome(Id, Outcome, Hops)),").
promise(limit_of_results, bounds,
        'prolog/typhon/kernel/travel/outcomes.pl',
        "           bounded(left(_, _), typhon_outcomes:results,\n                   \c
         durable_assertz(left(Id, Item))))."-
        "           durable_assertz(left(Id, Item))).").
promise(limit_of_clones, bounds,
        'prolog/typhon/kernel/travel/outcomes.pl',
        "    bounded(clone_of(_, _), typhon_outcomes:clones,\n            \c
         durable_assertz(clone_of(Parent, Clone))),"-
        "    durable_assertz(clone_of(Parent, Clone)),").
promise(forwarding_addresses_are_bounded, bounds,
        'prolog/typhon/kernel/travel/whereabouts.pl',
        "    bounded(forward(_, _, _, _), typhon_whereabouts:forwards,\n            \c
         with_mutex(typhon_forward,\n                       \c
         put_forward(Id, Address, Hops, Process)))."-
        "    with_mutex(typhon_forward, put_forward(Id, Address, Hops, Process)).").
promise(endings_are_bounded, bounds,
        'prolog/typhon/kernel/travel/whereabouts.pl',
        "    bounded(ended_here(_, _), typhon_whereabouts:endings,\n            \c
         assertz(ended_here(Id, Hops)))."-
        "    assertz(ended_here(Id, Hops)).").
promise(agents_created_elsewhere_are_bounded, bounds,
        'prolog/typhon/kernel/lifecycle/questions.pl',
        "    bounded(met(_, _), typhon_questions:met, assertz(met(Id, alive)))."-
        "    assertz(met(Id, alive)).").
promise(table_never_exceeds_its_bound, bounds,
        'prolog/typhon/kernel/base/bounds.pl',
        "    Excess is Count+Some-Max,"-"    Excess is Count-Max,").
promise(little_is_deleted_of_a_full_table, bounds,
        'prolog/typhon/kernel/base/bounds.pl',
        "    Some is max(1, min(100, Max//100)),"-
        "    Some is max(1, min(1000, Max//2)),").
promise(lower_bound_holds_soon, bounds,
        'prolog/typhon/kernel/base/bounds.pl',
        "    Room is max(1, min(100, Max-Count+Deleted)),"-
        "    Room is max(1, Max-Count+Deleted),").
