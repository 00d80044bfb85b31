?- use_module(agents(hierarchy/operator)), use_module(agents(sync/operator)).
?- network_start(ring(6), _, [clock(virtual), seed(1), hop_time(uniform(0.2, 0.4))]), network_property(_, hosts(Hosts)).
?- $Hosts = [A, B, C, D, E, F], hierarchy_start([A, D], payloads(hierarchy/steps), [settings([workers-1, pool-robots, delta-0.5])], Leaders).
?- $Hosts = [A, B, C, D, E, F], forall(member(Round, [one, two]), ( sequence_start(Round, $Hosts, [1-sleep(1), 2-sleep(1)], [agents(0), pool(robots)], _), hierarchy_serve($Leaders, Round, [[A, B, C], [D, E, F]], 1000) )).
