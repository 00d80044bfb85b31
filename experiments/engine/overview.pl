:- module(study_overview,
          [ overview_title/2,           % +Shown, -Title
            overview//2                 % +Directory, +Shown
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(http/html_write), [html//1]).
:- use_module(library(lists), [list_to_set/2, member/2]).
:- use_module(library(uri), [uri_encoded/3]).
:- use_module(studies, [study_call/2, study_title/3]).

/** <module> The beginning of the page: introduction, and a row for each study

Studies named by numbers, such as 5.6, are figures and tables of the thesis, and
are listed under their chapters; others come after them.

*Threading*: no state; any thread.
*/

%!  overview_title(+Shown:list, -Title:atom) is det.
%!  overview(+Directory, +Shown:list)// is det.
%
%   For the studies Shown, see page_save/2.

overview_title(Shown, Title) :-
    (   of_the_thesis(Shown)
    ->  Title = 'Figures and tables of a thesis, reproduced'
    ;   Title = 'Studies'
    ).

of_the_thesis(Shown) :-
    member(shown(Study, _, _, _), Shown),
    study_title(Study, Name, _),
    numbered(Name, _),
    !.

numbered(Name, Chapter) :-
    atomic_list_concat([First, Last], '.', Name),
    atom_number(First, Chapter),
    atom_number(Last, _).

overview(Directory, Shown) -->
    { overview_title(Shown, Title),
      findall(Group, ( member(One, Shown), group(One, Group) ), Groups0),
      list_to_set(Groups0, Groups1),
      sort(Groups1, Groups) },
    html(h1(Title)),
    explained(Shown),
    html(table([ tr([ th(study), th(title), th(figures),
                      th('claims that hold for the medians') ])
               | \groups(Groups, Shown, Directory) ])).

explained(Shown) -->
    { of_the_thesis(Shown) },
    !,
    html(p([ 'Agents of Typhon run the mechanisms of the thesis of Shashi Shekhar ',
             'Jha on mobile agents for networked robots (Indian Institute of ',
             'Technology Guwahati) in virtual time; the results are compared with ',
             'the figures and tables of the thesis. A row shows a study, its ',
             'figures, and how many of its claims hold for the medians of all ',
             'runs. Below, numbers printed in the thesis are in brackets beside ',
             'ours; in figures they are triangles.' ])).
explained(_) -->
    [].

groups([], _, _) -->
    [].
groups([Group|Groups], Shown, Directory) -->
    { findall(tr([th(colspan(4), Heading)]),
              heading(Group, Shown, Heading), Headings),
      findall(Row,
              ( member(One, Shown), group(One, Group),
                row(One, Directory, Row) ),
              Rows) },
    html(Headings),
    html(Rows),
    groups(Groups, Shown, Directory).

%   group(+Shown, -Group): number of the chapter, inf for studies beyond the
%   thesis.

group(shown(Study, _, _, _), Group) :-
    study_title(Study, Name, _),
    (   numbered(Name, Chapter)
    ->  Group = Chapter
    ;   Group = inf
    ).

heading(inf, Shown, 'Beyond the thesis') :-
    of_the_thesis(Shown).
heading(Chapter, _, Heading) :-
    number(Chapter),
    format(atom(Heading), 'Chapter ~w', [Chapter]).

row(shown(Study, Outcome, _, _), Directory,
    tr([td(a(href(Link), Name)), td(Title), td(Pictures), td(class(n), Text)])) :-
    study_title(Study, Name, Title),
    uri_encoded(fragment, Name, Anchor),
    atom_concat(#, Anchor, Link),
    findall(Picture, small_picture(Study, Name, Directory, Picture), Pictures),
    share(Outcome, Text).

%   For each figure that has been drawn.

small_picture(Study, Name, Directory, img([class(small), src(Path), alt(Title)])) :-
    study_call(Study, plot(Plot, Title, _)),
    atomic_list_concat([Name, '/', Plot, '.svg'], File),
    atomic_list_concat([Directory, File], /, Drawn),
    exists_file(Drawn),
    uri_encoded(path, File, Path).

%   Claims that need a missing run are unknown.

share(Outcome, Text) :-
    findall(OfMedians,
            ( member(claim(_, _, _, _, OfMedians, _), Outcome.claims),
              OfMedians \== unknown ),
            Known),
    aggregate_all(count, member(true, Known), Held),
    length(Known, KnownCount),
    length(Outcome.claims, Count),
    Unknown is Count - KnownCount,
    (   Unknown =:= 0
    ->  format(atom(Text), '~d of ~d', [Held, Count])
    ;   format(atom(Text), '~d of ~d, ~d not known',
               [Held, KnownCount, Unknown])
    ).
