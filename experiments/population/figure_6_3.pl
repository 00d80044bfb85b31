%   Figure 6.3: tasks and populations on 50 and on 100 hosts.

:- include(ground).
:- include(tasks).
:- use_module(pictures,
              [bar_rows/2, crash_rows/2, kind_rows/2, other_rows/2,
               panel_variables/2, span_rows/2]).

study('6.3', "One kind of agent for each task, on 50 and 100 hosts").

real([hosts=50], [clock=10, processes=2]).
text("Five kinds of agents execute five tasks in order on every host of a \c
mesh. Agents that are rewarded for their task clone themselves; clones that \c
find nothing to do die.").

fixed(crash, 0, printed("section 6.5: none in this figure")).

printed(overlapped, [hosts=50], 0).
printed(overlapped, [hosts=100], 1).

plot('6.3', "One kind of agent for each task",
     script('population.gp',
            [ starts-bar_rows, kinds-kind_rows, others-other_rows,
              spans-span_rows, crash-crash_rows ],
            [size(1600, 1050), variables(panel_variables)])).
