:- module(study_picture,
          [ picture/4                   % +Study, +Plot, +Runs, +Directory
          ]).
:- use_module(library(filesex), [copy_file/2, directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(gnuplot,
              [plain_text/2, plot/3, save_columns/2, save_variables/2]).
:- use_module(lines, [lines_picture/6, matching/3]).
:- use_module(series, [runs_over_time/3]).
:- use_module(studies, [study_call/2]).

/** <module> Plots

A picture is

  - lines(Options): medians over the runs against a parameter, bars from
    the least to the greatest run, a dot for each run.  Options are x(P),
    y(Measures), line(P): a line for each value, default none;
    where(Conditions): Name=Value or Name=in(Values); log(Measure),
    rule(Measure, Number), subtitle(Text), xlabel(Text).
  - over_time(Options): medians of series (see series.pl) against time, and a
    band from the least to the greatest run.  Options are as of lines, without
    x(P).
  - script(File, Tables, Options): gnuplot runs File, in the folder of the
    study.  Tables are NAME-Goal: call(Goal, Runs, Rows) in the study, for the
    data file NAME.dat; options size(W,H), seed(first): only the runs of the
    first seed, and variables(Goal): call(Goal, Runs, Pairs) of gnuplot
    variables Name-Value.
  - file(File, Where): an SVG file that a run has written to its directory: of
    the first run of the case in which Where, a list of Name=Value, holds.

Runs are run(Case, Seed, Measures).

*Threading*: no state; any thread.
*/

:- multifile
    prolog:message//1.

%!  picture(+Study, +Plot, +Runs, +Directory) is det.
%
%   Plot is plot(Name, Title, Picture).  Writes Name.svg and Name.png in
%   Directory, and their data. A picture that cannot be drawn is reported, and
%   does not affect the others.

picture(Study, plot(Name, Title, Picture), Runs, Directory) :-
    (   catch(drawn(Picture, Study, Name, Title, Runs, Directory),
              error(Formal, Context),
              ( print_message(warning,
                              study_picture(Name, error(Formal, Context))) ))
    ->  true
    ;   print_message(warning, study_picture(Name, no_data))
    ).

drawn(lines(Options), Study, Name, Title, Runs, Directory) :-
    plain_text(Title, Plain),
    lines_picture(Study, Name-Plain, Options, Runs, Directory,
                  Height-Variables),
    module_property(study_picture, file(Here)),
    file_beside(Here, 'lines.gp', Script),
    draw(Directory, Name, 1000-Height, Script, Variables).
drawn(over_time(Options), Study, Name, Title, Runs0, Directory) :-
    option(y(Y), Options),
    ( is_list(Y) -> Measures = Y ; Measures = [Y] ),
    option(where(Where), Options, []),
    matching(Where, Runs0, Runs),
    runs_over_time(Runs, Measures, Steps),
    append(Options, [x(time), xlabel('host seconds'), band(true)], All),
    drawn(lines(All), Study, Name, Title, Steps, Directory).
drawn(script(File, Tables, Options), Study, Name, Title, Runs0, Directory) :-
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
    file_beside(Study, File, Script),
    plain_text(Title, Plain),
    draw(Directory, Name, W-H, Script, ['TITLE'-Plain, 'HEIGHT'-H|More]).
drawn(file(File, Where), _, Name, _, Runs0, Directory) :-
    matching(Where, Runs0, Runs),
    of_seed([seed(first)], Runs, [run(_, _, Measures)|_]),
    directory_file_path(Measures.directory, File, Drawn),
    file_name_extension(Name, svg, Copy),
    directory_file_path(Directory, Copy, Path),
    copy_file(Drawn, Path).

of_seed(Options, Runs0, Runs) :-
    option(seed(first), Options),
    !,
    findall(Seed, member(run(_, Seed, _), Runs0), Seeds),
    sort(Seeds, [First|_]),
    findall(run(Case, First, Ms), member(run(Case, First, Ms), Runs0), Runs).
of_seed(_, Runs, Runs).

file_beside(File, Name, Path) :-
    file_directory_name(File, Directory),
    directory_file_path(Directory, Name, Path).

%   The script is copied to the pictures, so that a figure can be changed
%   without the runs.

draw(Directory, Name, Size, Script, Variables) :-
    file_base_name(Script, Base),
    directory_file_path(Directory, Base, Copy),
    copy_file(Script, Copy),
    file_name_extension(Name, gnuplot, Own),
    directory_file_path(Directory, Own, Path),
    append(['NAME'-Name|Variables], [load-Base], All),
    save_variables(Path, All),
    plot(Directory, Name, Size).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(study_picture(Name, no_data)) -->
    [ 'Picture ~w is not drawn: there are no data'-[Name] ].
prolog:message(study_picture(Name, error(Formal, Context))) -->
    [ 'Picture ~w is not drawn: '-[Name] ],
    '$messages':translate_message(error(Formal, Context)).
