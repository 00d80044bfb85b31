:- module(typhon_agent_words,
          [ words_only/3,               % +Query, +Module, -PI
            word_lines/3,               % +Spec, //
            directive_meant/2,          % +Directive, -Directives
            directive_coloured/2,       % +Directive, -Colours
            words_file/1,               % ?File
            help_shown/1,               % +HTML
            apropos_completed/3         % +Told, -Pairs, -Count
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(solution_sequences), [distinct/2, limit/2]).
:- autoload(library(prolog_xref), [xref_source/2]).
:- use_module('../kernel/program',
              [indicator_in/2, vocabulary_word/2]).
:- autoload('../language', [declaration/4]).
:- use_module('../kernel/vocabulary', []).

/** <module> Predicates of agents, for the top level, help/1 and editors

`move(beta)` is for programs of agents.  Called at the top level or in a module,
it raises an error that names the predicate to call instead.  Prolog itself
would propose the predicate of the module that implements it.

Editors such as PceEmacs, Sweep for Emacs and the language server lsp_server
parse a program by library(prolog_xref) and library(prolog_colour).  For a file
with `:- agent(Name, Options)` this module declares to them the vocabulary of
agents as built-in predicates, main/0 and on_message/2 as called, and the state
as predicates of the file; for a payload, the predicates that it provides.
Loading a file is not affected.

Prolog's apropos/1 searches only its own manual; this module adds matches among
the exports of library(typhon) and the vocabulary of agents.  Prolog's help/1
prints a comment once for each predicate that the comment documents; this module
removes the repetitions.  The modules of Prolog for this are loaded at the first
request.

*Threading*: any thread; editors: see prolog_load_context/2.
*/

%!  words_only(+Query, +Module, -PI) is semidet.
%
%   A goal of Query calls PI, which is in the vocabulary of agents and undefined
%   in Module.

words_only(Query, Module, PI) :-
    goal(Query, Module, Goal),
    functor(Goal, Name, Arity),
    PI = Name/Arity,
    vocabulary_word(_, PI),
    \+ predicate_property(Module:Goal, visible),
    !.

%   goal(+Query, +Module, -Goal) is nondet: Goal is Query, or a goal that Query
%   calls.

goal(Query, _, Query) :-
    callable(Query).
goal(Query, Module, Goal) :-
    callable(Query),
    Query \= _:_,
    predicate_property(Module:Query, meta_predicate(Spec)),
    arg(I, Spec, 0),
    arg(I, Query, Argument),
    goal(Argument, Module, Goal).

%!  word_lines(+Spec, -Text, ?Rest) is semidet.
%
%   Text is the error message for the unknown procedure Spec, which is in the
%   vocabulary of agents.

word_lines(Spec) -->
    { own_module(Spec, PI),
      vocabulary_word(_, PI)
    },
    [ 'Unknown procedure: ~p: the program of an agent can call it'-[PI] ],
    instead(PI).

own_module(Name/Arity, Name/Arity).
own_module(user:PI, PI).

instead(PI) -->
    { outside(PI, Text) },
    !,
    [ '; from outside it is ~w'-[Text] ].
instead(_) -->
    [].

%   outside(+PI, -Text): Text is the call that has the same effect outside of
%   agents.

outside(move/1, 'agent_move(Agent, Host)').
outside(move/2, 'agent_move(Agent, Host)').
outside(clone/1, 'agent_clone(Agent, Clone)').
outside(clone/2, 'agent_clone(Agent, Clone)').
outside(send/2, 'agent_send(Agent, Message)').
outside(dispose/0, 'agent_dispose(Agent)').
outside(attach/1, 'payload_attach(Agent, Payload)').
outside(detach/1, 'payload_detach(Agent, Name)').
outside(result/1, 'agent_result(Agent, Term, Timeout)').
outside(home/1, 'agent_property(Agent, home(Host))').
outside(here/1, 'agent_property(Agent, host(Host))').
outside(hops/1, 'agent_property(Agent, hops(Count))').
outside(neighbours/1, 'host_property(Host, neighbours(Hosts))').
outside(host_load/1, 'host_property(Host, load(Count))').
outside(PI, Text) :-
    member(PI, [leave/1, leave_new/1, sense/1, take/1, now/1, emit/1, emit/2,
                withdraw/1, pheromone/3]),
    PI = Name/Arity,
    length(Arguments, Arity),
    maplist(=('_'), Arguments),
    Goal =.. [Name|Arguments],
    format(atom(Text), 'remote(Host, ~w)', [Goal]).

                /*******************************
                *           EDITORS            *
                *******************************/

%!  directive_meant(+Directive, -Directives) is semidet.
%
%   Directive declares an agent or a payload; Directives express the same for
%   the cross-referencer.

directive_meant(Directive, Directives) :-
    declared(Directive, Kind, Options),
    findall((:- Meant), meant(Kind, Options, Meant), Directives).

declared(Directive, Kind, Options) :-
    predicates_option(Kind, _, _),
    declaration(Kind, (:- Directive), _, Options),
    !.

meant(_, _, use_module(File)) :-
    words_file(File).
meant(agent, _, public([main/0, on_message/2])).
meant(Kind, Options, Meant) :-
    predicates_option(Kind, PIs, Option),
    member(Option, Options),
    findall(PI, indicator_in(PIs, PI), List),
    (   Meant = dynamic(List)
    ;   Kind == payload,
        Meant = public(List)            % agents with the payload may call them
    ).

predicates_option(agent, PIs, state(PIs)).
predicates_option(payload, PIs, provides(PIs)).

%!  words_file(?File) is nondet.
%
%   File defines predicates that agents can call.

words_file(File) :-
    distinct(Module, vocabulary_word(Module, _)),
    module_property(Module, file(File)).

%!  directive_coloured(+Directive, -Colours) is semidet.
%
%   As prolog_colour:directive_colours/2.

directive_coloured(Directive, built_in-Arguments) :-
    declared(Directive, Kind, Options),
    (   Options == []
    ->  Arguments = [identifier,classify]
    ;   findall(Colours, option_colours(Kind, Options, Colours), List),
        Arguments = [identifier,list-List]
    ).

option_colours(Kind, Options, Colours) :-
    member(Option, Options),
    (   predicates_option(Kind, _, Known),
        subsumes_term(Known, Option)
    ->  Colours = functor-[predicates]
    ;   Colours = type_error(option)
    ).

%   part(?What, ?Module): Module of Prolog's manual implements What.

part(help, prolog_help).
part(comments, pldoc_process).

%!  help_shown(+HTML) is semidet.
%
%   Show HTML, a page of help/1, without its repetitions.  Fails if it has none.

help_shown(HTML) :-
    begins(Mark),
    atomic_list_concat([Begin|Pieces0], Mark, HTML),
    once_each(Pieces0, [], Pieces),
    Pieces \== Pieces0,
    atomic_list_concat([Begin|Pieces], Mark, Once),
    part(help, Help),
    Help:show_html(Once).

%   begins(?Mark): the text on a predicate begins with Mark.

begins('<div class="navhdr">').

%   once_each(+Pieces0, +Before, -Pieces): drop pieces that begin with one of
%   the pieces before.  The last piece may be longer, as it also has the end of
%   the page.

once_each([], _, []).
once_each([Piece|Pieces0], Before, Pieces) :-
    split_string(Piece, "", "\n ", [Text]),
    (   member(Earlier, Before),
        string_concat(Earlier, _, Text)
    ->  Pieces = Pieces1
    ;   Pieces = [Piece|Pieces1]
    ),
    once_each(Pieces0, [Text|Before], Pieces1).

                /*******************************
                *            APROPOS           *
                *******************************/

%!  apropos_completed(+Told, -Pairs, -Count) is semidet.
%
%   Told is the message of apropos/1.  Pairs are the matches to show: first
%   those of Typhon, then those of the manual.  Count is the number of all
%   matches.

apropos_completed(no_apropos_match(Query), Pairs, Count) :-
    matches(Query, Ours),
    Ours \== [],
    findall(Pair, limit(20, member(Pair, Ours)), Pairs),
    length(Ours, Count).
apropos_completed(apropos_matches(Manual, Count0), Pairs, Count) :-
    asked(Query),
    matches(Query, Ours),
    Ours \== [],
    findall(Pair, limit(12, member(Pair, Ours)), Nearest),
    append(Nearest, Manual, All),
    findall(Pair, limit(20, member(Pair, All)), Pairs),
    length(Ours, Length),
    Count is Count0+Length.

%   asked(-Query): the message does not hold the query, so it is read from the
%   stack frame of apropos/1.

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

%   matches(+Query, -Pairs): Pairs are PI-Summary of the predicates of Typhon
%   that have all words of Query in name or summary; those with all words in the
%   name come first.

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

%   ours(?Module, -PI): PI is public, and is defined in Module.

ours(Module, Name/Arity) :-
    (   module_property(typhon, exports(PIs)),
        Interface = typhon,
        member(Name/Arity, PIs)
    ;   vocabulary_word(Interface, Name/Arity)
    ),
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
