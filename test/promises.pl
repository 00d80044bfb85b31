:- module(test_promises,
          [ promise/5,                  % ?Name, ?Document, -Suites, -File,
                                        % -Edit
            promise_change/3,           % ?Name, -Change, -Suites
            promising/2,                % +Name, -Document
            promise_problem/1,          % -Problem
            check_promises/0
          ]).

/** <module> What is promised, the tests that pin it, and what must break them

A promise is a sentence of a document that users rely on. There it begins with
the anchor `<a id="NAME"></a>`. For doc/agents.md, promises/agents.diff has a
change of the product that takes it away, for each; so has
promises/UPGRADING.diff for UPGRADING.md:

    --- FILE
    @@ NAME: SUITE ...
     text that is kept
    -text that is deleted
    +text that is added

With it a test of the suites fails, which are named as test/run.pl takes them.
FILE, from the root of the project, is that of all changes up to the next. What
is kept and deleted are whole lines, which occur there once.

*Threading*: any thread.
*/

:- use_module(lib/common, [project_file/2]).
:- use_module(lib/suites, [suite_named/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [convlist/3, maplist/3]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, nextto/3]).
:- use_module(library(readutil), [read_file_to_string/3]).

%!  promise(?Name, ?Document, -Suites:list, -File, -Edit) is nondet.
%
%   Document promises Name. Edit is Old-New.

promise(Name, Document, Suites, File, Edit) :-
    promised(Document, Text),
    promise_in(Text, Name, Suites, File, Edit).

promised(Document, Text) :-
    project_file('test/promises', Dir),
    directory_member(Dir, Path, [extensions([diff])]),
    file_base_name(Path, Base),
    file_name_extension(Name, diff, Base),
    promising(Name, Document),
    read_file_to_string(Path, Text, [encoding(utf8)]).

%!  promising(+Name, -Document) is semidet.
%
%   Document is the one that is called Name, in doc/ or at the top of the tree.

promising(Name, Document) :-
    member(Form, ['doc/~w.md', '~w.md']),
    format(atom(Document), Form, [Name]),
    project_file(Document, File),
    exists_file(File),
    !.

promise_in(Text, Name, Suites, File, Old-New) :-
    string_concat(Changes, "\n", Text),
    atomic_list_concat([_|OfFiles], '\n--- ', Changes),
    member(OfFile, OfFiles),
    atomic_list_concat([File|OfNames], '\n@@ ', OfFile),
    member(OfName, OfNames),
    split_string(OfName, "\n", "", [Head|Lines]),
    atomic_list_concat([Name,Names], ': ', Head),
    atomic_list_concat(Suites, ' ', Names),
    maplist(side(Lines), ["-","+"], [Old,New]).

%   side(+Lines, +Sign, -Text): without what has the other sign.

side(Lines, Sign, Text) :-
    convlist(line_of_side(Sign), Lines, Kept),
    append([""|Kept], [""], All),
    atomic_list_concat(All, '\n', Text).

line_of_side(_, "", "").
line_of_side(Sign, Line, Text) :-
    sub_string(Line, 0, 1, _, First),
    \+ ( member(First, ["-","+"]), First \== Sign ),
    sub_string(Line, 1, _, 0, Text).

%!  promise_change(?Name, -Change, -Suites:list) is nondet.

promise_change(Name, change(File, Start, End, New, declared, -, Line), Paths) :-
    promise(Name, _, Suites, File, Old-New),
    findall(Path,
            ( member(Suite, Suites),
              suite_named(Suite, Absolute),
              project_file(Path, Absolute)
            ),
            Paths),
    file_text(File, Text),
    once(sub_string(Text, Start, Length, _, Old)),
    End is Start+Length,
    sub_string(Text, 0, Start, _, Before),
    split_string(Before, "\n", "", Lines),
    length([_|Lines], Line).

file_text(File, Text) :-
    project_file(File, Path),
    read_file_to_string(Path, Text, [encoding(utf8)]).

%!  promise_problem(-Problem:string) is nondet.
%
%   An anchor without a promise, a promise without an anchor, without a test, or
%   whose text is gone from the product; two promises of one name.

promise_problem(Problem) :-
    promised(Document, Promises),
    file_text(Document, Text),
    findall(Anchor, anchor(Text, Anchor), Anchors),
    findall(Name, promise_in(Promises, Name, _, _, _), Names),
    (   member(Name, Names),
        \+ memberchk(Name, Anchors),
        format(string(Message), "~w has no anchor", [Name])
    ;   member(Anchor, Anchors),
        \+ memberchk(Anchor, Names),
        format(string(Message), "no promise has the name ~w", [Anchor])
    ;   promise_in(Promises, Name, Suites, File, Edit),
        edit_problem(Suites, File, Edit, Message0),
        format(string(Message), "~w: ~s", [Name, Message0])
    ),
    format(string(Problem), "~w: ~s", [Document, Message]).
promise_problem(Problem) :-
    findall(Name, promise(Name, _, _, _, _), Names0),
    msort(Names0, Names),
    nextto(Name, Name, Names),
    format(string(Problem), "two promises are named ~w", [Name]).

anchor(Text, Anchor) :-
    atom_string(Atom, Text),
    atomic_list_concat([_|Parts], '<a id="', Atom),
    member(Part, Parts),
    once(sub_atom(Part, End, _, _, '"')),
    sub_atom(Part, 0, End, _, Anchor).

edit_problem(Suites, _, _, Problem) :-
    member(Suite, Suites),
    \+ suite_named(Suite, _),
    format(string(Problem), "there is no suite ~w", [Suite]).
edit_problem(_, File, Old-_, Problem) :-
    \+ ( file_text(File, Text),
         aggregate_all(count, sub_string(Text, _, _, _, Old), 1) ),
    format(string(Problem), "its text is not once in ~w", [File]).
edit_problem(_, _, Same-Same, "it changes nothing").

%!  check_promises is semidet.
%
%   Print all problems; fail if there are any.

check_promises :-
    findall(Problem, promise_problem(Problem), Problems),
    forall(member(Problem, Problems),
           format(user_error, '~s~n', [Problem])),
    Problems == [].
