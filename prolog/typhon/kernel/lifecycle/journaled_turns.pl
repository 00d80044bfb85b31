:- module(typhon_journaled_turns, []).
:- use_module('../base/durable_changes',
              [durable_on/0, enqueue_changes/0, unit_of_work/1]).
:- use_module('../base/unit_of_work',
              [ unit_commit/0, unit_has_effects/0, unit_release/0,
                unit_run/1 ]).
:- use_module('../agent', [agent_put_down/3]).
:- use_module(turn, []).

/** <module> With a journal, a turn is one unit of work

What the agent has done in its turn is noted together with what it is to do
next, and released after that: as soon as the agent rests another worker may
run it, and what it says then must not overtake what it said before.

*Threading*: in the worker that has the agent.
*/

:- multifile
    typhon_turn:settle/0,
    typhon_turn:unit/2.

typhon_turn:unit(typhon_journaled_turns:run,
                 typhon_journaled_turns:conclude) :-
    durable_on.

typhon_turn:settle :-
    unit_commit,
    unit_release.

:- public run/1, conclude/4.

run(Goal) :-
    unit_run(Goal).

conclude(Id, Outcome, Conclude, Next) :-
    unit_of_work(( turn_ends(Outcome, Id),
                   call(Conclude),
                   noted(Next, Id) )),
    unit_release.

turn_ends(effect(Control, Hole, Goals), Id) :-
    !,
    \+ \+ ( Hole = Control,
            before_it_rests(Id, Goals) ).
turn_ends(done, Id) :-
    !,
    before_it_rests(Id, []).
turn_ends(_, _) :-
    unit_commit.

before_it_rests(Id, Goals) :-
    (   unit_has_effects
    ->  unit_commit,
        agent_put_down(Id, ready, Goals),
        enqueue_changes,
        unit_release
    ;   true
    ).

noted(stop, _).
noted(go(Goals), Id) :-
    agent_put_down(Id, ready, Goals).
noted(elsewhere(Goals), Id) :-
    agent_put_down(Id, ready, Goals).
