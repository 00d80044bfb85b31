:- module(typhon_manual,
          [ help_shown/1,               % +HTML
            apropos_completed/3         % +Told, -Pairs, -Count
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module('../kernel/vocabulary', []).
:- autoload(library(prolog_xref), [xref_source/2]).

/** <module> Our predicates in help/1 and apropos/1

Prolog's apropos/1 looks into its own manual only: what it has found is
completed by what library(typhon) exports, and what agents can say.  Its
help/1 prints a comment once for each predicate that the comment is about: of
several that are the same, one is left.

The modules of Prolog that do it are loaded at the first request.

*Threading*: called by library(help), in the thread that asks.
*/

%   part(?What, ?Module): of Prolog's manual.

part(help, prolog_help).
part(comments, pldoc_process).

                /*******************************
                *             HELP             *
                *******************************/

%!  help_shown(+HTML) is semidet.
%
%   Show HTML, a page of help/1, without its repetitions, if it has any.

help_shown(HTML) :-
    begins(Mark),
    atomic_list_concat([Begin,First|More0], Mark, HTML),
    once_each(More0, First, More),
    More \== More0,
    atomic_list_concat([Begin,First|More], Mark, Once),
    part(help, Help),
    Help:show_html(Once).

%   begins(?Mark): what is about one predicate begins with it.

begins('<div class="navhdr">').

%   once_each(+Pieces0, +First, -Pieces): without those that are First; the
%   last has the end of the page behind it.

once_each([], _, []).
once_each([Piece|Pieces0], First, Pieces) :-
    split_string(First, "", "\n ", [Text]),
    split_string(Piece, "", "\n ", [Same]),
    string_concat(Text, _, Same),
    !,
    once_each(Pieces0, First, Pieces).
once_each([Piece|Pieces0], First, [Piece|Pieces]) :-
    once_each(Pieces0, First, Pieces).

                /*******************************
                *            APROPOS           *
                *******************************/

%!  apropos_completed(+Told, -Pairs, -Count) is semidet.
%
%   Told is what apropos/1 prints; Pairs are the manual's matches behind the
%   first of ours, as many as are shown, and Count is the number of all.

apropos_completed(no_apropos_match(Query), Pairs, Count) :-
    matches(Query, Ours),
    Ours \== [],
    first(20, Ours, Pairs),
    length(Ours, Count).
apropos_completed(apropos_matches(Manual, Count0), Pairs, Count) :-
    asked(Query),
    matches(Query, Ours),
    Ours \== [],
    first(12, Ours, Nearest),
    append(Nearest, Manual, All),
    first(20, All, Pairs),
    length(Ours, Length),
    Count is Count0+Length.

first(Count, All, First) :-
    length(First, Count),
    append(First, _, All),
    !.
first(_, All, All).

%   asked(-Query): apropos/1 does not say what for, but is still there.

asked(Query) :-
    part(help, Help),
    asking(Help, Query, Goal),
    prolog_current_frame(Frame),
    prolog_frame_attribute(Frame, parent_goal, Goal),
    !.

asking(Help, Query, Help:apropos(Query)).
asking(Help, Query, Help:apropos_no_trace(Query)).
asking(Help, Query,
       system:setup_call_cleanup(
                  _, system:once(Help:apropos_no_trace(Query)), _)).
asking(Help, Query,
       system:setup_call_catcher_cleanup(
                  _, system:once(Help:apropos_no_trace(Query)), _, _)).

%   matches(+Query, -Pairs): PI-Summary of our predicates that have all words
%   of Query in name or summary; names first.

matches(Query, Pairs) :-
    query_text(Query, Text),
    string_lower(Text, Lower),
    split_string(Lower, " ", " ", Words),
    findall(Rank-(PI-Summary),
            ( ours(Module, PI),
              summary(Module, PI, Summary),
              matches(Words, PI, Summary, Rank) ),
            Ranked),
    sort(Ranked, Sorted),
    pairs_values(Sorted, Pairs).

query_text(Type:Text, Text) :-
    !,
    member(Class, [predicate, library_predicate]),
    sub_atom(Class, 0, _, _, Type),
    !.
query_text(Text, Text).

matches(Words, Name/_, Summary0, Rank) :-
    string_lower(Summary0, Summary),
    maplist(part_of_one([Name,Summary]), Words),
    (   maplist(part_of_one([Name]), Words)
    ->  Rank = 0
    ;   Rank = 1
    ).

part_of_one(Texts, Word) :-
    member(Text, Texts),
    sub_string(Text, _, _, _, Word),
    !.

%   ours(?Module, -PI): PI is public, and defined in Module.

ours(Module, Name/Arity) :-
    member(Interface, [typhon, typhon_words, typhon_memory]),
    module_property(Interface, exports(PIs)),
    member(Name/Arity, PIs),
    functor(Head, Name, Arity),
    (   predicate_property(Interface:Head, imported_from(Module))
    ->  true
    ;   Module = Interface
    ).

summary(Module, PI, Summary) :-
    part(comments, Comments),
    (   Comments:doc_comment(Module:_, _, _, _)
    ->  true
    ;   module_property(Module, file(File)),
        xref_source(File, [comments(store)])
    ),
    Comments:doc_comment(Module:PI, _, Summary, _),
    !.
