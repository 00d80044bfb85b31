:- module(typhon_turn,
          [ turn_run/1,                 % :Goal
            turn_defers/0,
            turn_note/1,                % +Change
            turn_note_put/4,            % +Kind, +Key, +N, +Term
            turn_note_drop/3,           % +Kind, +Key, +N
            turn_after/1,               % :Goal
            turn_has_effects/0,
            turn_commit/0,
            turn_release/0
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(item_key, [journal_key/2]).
:- use_module(ledger,
              [journal_on/0, note_change/1, note_putting/5]).

/** <module> What an agent does between two stops

It is to happen as a whole or not at all: so what it sends, leaves and takes
is put off until it stops.  Then all that is noted together with what the agent
is from there on, and only then released to others.

*Threading*: each thread has its own turn.
*/

:- meta_predicate
    turn_run(0),
    turn_after(0).

:- thread_local
    change/1,                           % see typhon_store
    after/1.                            % Goal

%!  turn_run(:Goal) is det.
%
%   Run Goal, the native part of a turn of an agent.

turn_run(Goal) :-
    (   journal_on
    ->  setup_call_cleanup(nb_setval(typhon_journal_turn, true),
                           once(Goal),
                           nb_setval(typhon_journal_turn, false))
    ;   call(Goal)
    ).

%!  turn_defers is semidet.
%
%   This thread is in a turn, and there is a journal.

turn_defers :-
    journal_on,
    nb_current(typhon_journal_turn, true).

%!  turn_note(+Change) is det.
%!  turn_note_put(+Kind, +Key, +N, +Term) is det.
%!  turn_note_drop(+Kind, +Key, +N) is det.
%
%   As note_change/1, note_put/4 and note_drop/3; in a turn, at its end.

turn_note_put(Kind, Key, N, Term) :-
    (   journal_on
    ->  note_putting(Kind, Key, N, Term, Change),
        turn_note(Change)
    ;   true
    ).

turn_note_drop(Kind, Key, N) :-
    (   journal_on,
        journal_key(Key, N)
    ->  turn_note(drop(Kind, Key, N))
    ;   true
    ).

turn_note(Change) :-
    (   nb_current(typhon_journal_turn, true)
    ->  assertz(change(Change))
    ;   note_change(Change)
    ).

%!  turn_after(:Goal) is det.
%
%   Call Goal when this turn has been noted.

turn_after(Goal) :-
    assertz(after(Goal)).

%!  turn_has_effects is semidet.
%!  turn_commit is det.
%!  turn_release is det.
%
%   Something was put off; it is noted; it is released.

turn_has_effects :-
    (   change(_)
    ;   after(_)
    ),
    !.

turn_commit :-
    forall(retract(change(Change)), note_change(Change)).

turn_release :-
    (   after(_)
    ->  findall(Goal, after(Goal), Goals),
        retractall(after(_)),
        forall(member(Goal, Goals), release(Goal))
    ;   true
    ).

release(Goal) :-
    catch(ignore(Goal), error(Formal, Context),
          print_message(warning, error(Formal, Context))).
