:- module(typhon_alarms,
          [ alarms_begin/0,
            alarms_end/0,
            alarm_add/3,                % +Stamp, +Agent, +Token
            alarm_stamp/3,              % ?Stamp, +Agent, ?Token
            alarms_renew/1,             % +Stamp
            alarms_new/1,               % -Count
            alarms_go_off/1,            % +Stamp
            alarms_number/1,            % -Count
            index_make/1,               % -Index
            index_update/2,             % +Index0, -Index
            index_delete/3,             % +Index0, +Stamp, -Index
            index_first/2,              % +Index, -Stamp
            index_size/2                % +Index, -Count
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module('../base/error_text', [error_told/3]).
:- autoload(library(rbtrees),
              [ ord_list_to_rbtree/2, rb_delete/3, rb_insert/4, rb_min/3,
                rb_size/2 ]).

/** <module> What the timer is to do, and when

An alarm is a fact: at Stamp, fire(Agent, Token) is to be called.

An alarm that is not needed any more does no harm, and is not cleared: the
modules that set alarms define by over/2 which are, and these are forgotten
when as many have been set as there were alarms.  Thus there are never more
than twice those that count, and some hundreds.

The stamps of new alarms are put in a queue, from which the timer hears of
them.  It keeps an index of all stamps that alarms are set to, and some more,
and makes it anew when Left more have been set; then the alarms that are over
are forgotten.  The index is index(Stamps, Left), a tree, or
least(Stamp, Left), only the first, where a tree would fill the stack.  Then
the next is looked for when that has gone off.

*Threading*: any thread; the index is on the stack of the timer.
*/

:- multifile
    typhon_scheduler:fire/2,            % Agent, Token: an alarm went off
    typhon_scheduler:over/2,            % Agent, Token: it is not needed any more
    prolog:message//1.

:- dynamic
    alarm/3,                            % Stamp, Agent, Token
    new/1.                              % Queue of stamps

%!  alarms_begin is det.
%!  alarms_end is det.
%
%   From the one to the other alarms can be added; then all are forgotten.

alarms_begin :-
    message_queue_create(New),
    assertz(new(New)).

alarms_end :-
    findall(New, new(New), Queues),
    retractall(new(_)),
    maplist(message_queue_destroy, Queues),
    retractall(alarm(_, _, _)).

%!  alarm_add(+Stamp, +Agent, +Token) is semidet.
%
%   Fails if there is this alarm already.

alarm_add(Stamp, Agent, Token) :-
    \+ alarm(Stamp, Agent, Token),
    new(New),
    !,
    assertz(alarm(Stamp, Agent, Token)),
    catch(thread_send_message(New, Stamp), error(existence_error(_, _), _),
          true).                        % ending

%!  alarms_renew(+Stamp) is det.
%!  alarm_stamp(?Stamp, +Agent, ?Token) is nondet.
%
%   The timer hears once more of the alarms that are not later; there is this
%   alarm.

alarms_renew(Stamp) :-
    new(New),
    !,
    findall(Due, ( alarm(Due, _, _), Due =< Stamp ), Stamps),
    maplist(thread_send_message(New), Stamps).
alarms_renew(_).

alarm_stamp(Stamp, Agent, Token) :-
    alarm(Stamp, Agent, Token).

%!  alarms_new(-Count) is det.
%
%   So many stamps the timer has not heard of.

alarms_new(Count) :-
    (   new(New),
        catch(message_queue_property(New, size(Count0)),
              error(existence_error(_, _), _), fail)
    ->  Count = Count0
    ;   Count = 0
    ).

%!  alarms_go_off(+Stamp) is det.
%
%   Call fire/2 for each alarm set to Stamp.  An alarm goes off once, whatever
%   signals the thread.

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

%!  alarms_number(-Count) is det.
%
%   This is slow: clauses are counted.

alarms_number(Count) :-
    (   predicate_property(alarm(_, _, _), number_of_clauses(Count0))
    ->  Count = Count0
    ;   Count = 0
    ).

                /*******************************
                *           THE INDEX          *
                *******************************/

%!  index_make(-Index) is det.

index_make(Index) :-
    alarms_thin,
    alarms_number(Count),
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

%   Forget the alarms that are over.

alarms_thin :-
    forall(clause(alarm(_, Agent, Token), true, Alarm),
           forget_if_over(Alarm, Agent, Token)).

forget_if_over(Alarm, Agent, Token) :-
    (   catch(typhon_scheduler:over(Agent, Token), error(_, _), fail)
    ->  catch(erase(Alarm), error(existence_error(_, _), _), true)
    ;   true
    ).

%   The least stamp, without a list of all, or `inf`.

alarm_least(Stamp) :-
    Least = least(inf),
    forall(( alarm(Stamp0, _, _), arg(1, Least, Stamp1), Stamp0 < Stamp1 ),
           nb_setarg(1, Least, Stamp0)),
    arg(1, Least, Stamp).

%!  index_update(+Index0, -Index) is det.
%!  index_delete(+Index0, +Stamp, -Index) is det.
%
%   With the stamps of new alarms, which are taken from their queue; without
%   Stamp.

index_update(Index0, Index) :-
    (   new(New),
        thread_peek_message(New, _)
    ->  thread_get_message(New, Stamp),
        index_insert(Index0, Stamp, Index1),
        index_update(Index1, Index)
    ;   Index = Index0
    ).

index_insert(least(_, 0), _, Index) :-
    !,
    index_make(Index).
index_insert(least(Stamp0, Left0), Stamp1, least(Stamp, Left)) :-
    Left is Left0-1,
    Stamp is min(Stamp0, Stamp1).
index_insert(index(_, 0), _, Index) :-
    !,
    index_make(Index).
index_insert(index(Stamps0, Left0), Stamp, index(Stamps, Left)) :-
    Left is Left0-1,
    rb_insert(Stamps0, Stamp, Stamp, Stamps).

index_delete(least(_, Left), _, least(Stamp, Left)) :-
    alarm_least(Stamp).
index_delete(index(Stamps0, Left), Stamp, index(Stamps, Left)) :-
    (   rb_delete(Stamps0, Stamp, Stamps)
    ->  true
    ;   Stamps = Stamps0
    ).

%!  index_first(+Index, -Stamp) is det.
%
%   `inf` if there is none.

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
    [ 'An alarm met with an error; the others go on', nl ],
    error_told(Ball).
prolog:message(typhon(no_index(Count))) -->
    [ 'The timer has no memory for an index of ~D alarms, and is slow'-
      [Count] ].
