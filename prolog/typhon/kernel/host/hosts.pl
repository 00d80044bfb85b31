:- module(typhon_hosts,
          [ host/3,                     % ?Name, ?Address, ?Place
            host_add/4,                 % +Name, +Address, +Place, +Options
            host_close/1,               % +Name
            host_closed/1,              % +Name
            host_remove/1,              % +Name
            host_option/2,              % ?Name, ?Option
            host_put/2,                 % +Name, +Option
            host_note/1,                % +Name
            host_enter/3,               % +Name, +Tokens, -Answer
            host_again/1,               % +Name
            host_leave/1,               % +Name
            host_load/2,                % +Name, -Load
            host_hop/3,                 % +Name, +Direction, +Seconds
            host_plain/2,               % ?Name, -Plain
            host_plain_leaves/2,        % +Name, -Since
            host_came/2,                % +Name-Plain, +Since
            host_left/2,                % +Name, +Since
            host_passes/4,              % +From, +Name-To, +Since, -Seconds
            host_passed/3,              % +Here, +There, +Seconds
            host_hop_stats/3            % +Name, ?Direction, -Stats
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/durable', [durable/6]).
:- use_module('../base/durable_changes',
              [durable_drop/3, durable_on/0, durable_put/4]).
:- use_module('../base/bounds', [memory_short/1]).
:- use_module(time, [clock/3, host_time/2, time_now/1]).
:- use_module(links, [host_unlink/2]).
:- use_module(host_parts, [parts/3, parts_compile/1, parts_forget/1]).

/** <module> Hosts of this process

The records of hosts: name, address, place, options, how many agents stand
on them and how long hops take.

*Threading*: any thread.  Load and statistics are flags, which change under
one mutex: flag/3 would lock for each of them.
*/

:- dynamic
    host/3,                     % Name, Address, Place
    option/2,                   % Name, Option
    door/4,                     % Name, Tokens, Capacity, Flag: while
                                % it is open
    load_key/2,                 % Name, Flag
    hop_keys/3,                 % Name, Direction, Flags
    host_plain/2.               % Name, Plain

%!  host(?Name, ?Address, ?Place) is nondet.
%
%   The hosts of this process, in the order in which they were started.

%!  host_add(+Name, +Address, +Place, +Options) is det.

host_add(Name, Address, Place, Options) :-
    make_keys(Name),
    forall(member(Option, Options), assertz(option(Name, Option))),
    parts_compile(Name),
    assertz(host(Name, Address, Place)),
    open_door(Name),
    note_plain(Name),
    host_note(Name).

open_door(Name) :-
    asked(Name, tokens(Tokens), []),
    asked(Name, capacity(Capacity), inf),
    load_key(Name, Key),
    assertz(door(Name, Tokens, Capacity, Key)).

%!  host_plain(?Name, -Plain) is nondet.
%!  host_plain_leaves(+Name, -Since:float) is semidet.
%
%   Nothing comes between what happens on Name and the kernel: the host is open,
%   has no parts and asks for no token.  Plain is what a hop has to know of it,
%   one fact.  A hop from there to another process begins now, at Since; fails if
%   Name is not plain, or hops are delayed.

note_plain(Name) :-
    (   \+ parts(_, Name, _),
        door(Name, [], Capacity, Load),
        host(Name, Address, Place),
        asked(Name, hop_time(Delay), none),
        clock(Name, Epoch, Rate),
        hop_keys(Name, in, In),
        hop_keys(Name, out, Out)
    ->  assertz(host_plain(Name, plain(Address, Place, Delay, Epoch, Rate,
                                       Capacity, Load, In, Out)))
    ;   true
    ).

host_plain_leaves(Name, Since) :-
    host_plain(Name, plain(_, _, none, Epoch, Rate, _, _, _, _)),
    !,
    get_time(Now),
    Since is (Now-Epoch)*Rate.

asked(Name, Option, Default) :-
    (   option(Name, Option)
    ->  true
    ;   arg(1, Option, Default)
    ).

%   Flags are counters that many threads change without leaving garbage.

make_keys(Name) :-
    atom_concat('typhon load ', Name, Load),
    flag(Load, _, 0),
    assertz(load_key(Name, Load)),
    forall(direction(Direction), make_hop_keys(Name, Direction)).

make_hop_keys(Name, Direction) :-
    findall(Key,
            ( member(What-Zero, [count-0, min-inf, sum-0.0, max-0.0]),
              atomic_list_concat(['typhon hop ', Direction, What, Name],
                                 ' ', Key),
              Value is Zero,
              flag(Key, _, Value)
            ),
            Keys),
    Flags =.. [flags|Keys],
    assertz(hop_keys(Name, Direction, Flags)).

%   How many stand there, and how long hops took.

:- durable(counts, Name, 0, Values, counts_item(Name, Values),
           counts_restore(Name, Values)).

counts_item(Name, Values) :-
    host(Name, _, _),
    findall(Value, ( count_key(Name, Key), flag(Key, Value, Value) ), Values).

counts_restore(Name, Values) :-
    findall(Key, count_key(Name, Key), Keys),
    maplist(set_flag, Keys, Values).

count_key(Name, Key) :-
    load_key(Name, Key).
count_key(Name, Key) :-
    hop_keys(Name, _, Flags),
    arg(_, Flags, Key).

%!  host_close(+Name) is det.
%!  host_closed(+Name) is semidet.
%
%   From now on no agent is admitted: it is about to stop.

host_close(Name) :-
    retractall(host_plain(Name, _)),
    retractall(door(Name, _, _, _)).

host_closed(Name) :-
    \+ door(Name, _, _, _).

%!  host_remove(+Name) is det.

host_remove(Name) :-
    durable_drop(host, Name, 0),
    host_close(Name),
    retractall(host(Name, _, _)),
    retractall(option(Name, _)),
    host_unlink(Name, _),
    retractall(load_key(Name, _)),
    retractall(hop_keys(Name, _, _)),
    parts_forget(Name).

%!  host_option(?Name, ?Option) is nondet.

host_option(Name, Option) :-
    option(Name, Option).

%!  host_note(+Name) is det.
%
%   What its options are by now outlives the process.  As host_add/4 and
%   host_put/2 do, if changes are queued already.

host_note(Name) :-
    (   durable_on
    ->  findall(Option,
                ( option(Name, Option),
                  \+ typhon_host_parts:unnoted(Option) ),
                Options),
        durable_put(host, Name, 0, Options)
    ;   true
    ).

%!  host_put(+Name, +Option) is det.
%
%   Option replaces that of its name.  The new comes before the old goes: a
%   host is never without.  It is not plain until the parts are those of the
%   new options.

host_put(Name, Option) :-
    functor(Option, OptionName, Arity),
    functor(Old, OptionName, Arity),
    retractall(host_plain(Name, _)),
    (   option(Name, Old)
    ->  assertz(option(Name, Option)),
        once(retract(option(Name, Old)))
    ;   assertz(option(Name, Option))
    ),
    parts_compile(Name),
    (   door(Name, Tokens, Capacity, Key)
    ->  open_door(Name),
        once(retract(door(Name, Tokens, Capacity, Key)))
    ;   true                            % it stops
    ),
    note_plain(Name),
    host_note(Name).

                /*******************************
                *          ADMISSION           *
                *******************************/

%!  host_enter(+Name, +Tokens, -Answer) is det.
%
%   An agent with Tokens asks to enter.  Answer is `ok`, and a place is taken
%   for it, or refused(Reason).

host_enter(Name, Tokens, Answer) :-
    (   door(Name, Wanted, Capacity, Load)
    ->  (   Wanted \== [],
            \+ shown(Wanted, Tokens)
        ->  Answer = refused(token)
        ;   with_mutex(typhon_host_flags, room_taken(Capacity, Load, Answer))
        )
    ;   Answer = refused(unknown_host)
    ).

shown(Wanted, Tokens) :-
    member(Token, Wanted),
    member(Shown, Tokens),
    subsumes_term(Token, Shown),        % no master key, which would fit all
    !.

room_taken(Capacity, Key, Answer) :-
    get_flag(Key, Load),
    (   Load < Capacity
    ->  Load1 is Load+1,
        set_flag(Key, Load1),
        Answer = ok
    ;   Answer = refused(capacity)
    ).

count_load(Key, Change) :-
    get_flag(Key, Load0),
    Load is Load0+Change,
    set_flag(Key, Load).

%!  host_came(+Where, +Since) is semidet.
%
%   An agent has come to Where, Name-Plain as of host_plain/2, by a hop that began
%   at Since, in host time; fails, and it has not, if there is no capacity, or the
%   host is plain no longer.

host_came(Where, Since) :-
    Where = _-plain(_, _, _, Epoch, Rate, _, _, In, _),
    get_time(Now),
    Seconds is max(0.0, (Now-Epoch)*Rate-Since),
    with_mutex(typhon_host_flags, came(Where, In, Seconds)).

%!  host_again(+Name) is det.
%!  host_leave(+Name) is det.
%
%   An agent on Name counts again, whatever its capacity; or no longer.

host_again(Name) :-
    (   load_key(Name, Key)
    ->  with_mutex(typhon_host_flags, count_load(Key, 1))
    ;   true                            % stopped meanwhile
    ).

host_leave(Name) :-
    (   load_key(Name, Key)
    ->  with_mutex(typhon_host_flags, count_load(Key, -1))
    ;   true                            % stopped meanwhile
    ).

%!  host_load(+Name, -Load:integer) is det.

host_load(Name, Load) :-
    load_key(Name, Key),
    get_flag(Key, Load).

                /*******************************
                *           HOP TIMES          *
                *******************************/

%!  host_hop(+Name, +Direction, +Seconds) is det.
%!  host_left(+Name, +Since) is det.
%!  host_passes(+From, +Where, +Since, -Seconds:float) is semidet.
%!  host_passed(+Here, +There, +Seconds) is det.
%
%   A hop into (`in`) or out of (`out`) Name took Seconds of host time; an agent
%   on Name has gone to another process by one that began at Since.  An agent has
%   passed from a host of this process that is plain as From says to Where, see
%   host_came/2, by one that began at Since; fails, and it has not, where that
%   does.  An agent on Here is on There now, where its place was taken before.

host_hop(Name, Direction, Seconds) :-
    hop_keys(Name, Direction, Flags),
    !,
    with_mutex(typhon_host_flags, add_hop(Flags, Seconds)).
host_hop(_, _, _).

host_left(Name, Since) :-
    host_plain(Name, plain(_, _, _, Epoch, Rate, _, Load, _, Out)),
    !,
    get_time(Now),
    Seconds is max(0.0, (Now-Epoch)*Rate-Since),
    with_mutex(typhon_host_flags, left(Load, Out, Seconds)).
host_left(Name, Since) :-
    host_time(Name, Now),
    !,
    Seconds is max(0.0, Now-Since),
    host_hop(Name, out, Seconds),
    host_leave(Name).
host_left(_, _).                        % stopped meanwhile

host_passes(plain(_, _, _, Epoch, Rate, _, Load0, _, Out), Where, Since,
            Seconds) :-
    Where = _-plain(_, _, _, _, _, _, _, In, _),
    time_now(Now),
    Seconds is max(0.0, (Now-Epoch)*Rate-Since),
    with_mutex(typhon_host_flags, passes(Where, Load0, Out, In, Seconds)).

passes(Where, Load0, Out, In, Seconds) :-
    Where = _-plain(_, _, _, _, _, _, Load, _, _),
    get_flag(Load, Count),
    place_taken(Where, Count),
    left(Load0, Out, Seconds),
    add_hop(In, Seconds).

%   place_taken(+Where, +Count): Count agents stand there, and one more from now
%   on.  A host that stops is not plain any more, and then waits until its load is 0:
%   where it is still plain after the load has grown, the stop waits for the agent.

place_taken(Name-Plain, Count) :-
    Plain = plain(_, _, _, _, _, Capacity, Load, _, _),
    Count < Capacity,
    Count1 is Count+1,
    set_flag(Load, Count1),
    (   host_plain(Name, Plain)
    ->  true
    ;   set_flag(Load, Count),
        fail
    ).

%   A host that stops waits until its load is 0, so that is counted last.

host_passed(Here, There, Seconds) :-
    host_hop(Here, out, Seconds),
    host_hop(There, in, Seconds),
    host_leave(Here).

came(Where, In, Seconds) :-
    Where = _-plain(_, _, _, _, _, _, Load, _, _),
    get_flag(Load, Count),
    Next is Count+1,
    \+ memory_short(Next),
    place_taken(Where, Count),
    add_hop(In, Seconds).

left(Load, Out, Seconds) :-
    count_load(Load, -1),
    add_hop(Out, Seconds).

%   In virtual time hops mostly take none.

add_hop(flags(Count, Min, Sum, Max), Seconds) :-
    get_flag(Count, N0), N is N0+1, set_flag(Count, N),
    (   Seconds =:= 0.0,
        get_flag(Min, 0.0)
    ->  true
    ;   get_flag(Sum, Sum0), Sum1 is Sum0+Seconds, set_flag(Sum, Sum1),
        get_flag(Min, Min0),
        ( Seconds < Min0 -> set_flag(Min, Seconds) ; true ),
        get_flag(Max, Max0),
        ( Seconds > Max0 -> set_flag(Max, Seconds) ; true )
    ).

direction(in).
direction(out).

%!  host_hop_stats(+Name, ?Direction, -Stats) is nondet.
%
%   Stats is stats(Count, Min, Mean, Max), in host seconds.

host_hop_stats(Name, Direction, stats(Count, Min, Mean, Max)) :-
    direction(Direction),
    once(hop_keys(Name, Direction, flags(CountKey, MinKey, SumKey, MaxKey))),
    get_flag(CountKey, Count),
    (   Count =:= 0
    ->  Min = 0.0, Mean = 0.0, Max = 0.0
    ;   get_flag(MinKey, Min),
        get_flag(SumKey, Sum),
        get_flag(MaxKey, Max),
        Mean is Sum/Count
    ).
