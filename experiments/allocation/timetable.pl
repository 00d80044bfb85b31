:- module(allocation_timetable,
          [ timetable/4,                % +Events, +Names, +Tasks, -Timetable
            timetable_measure/3,        % ?Name, +Timetable, -Value
            held_rows/2,                % +Runs, -Rows
            executed_rows/2,            % +Runs, -Rows
            timetable_extent/2          % +Runs, -Variables
          ]).
:- use_module('../sync/metrics',
              [executions/2, out_of_order/2, overlaps/2]).
:- use_module(metrics, [communications/2, from_first/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists),
              [last/2, member/2, memberchk/2, nth1/3, subtract/3]).

/** <module> Allocation of robots to sequences, and times of executions

A timetable is timetable(Tasks, Sequences, Communications): the number of
tasks of each sequence, and sequence(Name, Robots, times(Allocated,
Completed), Executions).  Robots are the allocated robots, Executions those of
executions/2, times are in seconds since the first allocator began.

*Threading*: pure.
*/

%!  timetable(+Events, +Names:list(atom), +Tasks:integer, -Timetable) is det.
%
%   Timetable has the completed sequences of Names.  Events are in order of
%   time.

timetable(Events0, Names, Tasks, timetable(Tasks, Sequences, Sum)) :-
    from_first(Events0, Events),
    findall(Sequence,
            ( member(Name, Names), sequence(Events, Name, Sequence) ),
            Sequences),
    communications(Events, Sum).

%   Each replacement of a robot logs another allocation: the last one counts.

sequence(Events, Name,
         sequence(Name, Robots, times(Allocated, Completed), Executions)) :-
    memberchk(event(Completed, _, _, completed(Name)), Events),
    findall(Time-Hosts,
            member(event(Time, _, _, allocated(Name, Hosts)), Events), All),
    last(All, Allocated-Robots),
    findall(event(Time, Host, Agent, What),
            ( member(event(Time, Host, Agent, What), Events),
              step(What, Name) ),
            Steps),
    executions(Steps, Executions).

step(executing(Name, _), Name).
step(completed(Name, _), Name).

                /*******************************
                *           MEASURES           *
                *******************************/

%!  timetable_measure(?Name, +Timetable, -Value) is nondet.
%
%   `timetable` is Timetable itself, all others are numbers.

timetable_measure(timetable, Timetable, Timetable).
timetable_measure(communications, timetable(_, _, Sum), Sum).
timetable_measure(found, timetable(_, Sequences, _), Time) :-
    aggregate_all(max(T), member(sequence(_, _, times(T, _), _), Sequences),
                  Time).
timetable_measure(completed, timetable(_, Sequences, _), Time) :-
    aggregate_all(max(T), member(sequence(_, _, times(_, T), _), Sequences),
                  Time).
timetable_measure(Name, Timetable, Count) :-
    counted(Name),
    aggregate_all(count, wrong(Name, Timetable), Count).

counted(faulty).
counted(strangers).
counted(overlaps).
counted(disorder).
counted(both).

%   wrong(+Name, +Timetable): succeeds once for each violation.

wrong(faulty, timetable(Tasks, Sequences, _)) :-
    member(sequence(_, Robots, _, Executions), Sequences),
    member(Robot, Robots),
    \+ forall(between(1, Tasks, Task),
              aggregate_all(count,
                            member(execution(Task, Robot, _, _), Executions),
                            1)).
wrong(strangers, timetable(_, Sequences, _)) :-
    member(sequence(_, Robots, _, Executions), Sequences),
    findall(Host, member(execution(_, Host, _, _), Executions), Hosts0),
    sort(Hosts0, Hosts),
    subtract(Hosts, Robots, Others),
    member(_, Others).
wrong(overlaps, timetable(_, Sequences, _)) :-
    member(sequence(_, _, _, Executions), Sequences),
    overlaps(Executions, Overlapping),
    member(_, Overlapping).
wrong(disorder, timetable(_, Sequences, _)) :-
    member(sequence(_, _, _, Executions), Sequences),
    out_of_order(Executions, OutOfOrder),
    member(_, OutOfOrder).
wrong(both, timetable(_, Sequences, _)) :-
    member(sequence(Name1, _, _, Executions1), Sequences),
    member(sequence(Name2, _, _, Executions2), Sequences),
    Name1 @< Name2,
    member(execution(_, Host, Start1, End1), Executions1),
    member(execution(_, Host, Start2, End2), Executions2),
    Start1 < End2,
    Start2 < End1.

                /*******************************
                *            PICTURE           *
                *******************************/

%!  held_rows(+Runs, -Rows) is det.
%!  executed_rows(+Runs, -Rows) is det.
%
%   Rows are [Number, From, Till, Task]; Number is the number of a robot in the
%   one run of Runs.

held_rows([Run|_], Rows) :-
    robots(Run, Sequences, Robots),
    findall([Number, From, Till, 0],
            ( member(sequence(_, Its, times(From, Till), _), Sequences),
              member(Robot, Its),
              nth1(Number, Robots, Robot) ),
            Rows).

executed_rows([Run|_], Rows) :-
    robots(Run, Sequences, Robots),
    findall([Number, From, Till, Task],
            ( member(sequence(_, _, _, Executions), Sequences),
              member(execution(Task, Robot, From, Till), Executions),
              nth1(Number, Robots, Robot) ),
            Rows).

robots(run(_, _, Measures), Sequences, Robots) :-
    get_dict(timetable, Measures, timetable(_, Sequences, _)),
    findall(Robot, ( member(sequence(_, Its, _, _), Sequences),
                     member(Robot, Its) ),
            All),
    sort(All, Robots).

%!  timetable_extent(+Runs, -Variables) is det.

timetable_extent([Run|_], [robots-Count, 'END'-End]) :-
    robots(Run, Sequences, Robots),
    length(Robots, Count),
    aggregate_all(max(T), member(sequence(_, _, times(_, T), _), Sequences),
                  End).
