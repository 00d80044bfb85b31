:- module(study_picture,
          [ picture/4                   % +Study, +Plot, +Runs, +Directory
          ]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(filesex), [copy_file/2, directory_file_path/3]).
:- use_module(library(lists),
              [ append/2, append/3, last/2, member/2, memberchk/2, nth0/3,
                nth1/3 ]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(gnuplot, [colour/2, plot/3, save_columns/2, save_variables/2]).
:- use_module(numbers, [spread/4]).
:- use_module(studies, [study_call/2]).

/** <module> What is drawn

A picture is

  - lines(Options): medians over the runs against a parameter, bars from
    the least to the greatest run, a dot for each run.  Options are x(P),
    y(Measures), line(P): a line for each value, default none;
    where(Conditions): Name=Value or Name=in(Values); log(Measure),
    rule(Measure, Number), subtitle(Text), xlabel(Text).
  - script(File, Tables, Options): what gnuplot does with File, beside the
    study.  Tables are NAME-Goal: call(Goal, Runs, Rows) in the study, for
    the data file NAME.dat; options size(W,H), seed(first): only the runs
    of the first seed, and variables(Goal): call(Goal, Runs, Pairs) of
    gnuplot variables Name-Value.

Runs are run(Case, Seed, Measures).

*Threading*: no state; any thread.
*/

%!  picture(+Study, +Plot, +Runs, +Directory) is det.
%
%   Plot is plot(Name, Title, Picture).  Writes Name.svg and Name.png in
%   Directory, and what they were drawn from.

picture(Study, plot(Name, Title, lines(Options)), Runs0, Directory) :-
    !,
    option(where(Where), Options, []),
    matching(Where, Runs0, Runs),
    option(x(X), Options),
    option(y(Measures), Options),
    positions(X, Runs, Positions, Ticks),
    lines(Options, Runs, Lines),
    save_blocks(Directory, Name, '', Measures, Lines,
                median_rows(Runs, X, Positions)),
    save_blocks(Directory, Name, '-runs', Measures, Lines,
                run_rows(Runs, X, Positions)),
    save_blocks(Directory, Name, '-printed', Measures, Lines,
                printed_rows(Study, Runs, X, Positions)),
    length(Measures, Count),
    Height is 110 + 330*Count,
    variables(Study, Name, Title, Options, Positions, Ticks, Measures, Lines,
              Runs, Height, Variables),
    engine_script('lines.gp', Script),
    draw(Directory, Name, 1000-Height, Script, Variables).
picture(Study, plot(Name, Title, script(File, Tables, Options)), Runs0,
        Directory) :-
    of_seed(Options, Runs0, Runs),
    forall(member(Table-Goal, Tables),
           ( study_call(Study, call(Goal, Runs, Rows)),
             file_name_extension(Table, dat, Data),
             directory_file_path(Directory, Data, Path),
             save_columns(Path, Rows) )),
    (   option(variables(Goal), Options)
    ->  study_call(Study, call(Goal, Runs, More))
    ;   More = []
    ),
    append(Options, [size(1200, 1000)], Sizes),
    memberchk(size(W, H), Sizes),
    file_directory_name(Study, Beside),
    directory_file_path(Beside, File, Script),
    draw(Directory, Name, W-H, Script,
         ['NAME'-Name, 'TITLE'-Title, 'HEIGHT'-H|More]).

of_seed(Options, Runs0, Runs) :-
    option(seed(first), Options),
    !,
    findall(Seed, member(run(_, Seed, _), Runs0), Seeds),
    sort(Seeds, [First|_]),
    findall(run(Case, First, Ms), member(run(Case, First, Ms), Runs0), Runs).
of_seed(_, Runs, Runs).

%   The script stays beside the pictures, so that a figure can be changed
%   without the runs.

draw(Directory, Name, Size, Script, Variables) :-
    file_name_extension(Name, gnuplot, Own),
    directory_file_path(Directory, Own, Path),
    file_base_name(Script, Base),
    directory_file_path(Directory, Base, Copy),
    copy_file(Script, Copy),
    append(Variables, [load-Base], All),
    save_variables(Path, All),
    plot(Directory, Name, Size).

engine_script(File, Script) :-
    module_property(study_picture, file(Here)),
    file_directory_name(Here, Engine),
    directory_file_path(Engine, File, Script).

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

%   positions(+X, +Runs, -Positions, -Ticks): where values of X are drawn:
%   numbers there, others side by side.

positions(X, Runs, Positions, Ticks) :-
    findall(Value, ( member(run(Case, _, _), Runs), get_dict(X, Case, Value) ),
            Values0),
    distinct(Values0, Values),
    findall(Value-At,
            ( nth1(I, Values, Value),
              ( number(Value) -> At = Value ; At = I ) ),
            Positions),
    findall(Tick,
            ( member(Value-At, Positions),
              format(atom(Tick), '"~w" ~w', [Value, At]) ),
            Ticks).

distinct(Values0, Values) :-
    foldl([V, Seen0, Seen]>>( memberchk(V, Seen0)
                            -> Seen = Seen0
                            ;  append(Seen0, [V], Seen) ),
          Values0, [], Values).

lines(Options, Runs, Lines) :-
    option(line(P), Options),
    !,
    findall(Value, ( member(run(Case, _, _), Runs), get_dict(P, Case, Value) ),
            Values0),
    distinct(Values0, Values),
    findall(line(Value, [P=Value]), member(Value, Values), Lines).
lines(_, _, [line('', [])]).

                /*******************************
                *             DATA             *
                *******************************/

%   A block for each line of each measure.  gnuplot does not count empty
%   ones.

:- meta_predicate save_blocks(+, +, +, +, +, 3).

save_blocks(Directory, Name, Suffix, Measures, Lines, Rows) :-
    findall([Block, [gap, gap]],
            ( member(Measure, Measures),
              member(line(_, Where), Lines),
              findall(Row, call(Rows, Measure, Where, Row), Block0),
              ( Block0 == [] -> Block = [['NaN', 'NaN', 'NaN', 'NaN']]
              ; Block = Block0 ) ),
            Blocks0),
    append(Blocks0, Blocks1),
    append(Blocks1, Blocks),
    atomic_list_concat([Name, Suffix, '.dat'], File),
    directory_file_path(Directory, File, Path),
    save_columns(Path, Blocks).

median_rows(Runs, X, Positions, Measure, Where, [At, Median, Least, Most]) :-
    member(Value-At, Positions),
    findall(Number, value_at(Runs, [X=Value|Where], Measure, Number), Numbers),
    spread(Numbers, Least, Median, Most).

run_rows(Runs, X, Positions, Measure, Where, [At, Number]) :-
    member(Value-At, Positions),
    value_at(Runs, [X=Value|Where], Measure, Number).

value_at(Runs, Where, Measure, Number) :-
    member(run(Case, _, Measures), Runs),
    forall(member(Condition, Where), meets(Condition, Case)),
    get_dict(Measure, Measures, Number),
    number(Number).

%   What the thesis prints for a case that is drawn.

printed_rows(Study, Runs, X, Positions, Measure, Where, [At, Number]) :-
    study_call(Study, printed(Measure, Said, Number)),
    number(Number),
    member(Value-At, Positions),
    once(( member(run(Case, _, _), Runs),
           forall(member(Condition, [X=Value|Where]), meets(Condition, Case)),
           forall(member(Condition, Said), meets(Condition, Case)) )).

                /*******************************
                *           VARIABLES          *
                *******************************/

variables(Study, Name, Title, Options, Positions, Ticks, Measures, Lines,
          Runs, Height,
          [ 'NAME'-Name, 'TITLE'-Title, 'SUBTITLE'-Subtitle,
            'XLABEL'-XLabel, 'XTICS'-XTics, 'LEFT'-Left, 'RIGHT'-Right,
            'HEIGHT'-Height, panels-Panels, series-Series,
            'PRINTED'-Printed, 'Panel'-Titles, 'Log'-Logs, 'Rules'-Rules,
            'Series'-Labels, 'Colour'-Colours
          ]) :-
    option(x(X), Options),
    subtitle(Options, Runs, Subtitle),
    label(Study, X, XLabel0),
    option(xlabel(XLabel), Options, XLabel0),
    atomic_list_concat(Ticks, ',', XTics),
    findall(At, member(_-At, Positions), Ats0),
    sort(0, @<, Ats0, Ats),
    Ats = [First|_],
    last(Ats, Last),
    Margin is max(0.05*(Last - First), 0.01),
    Left is First - Margin,
    Right is Last + Margin,
    length(Measures, Panels),
    length(Lines, Series),
    maplist(label(Study), Measures, Titles),
    maplist(is_log(Options), Measures, Logs),
    maplist(rules(Options), Measures, Rules),
    findall(Label, ( member(line(Value, _), Lines),
                     label(Study, Value, Label) ), Labels),
    findall(Colour, ( nth0(I, Lines, _), N is I mod 6, colour(N, Colour) ),
            Colours),
    (   study_call(Study, printed(Measure, _, _)),
        memberchk(Measure, Measures)
    ->  Printed = 1
    ;   Printed = 0
    ).

subtitle(Options, Runs, Subtitle) :-
    findall(Seed, member(run(_, Seed, _), Runs), Seeds0),
    sort(Seeds0, Seeds),
    length(Seeds, Count),
    ( Count =:= 1 -> Word = run ; Word = runs ),
    option(subtitle(Text), Options, ''),
    ( Text == '' -> Separator = '' ; Separator = '; ' ),
    format(atom(Subtitle), '~w~w~d ~w of each: medians, least and greatest',
           [Text, Separator, Count, Word]).

label(Study, Name, Label) :-
    (   study_call(Study, label(Name, Label0))
    ->  Label = Label0
    ;   format(atom(Text), '~w', [Name]),
        atomic_list_concat(Words, '_', Text),      % gnuplot's for below
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
