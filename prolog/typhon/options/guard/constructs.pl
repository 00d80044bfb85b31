:- module(typhon_guard_constructs,
          [ construct/2                 % @Goal, -How
          ]).

/** <module> Goals that are no calls

The compiler of SWI-Prolog, call/N and the machine do not call a predicate of
the name of these goals: they run the parts.  This table is all the guard
knows of them.  Of any other goal the compiled clause calls the predicate of
that name and number of arguments, so that it suffices to check the name.

*Threading*: pure.
*/

%!  construct(@Goal, -How) is semidet.
%
%   Goal is no call.  No rule of a policy allows it, and no predicate of an
%   agent may have its name.  How is
%
%     - `plain`: it has no parts
%     - parts(Parts0, Copy, Parts): its goals are Parts0; Copy is the same
%       construct of Parts
%     - `catch`, `closure`: catch/3; call/N with a closure
%     - `refused`: agents may not use it

construct((A0,B0), parts([A0,B0], (A,B), [A,B])).
construct((A0;B0), parts([A0,B0], (A;B), [A,B])).
construct((A0->B0), parts([A0,B0], (A->B), [A,B])).
construct((A0*->B0), parts([A0,B0], (A*->B), [A,B])).
construct(\+A0, parts([A0], \+A, [A])).
construct(call(A0), parts([A0], call(A), [A])).
construct(once(A0), parts([A0], once(A), [A])).
construct(ignore(A0), parts([A0], ignore(A), [A])).
construct(catch(_,_,_), catch).
construct(!, plain).
construct(true, plain).
construct(fail, plain).
construct(_:_, refused).
construct(@(_,_), refused).
construct('|'(_,_), refused).           % a disjunction
construct($, refused).
construct($(_), refused).
construct(Goal, closure) :-
    compound(Goal),
    compound_name_arity(Goal, call, Arity),
    Arity > 1.
