:- module(test_fidelity, []).
:- use_module('../lib/common', [project_file/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [append/3, last/2, member/2, memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).

/** <module> doc/fidelity.md: the deviations from the thesis, and their files

Files are read, not loaded.
*/

%   deviation(-Cells): a row of the first table.

deviation(Cells) :-
    text('doc/fidelity.md', Text),
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

text(Name, Text) :-
    project_file(Name, File),
    read_file_to_string(File, Text, [encoding(utf8)]).

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
