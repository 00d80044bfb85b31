:- module(study_lines,
          [ lines_picture/6,            % +Study, +NameTitle, +Options, +Runs,
                                        % +Directory, -Picture
            matching/3                  % +Where, +Runs, -Matching
          ]).
:- use_module(library(apply), [exclude/3, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [ append/2, append/3, last/2, list_to_set/2, max_list/2, member/2,
                memberchk/2, min_list/2, nth0/3, nth1/3,
                selectchk/3, subtract/3 ]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(pairs), [group_pairs_by_key/2, pairs_keys/2]).
:- use_module(cases, [parameters/3, varied/3]).
:- use_module(gnuplot, [colour/2, plain_text/2, save_columns/2]).
:- use_module(numbers, [spread/4]).
:- use_module(studies, [study_call/2]).

/** <module> Lines of medians against a parameter

A panel for each measure, a line for each value of a parameter.

*Threading*: no state; any thread.
*/

%!  lines_picture(+Study, +Titled, +Options, +Runs, +Dir, -Picture) is semidet.
%
%   Titled is Name-Title.  Writes the data files of lines(Options).  Picture is Height-Variables, for
%   lines.gp.  Fails if Options select no run.

lines_picture(Study, Name-Title, Options, Runs0, Directory, Height-Variables) :-
    option(where(Where), Options, []),
    matching(Where, Runs0, Runs),
    once(( member(run(_, _, Ms), Runs), Ms \== measures{} )),
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
    findall(Variable,
            variable(Study, Options, Shown, Measures, Lines, Variable),
            Variables0),
    heights(Title, Count, Variables0, Height, Variables).

%   heights(+Title, +Panels, +Variables0, -Height, -Variables): the space above
%   the panels depends on the lines of title, subtitle and key, the space below
%   each panel on rotated labels.

heights(Title, Panels, Variables0, Height, Variables) :-
    memberchk('SUBTITLE'-Subtitle0, Variables0),
    memberchk('Series'-Labels, Variables0),
    memberchk('ROTATED'-Rotated, Variables0),
    memberchk('PRINTED'-Printed, Variables0),
    folded(Title, 75, '}\n{/:Bold=15 ', TitleText, TitleLines),
    folded(Subtitle0, 110, '}\n{/*0.9 ', Subtitle, SubtitleLines),
    ( Printed =:= 1 -> Keys = [printed|Labels] ; Keys = Labels ),
    key_rows(Keys, Rows),
    Subline is 54.0 + 22*(TitleLines - 1),
    Head is 90.0 + 22*(TitleLines - 1) + 20*(SubtitleLines - 1)
            + 19*(Rows - 1),
    Foot is 45.0 + 3.5*max(0, Rotated - 4),
    Height is round(Head + 40 + (285 + Foot)*Panels),
    selectchk('SUBTITLE'-Subtitle0, Variables0, Variables1),
    selectchk('ROTATED'-Rotated, Variables1, Variables2),
    left_margin(Rotated, Variables2, Variables3),
    Variables = [ 'TITLE'-TitleText, 'SUBTITLE'-Subtitle, 'HEIGHT'-Height,
                  'HEAD'-Head, 'FOOT'-Foot, 'SUBLINE'-Subline,
                  'KEYROWS'-Rows, 'ROTATED'-Rotated
                | Variables3 ].

%   Rotated labels end at their tick, so they need space on the left.

left_margin(0, Variables, Variables) :-
    !.
left_margin(_, Variables0, ['LEFT'-Left|Variables]) :-
    selectchk('LEFT'-Left0, Variables0, Variables),
    memberchk('RIGHT'-Right, Variables),
    Left is Left0 - 0.1*(Right - Left0).

%   folded(+Text, +Width, +Between, -Folded, -Count): Folded has Count lines of
%   about Width characters, separated by Between.

folded(Text, Width, Between, Folded, Count) :-
    atomic_list_concat(Words, ' ', Text),
    fold(Words, Width, 0, '', Broken),
    atomic_list_concat(Lines, '\n', Broken),
    length(Lines, Count),
    atomic_list_concat(Lines, Between, Folded).

fold([], _, _, Text, Text).
fold([Word|Words], Width, Used, Text0, Text) :-
    atom_length(Word, Length),
    Next is Used + Length + 1,
    (   Used =:= 0
    ->  atom_concat(Text0, Word, Text1),
        Now = Next
    ;   Next > Width
    ->  atomic_list_concat([Text0, '\n', Word], Text1),
        Now is Length + 1
    ;   atomic_list_concat([Text0, ' ', Word], Text1),
        Now = Next
    ),
    fold(Words, Width, Now, Text1, Text).

%   gnuplot makes columns as wide as the longest label.

key_rows(Labels, Rows) :-
    findall(Length, ( member(Label, Labels), atom_length(Label, Length) ),
            Lengths),
    max_list(Lengths, Longest),
    length(Labels, Count),
    Columns is max(1, 100 // (Longest + 8)),
    Rows is (Count + Columns - 1) // Columns.

%!  matching(+Where, +Runs, -Matching) is det.
%
%   Matching are the runs whose cases satisfy Where: Name=Value,
%   Name=in(Values).

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

%   positions(+X, +Runs, -Positions): pairs At-Value: numbers have their own
%   positions, other values are side by side.

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

%   Writes a block for each line of each measure.  gnuplot does not count empty
%   blocks.

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

median_row(shown(Runs, X, Positions), Measure, Where, Row) :-
    member(At-Value, Positions),
    matching([X=Value|Where], Runs, [First|Matching]),
    findall(Number, value_at([First|Matching], [], Measure, Number), Numbers),
    (   spread(Numbers, Least, Median, Most)
    ->  Row = [At, Median, Least, Most]
    ;   Row = [At, 'NaN', 'NaN', 'NaN']         % not joined across it
    ).

run_row(shown(Runs, X, Positions), Measure, Where, [At, Number]) :-
    member(At-Value, Positions),
    value_at(Runs, [X=Value|Where], Measure, Number).

value_at(Runs, Where, Measure, Number) :-
    member(run(Case, _, Measures), Runs),
    forall(member(Condition, Where), meets(Condition, Case)),
    get_dict(Measure, Measures, Number),
    number(Number).

%   The printed value of the thesis for a case in the plot.

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
variable(Study, _, shown(_, _, Positions0), _, _, 'XTICS'-Tics) :-
    ticked(Positions0, Positions),
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
variable(_, Options, _, _, _, 'BAND'-Band) :-
    (   option(band(true), Options)
    ->  Band = 1
    ;   Band = 0
    ).
variable(Study, _, shown(_, X, Positions), _, _, 'JOINED'-Joined) :-
    parameters(Study, [], Parameters),
    (   ( memberchk(parameter(X, _, sampled), Parameters)
        ; Positions = [_-Value|_], \+ number(Value)    % names
        )
    ->  Joined = 0
    ;   Joined = 1
    ).
variable(Study, _, shown(_, _, Positions0), _, _, 'ROTATED'-Rotated) :-
    ticked(Positions0, Positions),
    findall(Length, ( member(_-Value, Positions),
                      label(Study, Value, Label),
                      atom_length(Label, Length) ),
            Lengths),
    length(Lengths, Count),
    max_list(Lengths, Longest),
    last(Lengths, LastLength),
    (   ( Count*(Longest + 2) > 95      % characters in a line
        ; LastLength > 13               % which are in the middle of the tick
        )
    ->  Rotated = Longest
    ;   Rotated = 0
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

%   ticked(+Positions, -Ticked): of many numbers only some have a tick: numbers
%   at a distance of 1, 2 or 5 times a power of ten, if there are any, else
%   numbers at equal distances.

ticked(Positions, Ticked) :-
    length(Positions, Count),
    Count =< 12,
    far_apart(Positions),
    !,
    Ticked = Positions.
ticked(Positions, Ticked) :-
    Positions = [First-Value|_],
    number(Value),
    First =:= Value,
    !,
    last(Positions, Last-_),
    round_step((Last - First)/8, Step),
    Low is ceiling(First/Step - 1.0e-9),
    High is floor(Last/Step + 1.0e-9),
    findall(At-At, ( between(Low, High, I), tick_at(I, Step, At) ), Ticked).
ticked(Positions, Positions).

%   Numbers have fixed positions: their labels must not overlap.

far_apart(Positions) :-
    Positions = [First-_|_],
    last(Positions, Last-_),
    Least is (Last - First)/25,
    \+ ( append(_, [A-_, B-_|_], Positions),
         B - A < Least ).

round_step(Least0, Step) :-
    Least is max(Least0, 1.0e-12),
    Power is 10.0**floor(log10(Least)),
    member(Factor, [1, 2, 5, 10]),
    Step is Factor*Power,
    Step >= Least*0.999,
    !.

tick_at(I, Step, At) :-
    At0 is I*Step,
    (   At0 =:= round(At0)
    ->  At is round(At0)
    ;   format(atom(Text), '~4g', [At0]),
        atom_number(Text, At)
    ).

tick(Label, At, Tick) :-
    atomic_list_concat(Parts, '\'', Label),
    atomic_list_concat(Parts, '\'\'', Quoted),
    format(atom(Tick), '\'~w\' ~w', [Quoted, At]).

%   Subtitle also names the parameters over which the plot aggregates.

subtitle(Study, Options, Runs, X, Subtitle) :-
    run_counts(Runs, Least, Most),
    ( Least =:= Most -> From = '' ; format(atom(From), '~d to ', [Least]) ),
    ( Most =:= 1 -> Word = run ; Word = runs ),
    format(atom(Counted), '~w~d ~w of each: medians, least and greatest',
           [From, Most, Word]),
    findall(Text, option(subtitle(Text), Options), Said),
    together(Study, Options, Runs, X, Together),
    append([Said, [Counted], Together], Parts),
    atomic_list_concat(Parts, '; ', Subtitle).

%   Least and Most are the numbers of runs of a case, whose steps are cases.

run_counts(Runs, Least, Most) :-
    findall(Case-N, ( member(run(Case0, Seed, Ms), Runs),
                      ( del_dict(time, Case0, _, Case) -> true ; Case = Case0 ),
                      ( Ms == measures{} -> N = none ; N = Seed ) ),
            All),
    sort(All, Made),
    group_pairs_by_key(Made, Groups),
    findall(Count, ( member(_-Seeds0, Groups), exclude(==(none), Seeds0, Seeds),
                     length(Seeds, Count) ),
            Counts),
    min_list(Counts, Least),
    max_list(Counts, Most).

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
