:- module(typhon_unit_of_work,
          [ unit_run/1,                 % :Goal
            unit_defers/0,
            unit_note/1,                % +Change
            unit_note_put/4,            % +Kind, +Key, +N, +Term
            unit_note_drop/3,           % +Kind, +Key, +N
            unit_after/1,               % :Goal
            unit_has_effects/0,
            unit_commit/0,
            unit_release/0
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module(item_key, [journal_key/2]).
:- use_module(ledger,
              [journal_on/0, note_change/1, note_putting/5]).

/** <module> What an agent does between two stops is one unit of work

It happens as a whole or not at all.  So what an agent sends, leaves and takes
is put off until the agent stops.  Then all of it is noted together with the
agent's new state, and only then released to others.

*Threading*: each thread has its own.
*/

:- meta_predicate
    unit_run(0),
    unit_after(0).

:- thread_local
    change/1,                           % see typhon_store
    after/1.                            % Goal

%!  unit_run(:Goal) is det.
%
%   Run Goal, in which an agent acts, as part of this thread's unit of work.

unit_run(Goal) :-
    (   journal_on
    ->  setup_call_cleanup(nb_setval(typhon_unit_of_work, true),
                           once(Goal),
                           nb_setval(typhon_unit_of_work, false))
    ;   call(Goal)
    ).

%!  unit_defers is semidet.
%
%   This thread is in unit_run/1, and there is a journal.

unit_defers :-
    journal_on,
    nb_current(typhon_unit_of_work, true).

%!  unit_note(+Change) is det.
%!  unit_note_put(+Kind, +Key, +N, +Term) is det.
%!  unit_note_drop(+Kind, +Key, +N) is det.
%
%   As note_change/1, note_put/4 and note_drop/3; in unit_run/1, at the end of
%   the unit.

unit_note_put(Kind, Key, N, Term) :-
    (   journal_on
    ->  note_putting(Kind, Key, N, Term, Change),
        unit_note(Change)
    ;   true
    ).

unit_note_drop(Kind, Key, N) :-
    (   journal_on,
        journal_key(Key, N)
    ->  unit_note(drop(Kind, Key, N))
    ;   true
    ).

unit_note(Change) :-
    (   nb_current(typhon_unit_of_work, true)
    ->  assertz(change(Change))
    ;   note_change(Change)
    ).

%!  unit_after(:Goal) is det.
%
%   Call Goal when this unit of work has been noted.

unit_after(Goal) :-
    assertz(after(Goal)).

%!  unit_has_effects is semidet.
%!  unit_commit is det.
%!  unit_release is det.
%
%   Something was put off; it is noted; it is released.

unit_has_effects :-
    (   change(_)
    ;   after(_)
    ),
    !.

unit_commit :-
    forall(retract(change(Change)), note_change(Change)).

unit_release :-
    (   after(_)
    ->  findall(Goal, after(Goal), Goals),
        retractall(after(_)),
        forall(member(Goal, Goals), release(Goal))
    ;   true
    ).

release(Goal) :-
    catch(ignore(Goal), error(Formal, Context),
          print_error(warning, error(Formal, Context))).
