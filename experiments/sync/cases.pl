:- module(sync_cases,
          [ run_measures/2,             % +Directory, -Measures
            run_result/3,               % +Directory, -Options, -Result
            save_runs/2,                % +File, +Data
            print_runs/2                % +Stream, +Data
          ]).
:- use_module('../lib/chart', [median/2]).
:- use_module('../lib/report', [print_table/3, save_csv/3]).
:- use_module(run, [sync_result/4]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [max_list/2, member/2, memberchk/2, min_list/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).

/** <module> Runs that have been made, read again

Data is a list of pairs Key-Runs as in statements/3.

*Threading*: no state; any thread.
*/

%!  run_measures(+Directory, -Measures) is det.
%
%   The measures of the run in Directory (see measures/2), its seed(S) and
%   the claims(List) about it.

run_measures(Directory, [claims(Claims), seed(Seed)|Measures]) :-
    metadata(Directory, Facts),
    findall(claim(Text, Held, Found),
            member(claim(Text, Held, Found), Facts), Claims),
    memberchk(parameter(seed, Seed), Facts),
    findall(Measure,
            ( member(result(Name, Value), Facts), Measure =.. [Name, Value] ),
            Measures).

%!  run_result(+Directory, -Options, -Result) is det.
%
%   The Options and the Result of the run in Directory: see sync_result/4.

run_result(Directory, Options, Result) :-
    metadata(Directory, Facts),
    findall(Option,
            ( member(parameter(Name, Value), Facts), Option =.. [Name, Value] ),
            Options),
    memberchk(hosts(Hosts), Facts),
    directory_file_path(Directory, 'events.pl', Log),
    read_file_to_terms(Log, Events, [encoding(utf8)]),
    sync_result(Options, Events, Hosts, Result).

metadata(Directory, Facts) :-
    directory_file_path(Directory, 'metadata.pl', File),
    read_file_to_terms(File, Facts, [encoding(utf8)]).

%!  save_runs(+File, +Data) is det.
%
%   A line of CSV for each run.

save_runs(File, Data) :-
    findall([Name, X, Seed|Cells],
            ( member(Key-Runs, Data),
              name_x(Key, Name, X),
              member(Run, Runs),
              memberchk(seed(Seed), Run),
              maplist(cell(Run), [ idle, overlaps, tau, total, executions,
                                   out_of_order, lost, redone, healing_tau,
                                   meanwhile, real_time ], Cells)
            ),
            Rows),
    save_csv(File, [ case, x, seed, idle, overlaps, tau, total, executions,
                     out_of_order, lost, redone, healing_tau, meanwhile,
                     real_time ], Rows).

name_x(Name-X, Name, X) :-
    !.
name_x(Name, Name, '').

cell(Run, Name, Value) :-
    Term =.. [Name, Value],
    (   memberchk(Term, Run)
    ->  true
    ;   Value = ''
    ).

%!  print_runs(+Stream, +Data) is det.
%
%   A table with a line for each case: medians, and from which to which.

print_runs(Stream, Data) :-
    findall([Name, X, Count|Cells],
            ( member(Key-Runs, Data),
              name_x(Key, Name, X),
              length(Runs, Count),
              maplist(range_cell(Runs), [idle, overlaps, tau, total], Cells)
            ),
            Rows),
    print_table(Stream, [ '', '', runs, 'idle (s)', overlaps, tau,
                          'total (s)' ], Rows).

range_cell(Runs, Name, Cell) :-
    Term =.. [Name, Value],
    findall(Value, ( member(Run, Runs), memberchk(Term, Run) ), Values),
    median(Values, Median),
    min_list(Values, Least),
    max_list(Values, Most),
    (   Least =:= Most
    ->  short(Median, Cell)
    ;   maplist(short, [Median, Least, Most], Texts),
        format(atom(Cell), '~w (~w-~w)', Texts)
    ).

short(X, Text) :-
    (   float(X)
    ->  format(atom(Text), '~1f', [X])
    ;   Text = X
    ).
