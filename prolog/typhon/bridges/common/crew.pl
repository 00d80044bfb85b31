:- module(typhon_crew,
          [ crew_start/4,               % +Owner, +Role, :Goal, :Release
            crew_end/1                  % +Owner
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).

/** <module> Threads that end with their owner

A thread that comes to its end by itself is gone then; those that are left
are ended, and joined, with their owner.

*Threading*: any thread but those of the crew calls crew_end/1.
*/

:- meta_predicate crew_start(+, +, 0, 0).

:- dynamic crew/2.                      % Owner, Thread

%!  crew_start(+Owner, +Role:atom, :Goal, :Release) is det.
%
%   Run Goal in a new thread, and Release when that ends, even if it has not
%   come to Goal.
%
%   @error resource_error(threads) or the like

crew_start(Owner, Role, Goal, Release) :-
    flag(typhon_crew, Number, Number+1),
    atomic_list_concat([typhon, Role, Number], '_', Alias),
    sig_atomic(create(Owner, Goal, Release, Alias)).

create(Owner, Goal, Release, Alias) :-
    thread_create(typhon_crew:work(Goal), Thread,
                  [ alias(Alias), at_exit(Release) ]),
    assertz(crew(Owner, Thread)),
    thread_send_message(Thread, crew_begin).

work(Goal) :-
    setup_call_cleanup(
        true,
        catch(( thread_get_message(crew_begin),
                ignore(Goal) ),
              Ball,
              told(Ball)),
        ended).

told(crew_end) :-
    !.
told('$aborted') :-
    !.
told(unwind(_)) :-
    !.
told(Ball) :-
    print_message(error, Ball).

%   Whoever takes the fact away sees to what is left of the thread.

ended :-
    thread_self(Me),
    (   retract(crew(_, Me))
    ->  thread_detach(Me)
    ;   true
    ).

%!  crew_end(+Owner) is det.
%
%   End all threads of Owner, whatever they do.

crew_end(Owner) :-
    in_own_thread(typhon_crew:end_all(Owner)).

end_all(Owner) :-
    findall(Thread, crew(Owner, Thread), Threads),
    forall(( member(Thread, Threads), retract(crew(Owner, Thread)) ),
           end(Thread, 0.001)),
    (   crew(Owner, _)
    ->  end_all(Owner)
    ;   true
    ).

%   A signal that comes just before a thread blocks does not wake it.

end(Thread, Wait) :-
    (   thread_property(Thread, status(running))
    ->  catch(thread_signal(Thread, typhon_crew:end_once),
              error(_, _), true),
        sleep(Wait),
        Wait1 is min(0.1, 2*Wait),
        end(Thread, Wait1)
    ;   thread_join(Thread, _)
    ).

end_once :-
    (   nb_current(typhon_crew_ending, true)
    ->  true
    ;   nb_setval(typhon_crew_ending, true),
        throw(crew_end)
    ).
