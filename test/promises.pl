:- module(test_promises,
          [ promise/5,                  % ?Name, ?Document, -Suites, -File, -Edit
            promise_change/3,           % ?Name, -Change, -Suites
            promise_problem/1,          % -Problem
            check_promises/0
          ]).

/** <module> What is promised, the tests that pin it, and what must break them

A promise is a sentence of a document that users rely on. There it begins with
the anchor `<a id="NAME"></a>`. For doc/agents.md, the file promises/agents.pl
has a term

    promise(Name, Suites, File, Old-New)

for each: if in File the text Old, which occurs once, is replaced by New, then
a test of Suites fails. Suites is a name as test/run.pl takes it, or a list of
names; File begins at the root of the project.

*Threading*: any thread.
*/

:- use_module(lib/common, [project_file/2]).
:- use_module(lib/suites, [suite_named/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [member/2, memberchk/2, nextto/3]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_file_to_terms/3]).

%!  promise(?Name, ?Document, -Suites:list, -File, -Edit) is nondet.
%
%   Document promises Name. Edit is Old-New.

promise(Name, Document, Suites, File, Edit) :-
    promised(Document, Terms),
    member(promise(Name, Suites0, File, Edit), Terms),
    suite_list(Suites0, Suites).

suite_list(Suites, Suites) :-
    is_list(Suites),
    !.
suite_list(Suite, [Suite]).

promised(Document, Terms) :-
    project_file('test/promises', Dir),
    directory_member(Dir, Path, [extensions([pl])]),
    file_base_name(Path, Base),
    file_name_extension(Name, pl, Base),
    format(atom(Document), 'doc/~w.md', [Name]),
    read_file_to_terms(Path, Terms, [encoding(utf8)]).

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
    length(Lines, Line).

file_text(File, Text) :-
    project_file(File, Path),
    read_file_to_string(Path, Text, [encoding(utf8)]).

%!  promise_problem(-Problem:string) is nondet.
%
%   An anchor without a promise, a promise without an anchor, without a test, or
%   whose text is gone from the product; two promises of one name.

promise_problem(Problem) :-
    promised(Document, Terms),
    file_text(Document, Text),
    findall(Anchor, anchor(Text, Anchor), Anchors),
    (   member(Term, Terms),
        term_problem(Term, Anchors, Message)
    ;   member(Anchor, Anchors),
        \+ memberchk(promise(Anchor, _, _, _), Terms),
        format(string(Message), "no promise has the name ~w", [Anchor])
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

term_problem(promise(Name, Suites, File, Old-_), Anchors, Message) :-
    !,
    (   \+ memberchk(Name, Anchors),
        format(string(Message), "~w has no anchor", [Name])
    ;   suite_list(Suites, List),
        member(Suite, List),
        \+ suite_named(Suite, _),
        format(string(Message), "~w: there is no suite ~w", [Name, Suite])
    ;   file_text(File, Text),
        \+ aggregate_all(count, sub_string(Text, _, _, _, Old), 1),
        format(string(Message), "~w: its text is not once in ~w", [Name, File])
    ).
term_problem(Term, _, Message) :-
    format(string(Message), "no promise: ~p", [Term]).

%!  check_promises is semidet.
%
%   Print all problems; fail if there are any.

check_promises :-
    findall(Problem, promise_problem(Problem), Problems),
    forall(member(Problem, Problems),
           format(user_error, '~s~n', [Problem])),
    Problems == [].
