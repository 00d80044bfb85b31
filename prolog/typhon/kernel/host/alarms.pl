:- module(typhon_alarms,
          [ alarms_begin/0,
            alarms_end/0,
            alarm_add/3,                % +Stamp, +Agent, +Token
            alarm_stamp/3,              % ?Stamp, +Agent, ?Token
            alarms_renew/1,             % +Stamp
            alarms_new/1,               % -Count
            alarms_go_off/1,            % +Stamp
            index_make/1,               % -Index
            index_update/2,             % +Index0, -Index
            index_delete/3,             % +Index0, +Stamp, -Index
            index_first/2,              % +Index, -Stamp
            index_size/2                % +Index, -Count
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module('../base/error_text', [error_lines/3]).
:- use_module('../base/fifo', [fifo_size/2]).
:- autoload(library(rbtrees),
              [ ord_list_to_rbtree/2, rb_delete/3, rb_insert/4, rb_min/3,
                rb_size/2 ]).

/** <module> Alarms of the timer

An alarm is a fact: call fire(Agent, Token) at Stamp.

An alarm that is no longer needed does no harm and is not deleted at once.  The
modules that set alarms define by over/2 which alarms are obsolete.  Obsolete
alarms are deleted after as many new alarms have been set as there were alarms.
So there are never more than twice as many alarms as are needed, plus some
hundreds.

The stamps of new alarms are put in a queue, from which the timer reads them.
The timer keeps an index of the stamps of all alarms, and of some alarms that
are gone.  After Left more alarms have been set it deletes obsolete alarms and
rebuilds the index.  The index is a tree, index(Stamps, Left), or, where a tree
would fill the stack, least(Stamp, Left) with the first stamp alone; then the
timer searches for the next stamp after each alarm.

*Threading*: any thread; the index is on the stack of the timer.
*/

:- multifile
    typhon_scheduler:fire/2,            % Agent, Token: an alarm went off
    typhon_scheduler:over/2,            % Agent, Token: it is obsolete
    prolog:message//1.

:- dynamic
    alarm/3,                            % Stamp, Agent, Token
    new/1.                              % Queue of stamps

%!  alarms_begin is det.

alarms_begin :-
    message_queue_create(New),
    assertz(new(New)).

%!  alarms_end is det.
%
%   Delete all alarms. No alarm can be added until alarms_begin/0.

alarms_end :-
    findall(New, new(New), Queues),
    retractall(new(_)),
    maplist(message_queue_destroy, Queues),
    retractall(alarm(_, _, _)).

%!  alarm_add(+Stamp, +Agent, +Token) is semidet.
%
%   Fails if this alarm is set already.

alarm_add(Stamp, Agent, Token) :-
    \+ alarm(Stamp, Agent, Token),
    new(New),
    !,
    assertz(alarm(Stamp, Agent, Token)),
    catch(thread_send_message(New, Stamp), error(existence_error(_, _), _),
          true).                        % the timer is stopping

%!  alarms_renew(+Stamp) is det.
%
%   Put the stamps of all alarms that are not later than Stamp in the timer's
%   queue again.

alarms_renew(Stamp) :-
    new(New),
    !,
    findall(Due, ( alarm(Due, _, _), Due =< Stamp ), Stamps),
    maplist(thread_send_message(New), Stamps).
alarms_renew(_).

%!  alarm_stamp(?Stamp, +Agent, ?Token) is nondet.

alarm_stamp(Stamp, Agent, Token) :-
    alarm(Stamp, Agent, Token).

%!  alarms_new(-Count) is det.
%
%   Count stamps are in the queue, and the timer has not read them yet.

alarms_new(Count) :-
    (   new(New)
    ->  fifo_size(New, Count)
    ;   Count = 0
    ).

%!  alarms_go_off(+Stamp) is det.
%
%   Call fire/2 for each alarm set to Stamp.  An alarm goes off exactly once,
%   even if signals arrive in the thread.

alarms_go_off(Stamp) :-
    findall(Alarm, clause(alarm(Stamp, _, _), true, Alarm), Alarms),
    maplist(go_off, Alarms).

go_off(Alarm) :-
    sig_atomic(( alarm_take(Alarm, Agent, Token)
               ->  debug(typhon(scheduler), 'alarm ~p of ~p', [Token, Agent]),
                   catch(ignore(typhon_scheduler:fire(Agent, Token)), Ball,
                         print_message(error, typhon(alarm(Ball))))
               ;   true
               )).

alarm_take(Alarm, Agent, Token) :-
    clause(alarm(_, Agent, Token), true, Alarm),
    catch(erase(Alarm), error(existence_error(_, _), _), fail).

                /*******************************
                *           THE INDEX          *
                *******************************/

%!  index_make(-Index) is det.
%
%   Delete obsolete alarms, and make an index of the others.

index_make(Index) :-
    alarms_thin,
    predicate_property(alarm(_, _, _), number_of_clauses(Count)),
    More is max(500, Count),
    current_prolog_flag(stack_limit, Bytes),
    Space is Bytes//512-Count,
    (   Space > 0
    ->  tree(Stamps),
        Left is min(Space, More),
        Index = index(Stamps, Left)
    ;   print_message(warning, typhon(no_index(Count))),
        alarm_least(Stamp),
        Index = least(Stamp, More)
    ).

tree(Stamps) :-
    findall(Stamp, alarm(Stamp, _, _), List),
    sort(List, Set),
    pairs_keys_values(Pairs, Set, Set),
    ord_list_to_rbtree(Pairs, Stamps).

alarms_thin :-
    forall(clause(alarm(_, Agent, Token), true, Alarm),
           forget_if_over(Alarm, Agent, Token)).

forget_if_over(Alarm, Agent, Token) :-
    (   catch(typhon_scheduler:over(Agent, Token), error(_, _), fail)
    ->  catch(erase(Alarm), error(existence_error(_, _), _), true)
    ;   true
    ).

%   Stamp is the least stamp, or `inf`. There may be a million stamps, so this
%   makes no list of them.

alarm_least(Stamp) :-
    Least = least(inf),
    forall(( alarm(Stamp0, _, _), arg(1, Least, Stamp1), Stamp0 < Stamp1 ),
           nb_setarg(1, Least, Stamp0)),
    arg(1, Least, Stamp).

%!  index_update(+Index0, -Index) is det.
%
%   Index is Index0 with the stamps of new alarms, which are taken from their
%   queue.

index_update(Index0, Index) :-
    (   new(New),
        thread_peek_message(New, _)
    ->  thread_get_message(New, Stamp),
        index_insert(Index0, Stamp, Index1),
        index_update(Index1, Index)
    ;   Index = Index0
    ).

index_insert(Index0, _, Index) :-
    arg(2, Index0, 0),
    !,
    index_make(Index).
index_insert(least(Stamp0, Left0), Stamp1, least(Stamp, Left)) :-
    Left is Left0-1,
    Stamp is min(Stamp0, Stamp1).
index_insert(index(Stamps0, Left0), Stamp, index(Stamps, Left)) :-
    Left is Left0-1,
    rb_insert(Stamps0, Stamp, Stamp, Stamps).

%!  index_delete(+Index0, +Stamp, -Index) is det.

index_delete(least(_, Left), _, least(Stamp, Left)) :-
    alarm_least(Stamp).
index_delete(index(Stamps0, Left), Stamp, index(Stamps, Left)) :-
    (   rb_delete(Stamps0, Stamp, Stamps)
    ->  true
    ;   Stamps = Stamps0
    ).

%!  index_first(+Index, -Stamp) is det.
%
%   Stamp is the first stamp, or `inf` if the index is empty.

index_first(least(Stamp, _), Stamp).
index_first(index(Stamps, _), Stamp) :-
    (   rb_min(Stamps, First, _)
    ->  Stamp = First
    ;   Stamp = inf
    ).

%!  index_size(+Index, -Count) is det.

index_size(least(_, _), 1).
index_size(index(Stamps, _), Size) :-
    rb_size(Stamps, Size).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(alarm(Ball))) -->
    [ 'An alarm raised an error; other alarms are not affected', nl ],
    error_lines(Ball).
prolog:message(typhon(no_index(Count))) -->
    [ 'The timer has no memory for an index of ~D alarms, and is slow'-
      [Count] ].
