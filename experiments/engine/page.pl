:- module(study_page,
          [ page_save/2                 % +Directory, +Shown
          ]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(http/html_write), [html//1, page//2, print_html/2]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(uri), [uri_encoded/3]).
:- use_module(numbers, [number_text/2]).
:- use_module(overview, [overview//2, overview_title/2]).
:- use_module(report,
              [ case_texts/3, evidence/3, held_text/4, medians_text/4,
                parameter_rows/3,
                shown_measures/3, spread_text/3 ]).
:- use_module(store, [run_facts/2]).
:- use_module(studies, [study_call/2, study_title/3]).

/** <module> One page for all studies

The page needs no server: pictures and data are files in its directory.

*Threading*: no state; any thread.
*/

%!  page_save(+Directory, +Shown:list) is det.
%
%   Writes Directory/index.html.  Shown are shown(Study, Outcome, Command, Run):
%   Command repeats the study, and Run is the directory of one of its runs, or
%   `none`.

page_save(Directory, Shown) :-
    directory_file_path(Directory, 'index.html', File),
    style(Style),
    overview_title(Shown, Title),
    phrase(page([ title(Title), meta([charset('utf-8')]), style(Style) ],
                \everything(Directory, Shown)),
           Tokens),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        print_html(Out, Tokens),
        close(Out)).

style('body{font:16px/1.45 system-ui,sans-serif;max-width:70em;margin:2em auto;
padding:0 1em;color:#222}h2{margin-top:2.5em;border-top:1px solid #ccc;
padding-top:1em}img{max-width:100%;height:auto}table{border-collapse:collapse;
margin:1em 0;font-size:90%}td,th{padding:.2em .7em;border-bottom:1px solid #ddd;
text-align:left;vertical-align:top}td.n{text-align:right;white-space:nowrap}
.no{background:#fbe9e7}.some{background:#fff8e1}.yes{background:#e8f5e9}
.unknown{color:#666}
details{overflow-x:auto}img.small{height:7em;max-width:14em}
code{background:#f4f4f4;padding:.1em .3em}.small{color:#666;font-size:85%}').

%   Not named body//2, because html_write would take that for its hook.

everything(Directory, Shown) -->
    overview(Directory, Shown),
    studies(Shown, Directory),
    how_to_cite.

how_to_cite -->
    html([ h2('How to cite'),
           p([ 'The Typhon developers: Typhon, mobile agents that travel in ',
               'the middle of a clause. For studies of the thesis also: ',
               'Shashi Shekhar Jha, PhD thesis, Department of Computer ',
               'Science and Engineering, Indian Institute of Technology ',
               'Guwahati. Entries for BibTeX are in doc/citing.md.' ]) ]).

studies([], _) -->
    [].
studies([shown(Study, Outcome, Command, Run)|Shown], Directory) -->
    { study_title(Study, Name, Title),
      findall(p(Text), study_call(Study, text(Text)), Texts),
      findall(Figure, figure(Study, Directory, Name, Figure), Figures) },
    html([ h2(id(Name), [Name, ': ', Title]) | Texts ]),
    html(Figures),
    missing(Outcome.missing),
    claims(Outcome.claims, Outcome),
    medians(Study, Outcome),
    checks(Outcome.checks),
    parameters(Study, Outcome.given),
    one_run(Run),
    replay(Directory, Name),
    html(p(class(small),
           [ 'Data: ', \data(Directory, Name), '. Again: ', code(Command) ])),
    studies(Shown, Directory).

%   The same rows are in files .jsonl.

data(Directory, Name) -->
    { findall(File,
              ( member(Table, [ runs, steps, summary, tests, claims,
                                parameters ]),
                file_name_extension(Table, csv, File),
                atomic_list_concat([Directory, Name, File], /, Path),
                exists_file(Path) ),
              [First|Files]) },
    link(Name, First),
    more_data(Files, Name).

more_data([], _) -->
    [].
more_data([File|Files], Name) -->
    html(', '),
    link(Name, File),
    more_data(Files, Name).

link(Name, File) -->
    { path(Name, File, Path) },
    html(a(href(Path), File)).

path(Name, File, Path) :-
    atomic_list_concat([Name, File], /, Path0),
    uri_encoded(path, Path0, Path).

figure(Study, Directory, Name, p([b(Plot), ' ', Title, br([]), Shown])) :-
    study_call(Study, plot(Plot, Title, _)),
    format(atom(File), '~w.svg', [Plot]),
    atomic_list_concat([Directory, Name, File], /, Drawn),
    (   exists_file(Drawn)
    ->  path(Name, File, Path),
        Shown = img([src(Path), alt(Title)])
    ;   Shown = em('not drawn')
    ).

                /*******************************
                *            TABLES            *
                *******************************/

missing(0) -->
    !,
    [].
missing(Count) -->
    html(p(class(unknown), [Count, ' of the planned runs are missing.'])).

claims([], _) -->
    !,
    [].
claims(Claims, Outcome) -->
    { findall(tr(class(Class), [td(Said), td(Word), td([Found|Evidence])]),
              ( member(claim(Text, Notes, Held, Of, Medians, Found), Claims),
                held_text(Held, Of, Outcome.seeds, Word0),
                verdict(Held, Of, Outcome.seeds, Medians, Class),
                medians_text(Held, Of, Medians, Word1),
                atom_concat(Word0, Word1, Word),
                noted(Text, Notes, Said),
                evidence_span(Text, Outcome.tests, Evidence) ),
              Rows) },
    html(table([tr([th(claim), th('held'), th('found (medians)')])|Rows])).

evidence_span(Text, Tests, [' ', span(class(small), Said)]) :-
    evidence(Text, Tests, Said),
    !.
evidence_span(_, _, []).

verdict(_, 0, _, _, unknown) :- !.
verdict(Seeds, Seeds, Seeds, true, yes) :- !.
verdict(0, Seeds, Seeds, false, no) :- !.
verdict(_, _, _, _, some).

noted(Text, [], Text) :-
    !.
noted(Text, Notes, [Text, ' ', span(class(small), Said)]) :-
    findall(Part, ( member(Note, Notes), note_text(Note, Part) ), Parts),
    atomic_list_concat(Parts, ', ', Joined),
    format(atom(Said), '(~w)', [Joined]).

note_text(line(Line), Text) :- !, format(atom(Text), 'line ~w', [Line]).
note_text(formula, 'of the formula, not of a run') :- !.
note_text(why(Text), Text) :- !.
note_text(Note, Text) :- format(atom(Text), '~w', [Note]).

medians(Study, Outcome) -->
    { shown_measures(Study, Outcome.rows, Measures),
      findall(th(Text), ( member(M, Measures), heading(Study, M, Text) ),
              MeasureHeads),
      findall(th(Name), member(Name, Outcome.names), NameHeads),
      append([NameHeads, [th(runs)], MeasureHeads], Heads),
      findall(tr(Cells), ( member(Row, Outcome.rows),
                           cells(Study, Row, Outcome.names, Measures, Cells) ),
              Trs) },
    median_table(Study, table([tr(Heads)|Trs])).

%   The table is open if the thesis prints numbers to compare with.

median_table(Study, Table) -->
    { study_call(Study, printed(_, _, _)) },
    !,
    html(details(open(open),
                 [summary('medians (least to greatest) [printed]'), Table])).
median_table(_, Table) -->
    html(details([summary('medians (least to greatest)'), Table])).

heading(Study, Measure, Text) :-
    (   study_call(Study, label(Measure, Text0))
    ->  Text = Text0
    ;   Text = Measure
    ).

cells(Study, Row, Names, Measures, Cells) :-
    Row = row(Case, Count, _),
    case_texts(Case, Names, Texts),
    findall(td(Text), member(Text, Texts), Keys),
    findall(td(class(n), [Text, Printed]),
            ( member(Measure, Measures),
              spread_text(Row, Measure, Text),
              printed_text(Study, Case, Measure, Printed) ),
            Values),
    append([Keys, [td(class(n), Count)], Values], Cells).

printed_text(Study, Case, Measure, Text) :-
    study_call(Study, printed(Measure, Where, Value)),
    forall(member(Name=V, Where), get_dict(Name, Case, V)),
    !,
    number_text(Value, Number),
    format(atom(Text), ' [~w]', [Number]).
printed_text(_, _, _, '').

checks([]) -->
    !,
    [].
checks(Tables) -->
    { findall(table([tr(Ths)|Trs]),
              ( member(table(Header, Rows), Tables),
                Rows \== [],
                findall(th(Title), member(Title, Header), Ths),
                findall(tr(Tds), ( member(Row, Rows),
                                   findall(td(Text), member(Text, Row), Tds) ),
                        Trs) ),
              Shown) },
    html(details([summary('one case in real time')|Shown])).

parameters(Study, Given) -->
    { parameter_rows(Study, Given, Rows),
      findall(tr([td(Name), td(Value), td(Why)]),
              member([Name, Value, Why], Rows), Trs) },
    html(details([ summary(parameters),
                   table([tr([th(parameter), th(value), th(why)])|Trs]) ])).

%   A link to the replay of one run, if it was requested.

replay(Directory, Name) -->
    { atomic_list_concat([Directory, Name, 'replay.html'], /, File),
      exists_file(File),
      path(Name, 'replay.html', Path) },
    !,
    html(p(a(href(Path), 'Replay of one of the runs'))).
replay(_, _) -->
    [].

%   The facts of one run: the first of the study, and its machine.

one_run(none) -->
    !,
    [].
one_run(Run) -->
    { run_facts(Run, Facts),
      findall(tr([td(Name), td(Text)]),
              ( member(Fact, Facts), fact_text(Fact, Name, Text) ), Rows) },
    html(details([summary('one of the runs'), table(Rows)])).

fact_text(measure(_, Value), _, _) :-
    \+ number(Value),
    !,
    fail.
fact_text(Fact, Name, Text) :-
    Fact =.. [Kind|Arguments],
    append(Before, [Value], Arguments),
    atomic_list_concat([Kind|Before], ' ', Name),
    format(atom(Text), '~w', [Value]).
