:- module(allocation_beyond,
          [ beyond/2,                   % ?Figure, ?Title
            beyond_cases/3,             % +Figure, +Options, -Cases
            show_beyond/5               % +Figure, +Directory, +Subtitle,
                                        % +Data, -Claims
          ]).
:- use_module('../lib/chart', [draw_chart/3]).
:- use_module('../lib/report', [print_table/3, save_csv/3]).
:- use_module(integrated, [integrated_claims/2]).
:- use_module(timetable,
              [draw_timetable/3, print_sequences/2, save_executions/2]).
:- use_module(urgent, [urgent_claims/2]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(option), [option/2]).

/** <module> What goes beyond the thesis

`integrated`: allocation, then synchronised execution, see integrated.pl.
`urgent`: priorities and deadlines, see urgent.pl.

*Threading*: no state; any thread.
*/

%!  beyond(?Figure, ?Title) is nondet.

beyond(integrated, 'Sequences of tasks on robots that were allocated').
beyond(urgent, 'A task that comes late, and deadlines').

%!  beyond_cases(+Figure, +Options, -Cases:list(pair)) is det.
%
%   Cases are Key-Case; Case is for make_runs/3.  For sequences half of the
%   hosts have fitting robots: agents look for these on all hosts.

beyond_cases(integrated, Options,
             [integrated-beyond(integrated, [hosts(Hosts), allocators(2)])]) :-
    option(eligible(Eligible), Options),
    Hosts is 2*Eligible.
beyond_cases(urgent, _, Cases) :-
    findall(priority(P)-beyond(urgent, [priority(P), deadline(0)]),
            member(P, [0, 1]), Cases0),
    findall(deadline(S)-beyond(urgent, [priority(0), deadline(S)]),
            member(S, [30, 60, 120]), Cases1),
    append(Cases0, Cases1, Cases).

%!  show_beyond(+Figure, +Directory, +Subtitle, +Data, -Claims) is det.
%
%   Print the runs of Data, pairs Key-Runs, and write allocation-Figure.csv,
%   .svg and .png.  Claims are for print_claims/2.

show_beyond(integrated, Directory, Subtitle, [_-Runs], Claims) :-
    make_directory_path(Directory),
    print_sequences(user_output, Runs),
    save_executions(Directory, Runs),
    (   Runs = [_-Result|_]
    ->  draw_timetable(Directory, Subtitle, Result)
    ;   true
    ),
    integrated_claims(Runs, Claims).
show_beyond(urgent, Directory, Subtitle, Data, Claims) :-
    make_directory_path(Directory),
    findall(Row, urgent_row(Data, Row), Rows),
    Header = [ priority, deadline, seed, late, others, completed, missed,
               ended ],
    print_table(user_output, Header, Rows),
    directory_file_path(Directory, 'allocation-urgent.csv', File),
    save_csv(File, Header, Rows),
    draw_urgent(Directory, Subtitle, Data),
    urgent_claims(Data, Claims).

urgent_row(Data, [Priority, Deadline, Seed, Late, Others, Completed, Missed,
                  Ended]) :-
    member(Key-Runs, Data),
    key(Key, Priority, Deadline),
    member(Seed-Result, Runs),
    memberchk(late(Late), Result),
    memberchk(others(Others), Result),
    memberchk(completed(Done), Result),
    length(Done, Completed),
    memberchk(missed(Tasks), Result),
    length(Tasks, Missed),
    memberchk(ended(Ended), Result).

key(priority(P), P, none).
key(deadline(S), 0, S).

draw_urgent(Directory, Subtitle, Data) :-
    findall(series(Label, Index, Points, none),
            ( member(Measure-Label-Index,
                     [ late-'the last task'-1,
                       others-'the others, mean'-0 ]),
              findall(P-Values,
                      ( member(priority(P)-Runs, Data),
                        numbers(Measure, Runs, Values),
                        Values = [_|_] ),
                      Points),
              Points = [_|_] ),
            Series),
    (   Series = [_|_]
    ->  draw_chart(Directory, 'allocation-urgent',
                   [ title('Priorities: the last task comes late'),
                     subtitle(Subtitle), x('priority of the last task'),
                     panels([ panel('From its beginning to its completion',
                                    'host seconds', Series) ]) ])
    ;   true
    ).

numbers(Measure, Runs, Values) :-
    Term =.. [Measure, Value],
    findall(Value,
            ( member(_-Result, Runs), memberchk(Term, Result),
              number(Value) ),
            Values).
