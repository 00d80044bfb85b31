:- module(study_lines,
          [ lines_picture/6,            % +Study, +Name, +Options, +Runs,
                                        % +Directory, -Picture
            matching/3                  % +Where, +Runs, -Matching
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [ append/2, last/2, list_to_set/2, member/2, memberchk/2, nth0/3,
                nth1/3, subtract/3 ]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(cases, [varied/3]).
:- use_module(gnuplot, [colour/2, plain_text/2, save_columns/2]).
:- use_module(numbers, [spread/4]).
:- use_module(studies, [study_call/2]).

/** <module> Lines of medians against a parameter

A panel for each measure, a line for each value of a parameter.

*Threading*: no state; any thread.
*/

%!  lines_picture(+Study, +Name, +Options, +Runs, +Directory, -Picture) is semidet.
%
%   Write the data files of lines(Options).  Picture is Height-Variables, for
%   lines.gp.  Fails if no run is to be shown.

lines_picture(Study, Name, Options, Runs0, Directory, Height-Variables) :-
    option(where(Where), Options, []),
    matching(Where, Runs0, Runs),
    Runs = [_|_],
    option(x(X), Options),
    option(y(Y), Options),
    ( is_list(Y) -> Measures = Y ; Measures = [Y] ),
    positions(X, Runs, Positions),
    lines(Options, Runs, Lines),
    Shown = shown(Runs, X, Positions),
    save_blocks(Directory, Name, '', Measures, Lines, median_row(Shown)),
    save_blocks(Directory, Name, '-runs', Measures, Lines, run_row(Shown)),
    save_blocks(Directory, Name, '-printed', Measures, Lines,
                printed_row(Study, Shown)),
    length(Measures, Count),
    Height is 130 + 330*Count,         % the label below, in SVG, is large
    findall(Variable,
            variable(Study, Options, Shown, Measures, Lines, Variable),
            Variables0),
    Variables = ['HEIGHT'-Height|Variables0].

%!  matching(+Where, +Runs, -Matching) is det.
%
%   Runs of cases in which it is as Where says: Name=Value, Name=in(Values).

matching(Where, Runs0, Runs) :-
    findall(run(Case, Seed, Ms),
            ( member(run(Case, Seed, Ms), Runs0),
              forall(member(Condition, Where), meets(Condition, Case)) ),
            Runs).

meets(Name=in(Values), Case) :-
    !,
    get_dict(Name, Case, Value),
    memberchk(Value, Values).
meets(Name=Value, Case) :-
    get_dict(Name, Case, Value).

%   positions(+X, +Runs, -Positions): pairs At-Value: numbers are drawn where
%   they are, others side by side.

positions(X, Runs, Positions) :-
    values(X, Runs, Values),
    (   member(Value, Values),
        \+ number(Value)
    ->  findall(At-V, nth1(At, Values, V), Positions)
    ;   findall(V-V, member(V, Values), Positions0),
        keysort(Positions0, Positions)
    ).

values(Name, Runs, Values) :-
    findall(Value, ( member(run(Case, _, _), Runs),
                     get_dict(Name, Case, Value) ),
            All),
    list_to_set(All, Values).

%   lines(+Options, +Runs, -Lines): line(Value, Where).

lines(Options, Runs, Lines) :-
    (   option(line(P), Options)
    ->  values(P, Runs, Values),
        findall(line(Value, [P=Value]), member(Value, Values), Lines)
    ;   Lines = [line('', [])]
    ).

                /*******************************
                *             DATA             *
                *******************************/

%   A block for each line of each measure.  gnuplot does not count empty
%   ones.

:- meta_predicate save_blocks(+, +, +, +, +, 3).

save_blocks(Directory, Name, Suffix, Measures, Lines, Row) :-
    findall(Block,
            ( member(Measure, Measures),
              member(line(_, Where), Lines),
              findall(R, call(Row, Measure, Where, R), Block0),
              block(Block0, Block) ),
            Blocks),
    append(Blocks, Rows),
    atomic_list_concat([Name, Suffix, '.dat'], File),
    directory_file_path(Directory, File, Path),
    save_columns(Path, Rows).

block([], [['NaN', 'NaN', 'NaN', 'NaN'], gap, gap]) :- !.
block(Rows0, Rows) :- append([Rows0, [gap, gap]], Rows).

median_row(shown(Runs, X, Positions), Measure, Where,
           [At, Median, Least, Most]) :-
    member(At-Value, Positions),
    findall(Number, value_at(Runs, [X=Value|Where], Measure, Number), Numbers),
    spread(Numbers, Least, Median, Most).

run_row(shown(Runs, X, Positions), Measure, Where, [At, Number]) :-
    member(At-Value, Positions),
    value_at(Runs, [X=Value|Where], Measure, Number).

value_at(Runs, Where, Measure, Number) :-
    member(run(Case, _, Measures), Runs),
    forall(member(Condition, Where), meets(Condition, Case)),
    get_dict(Measure, Measures, Number),
    number(Number).

%   What the thesis prints for a case that is drawn.

printed_row(Study, shown(Runs, X, Positions), Measure, Where, [At, Number]) :-
    study_call(Study, printed(Measure, Said, Number)),
    number(Number),
    member(At-Value, Positions),
    append([Where, Said, [X=Value]], All),
    once(( member(run(Case, _, _), Runs),
           forall(member(Condition, All), meets(Condition, Case)) )).

                /*******************************
                *           VARIABLES          *
                *******************************/

%   variable(+Study, +Options, +Shown, +Measures, +Lines, -Variable) is multi.

variable(Study, Options, shown(Runs, X, _), _, _, 'SUBTITLE'-Subtitle) :-
    subtitle(Study, Options, Runs, X, Text),
    plain_text(Text, Subtitle).
variable(Study, Options, shown(_, X, _), _, _, 'XLABEL'-Label) :-
    label(Study, X, Label0),
    option(xlabel(Label), Options, Label0).
variable(Study, _, shown(_, _, Positions), _, _, 'XTICS'-Tics) :-
    findall(Tick, ( member(At-Value, Positions),
                    label(Study, Value, Label),
                    tick(Label, At, Tick) ),
            Ticks),
    atomic_list_concat(Ticks, ',', Tics).
variable(_, _, shown(_, _, Positions), _, _, Variable) :-
    pairs_keys(Positions, Ats),
    Ats = [First|_],
    last(Ats, Last),
    Margin is max(0.05*(Last - First), 0.01),
    (   Left is First - Margin,
        Variable = 'LEFT'-Left
    ;   Right is Last + Margin,
        Variable = 'RIGHT'-Right
    ).
variable(_, _, _, Measures, _, panels-Count) :-
    length(Measures, Count).
variable(_, _, _, _, Lines, series-Count) :-
    length(Lines, Count).
variable(Study, _, Shown, Measures, Lines, 'PRINTED'-Printed) :-
    (   member(Measure, Measures),
        member(line(_, Where), Lines),
        printed_row(Study, Shown, Measure, Where, _)
    ->  Printed = 1
    ;   Printed = 0
    ).
variable(Study, _, _, Measures, _, 'Panel'-Titles) :-
    maplist(label(Study), Measures, Titles).
variable(_, Options, _, Measures, _, 'Log'-Logs) :-
    maplist(is_log(Options), Measures, Logs).
variable(_, Options, _, Measures, _, 'Rules'-Rules) :-
    maplist(rules(Options), Measures, Rules).
variable(Study, _, _, _, Lines, 'Series'-Labels) :-
    findall(Label, ( member(line(Value, _), Lines),
                     label(Study, Value, Label) ), Labels).
variable(_, _, _, _, Lines, 'Colour'-Colours) :-
    findall(Colour, ( nth0(I, Lines, _), N is I mod 6, colour(N, Colour) ),
            Colours).

tick(Label, At, Tick) :-
    atomic_list_concat(Parts, '\'', Label),
    atomic_list_concat(Parts, '\'\'', Quoted),
    format(atom(Tick), '\'~w\' ~w', [Quoted, At]).

%   It says what is put together, too.

subtitle(Study, Options, Runs, X, Subtitle) :-
    findall(Seed, member(run(_, Seed, _), Runs), Seeds0),
    sort(Seeds0, Seeds),
    length(Seeds, Count),
    ( Count =:= 1 -> Word = run ; Word = runs ),
    format(atom(Counted), '~d ~w of each: medians, least and greatest',
           [Count, Word]),
    findall(Text, option(subtitle(Text), Options), Said),
    together(Study, Options, Runs, X, Together),
    append([Said, [Counted], Together], Parts),
    atomic_list_concat(Parts, '; ', Subtitle).

together(Study, Options, Runs, X, Together) :-
    findall(Case, member(run(Case, _, _), Runs), Cases),
    varied(Study, Cases, Names),
    findall(P, option(line(P), Options), Line),
    subtract(Names, [X|Line], Others),
    findall(Text, ( member(Name, Others), values(Name, Runs, [_, _|_]),
                    format(atom(Text), 'over all ~w', [Name]) ),
            Together).

label(Study, Name, Label) :-
    (   study_call(Study, label(Name, Label0))
    ->  Label = Label0
    ;   format(atom(Text), '~w', [Name]),
        atomic_list_concat(Words, '_', Text),
        atomic_list_concat(Words, ' ', Label)
    ).

is_log(Options, Measure, Log) :-
    (   memberchk(log(Measure), Options)
    ->  Log = 1
    ;   Log = 0
    ).

rules(Options, Measure, Rules) :-
    findall(Rule, member(rule(Measure, Rule), Options), All),
    atomic_list_concat(All, ' ', Rules).
