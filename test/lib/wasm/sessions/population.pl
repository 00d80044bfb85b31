?- use_module(agents(population/operator)), use_module(agents(sync/operator)).
?- network_start(edges([1-2,2-3,3-4,4-5,5-6,6-7,7-8,8-1,1-4,2-7,3-6,5-8]), _, [clock(virtual), seed(1), hosts([capacity(6)])]), network_property(_, hosts(Hosts)).
?- population_start(house, $Hosts, [floor-sleep(0.5), walls-sleep(0.5)], [seed(1), settings([threshold-5, tick-0.5])], Agents).
?- network_property(Network, seed(_)), network_advance(Network, 200).
