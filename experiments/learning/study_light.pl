%   Effects of the brightness of the light, which the thesis does not print.

:- include(ground).

study(light, "Executions and sharing against the brightness of the light").
text("The brightness at the goal scales the weights of all units, and of the \c
bag: the heavier the bag, the sooner an agent stops travelling (equation \c
4.2), and the fewer agents it can meet. The thesis prints 195 and 110 \c
executions with one and two agents on 10 hosts, and 92 with five agents on 50 \c
hosts.").

vary(network, [10, 50]).
vary(light, [10, 100]).
vary(density, [0.1, 0.2, 0.5]).

printed(executions, [network=50, density=0.1], 92).

claim("the brighter, the fewer sharing events", [ours],
      at([network=50], falls(sharing, along(light)))).
claim("195 executions with 1 agent on 10 hosts, within a tenth",
      [line(2483)],
      at([network=10, density=0.1], near(executions, 195, 19.5))).
claim("110 with 2 agents on 10 hosts, within a tenth", [line(2484)],
      at([network=10, density=0.2], near(executions, 110, 11))).
claim("92 with 5 agents on 50 hosts, within a tenth", [line(2425)],
      at([network=50, density=0.1], near(executions, 92, 9.2))).
claim("runs take 300 to 3000 s", [line(2373)], between(duration, 300, 3000)).
claim("no significant difference (0.15) between networks at D 0.5",
      [line(2479), ours],
      at([density=0.5, network=10],
         near(executions/at([network=50], executions), 1, 0.15))).

plot(light, "Executions and sharing against the brightness, D = 0.5",
     lines([ x(light), y([executions, sharing, duration]), line(network),
             where([density=0.5]), log(duration) ])).
