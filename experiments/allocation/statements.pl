:- module(allocation_statements,
          [ statement/3                 % ?Figure, ?Text, ?Test
          ]).

/** <module> What thesis sections 7.6.1 to 7.6.4 say of the figures

Tests are those of allocation_claims.  The thesis speaks of averages of five
runs.

*Threading*: pure.
*/

%!  statement(?Figure, ?Text, ?Test) is nondet.

statement(Figure, Text, Test) :-
    competition(Figure),
    competing(Text, Test).
statement(Figure, Text, Test) :-
    particular(Figure, Text, Test).

competition('7.1').
competition('7.2').

competing('proposed: fewer than 10,000 communications at the most \c
allocators', last_below(proposed, communications, 10000)).
competing('proposed: least communications throughout',
          least(proposed, [murdoch, anta], communications)).
competing('Murdoch: communications rise more than those of proposed',
          steeper(murdoch, proposed, communications)).
competing('ANTA: communications rise more than those of proposed',
          steeper(anta, proposed, communications)).
competing('proposed: communications grow with the allocators',
          grows(proposed, communications)).
competing('Murdoch: communications grow with the allocators',
          grows(murdoch, communications)).
competing('ANTA: communications grow with the allocators',
          grows(anta, communications)).
competing('proposed: completed sooner than Murdoch throughout',
          least(proposed, [murdoch], time)).
competing('proposed: completed sooner than ANTA throughout',
          least(proposed, [anta], time)).
competing('proposed: more back-offs than Murdoch throughout',
          most(proposed, [murdoch], backoffs)).
competing('proposed: more back-offs than ANTA throughout',
          most(proposed, [anta], backoffs)).
competing('proposed: shorter back-offs than Murdoch throughout',
          least(proposed, [murdoch], interval)).
competing('proposed: shorter back-offs than ANTA throughout',
          least(proposed, [anta], interval)).
competing('proposed: back-offs get longer with the allocators',
          grows(proposed, interval)).

particular('7.1', 'Murdoch: more than 50,000 communications at the most \c
allocators', last_above(murdoch, communications, 50000)).
particular('7.1', 'ANTA: more than 50,000 communications at the most \c
allocators', last_above(anta, communications, 50000)).
particular('7.1', 'proposed: 2.6 back-offs of an allocator that is alone \c
(within 1)', first_near(proposed, backoffs, 2.6, 1)).
particular('7.1', 'proposed: an allocator that is alone backs off for \c
5.16 s (within 3 s)', first_near(proposed, interval, 5.16, 3)).
particular('7.2', 'Murdoch: more than 50,000 communications at the most \c
allocators', last_above(murdoch, communications, 50000)).
particular('7.2', 'proposed: communications about as on the dynamic network \c
(0.5 to 2 times)', compared(proposed, communications, 0.5, 2)).
particular('7.2', 'Murdoch: communications about as on the dynamic network \c
(0.5 to 2 times)', compared(murdoch, communications, 0.5, 2)).
particular('7.2', 'ANTA: a large reduction against the dynamic network \c
(to less than half)', compared(anta, communications, 0, 0.5)).
particular('7.2', 'proposed: completed about as soon as on the dynamic \c
network (0.5 to 2 times)', compared(proposed, time, 0.5, 2)).
particular('7.3', 'adaptive: more communications than constant throughout',
          most(proposed, [constant], communications)).
particular('7.3', 'the times follow almost the same trend: both rise, the \c
rises differ by less than twice', same_rise(proposed, constant, time, 2)).
particular('7.4', 'proposed: communications fall with the density',
           falls(proposed, communications)).
particular('7.4', 'ANTA: communications fall with the density',
           falls(anta, communications)).
particular('7.4', 'Murdoch: communications grow with the density',
           grows(murdoch, communications)).
particular('7.4', 'proposed: least communications throughout',
           least(proposed, [murdoch, anta], communications)).
particular('7.4', 'proposed: time falls with the density',
           falls(proposed, time)).
particular('7.4', 'Murdoch: time falls with the density',
           falls(murdoch, time)).
particular('7.4', 'ANTA: time falls with the density', falls(anta, time)).
particular('7.4', 'proposed: least time throughout',
           least(proposed, [murdoch, anta], time)).
particular('7.4', 'proposed: back-offs fall with the density',
           falls(proposed, backoffs)).
particular('7.4', 'Murdoch: back-offs fall with the density, first to last',
           lower_at_last(murdoch, backoffs)).
particular('7.4', 'ANTA: back-offs fall with the density, first to last',
           lower_at_last(anta, backoffs)).
particular('7.4', 'proposed: back-offs get shorter with the density',
           falls(proposed, interval)).
particular('7.5', 'communications grow with the size',
           grows(proposed, communications)).
particular('7.5', 'time grows with the size', grows(proposed, time)).
particular('7.5', 'fewer than 20,000 communications on the largest network',
           last_below(proposed, communications, 20000)).
particular('7.5', 'fewer of them than Murdoch has on half the network',
           last_below_other(murdoch, communications)).
particular('7.5', 'fewer of them than ANTA has on half the network',
           last_below_other(anta, communications)).
particular('7.5', 'time for each required robot falls slightly with the \c
size, first to last', lower_at_last(proposed, rate)).
