:- module(typhon_guard_limits,
          [ refuse/1,                   % +Culprit
            must_be_tree/1,             % +Term
            clause_cells/1,             % -Max
            harmless_format/1,          % +Format
            short_text/1,               % +Goal
            readable_text/1             % +Goal
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(lists), [member/2, sum_list/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/error_text', [is_tree/2]).
:- use_module('../../kernel/host', [context_now/2, parts/3]).

/** <module> Limits on the size of terms and texts of untrusted agents

Limits apply to clauses, where a shared subterm counts at each occurrence; to
format strings; to texts that become atoms; and to texts that are read as terms.
The module also raises the error of refused code.

*Threading*: any thread; no state.
*/

:- setting(clause_cells, positive_integer, 200 000,
           "Clauses that untrusted agents add have at most so many parts").
:- setting(atom_chars, positive_integer, 1000,
           "Atoms that untrusted agents make have at most so many characters").

%!  must_be_tree(+Term) is det.
%
%   Term is acyclic, and no larger than a clause may be.  A shared subterm
%   counts at each of its occurrences.
%
%   @error resource_error(clause_cells)

must_be_tree(Term) :-
    clause_cells(Max),
    (   is_tree(Term, Max)
    ->  true
    ;   throw(error(resource_error(clause_cells), _))
    ).

%!  clause_cells(-Max:integer) is det.
%
%   A clause of an untrusted agent has at most Max parts.

clause_cells(Max) :-
    setting(clause_cells, Max).

%!  refuse(+Culprit)
%
%   Refuse Culprit.  The error holds only the name of a large term.
%
%   @error permission_error(call, sandboxed, Culprit)

refuse(Culprit) :-
    (   \+ is_tree(Culprit, 1000),
        callable(Culprit)
    ->  functor(Culprit, Name, Arity),
        permission_error(call, sandboxed, Name/Arity)
    ;   permission_error(call, sandboxed, Culprit)
    ).

                /*******************************
                *            TEXTS             *
                *******************************/

%!  harmless_format(+Format) is semidet.
%
%   Format has no directives but those of directive//0.  Anything else is
%   refused: format/3 may take it for a directive that calls a goal.

harmless_format(Format) :-
    text_string(Format, String),
    string_codes(String, Codes),
    phrase(harmless, Codes).

harmless -->
    [].
harmless -->
    "~",
    !,
    directive,
    harmless.
harmless -->
    [_],
    harmless.

%   A count has at most three digits.  Neither modifiers (`:`) nor counts from
%   the arguments (`*`) are allowed; a character as count (`~`xt`) is allowed
%   only to fill a column.

directive -->
    "`", !, [_], "t".
directive -->
    digits(3),
    [Letter],
    { memberchk(Letter, `~wqadDsefgcrRnt|+`) }.

digits(Most) -->
    { Most > 0 },
    [Digit],
    { between(0'0, 0'9, Digit) },
    !,
    { Fewer is Most-1 },
    digits(Fewer).
digits(_) -->
    [].

%   text_string(+Text, -String) is semidet.

text_string(Text, String) :-
    ( atomic(Text) ; is_list(Text), ground(Text) ),
    !,
    catch(text_to_string(Text, String), error(_, _), fail).

%!  short_text(+Goal) is semidet.
%
%   The atoms that Goal makes are short.  Atoms are stored outside the stacks of
%   the agent, so they are kept short, and counted; long texts are strings.

short_text(Goal) :-
    most_characters(Max),
    joined_length(Goal, Length),
    Length =< Max,
    all_solutions(Goal, Length, Made),
    made(Made).

%   all_solutions(+Goal, +Length, -Made): Made is the number of characters in
%   all solutions; there may be one for each part of a text.

all_solutions(sub_atom(_, Before, Count, After, Sub), Length, Made) =>
    (   ( nonvar(Sub) ; nonvar(Before), nonvar(Count)
        ; nonvar(Count), nonvar(After) ; nonvar(Before), nonvar(After) )
    ->  Made = Length
    ;   Made is Length*Length
    ).
all_solutions(atom_concat(A, B, _), Length, Made), var(A), var(B) =>
    Made is Length*Length.
all_solutions(_, Length, Made) =>
    Made = Length.

%   made(+Length): tell options of the host, such as quotas, that the running
%   agent makes atoms with Length characters in all.

made(Length) :-
    (   context_now(Host, Agent),
        Agent \== none,
        parts(makes_text, Host, Closures)
    ->  forall(member(Closure, Closures), call(Closure, Length))
    ;   true
    ).

most_characters(Max) :-
    setting(atom_chars, Max).

%   joined_length(+Goal, -Length): the greatest length of the result.

joined_length(atomic_list_concat(List, Separator, _), Length) :-
    is_list(List),
    !,
    length(List, Count),
    argument_length(List, Length1),
    argument_length(Separator, Length2),
    Length is Length1+Count*Length2.
joined_length(Goal, Length) :-
    compound_name_arguments(Goal, _, Args),
    sum_lengths(argument_length, Args, Length).

:- meta_predicate sum_lengths(2, +, -).

sum_lengths(Goal, List, Length) :-
    maplist(Goal, List, Lengths),
    sum_list(Lengths, Length).

%   For an argument that is neither atomic nor a list the goal itself raises a
%   type error, so its length does not matter.

argument_length(Arg, Length) :-
    (   is_list(Arg)
    ->  sum_lengths(item_length, Arg, Length)
    ;   compound(Arg)
    ->  parts_length(Arg, Length)
    ;   item_length(Arg, Length)
    ).

item_length(Item, Length) :-
    (   number(Item)
    ->  number_length(Item, Length)
    ;   atomic(Item)
    ->  atom_length(Item, Length)
    ;   Length = 0
    ).

%   is_tree/2 bounds the size of a large integer without writing it.

number_length(Number, Length) :-
    most_characters(Max),
    (   is_tree(Number, Max)
    ->  atom_length(Number, Length)
    ;   Length is Max+1
    ).

%   Term holds the components of a URI, or is a partial list.

parts_length(Term, Length) :-
    most_characters(Max),
    is_tree(Term, Max),
    compound_name_arguments(Term, _, Args),
    sum_lengths(argument_length, Args, Length).

%!  readable_text(+Goal) is semidet.
%
%   Goal reads a text as a term, or writes a term as an atom.  The text must not
%   be longer than an atom may be, since it may become one, and must hold no
%   quasi quotation, which would call a parser by name.

readable_text(term_to_atom(Term, Text)) :-
    (   var(Text)
    ->  most_characters(Max),
        Parts is 1+Max//8,              % as is_tree/2 counts
        is_tree(Term, Parts),
        made(Max)
    ;   readable(Text)
    ).
readable_text(term_string(_, Text)) :-
    (   var(Text)
    ->  true
    ;   readable(Text)
    ).
readable_text(atom_to_term(Text, _, _)) :-
    readable(Text).

readable(Text) :-
    text_string(Text, String),
    \+ sub_string(String, _, _, _, "{|"),
    string_length(String, Length),
    most_characters(Max),
    Length =< Max,
    made(Length).
