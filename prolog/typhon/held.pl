:- module(typhon_held,
          [ held_begin/2,               % +Work, -Turn
            held_end/2,                 % +Turn, -Works
            held_ended/1,               % +Worker
            held_by/2,                  % +Agent, -Worker
            held_all/2,                 % +Count, +Since
            held_room/2,                % +Count, +Max
            held_full/2,                % +Count, +Why
            held_back/1,                % +Work
            held_forget/0
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> Workers that are held by what blocks

Which worker does what, and since when.  A native goal that blocks holds
its worker; nobody knows beforehand which goals do.  A worker that has done
one thing for longer than `held_seconds` is held.  The pool may grow beyond
its maximum by as many as are held, so there are workers for what does not
block, and people are told which agents do.

When there are `held_workers`, or no more threads can be made, it is known
what kinds of work hold workers: agents of one program are of one kind.
From then on these are held back until enough have come back.  `max_workers`
more can be made for the other kinds.

*Threading*: workers note what they begin and end; held_all/2, held_room/2
and held_full/2 are for the timer's thread alone.
*/

:- multifile
    typhon_scheduler:kind/2,            % Agent, Kind
    prolog:message//1.

:- setting(held_seconds, number, 1,
           "A worker that does one thing for longer is held").
:- setting(held_workers, positive_integer, 768,
           "When there are so many workers, what blocks is held back").

:- dynamic
    turn/4,                     % Worker, agent or goal, Agent or PI, Since
    blocking/1,                 % Kind: is held back
    back/1,                     % Work that is held back
    warned/1.                   % grown, full: people were told

                /*******************************
                *             TURNS            *
                *******************************/

%!  held_begin(+Work, -Turn) is det.
%!  held_end(+Turn, -Works) is det.
%!  held_ended(+Worker) is det.
%
%   This worker begins with Work, ends it, or has ended itself.  Works were
%   held back, and may be done now.

held_begin(Work, Turn) :-
    thread_self(Me),
    get_time(Now),
    doing(Work, Type, What),
    asserta(turn(Me, Type, What, Now), Turn).

%   A goal may be large: its name will do.

doing(agent(Agent), agent, Agent).
doing(agent(_, Agent), agent, Agent).
doing(goal(Goal), goal, Module:Name/Arity) :-
    strip_module(Goal, Module, Plain),
    functor(Plain, Name, Arity).

held_end(Turn, Works) :-
    erase(Turn),
    (   blocking(_)
    ->  may_go(Works)
    ;   Works = []
    ).

held_ended(Worker) :-
    retractall(turn(Worker, _, _, _)).

%!  held_by(+Agent, -Worker) is nondet.

held_by(Agent, Worker) :-
    turn(Worker, agent, Agent, _).

%!  held_forget is det.

held_forget :-
    retractall(turn(_, _, _, _)),
    retractall(blocking(_)),
    retractall(back(_)),
    retractall(warned(_)).

                /*******************************
                *          IS THERE ROOM       *
                *******************************/

%!  held_all(+Count, +Since) is semidet.
%
%   Each of Count workers does what it did at the time Since.

held_all(Count, Since) :-
    aggregate_all(count, held_since(Since, _, _), Count).

%!  held_room(+Count, +Max) is semidet.
%
%   Of Count workers so many are held that there is room for one more where
%   Max others may be.

held_room(Count, Max) :-
    Count < Max,
    !,
    retractall(warned(grown)).
held_room(Count, Max) :-
    held(Held),
    Count-Held < Max,
    setting(held_workers, Most),
    (   Count < Most
    ->  warn(Count)
    ;   held_full(Count, held_workers),
        Count < Most+Max
    ).

held(Count) :-
    long_ago(Stamp),
    aggregate_all(count, held_since(Stamp, _, _), Count).

held_since(Stamp, Type, What) :-
    turn(_, Type, What, Since),
    Since < Stamp.

long_ago(Stamp) :-
    setting(held_seconds, Seconds),
    get_time(Now),
    Stamp is Now-Seconds.

warn(_) :-
    warned(grown),
    !.
warn(Count) :-
    assertz(warned(grown)),
    doers(Doers),
    print_message(warning, typhon(held(Count, Doers))).

%   What has been done for longest comes first.

doers(Doers) :-
    findall(Since-What, turn(_, _, What, Since), Pairs),
    keysort(Pairs, Sorted),
    pairs_values(Sorted, Doers).

                /*******************************
                *           NO MORE ROOM       *
                *******************************/

%!  held_full(+Count, +Why) is det.
%
%   There are Count workers, and cannot be more: what is known to block is
%   held back.

held_full(Count, Why) :-
    long_ago(Stamp),
    findall(Kind, ( held_since(Stamp, Type, What), kind(Type, What, Kind) ),
            Kinds0),
    sort(Kinds0, Kinds),
    findall(Kind, ( member(Kind, Kinds), \+ blocking(Kind) ), New),
    forall(member(Kind, New), assertz(blocking(Kind))),
    (   New == [],
        warned(full)
    ->  true
    ;   retractall(warned(full)),
        assertz(warned(full)),
        doers(Doers),
        print_message(warning, typhon(held_full(Count, Why, Doers)))
    ).

kind(agent, Agent, Kind) :-
    typhon_scheduler:kind(Agent, Kind),
    !.
kind(goal, Goal, goal(Goal)).

%!  held_back(+Work) is semidet.
%
%   Work is of a kind that blocks, at a time when there is no room for
%   such: it is put back.

held_back(Work) :-
    blocking(_),
    doing(Work, Type, What),
    kind(Type, What, Kind),
    with_mutex(typhon_held, put_back(Kind, Work)).

put_back(Kind, Work) :-
    blocking(Kind),
    !,
    assertz(back(Work)).

%   may_go(-Works): a worker has come back.  What is held back may go when
%   there is room again.

may_go(Works) :-
    held(Held),
    setting(held_workers, Most),
    Held < Most*3//4,
    !,
    with_mutex(typhon_held,
               ( retractall(blocking(_)),
                 retractall(warned(full)),
                 findall(Work, back(Work), Works),
                 retractall(back(_)) )).
may_go([]).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(held(Count, Doers))) -->
    [ 'All ~D workers are held by what blocks; there are more now.'-[Count],
      nl ],
    doers(Doers).
prolog:message(typhon(held_full(Count, Why, Doers))) -->
    [ 'All ~D workers are held by what blocks, and there cannot be more \c
       (~w):'-[Count, Why], nl,
      'their like waits until some have come back.'-[], nl ],
    doers(Doers).

doers(Doers) -->
    { length(First, 10),
      append(First, More, Doers),
      !,
      length(More, Count)
    },
    [ 'They are ~p and ~D more'-[First, Count] ].
doers(Doers) -->
    [ 'They are ~p'-[Doers] ].
