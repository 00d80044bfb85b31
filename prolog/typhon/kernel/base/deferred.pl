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

The actions of an agent between two stops are one unit of work: all of them
take effect, or none.  So the messages that an agent sends, and the facts that
it leaves and takes, are deferred until the agent stops.  Then all of them are
queued together with the agent's new state, inside unit_of_work/1, and only
then released to others.  Without an open back end nothing is deferred.

*Threading*: each thread has its own deferred effects.
*/

:- meta_predicate
    defer_effects(0),
    deferred_call(0).

:- thread_local
    change/1,                           % see durable_change/1
    after/1.                            % Goal

%!  defer_effects(:Goal) is det.
%
%   Run Goal, in which an agent acts, and defer its effects to the end of this
%   thread's unit of work.

defer_effects(Goal) :-
    (   durable_on
    ->  setup_call_cleanup(nb_setval(typhon_deferred, true),
                           once(Goal),
                           nb_setval(typhon_deferred, false))
    ;   call(Goal)
    ).

%!  effects_deferred is semidet.
%
%   This thread is in defer_effects/1, and a back end is open.

effects_deferred :-
    durable_on,
    nb_current(typhon_deferred, true).

%!  deferred_put(+Kind, +Key, +N, +Term) is det.
%
%   As durable_put/4; inside defer_effects/1 the change is deferred, see
%   deferred_change/1.

deferred_put(Kind, Key, N, Term) :-
    (   durable_on
    ->  durable_putting(Kind, Key, N, Term, Change),
        deferred_change(Change)
    ;   true
    ).

%!  deferred_drop(+Kind, +Key, +N) is det.
%
%   As durable_drop/3; inside defer_effects/1 the change is deferred, see
%   deferred_change/1.

deferred_drop(Kind, Key, N) :-
    (   durable_on,
        durable_key(Key, N)
    ->  deferred_change(drop(Kind, Key, N))
    ;   true
    ).

%!  deferred_change(+Change) is det.
%
%   As durable_change/1; inside defer_effects/1 the change is deferred to the
%   end of the unit of work.

deferred_change(Change) :-
    (   nb_current(typhon_deferred, true)
    ->  assertz(change(Change))
    ;   durable_change(Change)
    ).

%!  deferred_call(:Goal) is det.
%
%   Call Goal after the changes of this unit of work are queued.

deferred_call(Goal) :-
    assertz(after(Goal)).

%!  deferred_any is semidet.
%
%   This thread has deferred effects.

deferred_any :-
    (   change(_)
    ;   after(_)
    ),
    !.

%!  deferred_commit is det.
%
%   Queue the deferred changes of this thread.

deferred_commit :-
    forall(retract(change(Change)), durable_change(Change)).

%!  deferred_release is det.
%
%   Call the deferred goals of this thread.

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
