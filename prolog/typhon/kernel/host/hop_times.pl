:- module(typhon_hop_times,
          [ hop_times_begin/1,          % +Name
            hop_times_end/1,            % +Name
            hop_times_flags/3,          % ?Name, ?Direction, -Flags
            hop_time_add/2,             % +Flags, +Seconds
            host_hop/3                  % +Name, +Direction, +Seconds
          ]).
:- use_module(library(lists), [member/2]).

/** <module> How long hops take

For each host the number of hops into it (`in`) and out of it (`out`), and the
least, mean and longest time of them, in host seconds.

*Threading*: any thread.  The numbers are flags, counters that many threads
change without leaving garbage.  They change under the mutex of the load of
hosts, typhon_host_flags: flag/3 would lock for each of them.
*/

:- dynamic hop_times_flags/3.   % Name, Direction, Flags

direction(in).
direction(out).

%!  hop_times_begin(+Name) is det.
%!  hop_times_end(+Name) is det.
%
%   The host Name begins, and ends.

hop_times_begin(Name) :-
    forall(direction(Direction), make_flags(Name, Direction)).

hop_times_end(Name) :-
    retractall(hop_times_flags(Name, _, _)).

make_flags(Name, Direction) :-
    findall(Key,
            ( member(What-Zero, [count-0, min-inf, sum-0.0, max-0.0]),
              atomic_list_concat(['typhon hop ', Direction, What, Name],
                                 ' ', Key),
              Value is Zero,
              flag(Key, _, Value)
            ),
            Keys),
    Flags =.. [flags|Keys],
    assertz(hop_times_flags(Name, Direction, Flags)).

%!  hop_times_flags(+Name, ?Direction, -Flags) is nondet.
%
%   Flags is flags(Count, Min, Sum, Max), of Name in that Direction.

%!  host_hop(+Name, +Direction, +Seconds) is det.
%
%   Record a hop into (`in`) or out of (`out`) Name that took Seconds of host
%   time.

host_hop(Name, Direction, Seconds) :-
    hop_times_flags(Name, Direction, Flags),
    !,
    with_mutex(typhon_host_flags, hop_time_add(Flags, Seconds)).
host_hop(_, _, _).

%!  hop_time_add(+Flags, +Seconds) is det.
%
%   As host_hop/3, inside the mutex, for Flags of hop_times_flags/3. In virtual
%   time most hops take no time.

hop_time_add(flags(Count, Min, Sum, Max), Seconds) :-
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
