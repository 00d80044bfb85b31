:- module(site_playable,
          [ playable/4,                 % +Path, ?N, -Files, -Queries
            playable_sessions/2,        % +Path, -Sessions
            playables/0
          ]).
:- use_module(documents, [document/2]).
:- use_module(library(http/json), [json_write_dict/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(lists), [append/3, last/2, member/2, memberchk/2, nth1/3]).

/** <module> The sessions of documents that readers can run in their browser

Those of a document whose networks are in virtual time, in the tab of a browser.

*Threading*: any thread.
*/

%!  playable(+Path, ?N, -Files:list(pair), -Queries:list(string)) is nondet.
%
%   The session with the number N in the document Path runs Queries: its own, and
%   those of earlier sessions since the network was started, without what stops
%   it.  Files are Name-Content, the programs shown before it.

playable(Path, N, Files, Queries) :-
    read_file_to_string(Path, Text, [encoding(utf8)]),
    sub_string(Text, _, _, _, "clock(virtual)"),
    !,
    blocks(Text, Blocks),
    findall(Session, member(block("prolog-session", Session), Blocks), Sessions),
    nth1(N, Sessions, Session),
    append(Before, [block("prolog-session", Session)|_], Blocks),
    findall(Name-Content,
            ( member(block(Kind, Content), Before),
              memberchk(Kind, ["prolog", "text"]),
              file_shown(Content, Name) ), Files),
    length(Earlier, N),
    append(Earlier, _, Sessions),
    since_start(Earlier, Mine),
    append(Others, Mine, Earlier),
    findall(Query, ( member(One, Others),
                     query_in(One, Query),
                     loads(Query) ), Queries0, Queries1),
    findall(Query, ( member(One, Mine), query_in(One, Query) ), Queries1),
    append(First, [Last], Queries0),
    going_on(Last, On),
    append(First, On, Queries),
    virtual(Files, Queries),
    \+ ( member(Query, Queries), elsewhere(Word),
         sub_string(Query, _, _, _, Word) ).

virtual(Files, Queries) :-
    ( member(Text, Queries) ; member(_-Text, Files) ),
    sub_string(Text, _, _, _, "clock(virtual)"),
    !.

%!  playable_sessions(+Path, -Sessions:list(pair)) is det.
%
%   Sessions are Text-Id of the sessions of the document Path.

playable_sessions(Path, Pairs) :-
    read_file_to_string(Path, Text, [encoding(utf8)]),
    blocks(Text, Blocks),
    findall(Session, member(block("prolog-session", Session), Blocks), Sessions),
    findall(Session-Id,
            ( playable(Path, N, _, _),
              nth1(N, Sessions, Session),
              format(atom(Id), '~w:~d', [Path, N]) ),
            Pairs).

%!  playables is det.
%
%   Write all of them to the current output, as JSON.

playables :-
    module_property(site_playable, file(Here)),
    absolute_file_name('../..', Root, [relative_to(Here)]),
    working_directory(_, Root),
    findall(_{id:Id, files:Pairs, queries:Queries},
            ( document('.', Path),
              playable(Path, N, Files, Queries),
              format(string(Id), "~w:~d", [Path, N]),
              findall([Name, Content], member(Name-Content, Files), Pairs) ),
            Dicts),
    current_output(Out),
    set_stream(Out, encoding(utf8)),
    json_write_dict(Out, Dicts, [width(0)]).

%   What a tab does not have.

elsewhere("processes(").
elsewhere("page_start").
elsewhere("journal").
elsewhere("shell(").
elsewhere(", sleep(").                  % of a query, not of an agent

blocks(Text, Blocks) :-
    atomic_list_concat(Parts, "\n```", Text),
    findall(block(Kind, Content),
            ( nth1(I, Parts, Part),
              I mod 2 =:= 0,
              once(sub_string(Part, Length, 1, After, "\n")),
              sub_string(Part, 0, Length, _, Kind),
              sub_string(Part, _, After, 0, Content0),
              string_concat(Content0, "\n", Content) ),
            Blocks).

%   The first line of a program is a comment with its name.

file_shown(Content, Name) :-
    once(sub_string(Content, Length, _, _, "\n")),
    sub_string(Content, 0, Length, _, Line),
    split_string(Line, " ", ":", ["%", Text|_]),
    atom_string(Name, Text),
    file_name_extension(_, pl, Name).

since_start(Sessions, Mine) :-
    append(_, [Start|After], Sessions),
    starts(Start),
    \+ ( member(Later, After), starts(Later) ),
    !,
    Mine = [Start|After].
since_start(Sessions, [Session]) :-
    last(Sessions, Session).

starts(Session) :-
    sub_string(Session, _, _, _, "network_start("),
    !.

%   A query is one line; its answer follows.

query_in(Session, Query) :-
    split_string(Session, "\n", "", Lines),
    member(Query, Lines),
    string_concat("?- ", _, Query).

loads(Query) :-
    ( string_concat("?- [", _, Query) ; string_concat("?- use_module(", _, Query) ),
    !.

%   The last query without the stop of the network, which readers want to see.

going_on(Query, On) :-
    (   once(sub_string(Query, Before, _, _, "network_stop("))
    ->  sub_string(Query, 0, Before, _, Start),
        (   string_concat(Start1, ", ", Start)
        ->  string_concat(Start1, ".", Kept),
            On = [Kept]
        ;   On = []
        )
    ;   On = [Query]
    ).
