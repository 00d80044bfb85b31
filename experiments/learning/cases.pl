:- module(learning_cases,
          [ figure/2,                   % ?Figure, -Title
            figure_cases/3,             % +Figure, +Sizes, -Cases
            case_name/2,                % +Case, -Name
            case_agents/2,              % +Case, -Agents
            case_clock/3,               % +Case, +Clock, -Rate
            case_options/3,             % +Case, +Common, -Options
            clock/1                     % ?Clock
          ]).
:- use_module(library(lists),
              [append/3, last/2, member/2, memberchk/2, selectchk/4]).

/** <module> The runs that the figures of thesis chapter 4 need

A case is case(Kind, Hosts, Density): Density is in tenths, the agents are
so many for each ten hosts.  Kind is

    sharing     the maze without obstacles
    alone       the same, and agents do not share
    obstacle    a maze with a wall, from (40,0) to (40,40)
    dynamic     without obstacles, on a network whose links come and go

*Threading*: pure.
*/

%!  figure(?Figure, -Title) is nondet.

figure('4.7', 'Final paths of all agents').
figure('4.8', 'Length of the plan that is executed').
figure('4.9', 'Executions that an agent needs').
figure('4.10', 'Sharing events per execution').
figure('4.11', 'Movements of all robots until all have converged').
figure('4.12', 'Sharing events as time passes').
figure('4.13', 'A dynamic network').

%!  figure_cases(+Figure, +Sizes:list(integer), -Cases) is det.
%
%   Sizes are those of the networks that are compared, ascending; what is
%   shown of one network is shown of the last.

figure_cases(Figure, Sizes, Cases) :-
    findall(Case, figure_case(Figure, Sizes, Case), Cases).

figure_case(Figure, Sizes, case(Kind, N, 1)) :-
    memberchk(Figure, ['4.7', '4.8']),
    member(Kind, [alone, sharing]),
    last(Sizes, N).
figure_case(Figure, Sizes, case(sharing, N, D)) :-
    memberchk(Figure, ['4.9', '4.10']),
    member(N, Sizes),
    between(1, 5, D).
figure_case(Figure, Sizes, case(obstacle, N, D)) :-
    memberchk(Figure, ['4.9', '4.10']),
    last(Sizes, N),
    between(1, 5, D).
figure_case('4.11', Sizes, case(Kind, N, 1)) :-
    member(Kind, [sharing, obstacle]),
    last(Sizes, N).
figure_case('4.12', Sizes, case(sharing, N, 5)) :-
    last(Sizes, N).
figure_case('4.13', Sizes, case(dynamic, N, D)) :-
    last(Sizes, N),
    between(1, 5, D).

%!  case_name(+Case, -Name) is det.
%!  case_agents(+Case, -Agents:integer) is det.

case_name(case(Kind, N, D), Name) :-
    case_agents(case(Kind, N, D), Agents),
    atomic_list_concat([Kind, N, Agents], -, Name).

case_agents(case(_, N, D), Agents) :-
    Agents is max(1, N*D // 10).

%!  clock(?Clock) is semidet.
%!  case_clock(+Case, +Clock, -Rate) is det.
%
%   Clock says how fast the clocks of hosts go: a number, or pace(Stays,
%   Most), as fast as all agents together stay so many host seconds in a
%   real one, but no faster than Most.  An agent hops after each second it
%   stays, so that is what a machine has to do.

clock(Clock) :-
    nonvar(Clock),
    (   number(Clock)
    ->  Clock > 0
    ;   Clock = pace(Stays, Most),
        number(Stays),
        number(Most),
        Stays > 0,
        Most > 0
    ).

case_clock(Case, pace(Stays, Most), Rate) :-
    !,
    case_agents(Case, Agents),
    Rate is min(Most, Stays/Agents).
case_clock(_, Rate, Rate).

%!  case_options(+Case, +Common, -Options) is det.
%
%   What one run of Case is to do: of Common, clock(Clock), dynamic(Model)
%   and settings(Pairs) are replaced by what is meant for the case.

case_options(Case, Common, [nodes(N), agents(Agents)|Options]) :-
    Case = case(Kind, N, _),
    case_agents(Case, Agents),
    selectchk(clock(Clock), Common, clock(Rate), Common1),
    case_clock(Case, Clock, Rate),
    selectchk(dynamic(Model0), Common1, dynamic(Model), Common2),
    links(Kind, Model0, Model),
    selectchk(settings(Settings0), Common2, settings(Settings), Options),
    findall(Setting, case_setting(Case, Settings0, Setting), More),
    append(More, Settings0, Settings).

links(dynamic, Model, Model) :-
    !.
links(_, _, none).

case_setting(case(alone, _, _), _, sharing-false).
case_setting(case(obstacle, _, _), Settings, obstacles-[(X,0)-(X,X)]) :-
    (   memberchk(size-Size, Settings)
    ->  true
    ;   Size = 50
    ),
    X is 4*Size // 5.
case_setting(case(Kind, _, 1), _, trace-true) :-
    memberchk(Kind, [sharing, obstacle]).
