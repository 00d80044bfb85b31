:- module(test_fidelity, []).
:- use_module('../lib/common', [project_file/2]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [append/3, last/2, member/2, memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3, read_file_to_terms/3]).

/** <module> doc/fidelity.md and doc/fidelity: results, figure by figure, and
the deviations from the thesis with their files

Files are read, not loaded.
*/

text(Name, Text) :-
    project_file(Name, File),
    read_file_to_string(File, Text, [encoding(utf8)]).

                /*******************************
                *            FIGURES           *
                *******************************/

%   figure(-Number): a study of the thesis' chapters draws it, or is named
%   after it.

figure(Number) :-
    findall(Name, ( of_studies(Term), named(Term, Name) ), Names),
    findall(Whole,
            ( member(Name, Names), split_string(Name, "", "ab", [Whole]) ),
            Numbers),
    sort(Numbers, Sorted),
    member(Number, Sorted).

of_studies(Term) :-
    project_file(experiments, Directory),
    directory_member(Directory, File, [extensions([pl]), recursive(true)]),
    file_base_name(File, Base),
    member(Begin, [figure_, table_]),
    sub_atom(Base, 0, _, _, Begin),
    read_file_to_terms(File, Terms, [encoding(utf8)]),
    member(Term, Terms).

named(study(Name, _), Name).
named(plot(Name, _, _), Name).
named((plot(Name, _, _) :- _), Name).

%   chapter(+Number, -Path): the tables of the chapter of figure Number.

chapter(Number, Path) :-
    split_string(Number, ".", "", [Chapter|_]),
    format(string(Path), "fidelity/chapter-~w.md", [Chapter]).

section(Number, Heading, Anchor) :-
    member(Kind, ["Figure", "Table"]),
    format(string(Heading), "\n## ~w ~w\n", [Kind, Number]),
    split_string(Number, ".", "", Parts),
    atomic_list_concat(Parts, Digits),
    string_lower(Kind, Lower),
    format(string(Anchor), "#~w-~w)", [Lower, Digits]).

                /*******************************
                *          DEVIATIONS          *
                *******************************/

%   deviation(-Cells): a row of the table.

deviation(Cells) :-
    text('doc/fidelity/deviations.md', Text),
    split_string(Text, "\n", "", Lines),
    append(_, ["| place | the thesis | here | why | file |", _|Rows], Lines),
    append(Table, [""|_], Rows),
    !,
    member(Line, Table),
    split_string(Line, "|", " ", [""|Cells0]),
    append(Cells, [""], Cells0).

deviating_file(File) :-
    deviation(Cells),
    last(Cells, Marked),
    split_string(Marked, "", "`", [File]).

%   departs(-Name): a mechanism whose comments mention a decision against or
%   beyond the printed text.

departs(Name) :-
    project_file('pack.pl', Pack),
    file_directory_name(Pack, Root),
    member(Folder, [agents, payloads]),
    project_file(Folder, Directory),
    directory_member(Directory, File, [extensions([pl]), recursive(true)]),
    read_file_to_string(File, Text, [encoding(utf8)]),
    member(Words, ["thesis leaves", "thesis prints", "printed in the thesis",
                   "thesis does not define", "requires the previous",
                   "thesis does not print"]),
    once(sub_string(Text, _, _, _, Words)),
    atom_concat(Root, Rest, File),
    atom_concat(/, Name, Rest).

:- begin_tests(fidelity).

test(page_is_read_in_five_minutes, true(Count =< 1 000)) :-
    text('doc/fidelity.md', Text),
    split_string(Text, " \n", " \n", Parts),
    exclude(==(""), Parts, Words),
    length(Words, Count).
test(each_figure_has_a_section_to_which_the_page_leads,
     [ forall(figure(Number)), nondet ]) :-
    chapter(Number, Path),
    section(Number, Heading, Anchor),
    string_concat("doc/", Path, Document),
    text(Document, Tables),
    sub_string(Tables, _, _, _, Heading),
    string_concat(Path, Anchor, Link),
    text('doc/fidelity.md', Page),
    sub_string(Page, _, _, _, Link).
test(rows_have_five_cells_and_a_file) :-
    forall(deviation(Cells),
           ( assertion(Cells = [_, _, _, _, _]),
             Cells = [Place, Thesis, Here|_],
             assertion(\+ member("", [Place, Thesis, Here])) )),
    forall(deviating_file(File),
           ( project_file(File, Path),
             assertion(exists_file(Path)) )).
test(deviations_in_comments_are_listed) :-
    findall(File, deviating_file(File), Files),
    forall(( departs(Name), atom_string(Name, Text) ),
           assertion(memberchk(Text, Files))).

:- end_tests(fidelity).
