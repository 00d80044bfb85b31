?- use_module(agents(learning/operator)).
?- network_start(mesh(4), _, [clock(virtual), seed(1)]), network_property(_, hosts(Hosts)).
?- learning_start($Hosts, payloads(learning/maze), [payloads(learning/greedy)], [agents(3), seed(1), settings([size-5])], Agents), forall(member(Agent, Agents), agent_join(Agent, done, 600)).
