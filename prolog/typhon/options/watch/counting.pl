:- module(typhon_counting,
          [ counting_begin/0,
            counted/2,                  % ?What, -Count
            counted_hops/2              % -Buckets, -Sum
          ]).
:- use_module('../../kernel/host', [events_hear/3, events_unheard/1, host/3]).

/** <module> What has happened, in numbers

Nothing is counted until the first request for numbers.
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
    bound(Bound, Key),
    Seconds =< Bound,
    !,
    flag(Key, N, N+1),
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

key(seconds, 'typhon count seconds').
key(sent, 'typhon count sent').
key(received, 'typhon count received').
key(faults, 'typhon count faults').
key(created, 'typhon count created').
key(ended, 'typhon count ended').

%   bound(?Seconds, ?Key): the flag of hops that took so long at the most

bound(0.0001, 'typhon count hops 1').
bound(0.00025, 'typhon count hops 2').
bound(0.0005, 'typhon count hops 3').
bound(0.001, 'typhon count hops 4').
bound(0.0025, 'typhon count hops 5').
bound(0.005, 'typhon count hops 6').
bound(0.01, 'typhon count hops 7').
bound(0.05, 'typhon count hops 8').
bound(0.1, 'typhon count hops 9').
bound(0.5, 'typhon count hops 10').
bound(1.0, 'typhon count hops 11').
bound(10.0, 'typhon count hops 12').
bound(inf, 'typhon count hops 13').

%!  counted(?What, -Count) is nondet.
%
%   What is `sent`, `received`, `faults`, `created` or `ended`.

counted(What, Count) :-
    key(What, Key),
    What \== seconds,
    flag(Key, Count, Count).

%!  counted_hops(-Buckets, -Sum) is det.
%
%   Buckets are Bound-Count: so many hops have taken at most Bound seconds of
%   the clock of the host, a number or `inf`, and Sum is what all have taken.

counted_hops(Buckets, Sum) :-
    findall(Bound-Count,
            ( bound(Bound, Key), flag(Key, Count, Count) ), Counts),
    cumulated(Counts, 0, Buckets),
    key(seconds, SumKey),
    flag(SumKey, Sum, Sum).

cumulated([], _, []).
cumulated([Bound-Own|Counts], Count0, [Bound-Count|Buckets]) :-
    Count is Count0+Own,
    cumulated(Counts, Count, Buckets).
