:- module(allocation_report,
          [ print_parameters/2,         % +Stream, +Options
            print_cases/3,              % +Stream, +Cases, +Data
            save_result/2,              % +Directory, +Result
            load_result/2,              % +Directory, -Result
            save_figure/5               % +Directory, +Figure, +Subtitle,
                                        % +Cases, +Data
          ]).
:- use_module('../lib/chart', [draw_chart/3, median/2]).
:- use_module('../lib/report', [print_options/3, print_table/3, save_csv/3, save_facts/2]).
:- use_module(cases, [figure/3, panels/2]).
:- use_module(curves, [values/4]).
:- use_module(mechanisms, [mechanism/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, nth0/3]).
:- use_module(library(option), [option/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).

/** <module> Telling people, and files, how allocations fared

*Threading*: no state; any thread.
*/

%!  print_parameters(+Stream, +Options) is det.
%
%   What is going to be run.

print_parameters(Stream, Options) :-
    print_options(Stream, Options,
                  [mechanism, links, single, priority, deadline]),
    option(clock(Rate), Options),
    option(hop_time(Min-Max), Options),
    Low is 1000*Min/Rate,
    High is 1000*Max/Rate,
    format(Stream, 'Host clock ×~w: a hop of ~w to ~w host seconds takes \c
~1f to ~1f real milliseconds.~n', [Rate, Min, Max, Low, High]),
    flush_output(Stream).

%!  print_cases(+Stream, +Cases, +Data) is det.
%
%   A line for each case: how many of its runs ended before the limit, and
%   medians of these.  `hop` is the mean time of a hop that was measured,
%   `cores` the processor seconds in a real second.

print_cases(Stream, Cases, Data) :-
    findall([Title, X, Ended|Texts],
            ( member(X-Case, Cases),
              Case = case(Mechanism, _, _, _, _, _),
              mechanism(Mechanism, Title),
              memberchk(Case-Runs, Data),
              ended(Runs, Ended),
              findall(Value,
                      ( member(Measure, [ communications, time, backoffs,
                                          interval, hop, cores, wall ]),
                        summary(Measure, Case, Data, Value) ),
                      Texts) ),
            Rows),
    print_table(Stream, [ mechanism, x, ended, communications, time,
                          'back-offs', interval, hop, cores, 'real s' ],
                Rows).

ended(Runs, Text) :-
    length(Runs, Count),
    aggregate_all(count,
                  ( member(_-Result, Runs),
                    memberchk(ended(true), Result) ),
                  Ended),
    format(atom(Text), '~d of ~d', [Ended, Count]).

summary(Measure, Case, Data, Value) :-
    case_values(Measure, Case, Data, Values),
    (   median(Values, Median)
    ->  Value = Median
    ;   Value = -
    ).

case_values(Measure, Case, Data, Values) :-
    memberchk(Measure, [hop, cores, wall]),
    !,
    findall(Value,
            ( member(Case-Runs, Data), member(_-Result, Runs),
              memberchk(load(Wall, Cpu, _, Hop), Result),
              load(Measure, Wall, Cpu, Hop, Value) ),
            Values).
case_values(Measure, Case, Data, Values) :-
    values(Measure, Case, Data, Values).

load(hop, _, _, Hop, Hop) :-
    number(Hop).
load(wall, Wall, _, _, Wall).
load(cores, Wall, Cpu, _, Cores) :-
    Cores is Cpu/Wall.

                /*******************************
                *             FILES            *
                *******************************/

%!  save_result(+Directory, +Result) is det.
%!  load_result(+Directory, -Result) is semidet.
%
%   What one run gave, in Directory/result.pl; loading fails if there is
%   nothing.

save_result(Directory, Result) :-
    directory_file_path(Directory, 'result.pl', File),
    save_facts(File, [result(Result)]).

load_result(Directory, Result) :-
    directory_file_path(Directory, 'result.pl', File),
    exists_file(File),
    read_file_to_terms(File, [result(Result)], [encoding(utf8)]).

%!  save_figure(+Directory, +Figure, +Subtitle, +Cases, +Data) is det.
%
%   Write allocation-Figure.csv, allocation-Figure-kinds.csv and the
%   pictures allocation-Figure.svg and .png.

save_figure(Directory, Figure, Subtitle, Cases, Data) :-
    make_directory_path(Directory),
    save_runs(Directory, Figure, Data),
    save_kinds(Directory, Figure, Data),
    draw(Directory, Figure, Subtitle, Cases, Data).

save_runs(Directory, Figure, Data) :-
    findall(Row,
            ( case_run(Data, Cells, Result), run_row(Result, More),
              append(Cells, More, Row) ),
            Rows),
    case_header(Header0),
    append(Header0,
           [ ended, communications, time, backoffs, interval, real, cpu,
             hops, hop ],
           Header),
    csv_file(Directory, Figure, '', File),
    save_csv(File, Header, Rows).

case_header([ mechanism, links, hosts, eligible, required, allocators,
              seed ]).

case_run(Data, [M, Links, N, E, R, K, Seed], Result) :-
    member(case(M, Links, N, E, R, K)-Runs, Data),
    member(Seed-Result, Runs).

run_row(Result, [ Ended, Communications, Time, Backoffs, Interval, Wall, Cpu,
                  Hops, Hop ]) :-
    memberchk(ended(Ended), Result),
    memberchk(communications(Communications), Result),
    memberchk(time(Time), Result),
    memberchk(backoffs(Backoffs), Result),
    memberchk(interval(Interval), Result),
    memberchk(load(Wall, Cpu, Hops, Hop), Result).

save_kinds(Directory, Figure, Data) :-
    findall(Row,
            ( case_run(Data, Cells, Result), memberchk(kinds(Kinds), Result),
              member(Kind-Count, Kinds), append(Cells, [Kind, Count], Row) ),
            Rows),
    case_header(Header0),
    append(Header0, [kind, count], Header),
    csv_file(Directory, Figure, '-kinds', File),
    save_csv(File, Header, Rows).

csv_file(Directory, Figure, Part, File) :-
    atomic_list_concat(['allocation-', Figure, Part, '.csv'], Name),
    directory_file_path(Directory, Name, File).

                /*******************************
                *            PICTURES          *
                *******************************/

draw(Directory, Figure, Subtitle, Cases, Data) :-
    figure(Figure, Title0, XLabel),
    format(atom(Title), 'Figure ~w: ~w', [Figure, Title0]),
    panels(Figure, Measures),
    maplist(panel(Cases, Data), Measures, Panels),
    atom_concat('allocation-', Figure, Name),
    draw_chart(Directory, Name,
               [ title(Title), subtitle(Subtitle), x(XLabel),
                 panels(Panels) ]).

panel(Cases, Data, Measure, panel(Title, Label, Series)) :-
    panel_text(Measure, Title, Label),
    findall(M, member(_-case(M, _, _, _, _, _), Cases), Ms0),
    findall(M, ( mechanism(M, _), memberchk(M, Ms0) ), Ms),
    findall(series(Name, Index, Points, none),
            ( nth0(Index, Ms, M), mechanism(M, Name),
              points(M, Measure, Cases, Data, Points), Points \== [] ),
            Series).

points(Mechanism, Measure, Cases, Data, Points) :-
    findall(X-Values,
            ( member(X-Case, Cases),
              Case = case(Mechanism, _, _, _, _, _),
              values(Measure, Case, Data, Values),
              Values \== [] ),
            Points).

panel_text(communications, 'Messages over a link, and migrations', number).
panel_text(time, 'Until the last task is completed', 'host seconds').
panel_text(backoffs, 'Back-offs of an allocator', number).
panel_text(interval, 'Mean length of a back-off', 'host seconds').
panel_text(rate, 'Time for each robot that an allocator requires',
           'host seconds').
