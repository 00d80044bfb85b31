:- module(test_robot_logs,
          [ robot_study/2,              % +Name, -Study
            measured/6,                 % +Study, +Given, +Hosts, +Events,
                                        % +Terms, -Point
            small_run/4,                % +Study, +Given, +Dir, -Point
            drawn/4,                    % +Study, +Points, +Dir, -Files
            stopped_when/5              % +Text, +Args, +Dir, +Signal, -Status
          ]).
:- use_module(common,
              [wait_for_end/3, wait_until/2, with_swipl/5, with_tmp_dir/1]).
:- use_module(project_studies, [first_run/5, project_study/2]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module('../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../experiments/engine/picture', [picture/4]).
:- use_module('../../experiments/engine/studies', [study_call/2]).

/** <module> Studies of robots, applied to hand-made logs and to runs

*Threading*: one test at a time.
*/

%!  robot_study(+Name, -Study) is det.

robot_study(Name, Study) :-
    atom_concat('robots/study_', Name, File),
    project_study(File, Study).

%!  measured(+Study, +Given, +Hosts, +Events, +Terms, -Point) is semidet.
%
%   Point is the first case with parameters Given, with its measures if the
%   network has logged Events and the arena Terms.

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

%!  small_run(+Study, +Given, +Dir, -Point) is det.
%
%   Make the first case with parameters Given in Dir.

small_run(Study, Given, Dir, Case-Measures) :-
    first_run(Study, Given, 1, Dir, Case-Measures0),
    Measures = Measures0.put(directory, Dir).

%!  drawn(+Study, +Points, +Dir, -Files:list(atom)) is det.
%
%   Files are there when the pictures of a run with Points are drawn in Dir.

drawn(Study, Points, Dir, Files) :-
    findall(run(Case, 1, Ms), member(Case-Ms, Points), Runs),
    forall(study_call(Study, plot(Name, Title, Picture)),
           picture(Study, plot(Name, Title, Picture), Runs, Dir)),
    directory_files(Dir, Files).

%!  stopped_when(+Text, +Args, +Dir, +Signal, -Status) is det.
%
%   A `swipl Args` gets Signal when a log below Dir has Text.  Status is as
%   of wait_for_end/3.

stopped_when(Text, Args, Dir, Signal, Status) :-
    with_swipl(Args, Pid, _, _,
               ( wait_until(logged_below(Dir, Text), 60),
                 process_kill(Pid, Signal),
                 wait_for_end(Pid, 40, Status)
               )).

%   A run may be renamed meanwhile.

logged_below(Dir, Text) :-
    directory_member(Dir, File, [recursive(true), matches('events.pl')]),
    catch(read_file_to_string(File, Log, []), error(existence_error(_, _), _),
          fail),
    sub_string(Log, _, _, _, Text),
    !.
