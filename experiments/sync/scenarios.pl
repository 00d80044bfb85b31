:- module(sync_scenarios,
          [ figure/2,                   % ?Figure, ?Title
            figure_cases/2,             % +Figure, -Cases
            case_arguments/4,           % +Case, +Seed, +Common, -Arguments
            case_name/3,                % +Case, +Seed, -Name
            topology/4                  % ?Name, ?Title, ?Topology, ?Delta
          ]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(option), [option/3]).

/** <module> What is run for the figures of thesis chapter 5

A case is a list of options of experiments/synchronisation.pl, those that
differ from its defaults, in a fixed order: figures that need the same runs
have equal cases.  It is run with several seeds.

*Threading*: pure.
*/

%!  figure(?Figure, ?Title) is nondet.
%
%   The figures, in their order; Figure is an atom.

figure('5.2',  'How a potential falls').
figure('5.5',  'Execution in step in four topologies, and Table 5.1').
figure('5.6',  'Idle time and overlaps against the penalty bias').
figure('5.7a', 'Idle time and overlaps against the number of agents').
figure('5.7b', 'Idle time and overlaps against the number of hosts').
figure('5.8',  'Tasks that take different times at different hosts').
figure('5.9',  'Idle time and overlaps in dynamic networks').
figure('5.10', 'Time for all tasks in dynamic networks').
figure('5.11', 'Healing of atomic failures').
figure('5.12', 'Healing of cascaded failures').

%!  topology(?Name, ?Title, ?Topology, ?Delta) is nondet.
%
%   The four networks of Figure 5.4 with sixty hosts, and the penalty bias
%   that the thesis found best for each (section 5.6.1).

topology(star_bus, 'Star-bus', star_bus(6,10), 0.2).
topology(ring,     'Ring',     ring(60),       0.8).
topology(tree,     'Tree',     tree(60),       0.2).
topology(grid,     'Grid',     grid(6,10),     0.5).

%   shape(+Name, +Hosts, -Topology): the same with more or fewer hosts.

shape(star_bus, N, star_bus(Arms,10)) :-
    Arms is N // 10.
shape(ring, N, ring(N)).
shape(tree, N, tree(N)).
shape(grid, N, grid(Rows,10)) :-
    Rows is N // 10.

%!  figure_cases(+Figure, -Cases) is det.
%
%   Cases are pairs Key-Case in order.  Key says which point of the figure
%   it is: Name, Name-X (a topology or model, a parameter).

figure_cases(Figure, Cases) :-
    findall(Key-Case, figure_case(Figure, Key, Case), Cases).

figure_case('5.5', Name, [topology(T), delta(D)]) :-
    topology(Name, _, T, D).
figure_case('5.6', Name-Delta, [topology(T), delta(Delta)]) :-
    topology(Name, _, T, _),
    member(Delta, [0.2, 0.3, 0.5, 0.8, 1.0]).
figure_case('5.7a', Name-Agents, Case) :-
    topology(Name, _, T, D),
    member(Agents, [5, 10, 15, 20]),
    with_agents(Agents, [topology(T), delta(D)], Case).
figure_case('5.7b', Name-Hosts, [topology(T), delta(D)]) :-
    topology(Name, _, _, D),
    member(Hosts, [30, 40, 50, 60]),
    shape(Name, Hosts, T).
figure_case('5.8', grid, [topology(T), delta(D), task_time(Times)]) :-
    topology(grid, _, T, D),
    task_times(Times).
figure_case('5.9', Model-Agents, Case) :-
    topology(grid, _, T, _),
    member(Model, [dynamic_1, dynamic_2]),
    member(Agents, [5, 10, 15, 20]),
    with_agents(Agents, [topology(T), delta(0.2), dynamic(Model)], Case).
figure_case('5.10', Key, Case) :-
    figure_case('5.9', Key, Case).
figure_case('5.11', Name,
            [topology(T), delta(D), failure(atomic(2,20,5))]) :-
    topology(Name, _, T, D).
figure_case('5.12', grid,
            [topology(T), delta(D), failure(cascaded(2,60,5))]) :-
    topology(grid, _, T, D).
figure_case('5.12', dynamic_2,
            [ topology(T), delta(0.2), dynamic(dynamic_2),
              failure(cascaded(2,60,5))
            ]) :-
    topology(grid, _, T, _).

%   Ten agents are the default.

with_agents(10, Case, Case) :-
    !.
with_agents(Agents, Case, [agents(Agents)|Case]).

%   Table 5.2, in seconds.

task_times([0.5-1.4, 1.5-2.3, 2.0-3.0, 3.15-4.1, 4.5-5.2, 6.0-8.0]).

%!  case_arguments(+Case, +Seed, +Common, -Arguments) is det.
%
%   The command line of experiments/synchronisation.pl for Case.  Common
%   are options that all cases of a session share.

case_arguments(Case, Seed, Common, Arguments) :-
    findall(Argument,
            ( ( member(Option, Case)
              ; member(Option, Common)
              ; Option = seed(Seed)
              ),
              Option =.. [Name, Value],
              format(atom(Argument), '--~w=~w', [Name, Value])
            ),
            Arguments).

%!  case_name(+Case, +Seed, -Name) is det.
%
%   Name tells people what was run.

case_name(Case, Seed, Name) :-
    memberchk(topology(Topology), Case),
    Topology =.. [Shape|Sizes],
    atomic_list_concat(Sizes, x, Size),
    memberchk(delta(Delta), Case),
    option(agents(Agents), Case, 10),
    findall(Word, case_word(Case, Word), Words),
    atomic_list_concat(Words, More),
    format(atom(Name), '~w-~w-delta~w-agents~w~w-seed~w',
           [Shape, Size, Delta, Agents, More, Seed]).

case_word(Case, '-table52') :-
    memberchk(task_time([_|_]), Case).
case_word(Case, Word) :-
    memberchk(dynamic(Model), Case),
    atom_concat('-', Model, Word).
case_word(Case, Word) :-
    memberchk(failure(Failure), Case),
    functor(Failure, Kind, _),
    atom_concat('-', Kind, Word).
