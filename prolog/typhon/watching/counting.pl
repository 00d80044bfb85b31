:- module(typhon_counting,
          [ counting_begin/0,
            counted/2,                  % ?What, -Count
            counted_hops/2              % -Buckets, -Sum
          ]).
:- use_module(library(lists), [nth1/3]).
:- use_module('../host', [events_hear/3, events_unheard/1, host/3]).

/** <module> What has happened, in numbers

Nothing is counted until somebody has asked for numbers for the first time.
From then on this process counts, as long as it has an endpoint.

*Threading*: any thread.  Numbers are flags.
*/

:- multifile
    typhon_events:told/4,
    typhon_hosting:begins/1,
    typhon_runtime:ending/1.

:- dynamic counting/0.

%!  counting_begin is det.

counting_begin :-
    counting,
    !.
counting_begin :-
    with_mutex(typhon_counting, begin).

begin :-
    counting,
    !.
begin :-
    assertz(counting),
    forall(host(Name, _, _), count_on(Name)).

count_on(Name) :-
    events_hear([life, faults, hops, messages], Name, count).

typhon_hosting:begins(Name) :-
    counting,
    count_on(Name).

typhon_runtime:ending(after) :-
    retractall(counting),
    events_unheard(count).

typhon_events:told(count, _, _, What) :-
    count(What).

count(arrived(_, Seconds)) =>
    bucket(Seconds, Number),
    bump(hops(Number), 1),
    bump(seconds, Seconds).
count(sent(_, _)) =>
    bump(sent, 1).
count(received(_, _)) =>
    bump(received, 1).
count(fault(_)) =>
    bump(faults, 1).
count(created) =>
    bump(created, 1).
count(ended(_)) =>
    bump(ended, 1).
count(_) =>
    true.

bump(What, By) :-
    key(What, Key),
    flag(Key, N, N+By).

key(hops(Number), Key) :-
    arg(Number, hops('typhon hops 1', 'typhon hops 2', 'typhon hops 3',
                     'typhon hops 4', 'typhon hops 5', 'typhon hops 6',
                     'typhon hops 7', 'typhon hops 8', 'typhon hops 9',
                     'typhon hops 10', 'typhon hops 11', 'typhon hops 12',
                     'typhon hops 13'), Key).
key(seconds, 'typhon count seconds').
key(sent, 'typhon count sent').
key(received, 'typhon count received').
key(faults, 'typhon count faults').
key(created, 'typhon count created').
key(ended, 'typhon count ended').

bounds([0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01, 0.05, 0.1, 0.5,
        1.0, 10.0, inf]).

bucket(Seconds, Number) :-
    bounds(Bounds),
    nth1(Number, Bounds, Bound),
    Seconds =< Bound,
    !.

%!  counted(?What, -Count) is nondet.
%
%   What is `sent`, `received`, `faults`, `created` or `ended`.

counted(What, Count) :-
    key(What, Key),
    atom(What),
    What \== seconds,
    flag(Key, Count, Count).

%!  counted_hops(-Buckets, -Sum) is det.
%
%   Buckets are Bound-Count: so many hops have taken at most Bound seconds of
%   the clock of the host, a number or `inf`, and Sum is what all have taken.

counted_hops(Buckets, Sum) :-
    bounds(Bounds),
    cumulated(Bounds, 1, 0, Buckets),
    key(seconds, Key),
    flag(Key, Sum, Sum).

cumulated([], _, _, []).
cumulated([Bound|Bounds], Number, Count0, [Bound-Count|Buckets]) :-
    key(hops(Number), Key),
    flag(Key, Own, Own),
    Count is Count0+Own,
    Next is Number+1,
    cumulated(Bounds, Next, Count, Buckets).
