:- module(test_touched,
          [ suite_times/1,              % -Times
            touched_suites/2,           % +Files, -Suites
            within_budget/4             % +Suites, +Budget, -Taken, -Left
          ]).

/** <module> The suites that a change touches

Files are named from the directory of the project on.

*Threading*: any thread.
*/

:- use_module(common, [project_file/2]).
:- use_module(suites, [all_suites/1, suite_name/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [include/3]).
:- use_module(library(filesex),
              [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_file_to_terms/3]).

%!  suite_times(-Times:list) is det.
%
%   time(Suite, Processor, Seconds) of each suite: of the last successful run of
%   all suites, or of that for out/coverage.pl, or a guess.

suite_times(Times) :-
    (   member(Name, ['out/passed.pl', 'out/coverage.pl']),
        terms(Name, Terms)
    ->  true
    ;   Terms = []
    ),
    findall(time(Suite, Processor, Seconds),
            ( suite(Suite),
              (   memberchk(suite(Suite, Processor, Seconds), Terms)
              ->  true
              ;   guess(Suite, Processor, Seconds)
              ) ),
            Times).

guess(Suite, Processor, Seconds) :-
    suite_name(Suite, Name),
    long(Seconds, Names),
    memberchk(Name, Names),
    !,
    Processor is Seconds/2.
guess(_, 2, 5).

long(80, [chaos, shell, scripted, cells, parking, engines, playground,
          playground_page, playground_firefox]).
long(40, [ doc, page, lasting, quick, network_journal, user_program, cell_floods,
           members, takeover, fleet_journal, study_work, mqtt, pack ]).
long(25, [ cell_policy, allocation_network, wire, cell_frames, app, network, make,
           page_server, hop, applications, postgresql, faults, parts, robots,
           warehouse, cluster, sync_network, site, cell_outcomes, gate, work ]).

suite(Suite) :-
    all_suites(Paths),
    member(Path, Paths),
    project_file(Suite, Path).

terms(Name, Terms) :-
    project_file(Name, File),
    exists_file(File),
    read_file_to_terms(File, Terms, [encoding(utf8)]).

%!  touched_suites(+Files:list, -Suites:list) is det.
%
%   The suites that changes of Files touch, as time/3: the nearest first, and
%   of those the quickest. A suite that is changed itself is nearest, then come
%   that of the same name, those of the same folder, and those that execute
%   something of the file, according to out/coverage.pl, or name it.

touched_suites(Files, Suites) :-
    suite_times(Times),
    change(Files, Change),
    findall((Place-Processor)-time(Suite, Processor, Seconds),
            ( member(time(Suite, Processor, Seconds), Times),
              aggregate_all(min(P), place(Suite, Change, P), Place) ),
            Pairs0),
    keysort(Pairs0, Pairs),
    pairs_values(Pairs, Suites).

%   change(Files, Names, Folders, Executing, Naming): Names of files, Folders in
%   which suites are near, the suites that execute or name one of Files.

change(Files0, change(Files, Names, Folders, Executing, Naming)) :-
    texts(Texts),
    with_users(Files0, [], Texts, Files),
    findall(Name, ( member(File, Files), plain_name(File, Name) ), Names),
    findall(Folder, ( member(File, Files), folder(File, Folder) ), Folders),
    ( terms('out/coverage.pl', Coverage) -> true ; Coverage = [] ),
    findall(Suite,
            ( member(executes(Suite, File, _), Coverage),
              memberchk(File, Files) ),
            Executing),
    findall(Test, ( member(File, Files), used_by(File, Texts, Test) ), Naming).

plain_name(File, Name) :-
    file_base_name(File, Base),
    file_name_extension(Name, _, Base).

%   place(+Suite, +Change, -Place) is nondet.

place(Suite, change(Files, _, _, _, _), 0) :-
    memberchk(Suite, Files).
place(Suite, change(_, Names, _, _, _), 1) :-
    suite_name(Suite, Name),
    memberchk(Name, Names).
place(Suite, change(_, _, Folders, _, _), 2) :-
    file_directory_name(Suite, Folder),
    memberchk(Folder, Folders).
place(Suite, change(_, _, _, Executing, _), 3) :-
    memberchk(Suite, Executing).
place(Suite, change(_, _, _, _, Naming), 3) :-
    memberchk(Suite, Naming).

%   folder(+File, -Folder) is semidet: the nearest that has suites. Files below
%   test/ are used by suites of any folder.

folder(File, Folder) :-
    \+ sub_atom(File, 0, _, _, 'test/'),
    file_directory_name(File, Dir),
    (   mirrored(From, To),
        atom_concat(From, Rest, Dir)
    ->  atom_concat(To, Rest, Mirrored)
    ;   Mirrored = Dir
    ),
    with_suites(Mirrored, Folder).

mirrored('prolog/typhon/', 'prolog/').
mirrored('payloads/', 'agents/').       % suites of the agents that carry them

with_suites(., 'test/project') :-
    !.
with_suites(Dir, Folder) :-
    directory_file_path(test, Dir, Folder0),
    (   suite(Suite),
        file_directory_name(Suite, Folder0)
    ->  Folder = Folder0
    ;   file_directory_name(Dir, Above),
        with_suites(Above, Folder)
    ).

%   with_users(+Files, +Before, +Texts, -Changed): also the files of test/ that
%   use changed files of test/, and so on; but suites are used by none. The users
%   of Before are among Before and Files.

with_users([], Changed, _, Changed) :-
    !.
with_users(Files, Before, Texts, Changed) :-
    append(Files, Before, Known),
    findall(Test,
            ( member(File, Files),
              sub_atom(File, 0, _, _, 'test/'),
              used_by(File, Texts, Test),
              \+ suite_name(Test, _),
              \+ memberchk(Test, Known) ),
            Users0),
    sort(Users0, Users),
    with_users(Users, Known, Texts, Changed).

%   used_by(+File, +Texts, -Test) is nondet: more than once, perhaps.

used_by(File, Texts, Test) :-
    findall(Name, name_of(File, Name), Names),
    member(Test-Text, Texts),
    member(Name, Names),
    has_name(Name, Test, Text).

%   texts(-Texts): Test-Text of all files of tests, read once.

:- table texts/1.

texts(Texts) :-
    findall(Test-Text, test_text(Test, Text), Texts).

%   test_text(-Test, -Text) is nondet. Text is text(Whole, Paths): Paths are the
%   words that have a slash, as most names are sought in these few only.

test_text(Test, text(Whole, Paths)) :-
    project_file(test, Dir),
    directory_member(Dir, Path, [recursive(true), extensions([pl])]),
    project_file(Test, Path),
    read_file_to_string(Path, Whole, [encoding(utf8)]),
    split_string(Whole, "\n", "", Lines),
    include(has_slash, Lines, WithSlash),
    atomic_list_concat(WithSlash, ' ', Joined),
    split_string(Joined, " '\"(,", "", Words0),
    include(has_slash, Words0, Words1),
    sort(Words1, Words),
    atomic_list_concat(Words, ' ', Paths).

has_slash(Text) :-
    sub_string(Text, _, _, _, "/"),
    !.

%   name_of(+File, -Name) is nondet: a text uses File as imports do, by the last
%   two names of its path, or as a library, or, in the same folder, by its own.

name_of(File, whole(File)) :-
    file_directory_name(File, '.').
name_of(File, path(Name)) :-
    file_directory_name(File, Dir),
    Dir \== '.',
    file_base_name(Dir, Parent),
    plain_name(File, Stem),
    directory_file_path(Parent, Stem, Name).
name_of(File, whole(Name)) :-
    atom_concat('prolog/', Rest, File),
    file_name_extension(Library, pl, Rest),
    format(atom(Name), 'library(~w)', [Library]).
name_of(File, beside(Dir, Name)) :-
    file_directory_name(File, Dir),
    plain_name(File, Stem),
    format(atom(Name), 'use_module(~w,', [Stem]).

has_name(Name, Test, Text) :-
    part(Name, Test, Text, Word, Part),
    sub_string(Part, _, _, _, Word),
    !.

part(whole(Word), _, text(Whole, _), Word, Whole).
part(path(Word), _, text(_, Paths), Word, Paths).
part(beside(Dir, Word), Test, text(Whole, _), Word, Whole) :-
    file_directory_name(Test, Dir).

%!  within_budget(+Suites, +Budget, -Taken, -Left) is det.
%
%   Suites, a list of time/3, without those that Budget is too small for. It is
%   budget(Processor, Seconds): the processor time of all together, and the
%   seconds of the longest.

within_budget([], _, [], []).
within_budget([time(Suite, P, S)|Suites], budget(Processor, Longest), Taken,
              Left) :-
    (   P =< Processor,
        S =< Longest
    ->  Rest is Processor-P,
        Taken = [time(Suite, P, S)|Taken1],
        within_budget(Suites, budget(Rest, Longest), Taken1, Left)
    ;   Left = [time(Suite, P, S)|Left1],
        within_budget(Suites, budget(Processor, Longest), Taken, Left1)
    ).
