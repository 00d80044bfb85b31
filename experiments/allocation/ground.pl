%   Chapter 7: one run of a mechanism, and its measures.
%
%   Expects the parameter `mechanism`.  Gives: the predicates of `robots`,
%   run/2, view/2, and the measures that have a label here.

:- include(robots).
:- use_module(faults, [no_reservation_faults/1]).
:- use_module(mechanisms, [mechanism_allocate/4]).
:- use_module(metrics,
              [backoffs/2, communications/2, completed/2, kind_sums/2, mean/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).

label(communications, "Messages over a link, and migrations").
label(time, "Until the last task is completed (s)").
label(backoffs, "Back-offs of an allocator").
label(interval, "Mean length of a back-off (s)").
label(upkeep, "Share of answers and renewals in the messages").
label(rate, "Time for each robot that an allocator requires (s)").
label(proposed, "proposed").
label(constant, "proposed, constant back-off").
label(murdoch, "Murdoch").
label(anta, "ANTA").

run(Case, Network) :-
    places(Case, Network, Starts),
    tasks(Case, Tasks),
    pairs_keys_values(Pairs, Tasks, Starts),
    mechanism_allocate(Case.mechanism, Pairs, Case, Network).

view(Log, view{case:Log.case, events:Log.events, intervals:Intervals}) :-
    no_reservation_faults(Log.events),
    completed(Log.events, Completed),
    length(Completed, Log.case.allocators),
    backoffs(Log.events, Intervals).

measure(communications, View, Sum) :-
    communications(View.events, Sum).
measure(time, View, Time) :-
    completed(View.events, Completed),
    aggregate_all(max(Seconds), member(_-Seconds, Completed), Time).
measure(rate, View, Rate) :-
    measure(time, View, Time),
    Rate is Time/View.case.required.
measure(backoffs, View, Mean) :-
    length(View.intervals, Count),
    Mean is Count/View.case.allocators.
measure(interval, View, Mean) :-
    mean(View.intervals, Mean).
measure(upkeep, View, Share) :-
    kind_sums(View.events, Pairs),
    aggregate_all(sum(Sum), ( member(Kind-Sum, Pairs),
                              memberchk(Kind, [ack, renew]) ), Upkeep),
    communications(View.events, All),
    Share is Upkeep/All.
measure(Kind, View, Sum) :-
    kind_sums(View.events, Pairs),
    member(Kind-Sum, Pairs).
