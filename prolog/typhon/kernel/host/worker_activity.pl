:- module(typhon_worker_activity,
          [ census/1,                   % -Began
            census_begin/0,
            census_end/0,
            worker_came/0,
            worker_ended/1,             % +Worker
            turn_begin/2,               % +Work, -Turn
            turn_end/1,                 % +Turn
            turns_begun/1,              % -Count
            work_doer/3,                % +Work, -Type, -What
            held_count/3,               % +Workers, +Stamp, -Held
            held_since/3,               % +Stamp, ?Type, ?What
            turn_of/2                   % ?Type, ?What
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).

/** <module> What workers do, and since when

Workers note what they begin and end while a census is held: without one
the notes would cost a third of the speed of hops, and the count of turns is
all that is kept.  A worker that has not come back for long is held by
something that blocks.

*Threading*: workers note what they begin and end.  The census begins and
ends in the thread of the timer.
*/

:- dynamic
    census/1,                   % Began
    returned/1,                 % Worker: came back during the census
    turn/4.                     % Worker, agent or goal, Agent or PI, Since

%!  census(-Began) is semidet.
%
%   One is held, since the time Began.

%!  census_begin is det.
%!  census_end is det.

census_begin :-
    census(_),
    !.
census_begin :-
    get_time(Now),
    assertz(census(Now)).

census_end :-
    retractall(census(_)),
    retractall(turn(_, _, _, _)),
    retractall(returned(_)).

                /*******************************
                *             TURNS            *
                *******************************/

%!  worker_came is det.
%!  worker_ended(+Worker) is det.
%
%   This thread, a worker, is ready to do something; Worker has ended.

worker_came :-
    (   census(_)
    ->  thread_self(Me),
        came_back(Me)
    ;   true
    ).

worker_ended(Worker) :-
    retractall(returned(Worker)),
    retractall(turn(Worker, _, _, _)).

came_back(Worker) :-
    (   returned(Worker)
    ->  true
    ;   assertz(returned(Worker))
    ).

%!  turn_begin(+Work, -Turn) is det.
%!  turn_end(+Turn) is det.
%
%   This worker begins with Work, and ends it.

turn_begin(Work, Turn) :-
    one_turn_more,
    (   census(_)
    ->  thread_self(Me),
        came_back(Me),
        get_time(Now),
        work_doer(Work, Type, What),
        asserta(turn(Me, Type, What, Now), Turn)
    ;   Turn = none
    ).

%   Two that begin at once may count as one: callers want to know whether
%   any did.

one_turn_more :-
    get_flag(typhon_taken, Taken0),
    Taken is Taken0+1,
    set_flag(typhon_taken, Taken).

turn_end(none) :-
    !,
    worker_came.
turn_end(Turn) :-
    catch(erase(Turn), error(existence_error(_, _), _), true).

%!  turns_begun(-Count) is det.
%
%   How often workers have begun with something, about.

turns_begun(Count) :-
    get_flag(typhon_taken, Count).

%!  work_doer(+Work, -Type, -What) is det.
%
%   The kind of Work: an `agent`, or a `goal`, which may be large: its name
%   will do.

work_doer(agent(Agent), agent, Agent).
work_doer(agent(_, Agent), agent, Agent).
work_doer(goal(Goal), goal, Module:Name/Arity) :-
    strip_module(Goal, Module, Plain),
    functor(Plain, Name, Arity).

                /*******************************
                *             HELD             *
                *******************************/

%!  held_count(+Workers, +Stamp, -Held) is det.
%
%   Of so many Workers, how many do what they did at Stamp.

held_count(Workers, Stamp, Held) :-
    (   census(Began),
        Began < Stamp
    ->  aggregate_all(count, returned(_), Returned),
        aggregate_all(count, held_since(Stamp, _, _), Late),
        Held is max(0, Workers-Returned)+Late
    ;   Held = 0
    ).

%!  held_since(+Stamp, ?Type, ?What) is nondet.
%
%   What holds a worker since before Stamp.

held_since(Stamp, Type, What) :-
    turn(_, Type, What, Since),
    Since < Stamp.

%!  turn_of(?Type, ?What) is nondet.
%
%   What has a worker, as far as that was noted.

turn_of(Type, What) :-
    turn(_, Type, What, _).
