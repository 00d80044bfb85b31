:- module(test_study_pictures, []).

% Pictures, their data, and the page that shows them.

:- use_module('../../lib/common').
:- use_module('../../lib/study_files',
              [save_lines/3, study_messages/2, with_study_file/4]).
:- use_module('../../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../../experiments/engine/gnuplot',
              [lighten/2, plain_text/2]).
:- use_module('../../../experiments/engine/lines', [lines_picture/6]).
:- use_module('../../../experiments/engine/outcome', [outcome/4]).
:- use_module('../../../experiments/engine/overview').
:- use_module('../../../experiments/engine/page').
:- use_module('../../lib/project_studies', [project_study/2]).
:- use_module(library(http/html_write), [print_html/1]).
:- use_module('../../../experiments/engine/picture').
:- use_module('../../../experiments/engine/tables', [outcome_save/4]).
:- use_module('../../../experiments/engine/studies',
              [study_call/2, study_load/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [max_list/2, member/2, memberchk/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(sgml), [load_html/3]).
:- use_module(library(uri), [uri_encoded/3]).
:- use_module(library(xpath)).

study([ 'study(\'toy 1\', "A <toy>").',
        'text("What it is & does.").',
        'vary(n, [1, 10, 2]).',
        'vary(kind, [new_one, old]).',
        'fixed(c, [1,2], assumed("<so>")).',
        'measure(m, Log, M) :- M = Log.case.n.',
        'measure(w, Log, M) :- M = Log.case.kind.',
        'label(m, "What <is> measured").',
        'label(old, "Old ones").',
        'printed(m, [n=10, kind=old], 12).',
        'claim("m < 3 & more", [line(7), why("so")], m < 3).',
        'claim("never", [ours, formula], w > 3).',
        'plot(one, "One \\"picture\\"",',
        '     lines([ x(n), y([m]), line(kind), log(m), rule(m, 5),',
        '             subtitle("of_toys") ])).',
        'plot(two, "Two", lines([x(kind), y(m), where([n=in([1, 2])])])).',
        'plot(three, "Three", script(\'own.gp\', [own-rows],',
        '     [seed(first), size(300, 200), variables(given)])).',
        'plot(four, "Four", file(\'drawn.svg\', [n=2, kind=old])).',
        'plot(none, "None", lines([x(n), y([m]), where([n=3])])).',
        'plot(wrong, "Wrong", script(\'own.gp\', [own-missing], [])).',
        'rows(Runs, [["a b", 1.5], [x, Count], gap, [\'c d\', 3]]) :-',
        '    length(Runs, Count).',
        'given(_, [\'X\'-1, \'Names\'-["a", \'b"c\']]).' ]).

%   pictures(+Dir, +File, -Out, -Messages)

pictures(Dir, File, Out, Text) :-
    save_lines(Dir, 'own.gp', ["plot 'own.dat' using 2"]),
    directory_file_path(Dir, 'drawn.svg', Drawn),
    save_lines(Dir, 'drawn.svg', ["<svg/>"]),
    assertion(exists_file(Drawn)),
    directory_file_path(Dir, out, Out),
    make_directory_path(Out),
    study_load(File, Study),
    runs(Study, Dir, _, Runs),
    study_messages(forall(study_call(Study, plot(Name, Title, Picture)),
                          picture(Study, plot(Name, Title, Picture), Runs,
                                  Out)),
                   Text).

%   m is 10*n + seed, and 100 more with old ones.

runs(Study, Dir, Cases, Runs) :-
    study_cases(Study, [], Cases),
    findall(run(Case, Seed, measures{m:M, directory:Dir}),
            ( member(Seed, [1, 2, 3]), member(Case, Cases),
              ( Case.kind == old -> More = 100 ; More = 0 ),
              M is 10*Case.n + Seed + More ),
            Runs).

:- meta_predicate with_pictures(-, -, 0).

with_pictures(Out, Told, Goal) :-
    study(Lines),
    with_study_file(Lines, Dir, File,
                    ( pictures(Dir, File, Out, Told), Goal )).

text(Out, Name, Text) :-
    directory_file_path(Out, Name, File),
    read_file_to_string(File, Text, [encoding(utf8)]).

has(Name, Parts, Out) :-
    text(Out, Name, Text),
    forall(member(Part, Parts),
           assertion(once(sub_string(Text, _, _, _, Part)))).

is_drawn(Name, Out) :-
    forall(member(Extension, [svg, png]),
           ( file_name_extension(Name, Extension, Base),
             directory_file_path(Out, Base, File),
             wait_until(( exists_file(File), size_file(File, Size),
                          Size > 0 ), 30) )).

%   The texts are inside the picture: the positions of texts and marks, from the
%   top, are above its height.

inside(Name, Out) :-
    is_drawn(two, Out),
    text(Out, Name, Text),
    findall(Y, ( between_texts(Text, "translate(", ")", XY),
                 split_string(XY, ",", "", [_, Y0]),
                 number_string(Y, Y0) ), Ys),
    once(between_texts(Text, "height=\"", "\"", Height0)),
    number_string(Height, Height0),
    max_list(Ys, Lowest),
    assertion(Lowest < Height - 5).     % descenders

between_texts(Text, Before, After, Between) :-
    sub_string(Text, _, _, Rest0, Before),
    sub_string(Text, _, Rest0, 0, Rest),
    once(sub_string(Rest, Length, _, _, After)),
    sub_string(Rest, 0, Length, _, Between).

gnuplot :-
    absolute_file_name(path(gnuplot), _, [access(execute), file_errors(fail)]).

%   file(Name, File, Text): what the pictures of the study write; part(Name,
%   File, Parts): parts of it.

file(medians, 'one.dat', "1 12 11 13\n2 22 21 23\n10 102 101 103\n\n\n\c
1 112 111 113\n2 122 121 123\n10 202 201 203\n\n\n").
file(printed, 'one-printed.dat', "NaN NaN NaN NaN\n\n\n10 12\n\n\n").
file(texts_are_placed_side_by_side, 'two.dat',
     "1 17 11 23\n2 117 111 123\n\n\n").
file(own_script, 'own.dat', "\"a b\" 1.5\nx 6\n\n\"c d\" 3\n").
file(pictures_of_a_run_are_copied, 'four.svg', "<svg/>\n").

part(runs, 'one-runs.dat', ["1 11\n1 12\n1 13\n2 21\n"]).
part(variables, 'one.gnuplot',
     [ "TITLE = \"One \\\"picture\\\"\"", "panels = 1", "series = 2",
       "PRINTED = 1", "Log[1] = [1]", "Rules[1] = [\"5\"]",
       "Panel[1] = [\"What <is> measured\"]",
       "Series[2] = [\"new one\", \"Old ones\"]",
       "of\\\\_toys; 3 runs of each: medians, least and greatest\"",
       "load \"lines.gp\"" ]).
part(without_printed_values, 'two.gnuplot', ["PRINTED = 0"]).
part(names_of_values_are_texts, 'two.gnuplot',
     ["XTICS = \"'new one' 1,'Old ones' 2\""]).
part(caption_names_the_aggregation, 'two.gnuplot',
     ["least and greatest; over all n\""]).
part(own_variables, 'three.gnuplot',
     [ "NAME = \"three\"", "HEIGHT = 200", "X = 1",
       "array Names[2] = [\"a\", \"b\\\"c\"]", "load \"own.gp\"" ]).

%   ticks(Name, Values, Ticks): at 1, 2 or 5 times a power of ten.

ticks(few_numbers, [1, 2, 4, 8], "'1' 1,'2' 2,'4' 4,'8' 8").
ticks(twelve_numbers, Values, Ticks) :-
    numlist(1, 12, Values),
    at_steps(1, 12, 1, Ticks).
ticks(thirteen_numbers, Values, Ticks) :-
    numlist(1, 13, Values),
    at_steps(2, 12, 2, Ticks).
ticks(steps_of_five, Values, Ticks) :-
    numlist(1, 20, Values),
    at_steps(5, 20, 5, Ticks).
ticks(a_whole_step, Values, Ticks) :-   % 40/8
    numlist(0, 40, Values),
    at_steps(0, 40, 5, Ticks).
ticks(more_than_a_step, Values, Ticks) :-
    numlist(0, 41, Values),
    at_steps(0, 40, 10, Ticks).
ticks(a_25th_apart, [0, 4, 100], "'0' 0,'4' 4,'100' 100").
ticks(closer_than_that, [0, 3.9, 100], Ticks) :-
    at_steps(0, 100, 20, Ticks).
ticks(fractions, Values, "'0.5' 0.5,'1' 1,'1.5' 1.5,'2' 2") :-
    findall(X, ( between(1, 20, I), X is I/10 ), Values).

at_steps(Low, High, Step, Text) :-
    findall(Tick,
            ( between(Low, High, At), At mod Step =:= 0,
              format(atom(Tick), "'~w' ~w", [At, At]) ), Ticks),
    atomic_list_concat(Ticks, ',', Atom),
    atom_string(Atom, Text).

x_ticks(Values, Ticks) :-
    format(atom(Vary), 'vary(n, ~w).', [Values]),
    with_study_file(['study(toy, "A toy").', Vary, 'measure(m, _, 1).'], Dir,
                    File, x_ticks(File, Dir, Ticks)).

x_ticks(File, Dir, Ticks) :-
    study_load(File, Study),
    study_cases(Study, [], Cases),
    findall(run(Case, 1, measures{m:1}), member(Case, Cases), Runs),
    lines_picture(Study, toy-"Toy", [x(n), y(m)], Runs, Dir, _-Variables),
    memberchk('XTICS'-Atom, Variables),
    atom_string(Atom, Ticks).

:- begin_tests(study_pictures).

test(files_of_pictures, Wrong == []) :-
    with_pictures(Out, _,
        ( findall(Name-Text,
                  ( file(Name, File, Expected), text(Out, File, Text),
                    Text \== Expected ), Wrong),
          forall(part(_, File, Parts), has(File, Parts, Out)) )).

%   The case n=2, kind=new_one has no run, the other new ones have one of three.

test(lines_are_not_joined_across_a_case_without_runs,
     Text == "1 11 11 11\n2 NaN NaN NaN\n10 101 101 101\n\n\n\c
1 112 111 113\n2 122 121 123\n10 202 201 203\n\n\n") :-
    study(Lines),
    with_study_file(Lines, Dir, File,
        ( study_load(File, Study),
          runs(Study, Dir, _, Runs0),
          findall(run(Case, Seed, Ms),
                  ( member(run(Case, Seed, Ms0), Runs0),
                    (   Case.kind == new_one,
                        ( Case.n == 2 ; Seed > 1 )
                    ->  Ms = measures{}
                    ;   Ms = Ms0
                    ) ),
                  Runs),
          once(study_call(Study, plot(one, Title, Picture))),
          picture(Study, plot(one, Title, Picture), Runs, Dir),
          has('one.gnuplot', ["0 to 3 runs of each"], Dir),
          text(Dir, 'one.dat', Text) )).
test(texts_are_drawn_verbatim, Plain == 'a\\_b\\^2\\{\\\\') :-
    plain_text("a_b^2{\\", Plain).
test(ticks_of_many_numbers, [ forall(ticks(_, Values, Ticks)),
                              true(Text == Ticks) ]) :-
    x_ticks(Values, Text).
test(light_colour_is_a_quarter_as_far_from_white, Wrong == []) :-
    findall(Colour,
            ( member(Shift, [0, 8, 16]), between(0, 255, Part),
              Colour is 0xffffff - ((255 - Part) << Shift),
              Light is 0xffffff - ((255 - ceiling((Part + 3*255)/4)) << Shift),
              \+ lighten(Colour, Light) ),
            Wrong).
test(impossible_plot_is_reported) :-
    with_pictures(_, Text, true),
    forall(member(Part, [ "Picture none is not drawn: there are no data",
                          "Picture wrong is not drawn:", "missing/2" ]),
           assertion(once(sub_string(Text, _, _, _, Part)))).
test(drawn, [condition(gnuplot)]) :-
    with_pictures(Out, _,
        ( forall(member(Name, [one, two, three]), is_drawn(Name, Out)),
          inside('two.svg', Out) )).
test(without_gnuplot) :-
    with_study_file(['study(toy, "A toy").'], Dir, File,
                    without_gnuplot(Text, Dir, File)),
    assertion(once(sub_string(Text, _, _, _, "apt-get install gnuplot"))).

:- end_tests(study_pictures).

without_gnuplot(Text, Dir, _) :-
    getenv('PATH', Path),
    setup_call_cleanup(
        setenv('PATH', Dir),
        ( study(Lines),
          with_study_file(Lines, Dir1, File, no_gnuplot(Text, Dir1, File)) ),
        setenv('PATH', Path)).

no_gnuplot(Text, Dir, File) :-
    pictures(Dir, File, Out, Text),
    directory_file_path(Out, 'one.gnuplot', Script),
    assertion(exists_file(Script)).

                /*******************************
                *             PAGE             *
                *******************************/

:- meta_predicate with_page(-, -, 0).

with_page(Dir, DOM, Goal) :-
    study(Lines),
    with_study_file(Lines, Dir, File, ( page(Dir, File, DOM), Goal )).

page(Dir, File, DOM) :-
    study_load(File, Study),
    runs(Study, Dir, Cases, Runs),
    findall(Seed, member(run(_, Seed, _), Runs), Seeds0),
    sort(Seeds0, Seeds),
    outcome(plan(Study, [], Cases), Seeds, Runs, Outcome0),
    Outcome = Outcome0.put(_{given:[c-[5]], 
                         checks:[table([measure, virtual, real, verdict],
                                       [[m, 1, 2, above]])]}),
    atomic_list_concat([Dir, '/toy 1'], Figures),
    make_directory_path(Figures),
    outcome_save(Study, Outcome, Runs, Figures),
    save_lines(Figures, 'one.svg', ["<svg/>"]),
    save_lines(Dir, 'result.pl', ["version(prolog,90004).", "wall(1.5).",
                                  "measure(m,3).", "measure(l,[a])."]),
    page_save(Dir, [shown(Study, Outcome, 'swipl a -- b', Dir)]),
    directory_file_path(Dir, 'index.html', Index),
    study_messages(load_html(Index, DOM, [dialect(html5)]), Complaints),
    assertion(Complaints == "").

links_inside(Missing, _, DOM) :-
    findall(Link,
            ( xpath(DOM, //a(@href), Link),
              atom_concat(#, Encoded, Link),
              uri_encoded(fragment, Id, Encoded),
              \+ xpath(DOM, //h2(@id=Id), _) ),
            Missing).

cells(Rows, _, DOM) :-
    findall(Row, ( xpath(DOM, //tr, Tr),
                   findall(Text, xpath(Tr, td(text), Text), Row) ), Rows).

:- begin_tests(study_page).

test(links_resolve, Missing-Inside == []-[]) :-
    with_page(Dir, DOM,
        ( findall(File,
                  ( member(Path, [a(@href), img(@src)]),
                    xpath(DOM, //Path, Link),
                    \+ sub_atom(Link, 0, _, _, #),
                    uri_encoded(path, File0, Link),
                    directory_file_path(Dir, File0, File),
                    \+ exists_file(File) ),
                  Missing) )),
    with_page(Dir1, DOM1, links_inside(Inside, Dir1, DOM1)).
test(tables) :-
    with_page(Dir, DOM, cells(Rows, Dir, DOM)),
    forall(member(Row, [ ['toy 1', 'A <toy>', '', '0 of 1, 1 not known'],
                         [c, '[5]', 'given by --set'],
                         ['10', old, '3', '202 (201–203) [12]'],
                         ['m < 3 & more (line 7, so)', 'DID NOT HOLD', _],
                         ['version prolog', '90004'],
                         ['measure m', '3'],
                         [m, '1', '2', above] ]),
           assertion(memberchk(Row, Rows))),
    assertion(\+ memberchk(['measure l'|_], Rows)).
test(page_shows_how_to_repeat_the_study) :-
    with_page(_, DOM, findall(T, xpath(DOM, //(*(text)), T), [Text|_])),
    forall(member(Part, [ 'swipl a -- b', 'What it is & does.',
                          'not drawn' ]),
           assertion(once(sub_atom(Text, _, _, _, Part)))).

test(figures_of_the_thesis_are_under_their_chapters,
     Headings == ['Chapter 5', 'Chapter 7', 'Beyond the thesis']) :-
    findall(shown(Study, outcome{claims:[]}, '', none),
            ( member(Name, [ 'allocation/beyond_urgent', 'allocation/figure_7_5',
                             'sync/figure_5_8' ]),
              project_study(Name, Study) ),
            Shown),
    with_tmp_dir(overview_headings(Shown, Headings)).

test(claims_without_runs_are_not_counted, Texts == ['1 of 2, 1 not known']) :-
    project_study('sync/figure_5_8', Study),
    Claims = [ claim("holds", [], 1, 1, true, []),
               claim("fails", [], 0, 1, false, []),
               claim("has no runs", [], 0, 0, unknown, []) ],
    overview_page([shown(Study, outcome{claims:Claims}, '', none)], '.', DOM),
    findall(Text, xpath(DOM, //td(@class=n, text), Text), Texts).

overview_headings(Shown, Headings, Dir) :-
    overview_page(Shown, Dir, DOM),
    findall(Heading, xpath(DOM, //th(@colspan='4', text), Heading), Headings),
    overview_title(Shown, Title),
    xpath(DOM, //h1(text), Title).

overview_page(Shown, Dir, DOM) :-
    phrase(overview(Dir, Shown), Tokens),
    with_output_to(string(Text), print_html(Tokens)),
    open_string(Text, In),
    load_html(stream(In), DOM, [dialect(html5)]).

:- end_tests(study_page).
