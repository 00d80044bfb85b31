:- module(typhon_functors,
          [ functors_room/0
          ]).

/** <module> Space in the table of functors

A functor that one thread makes while another makes the table of all functors
larger may be missing in the new table, on 9.0.4 and on 10.1.  A thread that
names it later gets a second one, and a term of the one never unifies with the
same term of the other: a predicate that is there is not found.  The table grows
at each power of two, for ever, as no functor goes away.

So it grows before threads begin, beyond what the programs of most hosts need.
A process that has read library(typhon) has 8,700 functors, one that begins with
a saved state of it 7,800: there the table grew, at 8,192, just when its first
agents were read.

*Threading*: while no other thread makes functors.
*/

%!  functors_room is det.
%
%   The table does not grow for the next 16,000 functors: 0.5 MB and 2 ms, once.

functors_room :-
    between(50, inf, Arity),
    current_atom(Name),
    functor(_, Name, Arity),
    statistics(functors, Count),
    Count > 0x4001,
    !.
