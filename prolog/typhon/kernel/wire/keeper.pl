:- module(typhon_keeper,
          [ keep/1,                     % +Me
            keeper_connect/1,           % +Address
            keeper_connect/2,           % +Address, +Deadline
            keeper_unheard/1            % +Messages
          ]).

/** <module> The keeper: connects, and connects again

One thread per endpoint keeps its sessions alive. It sees to it that those
are reached who are wanted, see connector.pl, that sessions with something to
send or to hear are connected again, and that others are forgotten.

*Threading*: keep/1 is the goal of the keeper's thread, which owns the table
below. Others talk to it through keeper_tell/1. It waits for nobody: what may
take a while is done by a thread in the background.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2, min_list/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module(attempts, [attempt_due/1, attempt_greeted/1]).
:- use_module(connector,
              [ connector_again/1, connector_begin/1, connector_ended/2,
                connector_give_up/0, connector_overdue/1, connector_send/1,
                connector_up/1, connector_wait/2 ]).
:- use_module(contacts, [contact_gone/1]).
:- use_module(keeper_queue, [keeper_hear/2, keeper_tell/1]).
:- use_module(request, [requests_lost/2, session_unfinished/1]).
:- use_module(resumption, [session_close/2, session_retire/1]).
:- use_module(session,
              [ route_key/2, session/2, session_adopting/2, session_key/2,
                session_up/1 ]).
:- use_module(threads, [in_background/2, wire_thread_join/1]).
:- use_module(unsent, [unsent_again/2, unsent_fail/1]).
:- use_module(waiters, [waiter_tell/2]).

:- setting(resting, positive_integer, 1000,
           "Sessions without connection kept though nothing is pending").

:- dynamic
    resting/1,                          % Key
    errand/2.                           % Time, Goal

%!  keeper_connect(+Address) is semidet.
%!  keeper_connect(+Address, +Deadline) is semidet.
%
%   See to it that there is a connection to Address; fails if there can be
%   none, or not before Deadline. The keeper always answers, so the first has
%   no deadline: a wait with a deadline may never end in a clean-up handler or
%   a hook, where signals are held back (SWI-Prolog 9.0.4). The keeper itself
%   does not wait for the keeper.

keeper_connect(Address) :-
    connected(Address, []).

keeper_connect(Address, Deadline) :-
    connected(Address, [deadline(Deadline)]).

connected(Address, Options) :-
    \+ nb_current(typhon_keeper, true),
    setup_call_cleanup(
        message_queue_create(Queue),
        ( keeper_tell(connect(Address, Queue)),
          thread_get_message(Queue, Result, Options),
          Result == met ),
        message_queue_destroy(Queue)).

%!  keeper_unheard(+Messages) is det.
%
%   Answer those who asked too late, and do what was to be done later.

keeper_unheard(Messages) :-
    forall(member(connect(_, Queue), Messages), waiter_tell(Queue, missed)),
    unsent_fail(_),
    forall(member(later(_, Goal), Messages), call(Goal)).

%!  keep(+Me) is det.
%
%   The life of the keeper, Me being our hello. Ends on the message `stop`.

keep(Me) :-
    nb_setval(typhon_keeper, true),
    repeat,
    next_deadline(Deadline),
    (   keeper_hear(Message, Deadline)
    ->  true
    ;   Message = overdue
    ),
    (   Message == stop
    ->  !,
        connector_give_up,
        retractall(resting(_)),
        run_errands(inf)
    ;   catch(( hear(Message, Me), connector_begin(Me) ),
              error(Formal, Context),
              print_error(error, error(Formal, Context))),
        fail
    ).

next_deadline(Deadline) :-
    findall(Time, ( attempt_due(Time) ; errand(Time, _) ), Times),
    (   Times == []
    ->  Deadline = infinite
    ;   min_list(Times, Deadline)
    ).

hear(connect(Address, Queue), _) :-
    connector_wait(Address, Queue).
hear(requests(Address), _) :-
    connector_send(Address).
hear(greeted(Thread), _) :-
    attempt_greeted(Thread).
hear(missed(Thread, Formal), _) :-
    connector_ended(Thread, Formal).
hear(ended(Thread), _) :-
    wire_thread_join(Thread),
    connector_ended(Thread, ended).
hear(up(Key), _) :-
    retractall(resting(Key)),
    connector_up(Key).
hear(wanted(Key), _) :-
    (   session(Key, Session),
        \+ session_up(Key)
    ->  down(Session)
    ;   true
    ).
hear(displaced(Key), Me) :-             % another process has its address
    (   route_key(_, Key)               % is it at that, too?
    ->  hear(wanted(Key), Me)
    ;   gone(Key)
    ).
hear(gone(Key), _) :-                   % it said goodbye
    forall(route_key(Address, Key), contact_gone(Address)),
    gone(Key).
hear(later(Time, Goal), _) :-           % Goal is quick
    assertz(errand(Time, Goal)).
hear(overdue, Me) :-
    get_time(Now),
    run_errands(Now),
    connector_overdue(Me).

%   What others have asked to be done at some time.

run_errands(Now) :-
    findall(Time-Goal, ( errand(Time, Goal), Time =< Now ), Due),
    forall(member(Time-Goal, Due),
           ( retractall(errand(Time, Goal)),
             call(Goal) )).

%   A session with nothing pending is kept for the sake of its counts: the
%   peer may be cut off only, and come back with frames that have arrived
%   before.

down(Session) :-
    session_unfinished(Session),
    !,
    connector_again(Session).
down(Session) :-
    session_key(Session, Key),
    retractall(resting(Key)),
    assertz(resting(Key)),
    predicate_property(resting(_), number_of_clauses(Count)),
    setting(resting, Max),
    (   Count > Max,
        retract(resting(Oldest)),
        session(Oldest, OldSession)
    ->  in_background(forget(OldSession), forget-Oldest)
    ;   true
    ).

forget(Session) :-
    session_adopting(Session, forget_at_rest(Session)).

forget_at_rest(Session) :-
    session_key(Session, Key),
    (   ( session_up(Key) ; session_unfinished(Session) )
    ->  true
    ;   ignore(session_close(Session, _))
    ).

gone(Key) :-
    retractall(resting(Key)),
    (   session(Key, Session)
    ->  debug(typhon(session), '~w: gone for good', [Key]),
        in_background(part(Session), part-Key)
    ;   true
    ).

%   Whoever waits for an answer is told, whatever happens.

part(Session) :-
    sig_atomic(( session_adopting(Session,
                                  ( session_retire(Session),
                                    session_close(Session, Unsent) )),
                 unsent_again(Session, Unsent),
                 requests_lost(Session, Unsent) )).
