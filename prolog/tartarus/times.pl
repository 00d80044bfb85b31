:- module(tartarus_times,
          [ hop_done/5,                 % +Way, +Agent, +From, +To, +Seconds
            in_hop_time/2,              % ?Agent, ?Seconds
            out_hop_time/2,             % ?Agent, ?Seconds
            in_hop_time/5,              % ?Agent, ?From, ?To, ?Date, ?Seconds
            out_hop_time/5,             % ?Agent, ?From, ?To, ?Date, ?Seconds
            in_hop_time_stat/3,         % -Max, -Min, -Mean
            out_hop_time_stat/3,        % -Max, -Min, -Mean
            overall_hop_time_stat/3,    % -Max, -Min, -Mean
            in_hop_times_info/1,        % -List
            out_hop_times_info/1,       % -List
            in_hop_times_details/1,     % -List
            out_hop_times_details/1,    % -List
            hoptime/4                   % ?Agent, ?From, ?To, ?Seconds
          ]).
:- use_module(library(lists),
              [append/3, max_list/2, min_list/2, sum_list/2]).

/** <module> How long hops take

From sending to knowing that it has arrived, on the side that sends; from
sending to arriving on the other, by the clocks of both.

*Threading*: any thread.
*/

:- dynamic hop/6.                       % Way, Agent, From, To, Date, Seconds

%   So many of either way are kept.

kept(10000).

%!  hop_done(+Way, +Agent, +From, +To, +Seconds) is det.
%
%   @arg Way is `in` or `out`

hop_done(Way, Agent, From, To, Seconds) :-
    get_time(Now),
    date(Now, Date),
    assertz(hop(Way, Agent, From, To, Date, Seconds)),
    predicate_property(hop(_, _, _, _, _, _), number_of_clauses(Count)),
    kept(Most),
    (   Count > 2*Most
    ->  ignore(retract(hop(_, _, _, _, _, _)))
    ;   true
    ).

date(Stamp, (Day,Minute)) :-
    stamp_date_time(Stamp, date(Y, M, D, H, Mn, _, _, _, _), local),
    format(atom(Day), '~d/~d/~d', [D,M,Y]),
    format(atom(Minute), '~d:~d', [H,Mn]).

%!  in_hop_time(?Agent, ?Seconds) is nondet.
%!  out_hop_time(?Agent, ?Seconds) is nondet.
%!  in_hop_time(?Agent, ?From, ?To, ?Date, ?Seconds) is nondet.
%!  out_hop_time(?Agent, ?From, ?To, ?Date, ?Seconds) is nondet.
%
%   @arg Date is (Day,Minute), two atoms as '21/11/2026' and '14:7'

in_hop_time(Agent, Seconds) :-
    in_hop_time(Agent, _, _, _, Seconds).

out_hop_time(Agent, Seconds) :-
    out_hop_time(Agent, _, _, _, Seconds).

in_hop_time(Agent, From, To, Date, Seconds) :-
    hop(in, Agent, From, To, Date, Seconds).

out_hop_time(Agent, From, To, Date, Seconds) :-
    hop(out, Agent, From, To, Date, Seconds).

%!  in_hop_times_info(-List) is det.
%!  out_hop_times_info(-List) is det.
%!  in_hop_times_details(-List) is det.
%!  out_hop_times_details(-List) is det.
%
%   The hops so far: (Agent,Seconds), or (Agent,From,To,Date,Seconds).

in_hop_times_info(List) :-
    findall((Agent,Seconds), in_hop_time(Agent, Seconds), List).

out_hop_times_info(List) :-
    findall((Agent,Seconds), out_hop_time(Agent, Seconds), List).

in_hop_times_details(List) :-
    details(in, List).

out_hop_times_details(List) :-
    details(out, List).

details(Way, List) :-
    findall((Agent,From,To,Date,Seconds),
            hop(Way, Agent, From, To, Date, Seconds),
            List).

%!  in_hop_time_stat(-Max, -Min, -Mean) is det.
%!  out_hop_time_stat(-Max, -Min, -Mean) is det.
%!  overall_hop_time_stat(-Max, -Min, -Mean) is det.
%
%   0 each before the first hop.

in_hop_time_stat(Max, Min, Mean) :-
    seconds(in, Seconds),
    stat(Seconds, Max, Min, Mean).

out_hop_time_stat(Max, Min, Mean) :-
    seconds(out, Seconds),
    stat(Seconds, Max, Min, Mean).

overall_hop_time_stat(Max, Min, Mean) :-
    seconds(in, In),
    seconds(out, Out),
    append(In, Out, All),
    stat(All, Max, Min, Mean).

seconds(Way, List) :-
    findall(Seconds, hop(Way, _, _, _, _, Seconds), List).

stat([], 0, 0, 0) :-
    !.
stat(List, Max, Min, Mean) :-
    max_list(List, Max),
    min_list(List, Min),
    sum_list(List, Sum),
    length(List, Count),
    Mean is Sum/Count.

%!  hoptime(?Agent, ?From, ?To, ?Seconds) is nondet.

hoptime(Agent, From, To, Seconds) :-
    out_hop_time(Agent, From, To, _, Seconds).
