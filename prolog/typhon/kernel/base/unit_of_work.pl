:- module(typhon_unit_of_work,
          [ unit_run/1,                 % :Goal
            unit_defers/0,
            unit_change/1,              % +Change
            unit_put/4,                 % +Kind, +Key, +N, +Term
            unit_drop/3,                % +Kind, +Key, +N
            unit_after/1,               % :Goal
            unit_has_effects/0,
            unit_commit/0,
            unit_release/0
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(error_text, [print_error/2]).
:- use_module(durable_changes,
              [ durable_change/1, durable_key/2, durable_on/0,
                durable_putting/5 ]).

/** <module> What an agent does between two stops is one unit of work

It happens as a whole or not at all.  So what an agent sends, leaves and takes
is deferred until the agent stops.  Then all of it is queued together with the
agent's new state, inside unit_of_work/1, and only then released to others.
Without an open back end nothing is deferred.

*Threading*: each thread has its own.
*/

:- meta_predicate
    unit_run(0),
    unit_after(0).

:- thread_local
    change/1,                           % see durable_change/1
    after/1.                            % Goal

%!  unit_run(:Goal) is det.
%
%   Run Goal, in which an agent acts, as part of this thread's unit of work.

unit_run(Goal) :-
    (   durable_on
    ->  setup_call_cleanup(nb_setval(typhon_unit_of_work, true),
                           once(Goal),
                           nb_setval(typhon_unit_of_work, false))
    ;   call(Goal)
    ).

%!  unit_defers is semidet.
%
%   This thread is in unit_run/1, and durable_on/0.

unit_defers :-
    durable_on,
    nb_current(typhon_unit_of_work, true).

%!  unit_change(+Change) is det.
%!  unit_put(+Kind, +Key, +N, +Term) is det.
%!  unit_drop(+Kind, +Key, +N) is det.
%
%   As durable_change/1, durable_put/4 and durable_drop/3; inside unit_run/1 the
%   change is deferred to the end of the unit.

unit_put(Kind, Key, N, Term) :-
    (   durable_on
    ->  durable_putting(Kind, Key, N, Term, Change),
        unit_change(Change)
    ;   true
    ).

unit_drop(Kind, Key, N) :-
    (   durable_on,
        durable_key(Key, N)
    ->  unit_change(drop(Kind, Key, N))
    ;   true
    ).

unit_change(Change) :-
    (   nb_current(typhon_unit_of_work, true)
    ->  assertz(change(Change))
    ;   durable_change(Change)
    ).

%!  unit_after(:Goal) is det.
%
%   Call Goal when the changes of this unit of work are queued.

unit_after(Goal) :-
    assertz(after(Goal)).

%!  unit_has_effects is semidet.
%!  unit_commit is det.
%!  unit_release is det.
%
%   Something was deferred; queue its changes; call its goals.

unit_has_effects :-
    (   change(_)
    ;   after(_)
    ),
    !.

unit_commit :-
    forall(retract(change(Change)), durable_change(Change)).

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
