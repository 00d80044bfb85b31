:- module(study_costs,
          [ cost/2                      % ?Name, -Seconds
          ]).

/** <module> How long a run of each study of the thesis takes

Rough numbers: only the order of runs and the estimates of the time left depend
on them, and on their ratios alone once a run has ended.

*Threading*: facts.
*/

%!  cost(?Name, -Seconds) is nondet.
%
%   A run of the study Name takes Seconds of a processor of two, on average of its
%   cases.

cost('3.3', 15).
cost('3.4', 15).
cost('3.5', 9).
cost('4.7', 4).
cost('4.9', 2.6).
cost('4.13', 5).
cost('5.2', 0.1).
cost('5.5', 1).
cost('5.6', 1).
cost('5.7', 1).
cost('5.8', 1).
cost('5.9', 1).
cost('5.11', 1).
cost('5.12', 1.5).
cost('6.1', 3).
cost('6.3', 3).
cost('6.4', 3).
cost('7.1', 3.5).
cost('7.4', 4).
cost('7.5', 3.5).
cost(cloning, 0.7).
cost(contest, 4).
cost(crews, 3).
cost(exchange, 3.5).
cost(guarantee, 0.1).
cost(integrated, 4).
cost(islands, 0.6).
cost(lead, 1.7).
cost(lead_learning, 3.5).
cost(memory, 7).
cost(mixed, 0.5).
cost(programs, 4).
cost(replacement, 3).
cost(return, 1.5).
cost(selected, 1).
cost(settings, 0.4).
cost(several, 4).
cost(sharing, 2).
cost(urgent, 1.2).
