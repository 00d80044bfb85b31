:- module(test_project_documents, []).

% README, CHANGELOG, CONTRIBUTING and the records of decisions keep their form:
% readers find what is new in a version, and why, on one page.

:- use_module('../lib/common').
:- use_module('../lib/texts', [file_lines/2]).
:- use_module(library(date), [parse_time/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [append/3, last/2, member/2, memberchk/2, numlist/3, subtract/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3, read_file_to_terms/3]).

text(Path, Text) :-
    project_file(Path, File),
    read_file_to_string(File, Text, [encoding(utf8)]).

lines(Path, Lines) :-
    project_file(Path, File),
    file_lines(File, Lines).

words(Path, Count) :-
    text(Path, Text),
    split_string(Text, " \n\t", "", Parts),
    subtract(Parts, [""], Words),
    length(Words, Count).

                /*******************************
                *           CHANGES            *
                *******************************/

%   section(-Heading, -Lines): Lines, after the heading, up to the next one.

section(Heading, Lines) :-
    lines('CHANGELOG.md', All),
    append(_, [Line|Rest], All),
    string_concat("## ", Heading, Line),
    (   append(Lines, [Next|_], Rest),
        string_concat("## ", _, Next)
    ->  true
    ;   append(Lines, [""], Rest)
    ).

parts(Lines, Parts) :-
    findall(Part,
            ( member(Line, Lines), string_concat("### ", Part, Line) ),
            Parts).

%   released(-Version, -Date): in the order of the file.

released(Version, Date) :-
    section(Heading, _),
    Heading \== "Unreleased",
    split_string(Heading, " ", "()", [Version,Date]).

ordered(Parts) :-
    findall(Part,
            ( member(Part, ["New", "Changed", "Breaking", "Repaired"]),
              memberchk(Part, Parts) ),
            Parts).

is_date(Date) :-
    catch(parse_time(Date, iso_8601, _), error(_, _), fail).

                /*******************************
                *             DEMO             *
                *******************************/

demo_claim(Claim) :-
    project_file('experiments/sync/study_demo.pl', File),
    read_file_to_terms(File, Terms, [encoding(utf8)]),
    member(claim(Claim, _, _), Terms).

shown_claim(Lines, Claim) :-
    member(Line, Lines),
    string_concat("      held ", Rest, Line),
    split_string(Rest, "", " ", [Claim]).

                /*******************************
                *           VERSIONS           *
                *******************************/

version(Version) :-
    project_file('pack.pl', File),
    read_file_to_terms(File, Terms, [encoding(utf8)]),
    memberchk(version(Atom), Terms),
    atom_string(Atom, Version).

%   Where the version is named, and how.

names_version('README.md', "Version\n~w").
names_version('CITATION.cff', "version: ~w\n").
names_version('doc/citing.md', "version = {~w}").
names_version('app/editors/vscode/package.json', "\"version\": \"~w\"").

                /*******************************
                *          DECISIONS           *
                *******************************/

record(Number, Path) :-
    project_file('doc/decisions', Dir),
    directory_files(Dir, Files),
    member(File, Files),
    split_string(File, "-", "", [First|_]),
    number_string(Number, First),
    directory_file_path('doc/decisions', File, Path).

heading(Level, Path, Heading) :-
    lines(Path, Lines),
    member(Line, Lines),
    string_concat(Level, Heading, Line).

listed(Path) :-
    once(heading("# ", Path, Title)),
    file_base_name(Path, File),
    split_string(Title, ".", " ", [Number|_]),
    string_concat(Number, ". ", Begin),
    string_concat(Begin, Subject, Title),
    format(string(Line), "~w. [~w](~w)", [Number,Subject,File]),
    text('doc/decisions/README.md', Text),
    sub_string(Text, _, _, _, Line),
    !.

:- begin_tests(project_documents).

test(section_of_a_version_has_at_most_60_lines, Long == []) :-
    findall(Heading-Length,
            ( section(Heading, Lines),
              length([Heading|Lines], Length),
              Length > 60 ),
            Long).
test(lines_of_changes_are_short, Long == []) :-
    lines('CHANGELOG.md', Lines),
    findall(Line, ( member(Line, Lines), string_length(Line, L), L > 92 ),
            Long).
test(changes_are_new_changed_breaking_or_repaired, Other == []) :-
    findall(Heading-Parts,
            ( section(Heading, Lines),
              parts(Lines, Parts),
              \+ ordered(Parts) ),
            Other).
test(sections_have_headings_of_versions, Others == []) :-
    findall(Heading,
            ( section(Heading, _),
              Heading \== "Unreleased",
              \+ ( split_string(Heading, " ", "()", [_,Date]), is_date(Date) )
            ),
            Others).
test(newer_versions_come_first, Dates == Sorted) :-
    findall(Date, released(_, Date), Dates),
    sort(0, @>=, Dates, Sorted).
test(newest_version_is_that_of_the_pack, Newest == Version) :-
    once(released(Newest, _)),
    version(Version).
test(version_is_the_same_everywhere, [forall(names_version(Path, Form))]) :-
    version(Version),
    format(string(Name), Form, [Version]),
    text(Path, Text),
    once(sub_string(Text, _, _, _, Name)).

test(readme_has_at_most_700_words) :-
    words('README.md', Count),
    Count =< 700.
test(readme_begins_with_demo_and_test,
     [forall(member(Target, [demo, test]))]) :-
    lines('README.md', Lines),
    length(Screen, 40),
    append(Screen, _, Lines),
    format(string(Command), "    $ make ~w", [Target]),
    once(( member(Line, Screen), string_concat(Command, _, Line) )).
test(readme_shows_the_claims_of_the_demo, Others == []) :-
    findall(Claim, demo_claim(Claim), Claims),
    lines('README.md', Lines),
    findall(Claim, ( shown_claim(Lines, Claim), \+ memberchk(Claim, Claims) ),
            Others),
    shown_claim(Lines, _),
    !,
    length(Claims, Count),
    format(string(Verdict), "    All ~d claims held.", [Count]),
    memberchk(Verdict, Lines).
test(contributing_is_one_page) :-
    lines('CONTRIBUTING.md', Lines),
    length(Lines, Count),
    Count =< 100.

test(decisions_are_numbered, Numbers == All) :-
    findall(Number, record(Number, _), Numbers0),
    msort(Numbers0, Numbers),
    last(Numbers, Last),
    numlist(1, Last, All).
test(decisions_have_150_to_300_words, Others == []) :-
    findall(Path-Count,
            ( record(_, Path),
              words(Path, Count),
              \+ between(150, 300, Count) ),
            Others).
test(decisions_have_context_costs_and_measurements, Others == []) :-
    findall(Path,
            ( record(_, Path),
              findall(Heading, heading("## ", Path, Heading), Headings),
              Headings \== [ "Context", "Decision", "Cost",
                             "Measured and refuted" ] ),
            Others).
test(decisions_are_listed, Others == []) :-
    findall(Path, ( record(_, Path), \+ listed(Path) ), Others).

:- end_tests(project_documents).
