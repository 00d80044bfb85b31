:- module(typhon_deferred,
          [ defer_effects/1,            % :Goal
            effects_deferred/0,
            deferred_change/1,              % +Change
            deferred_put/4,                 % +Kind, +Key, +N, +Term
            deferred_drop/3,                % +Kind, +Key, +N
            deferred_call/1,            % :Goal
            deferred_any/0,
            deferred_commit/0,
            deferred_release/0
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(error_text, [print_error/2]).
:- use_module(durable_changes,
              [ durable_change/1, durable_key/2, durable_on/0,
                durable_putting/5 ]).

/** <module> Effects of an agent are deferred until it stops

What an agent does between two stops is one unit of work: it happens as a whole
or not at all.  So what an agent sends, leaves and takes is deferred until the
agent stops.  Then all of it is queued together with the
agent's new state, inside unit_of_work/1, and only then released to others.
Without an open back end nothing is deferred.

*Threading*: each thread has its own.
*/

:- meta_predicate
    defer_effects(0),
    deferred_call(0).

:- thread_local
    change/1,                           % see durable_change/1
    after/1.                            % Goal

%!  defer_effects(:Goal) is det.
%
%   Run Goal, in which an agent acts, as part of this thread's unit of work.

defer_effects(Goal) :-
    (   durable_on
    ->  setup_call_cleanup(nb_setval(typhon_deferred, true),
                           once(Goal),
                           nb_setval(typhon_deferred, false))
    ;   call(Goal)
    ).

%!  effects_deferred is semidet.
%
%   This thread is in defer_effects/1, and durable_on/0.

effects_deferred :-
    durable_on,
    nb_current(typhon_deferred, true).

%!  deferred_change(+Change) is det.
%!  deferred_put(+Kind, +Key, +N, +Term) is det.
%!  deferred_drop(+Kind, +Key, +N) is det.
%
%   As durable_change/1, durable_put/4 and durable_drop/3; inside
%   defer_effects/1 the change is deferred to the end of the unit.

deferred_put(Kind, Key, N, Term) :-
    (   durable_on
    ->  durable_putting(Kind, Key, N, Term, Change),
        deferred_change(Change)
    ;   true
    ).

deferred_drop(Kind, Key, N) :-
    (   durable_on,
        durable_key(Key, N)
    ->  deferred_change(drop(Kind, Key, N))
    ;   true
    ).

deferred_change(Change) :-
    (   nb_current(typhon_deferred, true)
    ->  assertz(change(Change))
    ;   durable_change(Change)
    ).

%!  deferred_call(:Goal) is det.
%
%   Call Goal when the changes of this unit of work are queued.

deferred_call(Goal) :-
    assertz(after(Goal)).

%!  deferred_any is semidet.
%!  deferred_commit is det.
%!  deferred_release is det.
%
%   Something was deferred; queue its changes; call its goals.

deferred_any :-
    (   change(_)
    ;   after(_)
    ),
    !.

deferred_commit :-
    forall(retract(change(Change)), durable_change(Change)).

deferred_release :-
    (   after(_)
    ->  findall(Goal, after(Goal), Goals),
        retractall(after(_)),
        forall(member(Goal, Goals), release(Goal))
    ;   true
    ).

release(Goal) :-
    catch(ignore(Goal), error(Formal, Context),
          print_error(warning, error(Formal, Context))).
