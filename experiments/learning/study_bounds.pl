%   The bounds of section 4.3.6: γ < θ << β.

:- include(ground).
:- use_module(complexity, [digits/2, exhaustive_search/3, shared_search/4]).

study(bounds, "Executions against the bounds of an exhaustive search").
text("β is the number of all sequences of actions that may have to be tried, γ \c
its share for each of several agents that share everything. Counted: the \c
executions of an agent, θ, between those of one agent alone and their share. The \c
thesis says γ < θ << β.").

vary(density, [0.02, 0.04, 0.1, 0.2, 0.5]).
fixed(network, 50, printed("section 4.4")).
fixed(actions, 5, printed("section 4.3.3")).
fixed(vectors, 4, printed("section 4.3.6: of a cell")).
fixed(shared_in, 1, assumed("seconds of two agents; a stay in a queue")).

label(executions, "Executions of an agent, θ").
label(beta_digits, "Digits of β, as printed").
label(gamma_digits, "Digits of γ, as printed").
label(theta_digits, "Digits of the executions of all agents").

measure(beta_digits, View, Digits) :-
    beta(View.case, Beta),
    digits(Beta, Digits).
measure(gamma_digits, View, Digits) :-
    beta(View.case, Beta),
    agents(View.case, Agents),
    shared_search(Beta, Agents, View.case.shared_in, Gamma),
    digits(Gamma, Digits).
measure(theta_digits, View, Digits) :-
    measure(total, View, Count),
    digits(Count, Digits).

beta(Case, Beta) :-
    Vectors is Case.vectors*Case.size**2,
    exhaustive_search(Case.actions, Vectors, Beta).

%   The same with what one agent needs in place of β.

claim(Text, [line(2351)],
      at([density=D], executions > at([density=0.02], executions)/Agents)) :-
    several(D, Agents),
    format(string(Text), "~d agents: each needs more than its share of what one \c
agent alone needs (γ < θ)", [Agents]).
claim(Text, [line(2351)],
      at([density=D], executions < 0.5*at([density=0.02], executions))) :-
    several(D, Agents),
    Agents > 2,
    format(string(Text), "~d agents: each needs less than half of what one agent \c
alone needs (θ << β)", [Agents]).
claim("two agents: each needs less than one alone", [line(2351)],
      at([density=0.04], executions < at([density=0.02], executions))).
claim("as printed: θ << β, by 1,000 digits", [line(2351)],
      theta_digits + 1000 < beta_digits).
claim("as printed: γ < θ",
      [ line(2351), why("γ divides the work of agents that try all sequences; \c
agents that learn follow the light") ],
      gamma_digits =< theta_digits).

several(0.04, 2).
several(0.1, 5).
several(0.2, 10).
several(0.5, 25).

plot(bounds, "Executions of an agent, by the density of agents",
     lines([x(density), y([executions, duration])])).
