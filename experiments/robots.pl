/*  Robots: four that carry a pole (thesis section 5.7), and up to seven
    that push boxes (7.7).

        swipl experiments/robots.pl -- --figure pole --seed 1

    `--help` lists the parameters.
*/

:- module(robots, []).
:- use_module(lib/command, [acceptable/3, command/5, range/1]).
:- use_module(robots/boxes, [boxes_figure/2]).
:- use_module(robots/pole, [pole_figure/2]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [argv_options/3, main/0]).
:- use_module(library(option), [option/2]).

:- initialization(main, main).

:- public main/1.

opt_type(figure,   figure,   atom).
opt_type(seed,     seed,     integer).
opt_type(runs,     runs,     natural).
opt_type(agents,   agents,   natural).
opt_type(delta,    delta,    number).
opt_type(hop_time, hop_time, term).
opt_type(clock,    clock,    number).
opt_type(limit,    limit,    number).
opt_type(out,      out,      atom).

opt_help(help(header), "Simulated NXT robots, each driven by a host of its \c
own over a serial line\n").
opt_help(help(usage), " -- [options]").
opt_help(figure,   "pole: four robots carry a pole (thesis 5.7), boxes: \c
seven push boxes (7.7), or all [all]").
opt_help(seed,     "Seed of the first run; the next has the next [1]").
opt_help(runs,     "Number of runs [1]").
opt_help(agents,   "Agents that synchronise the robots with the pole [2]").
opt_help(delta,    "Their penalty bias, above 0 [0.5]").
opt_help(hop_time, "MIN-MAX host seconds that a hop takes [0.3-0.6]").
opt_help(clock,    "Host seconds in a real second [5]").
opt_help(limit,    "Real seconds to wait for the agents of a run, or of two \c
boxes [90]").
opt_help(out,      "Directory for logs, tables and pictures [out/robots]").

opt_meta(figure,   'FIGURE').
opt_meta(hop_time, 'MIN-MAX').
opt_meta(out,      'DIRECTORY').

defaults([ figure(all), seed(1), runs(1), agents(2), delta(0.5),
           hop_time(0.3-0.6), clock(5), limit(90), out('out/robots')
         ]).

main(Argv) :-
    argv_options(Argv, Positional, Given),
    defaults(Defaults),
    command(Positional, Given, Defaults, check, run).

check(Options) :-
    forall(( member(Name, [delta, clock, limit, runs, agents]),
             Option =.. [Name, Value],
             option(Option, Options) ),
           acceptable(Value > 0, Name, Value)),
    option(hop_time(HopTime), Options),
    acceptable(range(HopTime), hop_time, HopTime),
    option(figure(Figure), Options),
    acceptable(( Figure == all ; figure(Figure, _) ), figure, Figure).

%   figure(?Name, ?Predicate): Predicate(Options, Claims) makes it.

figure(pole, pole_figure).
figure(boxes, boxes_figure).

run(Options) :-
    option(figure(Wanted), Options),
    findall(Make, ( figure(Figure, Make), wanted(Wanted, Figure) ), Makes),
    maplist(make(Options), Makes).

wanted(all, _) :-
    !.
wanted(Figure, Figure).

make(Options, Make) :-
    nl,
    call(Make, Options, _).
