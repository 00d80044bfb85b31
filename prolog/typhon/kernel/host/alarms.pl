:- module(typhon_alarms,
          [ alarms_begin/0,
            alarms_end/0,
            alarm_add/3,                % +Stamp, +Agent, +Token
            alarm_new/1,                % -Stamp
            alarm_anew/1,               % +Stamp
            alarm_stamp/3,              % ?Stamp, +Agent, ?Token
            alarms_until/2,             % +Stamp, -Stamps
            alarms_new/1,               % -Count
            alarms_at/2,                % +Stamp, -Alarms
            alarm_take/3,               % +Alarm, -Agent, -Token
            alarm_stamps/1,             % -Stamps
            alarm_least/1,              % -Stamp
            alarms_number/1,            % -Count
            alarms_thin/0
          ]).
:- use_module(library(apply), [maplist/2]).

/** <module> What the timer is to do, and when

An alarm is a fact: at Stamp, fire(Agent, Token) is to be called.

An alarm that is not needed any more does no harm, and is not cleared: the
modules that set alarms define by over/2 which are, and these are forgotten
when as many have been set as there were alarms.  Thus there are never more
than twice those that count, and some hundreds.

The stamps of new alarms are put in a queue, from which the timer hears of
them.

*Threading*: any thread; alarm_new/1 is for that of the timer alone.
*/

:- multifile
    typhon_scheduler:over/2.            % Agent, Token: it is not needed any more

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

%!  alarms_until(+Stamp, -Stamps:list) is det.
%!  alarm_anew(+Stamp) is det.
%!  alarm_stamp(?Stamp, +Agent, ?Token) is nondet.
%
%   Those of alarms that are not later; the timer hears of it once more; there
%   is this alarm.

alarms_until(Stamp, Stamps) :-
    findall(Due, ( alarm(Due, _, _), Due =< Stamp ), Stamps).

alarm_anew(Stamp) :-
    new(New),
    !,
    thread_send_message(New, Stamp).
alarm_anew(_).

alarm_stamp(Stamp, Agent, Token) :-
    alarm(Stamp, Agent, Token).

%!  alarm_new(-Stamp) is semidet.
%!  alarms_new(-Count) is det.
%
%   Of the stamps of new alarms the next, which is taken, and how many wait.

alarm_new(Stamp) :-
    new(New),
    thread_peek_message(New, _),
    thread_get_message(New, Stamp).

alarms_new(Count) :-
    (   new(New),
        catch(message_queue_property(New, size(Count0)),
              error(existence_error(_, _), _), fail)
    ->  Count = Count0
    ;   Count = 0
    ).

%!  alarms_at(+Stamp, -Alarms:list) is det.
%!  alarm_take(+Alarm, -Agent, -Token) is semidet.
%
%   The Alarms set to Stamp; each can be taken once.

alarms_at(Stamp, Alarms) :-
    findall(Alarm, clause(alarm(Stamp, _, _), true, Alarm), Alarms).

alarm_take(Alarm, Agent, Token) :-
    clause(alarm(_, Agent, Token), true, Alarm),
    catch(erase(Alarm), error(existence_error(_, _), _), fail).

%!  alarm_stamps(-Stamps:ordset(float)) is det.
%!  alarm_least(-Stamp) is det.
%
%   All stamps; and the least of them, without a list of all, or `inf`.

alarm_stamps(Stamps) :-
    findall(Stamp, alarm(Stamp, _, _), List),
    sort(List, Stamps).

alarm_least(Stamp) :-
    Least = least(inf),
    forall(( alarm(Stamp0, _, _), arg(1, Least, Stamp1), Stamp0 < Stamp1 ),
           nb_setarg(1, Least, Stamp0)),
    arg(1, Least, Stamp).

%!  alarms_number(-Count) is det.
%
%   This is slow: clauses are counted.

alarms_number(Count) :-
    (   predicate_property(alarm(_, _, _), number_of_clauses(Count0))
    ->  Count = Count0
    ;   Count = 0
    ).

%!  alarms_thin is det.
%
%   Forget those that are over.

alarms_thin :-
    forall(clause(alarm(_, Agent, Token), true, Alarm),
           forget_if_over(Alarm, Agent, Token)).

forget_if_over(Alarm, Agent, Token) :-
    (   catch(typhon_scheduler:over(Agent, Token), error(_, _), fail)
    ->  catch(erase(Alarm), error(existence_error(_, _), _), true)
    ;   true
    ).
