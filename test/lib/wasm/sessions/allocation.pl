?- use_module(agents(allocation/operator)).
?- network_start(edges([1-2,2-3,3-4,4-5,5-6,6-1,1-4,2-5]), _, [clock(virtual), seed(1), hop_time(uniform(0.5, 1.5))]), network_property(_, hosts(Hosts)).
?- $Hosts = [H1, H2, H3, H4, H5, H6], forall(member(Host, [H1, H2, H3]), robot_start(Host, [push], [])), robot_start(H4, [push, battery=0.1], []), forall(member(Host, [H5, H6]), robot_start(Host, [lift(50), battery=0.9], [])).
?- $Hosts = [Host|_], task_allocate(task(box, [3-[push], 1-[lift(50), battery>=0.5]], [duration(2)]), Host, [], Agent), agent_join(Agent, Outcome, 600).
?- $Hosts = [Host|_], task_allocate(task(crane, [3-[lift(_)]], [deadline(20)]), Host, [], Agent), agent_join(Agent, Outcome, 600).
