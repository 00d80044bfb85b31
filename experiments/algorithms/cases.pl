:- module(algorithms_cases,
          [ figure/2,                   % ?Figure, -Title
            figure_case/2,              % ?Figure, -Case
            case_options/2,             % ?Case, -Options
            case_name/2                 % ?Case, -Name
          ]).
:- use_module(library(lists), [append/2]).

/** <module> What is compared in each figure

*Threading*: pure.
*/

%!  figure(?Figure, -Title) is nondet.
%!  figure_case(?Figure, -Case) is nondet.
%
%   Cases are atoms, in the order in which they are shown.

figure(settings, 'Ten printers that all differ, five agents').
figure(islands,  'A genetic algorithm: islands of the agents').
figure(mixed,    'Two learning algorithms in one population').
figure(exchange, 'Another learning algorithm while agents live').
figure(cloning,  'Agents that clone themselves when they make progress').

figure_case(Figure, Case) :-
    case(Case, Figure, _, _).

%!  case_name(?Case, -Name) is nondet.
%!  case_options(?Case, -Options) is nondet.
%
%   Options are, all of them in each case:
%
%     - problem(Name), algorithms(Names)
%       Payloads of learning; the agents have the algorithms in turn.
%     - agents(Count), nodes(Count)
%     - settings(Pairs)
%       Of agents and problem.
%     - exchange(What)
%       `none` or at(Seconds, Old, New): the first of the agents lays down
%       Old then and takes up New.
%     - limit(Seconds)
%       Of the hosts, after which nobody is waited for any more.

case_name(Case, Name) :-
    case(Case, _, Name, _).

case_options(Case, Options) :-
    case(Case, _, _, Parts),
    findall(Part, part(Parts, Part), Lists),
    append(Lists, Options).

part(Parts, Options) :-
    arg(_, Parts, Name),
    options(Name, Options).
part(Parts, [settings(Settings)]) :-
    findall(Some, ( arg(_, Parts, Name), pairs(Name, Some) ), Lists),
    append(Lists, Settings).
part(Parts, [exchange(none)]) :-
    \+ ( arg(_, Parts, Name), options(Name, [exchange(_)|_]) ).

%   case(Case, Figure, Name, Parts)

case(climb, settings, 'climb',
     c(printers, by([climb]), five)).
case(climb_alone, settings, 'climb, no sharing',
     c(printers, by([climb]), five, alone)).
case(lottery, settings, 'random search',
     c(printers, by([lottery]), five)).
case(lottery_alone, settings, 'random search, no sharing',
     c(printers, by([lottery]), five, alone)).
case(islands, islands, 'islands',
     c(printers, by([genetic]), six)).
case(islands_alone, islands, 'no sharing',
     c(printers, by([genetic]), six, alone)).
case(one_population, islands, 'one population',
     c(printers, by([genetic]), one)).
case(trap_greedy, mixed, 'maze: greedy',
     c(trap, by([greedy]), four, long)).
case(trap_scout, mixed, 'maze: scout',
     c(trap, by([scout]), four, long)).
case(trap_both, mixed, 'maze: 3 greedy, 1 scout',
     c(trap, by([greedy,greedy,greedy,scout]), four, long)).
case(print_climb, mixed, 'printers: climb',
     c(printers, by([climb]), four)).
case(print_genetic, mixed, 'printers: genetic',
     c(printers, by([genetic]), four)).
case(print_both, mixed, 'printers: 2 climb, 2 genetic',
     c(printers, by([climb,genetic]), four)).
case(unchanged, exchange, 'greedy throughout',
     c(trap, by([greedy]), four, short)).
case(changed, exchange, 'one takes up scout after 500 s',
     c(trap, by([greedy]), four, short, changing)).
case(barren, cloning, '3 agents',
     c(open, by([greedy]), three)).
case(breeding, cloning, '3 agents that clone',
     c(open, by([greedy]), three, breeding)).
case(crowd, cloning, '8 agents',
     c(open, by([greedy]), eight)).

options(printers, [problem(settings), nodes(10), limit(6000)]).
options(trap, [problem(maze), nodes(10)]).
options(short, [limit(3000)]).
options(long, [limit(6000)]).
options(open, [problem(maze), nodes(10), limit(4000)]).
options(by(Algorithms), [algorithms(Algorithms)]).
options(one, [agents(1)]).
options(three, [agents(3)]).
options(four, [agents(4)]).
options(five, [agents(5)]).
options(six, [agents(6)]).
options(eight, [agents(8)]).
options(changing, [exchange(at(500, greedy, scout))]).

%   The light behind a corner: who follows it goes into the corner, from
%   where all ways on lead away from it.

pairs(trap, [size-16, obstacles-[(6,6)-(6,11),(6,11)-(12,11)]]).
pairs(open, [size-25]).
pairs(alone, [sharing-false]).
pairs(breeding, [cloning-true,q_th-2,alpha_r-5,c_l-1,lifetime-5]).
