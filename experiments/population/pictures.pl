:- module(population_pictures,
          [ bar_rows/2,                 % +Runs, -Rows
            kind_rows/2,                % +Runs, -Rows
            other_rows/2,               % +Runs, -Rows
            span_rows/2,                % +Runs, -Rows
            crash_rows/2,               % +Runs, -Rows
            panel_variables/2           % +Runs, -Pairs
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists),
              [append/2, append/3, member/2, nth1/3, reverse/2]).

/** <module> Data of population.gp

Each table has a block for each number of hosts, the smaller first.

*Threading*: pure.
*/

%!  bar_rows(+Runs, -Rows) is det.
%
%   For the first seed, a stack of bars for each second, one for each task:
%   middle, left, right, bottom, top, task.

bar_rows(Runs, Rows) :-
    blocks(Runs, first_bars, Rows).

first_bars([_-Ms|_], Rows) :-
    findall(Second-Task,
            ( member(Start-Task, Ms.started), Second is floor(Start) ),
            Starts),
    sort(Starts, Distinct),
    findall(Bar-Count,
            ( member(Bar, Distinct),
              aggregate_all(count, member(Bar, Starts), Count) ),
            Counts),
    foldl(stack, Counts, bars([], none, 0), bars(Reversed, _, _)),
    reverse(Reversed, Rows).

stack((Second-Task)-Count, bars(Rows, Second0, Top0),
      bars([[Middle, Second, Right, Bottom, Top, Task]|Rows], Second, Top)) :-
    ( Second == Second0 -> Bottom = Top0 ; Bottom = 0 ),
    Top is Bottom + Count,
    Middle is Second + 0.5,
    Right is Second + 1.

%!  kind_rows(+Runs, -Rows) is det.
%!  other_rows(+Runs, -Rows) is det.
%
%   Time, agents of each kind, and their sum: for the first seed, and for all
%   other seeds one after the other.

kind_rows(Runs, Rows) :-
    blocks(Runs, first_steps, Rows).

first_steps([_-Ms|_], Rows) :-
    step_rows(Ms, Rows).

other_rows(Runs, Rows) :-
    blocks(Runs, other_steps, Rows).

other_steps([_|Others], Rows) :-
    findall([[gap]|[More]], ( member(_-Ms, Others), step_rows(Ms, More) ),
            Nested0),
    append(Nested0, Nested),
    append(Nested, Rows).

step_rows(Ms, Rows) :-
    findall([Time|Columns],
            ( member(step(Time, Counts, Total), Ms.steps),
              append(Counts, [Total], Columns) ),
            Rows).

%!  span_rows(+Runs, -Rows) is det.
%
%   From the first start to the last end of each task of each run: middle,
%   place of the run, left, right, bottom, top, task, seed.

span_rows(Runs, Rows) :-
    blocks(Runs, spans, Rows).

spans(Seeds, Rows) :-
    findall([Middle, Place, First, End, Low, High, Task, Seed],
            ( nth1(Place, Seeds, Seed-Ms),
              member(task(Task, First, _, End, _, _), Ms.rows),
              Middle is (First + End)/2,
              Low is Place - 0.3,
              High is Place + 0.3 ),
            Rows).

%!  crash_rows(+Runs, -Rows) is det.
%
%   The times at which hosts lost a task, in the run of the first seed.

crash_rows(Runs, Rows) :-
    blocks(Runs, crash, Rows).

crash([_-Ms|_], Rows) :-
    findall([Time], get_dict(crash_time, Ms, Time), Rows).

%!  panel_variables(+Runs, -Pairs) is det.

panel_variables(Runs, [ columns-Columns, 'Hosts'-Sizes, seeds-SeedCount,
                        crashed-Crashed ]) :-
    sizes(Runs, Sizes),
    length(Sizes, Columns),
    findall(Seed, member(run(_, Seed, _), Runs), Seeds0),
    sort(Seeds0, Seeds),
    length(Seeds, SeedCount),
    (   member(run(_, _, Ms), Runs),
        get_dict(crash_time, Ms, _)
    ->  Crashed = 1
    ;   Crashed = 0
    ).

sizes(Runs, Sizes) :-
    findall(Hosts, ( member(run(Case, _, _), Runs), Hosts = Case.hosts ),
            Sizes0),
    sort(Sizes0, Sizes).

%   blocks(+Runs, :Goal, -Rows): calls Goal(Seeds, Block) for each number of
%   hosts; Seeds are pairs Seed-Measures.

:- meta_predicate blocks(+, 2, -).

blocks(Runs, Goal, Rows) :-
    sizes(Runs, Sizes),
    findall([Block, [gap, gap]],
            ( member(Hosts, Sizes),
              findall(Seed-Ms,
                      ( member(run(Case, Seed, Ms), Runs),
                        Case.hosts =:= Hosts ),
                      Seeds0),
              keysort(Seeds0, Seeds),
              call(Goal, Seeds, Block0),
              ( Block0 == [] -> Block = [['NaN']] ; Block = Block0 ) ),
            Nested0),
    append(Nested0, Nested),
    append(Nested, Rows).
