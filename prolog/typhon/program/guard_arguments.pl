:- module(typhon_guard_arguments,
          [ looked_at/4                 % +Kind, +Policy, +Goal0, -Goal
          ]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/trees', [is_tree/2]).
:- use_module(allowed, [own_name/1]).
:- use_module(guard, [allowed_fact/2, guard_clauses/3]).
:- use_module(refusing, [clause_cells/1, must_be_tree/1, refuse/1]).

/** <module> What strangers call things with

Whether some goals are allowed depends on their arguments: what they add and
take away, what they throw, and texts.

*Threading*: pure.
*/

:- setting(atom_chars, positive_integer, 1000,
           "Atoms that strangers make have at most so many characters").
:- setting(ball_cells, positive_integer, 10 000,
           "What strangers throw has at most so many parts").

%!  looked_at(+Kind, +Policy, +Goal0, -Goal) is det.
%
%   What a goal depends on is known now; Kind is as of allowed/3.
%
%   @error permission_error(call, sandboxed, Culprit)

looked_at(clause, _, Goal, Goal) :-
    arg(1, Goal, Fact),
    clause_cells(Max),
    allowed_fact(Fact, Max),
    !.
looked_at(clause, Policy, Goal0, Goal) :-
    Goal0 =.. [Name,Clause0],
    must_be_tree(Clause0),
    nonvar(Clause0),
    \+ ( Clause0 = (Head:-_), \+ callable(Head) ),
    !,
    guard_clauses(Policy, [Clause0], [Clause]),
    Goal =.. [Name,Clause].
looked_at(pattern, _, Goal, Goal) :-
    Goal = retract(Clause),
    nonvar(Clause),
    ( Clause = (Head:-_) -> true ; Head = Clause ),
    unqualified(Head),
    !.
looked_at(head, _, Goal, Goal) :-
    arg(1, Goal, Head),
    unqualified(Head),
    own_name(Head),
    !.
looked_at(ball, _, throw(Ball), throw(Ball)) :-
    nonvar(Ball),
    \+ ends_thread(Ball),
    setting(ball_cells, Max),
    is_tree(Ball, Max),
    !.
looked_at(format, _, Goal, Goal) :-
    Goal = format(Sink, Format, _),
    nonvar(Sink),
    sink(Sink),
    text_of(Format, Codes),
    harmless(Codes),
    !.
looked_at(text, _, Goal, Goal) :-
    short_text(Goal),
    !.
looked_at(term_text, _, Goal, Goal) :-
    must_be_tree(Goal),
    no_quotation(Goal),
    !.
looked_at(payload, _, attach(Spec), attach(Spec)) :-
    nonvar(Spec),
    Spec = payloads(Path),
    ground(Path),
    inside(Path),
    !.
looked_at(_, _, Goal, _) :-
    refuse(Goal).

unqualified(Head) :-
    callable(Head),
    Head \= _:_.

%   What ends a thread, or stops what is measured.

ends_thread('$aborted').
ends_thread(unwind(_)).
ends_thread(inference_limit_exceeded(_)).
ends_thread(depth_limit_exceeded).
ends_thread(time_limit_exceeded).
ends_thread(time_limit_exceeded(_)).

sink(string(_)).
sink(codes(_)).
sink(chars(_)).

text_of(Text, Codes) :-
    ( atomic(Text) ; is_list(Text), ground(Text) ),
    catch(text_to_string(Text, String), error(_, _), fail),
    string_codes(String, Codes).

%   No directive that calls (`~@`), asks others how to print (`~p`), takes
%   its width from the arguments (`~*`), or has one of more than 999.

harmless([]).
harmless([0'~|Codes]) :-
    !,
    directive(Codes, 0, Rest),
    harmless(Rest).
harmless([_|Codes]) :-
    harmless(Codes).

directive([Digit|Codes], N, Rest) :-
    code_type(Digit, digit),
    !,
    N < 3,
    N1 is N+1,
    directive(Codes, N1, Rest).
directive([0'`,_|Codes], _, Rest) :-
    !,
    directive(Codes, 0, Rest).
directive([Code|Rest], _, Rest) :-
    \+ memberchk(Code, [0'@, 0'p, 0'*, 0'i]).

%   Atoms live outside the stacks of the agent, so they are kept short;
%   long texts are strings.

short_text(Goal) :-
    setting(atom_chars, Max),
    Goal =.. [_|Args],
    text_length(Args, Max).

text_length([], _).
text_length([Arg|Args], Left) :-
    argument_length(Arg, Left, Length),
    Left1 is Left-Length,
    Left1 >= 0,
    text_length(Args, Left1).

argument_length(Arg, _, 0) :- var(Arg), !.
argument_length(Arg, Left, Length) :-
    is_list(Arg),
    !,
    length(Arg, Count),
    Count =< Left,
    items_length(Arg, 0, Length).
argument_length(Arg, _, Length) :-
    atomic(Arg),
    !,
    atom_length(Arg, Length).
argument_length(_, _, 0).               % which is a type error

items_length([], N, N).
items_length([Item|Items], N0, N) :-
    (   atomic(Item)
    ->  atom_length(Item, Length),
        N1 is N0+Length
    ;   N1 = N0
    ),
    items_length(Items, N1, N).

no_quotation(Goal) :-
    \+ ( arg(_, Goal, Text),
         atomic(Text),
         sub_string(Text, _, _, _, "{|") ).

inside(Path) :-
    (   atom(Path)
    ->  \+ sub_atom(Path, _, _, _, '..'),
        \+ is_absolute_file_name(Path)
    ;   Path = A/B,
        inside(A),
        inside(B)
    ).

