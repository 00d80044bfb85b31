%   Two learning algorithms in one population.

:- include(ground).

study(mixed, "Two learning algorithms in one population").
text("In the maze the light is behind a corner: an agent that follows the \c
light enters the corner, from where all paths lead away from the light.").

vary(crew, [greedy, scout, greedy_scout, climb, genetic, climb_genetic]).
derive(algorithms, Case, Names) :-
    crew(Case.crew, _, Names).
derive(problem, Case, Problem) :-
    crew(Case.crew, Problem, _).
derive(settings, Case, Settings) :-
    crew(Case.crew, Problem, _),
    findall(Setting, ( Problem == maze, trap(Setting) ), Settings).
fixed(agents, 4, assumed("")).
fixed(limit, 6000, assumed("host seconds")).

crew(greedy, maze, [greedy]).
crew(scout, maze, [scout]).
crew(greedy_scout, maze, [greedy, greedy, greedy, scout]).
crew(climb, settings, [climb]).
crew(genetic, settings, [genetic]).
crew(climb_genetic, settings, [climb, genetic]).

claim("greedy and scout together always reach the light", [ours],
      at([crew=greedy_scout], reached =:= 100)).
claim("greedy alone does not always reach the light", [ours],
      at([crew=greedy], reached < 100)).
claim("greedy and scout together need fewer executions than scouts alone",
      [ours],
      at([crew=greedy_scout], executions < at([crew=scout], executions))).
claim("climb and genetic together need no more pages than genetic alone",
      [ours],
      at([crew=climb_genetic], pages =< at([crew=genetic], pages))).

plot(mixed, "A maze with a corner, four agents",
     lines([ x(crew), y([reached, executions]),
             where([crew=in([greedy, scout, greedy_scout])]) ])).
plot(mixed_printers, "Printers, four agents",
     lines([ x(crew), y([reached, executions, pages]),
             where([crew=in([climb, genetic, climb_genetic])]) ])).
