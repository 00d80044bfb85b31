:- module(test_quick, []).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/host/short_turns)).

/** <module> Turns that are short, and what is remembered of those that are not

The agents here are names; their kind is the name before the slash.

*Threading*: the main thread.
*/

:- multifile typhon_scheduler:kind/2.

typhon_scheduler:kind(Agent, Kind) :-
    atom(Agent),
    sub_atom(Agent, Before, _, _, /),
    !,
    sub_atom(Agent, 0, Before, _, Kind).

short :-
    true.

long :-
    forall(between(1, 30000, _), succ_or_zero(1)).

succ_or_zero(_).

%   A turn in which another thread has run is long, too: some kind was not held
%   up.

:- meta_predicate some_kind(+, 1).

some_kind(Name, Goal) :-
    between(1, 20, I),
    atomic_list_concat([Name,I,/], Agent),
    call(Goal, Agent),
    !.

long_once(Agent) :-
    quick_turn(Agent, long),
    \+ quick_turn(Agent, short),
    atom_concat(another_, Agent, Another),
    quick_turn(Another, short).

now_and_then(Agent) :-
    quick_turn(Agent, waits),
    forall(between(1, 10, _), quick_turn(Agent, short)),
    quick_turn(Agent, waits),
    quick_turn(Agent, short).

waits :-
    thread_self(Me),
    \+ thread_get_message(Me, never, [timeout(0.006)]).

:- begin_tests(quick).

test(unknown_kind, fail) :-
    quick_turn(nobody, short).
test(short) :-
    forall(between(1, 100, _), quick_turn('a/1', short)).
test(long_once) :-
    some_kind(b, long_once).
test(waits_once) :-
    quick_turn('d/1', waits),
    quick_turn('d/2', short).
test(waits_twice_in_a_row) :-
    quick_turn('e/1', waits),
    quick_turn('e/2', waits),
    \+ quick_turn('e/3', short).
test(waits_now_and_then) :-
    some_kind(f, now_and_then).
test(longer_memory_stays) :-
    quick_not('g/1', 60),
    quick_not('g/1', 0),
    \+ quick_turn('g/2', short).
test(is_forgotten) :-
    quick_not('h/1', 0),
    quick_turn('h/2', short).

:- end_tests(quick).
