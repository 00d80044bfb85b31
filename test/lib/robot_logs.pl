:- module(test_robot_logs,
          [ robot_study/2,              % +Name, -Study
            measured/6,                 % +Study, +Given, +Hosts, +Events,
                                        % +Terms, -Point
            holding/3,                  % +Study, +Points, -Numbers
            shapeless/2                 % +Study, -Problems
          ]).
:- use_module(common, [project_file/2, with_tmp_dir/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module('../../experiments/engine/claims',
              [claim_holds/3, claim_shape/2]).
:- use_module('../../experiments/engine/studies',
              [study_call/2, study_cases/3, study_load/2]).

/** <module> What the studies of robots say of logs made by hand

*Threading*: one test at a time.
*/

%!  robot_study(+Name, -Study) is det.

robot_study(Name, Study) :-
    format(atom(Relative), 'experiments/robots/study_~w.pl', [Name]),
    project_file(Relative, File),
    study_load(File, Study).

%!  measured(+Study, +Given, +Hosts, +Events, +Terms, -Point) is semidet.
%
%   Point is the first case with parameters Given, and what is measured where
%   the network has logged Events and the arena Terms.

measured(Study, Given, Hosts, Events, Terms, Point) :-
    with_tmp_dir(in_directory(Study, Given, Hosts, Events, Terms, Point)).

in_directory(Study, Given, Hosts, Events, Terms, Case-Measures, Dir) :-
    study_cases(Study, Given, [Case|_]),
    directory_file_path(Dir, 'arena.pl', File),
    setup_call_cleanup(
        open(File, write, Out),
        forall(member(Term, Terms), format(Out, '~q.~n', [Term])),
        close(Out)),
    Log = log{case:(Case.put(directory, Dir)), hosts:Hosts, events:Events},
    study_call(Study, view(Log, View)),
    !,
    findall(Name-Value, study_call(Study, measure(Name, View, Value)), Pairs),
    dict_create(Measures, measures, Pairs).

%!  holding(+Study, +Points, -Numbers:list(integer)) is det.
%
%   The numbers of the claims that hold.

holding(Study, Points, Numbers) :-
    findall(N,
            ( nth_claim(Study, N, Test),
              \+ \+ claim_holds(Study:Test, Points, Points) ),
            Numbers).

nth_claim(Study, N, Test) :-
    findall(Test, study_call(Study, claim(_, _, Test)), Tests),
    nth1(N, Tests, Test).

%!  shapeless(+Study, -Problems:list) is det.
%
%   What in the claims is no test.

shapeless(Study, Problems) :-
    findall(Problem,
            ( nth_claim(Study, _, Test),
              claim_shape(Study:Test, Problem) ),
            Problems).
