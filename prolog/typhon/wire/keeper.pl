:- module(typhon_keeper,
          [ keep/1,                     % +Me
            keeper_connect/1,           % +Address
            keeper_unheard/1            % +Messages
          ]).

/** <module> The keeper: connects, and connects again

One thread per endpoint keeps its sessions alive. It sees to it that those
are reached who are wanted, see quest.pl, that sessions with something to
send or to hear are connected again, and that others are forgotten.

_Threading_: keep/1 is the goal of the keeper's thread, which owns the table
below. Others talk to it through crew_tell/1. It waits for nobody: what may
take a while is done by a thread of the crew.
*/

:- use_module(library(lists), [member/2, min_list/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(contacts, [contact_gone/1]).
:- use_module(outbox, [session_close/2, session_retire/1, session_up/1]).
:- use_module(quest,
              [ quest_again/1, quest_begin/1, quest_due/1, quest_ended/2,
                quest_give_up/0, quest_greeted/1, quest_overdue/1,
                quest_send/1, quest_tell/2, quest_up/1, quest_wait/2,
                unfinished/1 ]).
:- use_module(request, [requests_lost/2]).
:- use_module(session, [route/2, session/2, session_adopting/2]).
:- use_module(threads, [crew_aside/1, crew_bury/1, crew_hear/2, crew_tell/1]).
:- use_module(unsent, [unsent_fail/1]).

:- setting(resting, positive_integer, 1000,
           "Sessions without connection kept though nothing is pending").

:- dynamic
    resting/1,                          % Key
    errand/2.                           % Time, Goal

%!  keeper_connect(+Address) is semidet.
%
%   See to it that there is a connection to Address; fails if there can be
%   none. The keeper always answers, so there is no deadline here: a wait
%   with a deadline may never end in a clean-up handler or a hook, where
%   signals are held back (SWI-Prolog 9.0.4). The keeper itself does not
%   wait for the keeper.

keeper_connect(Address) :-
    \+ nb_current(typhon_keeper, true),
    setup_call_cleanup(
        message_queue_create(Queue),
        ( crew_tell(connect(Address, Queue)),
          thread_get_message(Queue, Result),
          Result == met ),
        message_queue_destroy(Queue)).

%!  keeper_unheard(+Messages) is det.
%
%   Answer those who asked too late.

keeper_unheard(Messages) :-
    forall(member(connect(_, Queue), Messages), quest_tell(Queue, missed)),
    unsent_fail(_).

%!  keep(+Me) is det.
%
%   The life of the keeper, Me being our hello. Ends on the message `stop`.

keep(Me) :-
    nb_setval(typhon_keeper, true),
    repeat,
    next_deadline(Deadline),
    (   crew_hear(Message, Deadline)
    ->  true
    ;   Message = overdue
    ),
    (   Message == stop
    ->  !,
        quest_give_up,
        retractall(resting(_)),
        run_errands(inf)
    ;   catch(( hear(Message, Me), quest_begin(Me) ),
              error(Formal, Context),
              print_message(error, error(Formal, Context))),
        fail
    ).

next_deadline(Deadline) :-
    findall(Time, ( quest_due(Time) ; errand(Time, _) ), Times),
    (   Times == []
    ->  Deadline = infinite
    ;   min_list(Times, Deadline)
    ).

hear(connect(Address, Queue), _) :-
    quest_wait(Address, Queue).
hear(requests(Address), _) :-
    quest_send(Address).
hear(greeted(Thread), _) :-
    quest_greeted(Thread).
hear(missed(Thread, Formal), _) :-
    quest_ended(Thread, Formal).
hear(ended(Thread), _) :-
    crew_bury(Thread),
    quest_ended(Thread, ended).
hear(up(Key), _) :-
    retractall(resting(Key)),
    quest_up(Key).
hear(wanted(Key), _) :-
    (   session(Key, Session),
        \+ session_up(Key)
    ->  down(Session)
    ;   true
    ).
hear(displaced(Key), _) :-              % another process has its address
    (   leads_to(_, Key)
    ->  true
    ;   gone(Key)
    ).
hear(gone(Key), _) :-                   % it said goodbye
    forall(leads_to(Address, Key), contact_gone(Address)),
    gone(Key).
hear(later(Time, Goal), _) :-           % Goal is quick
    assertz(errand(Time, Goal)).
hear(overdue, Me) :-
    get_time(Now),
    run_errands(Now),
    quest_overdue(Me).

%   What others have asked to be done at some time.

run_errands(Now) :-
    findall(Time-Goal, ( errand(Time, Goal), Time =< Now ), Due),
    forall(member(Time-Goal, Due),
           ( retractall(errand(Time, Goal)),
             call(Goal) )).

leads_to(Address, Key) :-
    route(Address, session(Key, _, _, _, _)).

%   A session with nothing pending is kept for the sake of its counts: the
%   peer may be cut off only, and come back with frames that have arrived
%   before.

down(Session) :-
    unfinished(Session),
    !,
    quest_again(Session).
down(session(Key, _, _, _, _)) :-
    retractall(resting(Key)),
    assertz(resting(Key)),
    predicate_property(resting(_), number_of_clauses(Count)),
    setting(resting, Max),
    (   Count > Max,
        retract(resting(Oldest)),
        session(Oldest, Session)
    ->  crew_aside(forget(Session))
    ;   true
    ).

forget(Session) :-
    session_adopting(Session, forget_at_rest(Session)).

forget_at_rest(Session) :-
    arg(1, Session, Key),
    (   ( session_up(Key) ; unfinished(Session) )
    ->  true
    ;   ignore(session_close(Session, _))
    ).

gone(Key) :-
    retractall(resting(Key)),
    (   session(Key, Session)
    ->  crew_aside(part(Session))
    ;   true
    ).

%   Whoever waits for an answer is told, whatever happens.

part(Session) :-
    sig_atomic(( session_adopting(Session,
                                  ( session_retire(Session),
                                    session_close(Session, Unsent) )),
                 requests_lost(Session, Unsent) )).
