:- module(typhon_erased,
          [ forget_erased/0
          ]).

/** <module> References to clauses that are gone

Loading, for one, leaves references to erased clauses on the stacks of the
thread that does it.  As long as there are some, 9.0.4 collects atoms
whenever it collects clauses: every dozen hops, for a quarter of what they
cost.  For the same reason no table that changes with each hop is changed by
clause references.

*Threading*: of the thread that calls.
*/

%!  forget_erased is det.
%
%   Forget those that no table holds any more.

forget_erased :-
    garbage_collect,
    garbage_collect_atoms.
