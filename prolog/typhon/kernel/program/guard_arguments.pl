:- module(typhon_guard_arguments,
          [ looked_at/4                 % +Kind, +Policy, +Goal0, -Goal
          ]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/trees', [is_tree/2]).
:- use_module(allowed, [own_name/1]).
:- use_module(guard, [allowed_fact/2, guard_clauses/3]).
:- use_module(guard_texts,
              [harmless_format/1, readable_text/1, short_text/1]).
:- use_module(refusing, [clause_cells/1, must_be_tree/1, refuse/1]).

/** <module> Arguments of what untrusted agents call

Whether some goals are allowed depends on their arguments: what they add and
take away, what they throw, and texts, see typhon_guard_texts.

*Threading*: pure.
*/

:- setting(ball_cells, positive_integer, 10 000,
           "What untrusted agents throw has at most so many parts").

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
    Goal = format(Sink, Format, Args),
    nonvar(Sink),
    sink(Sink),
    must_be_tree(Format-Args),
    harmless_format(Format),
    !.
looked_at(text, _, Goal, Goal) :-
    short_text(Goal),
    !.
looked_at(term_text, _, Goal, Goal) :-
    must_be_tree(Goal),
    readable_text(Goal),
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

inside(Path) :-
    (   atom(Path)
    ->  \+ sub_atom(Path, _, _, _, '..'),
        \+ is_absolute_file_name(Path)
    ;   Path = A/B,
        inside(A),
        inside(B)
    ).

