:- module(study_page,
          [ page_save/3                 % +Directory, +Outcomes, +Options
          ]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(http/html_write),
              [html/3, page//2, print_html/2]).
:- use_module(library(lists), [append/2, append/3, member/2, memberchk/2]).
:- use_module(library(option), [option/3]).
:- use_module(numbers, [number_text/2]).
:- use_module(report, [held_text/3, parameter_rows/2]).
:- use_module(studies, [study_call/2, study_title/3]).

/** <module> One page that binds studies together

It needs no server: pictures and data are files beside it.

*Threading*: no state; any thread.
*/

%!  page_save(+Directory, +Outcomes, +Options) is det.
%
%   Write Directory/index.html.  Outcomes are pairs Study-Outcome; Options
%   are those of the command line.

page_save(Directory, Outcomes, Options) :-
    directory_file_path(Directory, 'index.html', File),
    style(Style),
    phrase(whole(Style, Outcomes, Options), Tokens),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        print_html(Out, Tokens),
        close(Out)).

whole(Style, Outcomes, Options) -->
    page([title('Studies'), meta([charset('utf-8')]), style(Style)],
         \everything(Outcomes, Options)).

style('body{font:16px/1.45 system-ui,sans-serif;max-width:70em;margin:2em auto;
padding:0 1em;color:#222}h2{margin-top:2.5em;border-top:1px solid #ccc;
padding-top:1em}img{max-width:100%;height:auto}table{border-collapse:collapse;
margin:1em 0;font-size:90%}td,th{padding:.2em .7em;border-bottom:1px solid #ddd;
text-align:left;vertical-align:top}td.n{text-align:right;white-space:nowrap}
.no{background:#fbe9e7}.some{background:#fff8e1}.yes{background:#e8f5e9}
code{background:#f4f4f4;padding:.1em .3em}.small{color:#666;font-size:85%}').

%   Not named body//2, which html_write would take for its hook.

everything(Outcomes, Options) -->
    html([ h1('Studies'),
           \contents(Outcomes),
           \studies(Outcomes, Options) ]).

contents(Outcomes) -->
    { findall(tr([td(a(href(Link), Name)), td(Title), td(class(n), Text)]),
              ( member(Study-Outcome, Outcomes),
                study_title(Study, Name, Title),
                atom_concat(#, Name, Link),
                share(Outcome, Text) ),
              Rows) },
    html(table([tr([th(study), th(title), th('claims: held of the medians')])
               |Rows])).

share(Outcome, Text) :-
    findall(x, member(claim(_, _, _, _, true, _), Outcome.claims), Held),
    length(Held, HeldCount),
    length(Outcome.claims, Count),
    format(atom(Text), '~d of ~d', [HeldCount, Count]).

studies([], _) -->
    [].
studies([Study-Outcome|Outcomes], Options) -->
    one(Study, Outcome, Options),
    studies(Outcomes, Options).

one(Study, Outcome, Options) -->
    { study_title(Study, Name, Title),
      findall(p(Text), study_call(Study, text(Text)), Texts),
      findall(Figure, figure(Study, Name, Figure), Figures),
      again(Name, Options, Again) },
    html([ h2(id(Name), [Name, ': ', Title]) | Texts ]),
    html(Figures),
    claims(Outcome.claims),
    medians(Study, Outcome.rows),
    html([ details([ summary('parameters'), \parameters(Study) ]),
           p(class(small),
             [ 'Data: ', \link(Name, 'runs.csv'), ', ',
               \link(Name, 'claims.csv'), ', ',
               \link(Name, 'parameters.csv'), '. Again: ', code(Again) ]) ]).

link(Name, File) -->
    { atomic_list_concat([Name, File], /, Path) },
    html(a(href(Path), File)).

again(Name, Options, Text) :-
    option(runs(Runs), Options, 3),
    option(seed(Seed), Options, 1),
    findall(Set, ( member(set(S), Options),
                   format(atom(Set), ' --set \'~w\'', [S]) ), Sets),
    atomic_list_concat(Sets, Settings),
    format(atom(Text),
           'swipl experiments/study.pl -- ~w --runs ~d --seed ~d~w',
           [Name, Runs, Seed, Settings]).

figure(Study, Name, p([b(Plot), ' ', Title, br([]), img([src(Path), alt(Title)])])) :-
    study_call(Study, plot(Plot, Title, _)),
    format(atom(Path), '~w/~w.svg', [Name, Plot]).

                /*******************************
                *            TABLES            *
                *******************************/

claims([]) -->
    !,
    [].
claims(Claims) -->
    { findall(tr(class(Class), [td(Said), td(Word), td(Found)]),
              ( member(claim(Text, Notes, Held, Of, Medians, Found), Claims),
                held_text(Held, Of, Word0),
                verdict(Held, Of, Medians, Class),
                medians_word(Medians, Of, Word1),
                atomic_list_concat([Word0, Word1], Word),
                noted(Text, Notes, Said) ),
              Rows) },
    html(table([tr([th('the thesis says'), th('held'), th('found (medians)')])
               |Rows])).

verdict(Of, Of, true, yes) :- Of > 0, !.
verdict(0, _, false, no) :- !.
verdict(_, _, _, some).

medians_word(true, _, '') :- !.
medians_word(false, Of, '; not of the medians') :- Of > 1, !.
medians_word(_, _, '').

noted(Text, [], Text) :-
    !.
noted(Text, Notes, [Text, ' ', span(class(small), Said)]) :-
    findall(Part, ( member(Note, Notes), note_text(Note, Part) ), Parts),
    atomic_list_concat(Parts, ', ', Joined),
    format(atom(Said), '(~w)', [Joined]).

note_text(line(Line), Text) :- !, format(atom(Text), 'line ~w', [Line]).
note_text(formula, 'of the formula, not of a run') :- !.
note_text(ours, 'ours, not of the thesis') :- !.
note_text(why(Text), Text) :- !.
note_text(Note, Text) :- format(atom(Text), '~w', [Note]).

medians(Study, Rows) -->
    { findall(Name, study_call(Study, vary(Name, _)), Names),
      measures(Study, Rows, Measures),
      findall(th(Text), ( member(M, Measures), heading(Study, M, Text) ),
              MeasureHeads),
      findall(th(Name), member(Name, Names), NameHeads),
      append([NameHeads, [th(runs)], MeasureHeads], Heads),
      findall(tr(Cells), ( member(Row, Rows),
                           cells(Study, Row, Names, Measures, Cells) ), Trs) },
    html(details([summary('medians (least to greatest) [thesis]'),
                  table([tr(Heads)|Trs])])).

measures(Study, Rows, Measures) :-
    findall(Name, ( member(row(_, _, Spreads), Rows),
                    member(spread(Name, _, _, _), Spreads) ), Names0),
    sort(Names0, All),
    findall(Name, ( study_call(Study, label(Name, _)), memberchk(Name, All) ),
            Labelled),
    ( Labelled == [] -> Measures = All ; Measures = Labelled ).

heading(Study, Measure, Text) :-
    (   study_call(Study, label(Measure, Text0))
    ->  Text = Text0
    ;   Text = Measure
    ).

cells(Study, row(Case, Count, Spreads), Names, Measures, Cells) :-
    findall(td(Text), ( member(Name, Names), get_dict(Name, Case, Value),
                        format(atom(Text), '~w', [Value]) ), Keys),
    findall(td(class(n), Text),
            ( member(Measure, Measures),
              value_text(Spreads, Measure, Text0),
              printed_text(Study, Case, Measure, Printed),
              atom_concat(Text0, Printed, Text) ),
            Values),
    append([Keys, [td(class(n), Count)], Values], Cells).

value_text(Spreads, Measure, Text) :-
    memberchk(spread(Measure, Least, Median, Most), Spreads),
    !,
    number_text(Median, Middle),
    (   Least =:= Most
    ->  Text = Middle
    ;   number_text(Least, A),
        number_text(Most, B),
        format(atom(Text), '~w (~w–~w)', [Middle, A, B])
    ).
value_text(_, _, '').

printed_text(Study, Case, Measure, Text) :-
    study_call(Study, printed(Measure, Where, Value)),
    forall(member(Name=V, Where), get_dict(Name, Case, V)),
    !,
    number_text(Value, Number),
    format(atom(Text), ' [~w]', [Number]).
printed_text(_, _, _, '').

parameters(Study) -->
    { parameter_rows(Study, Rows),
      findall(tr([td(Name), td(Value), td(Why)]),
              member([Name, Value, Why], Rows), Trs) },
    html(table([tr([th(parameter), th(value), th(why)])|Trs])).
