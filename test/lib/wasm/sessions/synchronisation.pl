?- use_module(agents(sync/operator)).
?- network_start(grid(3, 4), _, [clock(virtual), seed(1), hop_time(uniform(0.5, 1.5))]), network_property(_, hosts(Hosts)).
?- sequence_start(house, $Hosts, [floor-sleep(1), walls-sleep(1), ceiling-sleep(2)], [agents(4), seed(1)], Agents), forall(member(Agent, Agents), agent_join(Agent, done, 10000)).
?- $Hosts = [First|_], task_fail(house, floor, [First], Failed), sequence_start(house, $Hosts, [floor-sleep(1), walls-sleep(1), ceiling-sleep(2)], [starts([First])], [Agent]), agent_join(Agent, Outcome, 10000).
