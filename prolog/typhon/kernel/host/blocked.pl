:- module(typhon_blocked,
          [ blocked_room/3,             % +Workers, +Max, -Room
            blocked_full/2,             % +Workers, +Why
            blocked_kind/1,             % ?Kind
            blocked_held/1,             % +Work
            blocked_release/1,          % -Works
            blocked_forget/0
          ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module(turns, [turn_in/3]).

/** <module> Workers that native goals block

A native goal that blocks occupies its worker.  Which goals block is known only
at run time: each thread records when its turn began (module `turns`), and a
worker whose turn has lasted for `blocked_seconds` is blocked.  The pool may
grow beyond its maximum by as many workers as are blocked, and a warning names
their agents.

At `blocked_workers` workers, or when no thread can be created, work of the
kinds that block is held until workers are free again; agents of one program
are of one kind.  The pool may then grow by its maximum for the other kinds.

*Threading*: workers call blocked_held/1.  Only the thread of the timer calls
the other predicates.
*/

:- multifile
    typhon_scheduler:kind/2,            % Agent, Kind
    prolog:message//1.

:- setting(typhon_scheduler:blocked_seconds, number, 1,
           "Seconds of a turn after which its worker is blocked").
:- setting(typhon_scheduler:blocked_workers, positive_integer, 768,
           "Number of workers from which work that blocks is held").

:- dynamic
    blocked_kind/1,             % Kind
    held/1,                     % Work of these kinds
    warned/0.                   % the pool has passed its maximum

%!  blocked_room(+Workers:list, +Max, -Room) is det.
%
%   The run queue is stuck, and all Workers are busy: Room more workers may be
%   added.  At most Max workers are not blocked.

blocked_room(Workers, Max, Room) :-
    length(Workers, Count),
    (   Count < Max
    ->  Room is Max-Count,
        retractall(warned)
    ;   blocked(Workers, Blocked),
        limit(Count, Max, Blocked, Limit),
        length(Blocked, Apart),
        Room is min(Max-(Count-Apart), Limit-Count)
    ).

limit(Count, Max, Blocked, Limit) :-
    setting(typhon_scheduler:blocked_workers, Most),
    (   Count < Most
    ->  Limit = Most,
        warn(Count, Blocked)
    ;   Limit is Most+Max,
        hold(Count, blocked_workers, Blocked)
    ).

blocked(Workers, Blocked) :-
    setting(typhon_scheduler:blocked_seconds, Seconds),
    monotonic_time(Now),
    findall(What,
            ( member(Worker, Workers),
              turn_in(Worker, What, Since),
              Now-Since > Seconds ),
            Blocked).

warn(_, []) :-
    !.
warn(_, _) :-
    warned,
    !.
warn(Count, Blocked) :-
    assertz(warned),
    print_message(warning, typhon(workers_blocked(Count, Blocked))).

%!  blocked_full(+Workers:list, +Why) is det.
%
%   The run queue is stuck, and no worker can be added: hold work of the kinds
%   that block.

blocked_full(Workers, Why) :-
    length(Workers, Count),
    blocked(Workers, Blocked),
    hold(Count, Why, Blocked).

hold(Count, Why, Blocked) :-
    findall(Kind,
            ( member(What, Blocked),
              kind(What, Kind),
              \+ blocked_kind(Kind) ),
            Kinds0),
    sort(Kinds0, Kinds),
    (   Kinds == []
    ->  true
    ;   forall(member(Kind, Kinds), assertz(blocked_kind(Kind))),
        print_message(warning, typhon(pool_full(Count, Why, Blocked)))
    ).

kind(What, Kind) :-
    (   typhon_scheduler:kind(What, Kind0)
    ->  Kind = Kind0
    ;   Kind = goal(What)
    ).

%!  blocked_kind(?Kind) is nondet.
%
%   Work of that Kind is held; usually no kind is.

%!  blocked_held(+Work) is semidet.
%
%   Work is of a kind that is held; keep it in this module.

blocked_held(Work) :-
    work_of(Work, What),
    kind(What, Kind),
    with_mutex(typhon_blocked, keep(Kind, Work)).

work_of(agent(Agent), Agent).
work_of(agent(_, Agent), Agent).
work_of(goal(_:Goal), Name) :-
    functor(Goal, Name, _).

keep(Kind, Work) :-
    blocked_kind(Kind),
    !,
    assertz(held(Work)).

%!  blocked_release(-Works:list) is det.
%
%   Stop holding work. Works is the work that was held.

blocked_release(Works) :-
    with_mutex(typhon_blocked, release(Works)).

release(Works) :-
    retractall(blocked_kind(_)),
    findall(Work, held(Work), Works),
    retractall(held(_)).

%!  blocked_forget is det.
%
%   As blocked_release/1, but drop the work.

blocked_forget :-
    blocked_release(_),
    retractall(warned).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(workers_blocked(Count, Blocked))) -->
    { length(Blocked, Length) },
    [ 'Native goals block ~D of ~D workers; the pool grows beyond its maximum.'-
      [Length, Count], nl ],
    blocked_agents(Blocked).
prolog:message(typhon(pool_full(Count, Why, Blocked))) -->
    [ '~D workers are blocked or busy, and no more can be added (~w).'-
      [Count, Why], nl,
      'Agents of the programs that block wait until workers are free.'-[],
      nl ],
    blocked_agents(Blocked).

blocked_agents(Blocked) -->
    { length(First, 10),
      append(First, More, Blocked),
      !,
      length(More, Count)
    },
    [ 'Blocked: ~p and ~D more'-[First, Count] ].
blocked_agents(Blocked) -->
    [ 'Blocked: ~p'-[Blocked] ].
