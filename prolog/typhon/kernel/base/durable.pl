:- module(typhon_durable,
          [ durable_dump/4,             % +Kind, -Key, -N, -Term
            durable_restore/4           % +Kind, +Key, +N, +Term
          ]).
:- use_module(on_demand, [on_demand_load/2]).

/** <module> Tables that outlive the process

What outlives a process is items, item(Kind, Key, N, Term): a journal notes
them as they change, a saved network holds all of them.  Where a kind of item
is a table of facts, its owner declares that once,

    typhon_durable:fact_table(outcome, Id, _, Outcome-Hops,
                         typhon_home:outcome(Id, Outcome, Hops)).

and both directions follow.  Where it is more than that, as a mailbox, the
owner defines dump/4, restore/4 or both.

*Threading*: dump while nothing changes; restore before agents run.
*/

:- multifile
    fact_table/5,                    % Kind, Key, N, Term, Module:Fact
    dump/4,                     % Kind, Key, N, Term: there is this item
    restore/4,                  % Kind, Key, N, Term: put it where it was
    restored/0,                 % all items of a journal are restored
    recover/0,                  % the items of a journal are to be restored
    tidy/0,                     % no peer is let in yet
    go_on/0.                    % what was restored goes on

:- dynamic
    fact_table/5,
    dump/4,
    restore/4,
    restored/0,
    recover/0,
    tidy/0,
    go_on/0.

%!  durable_dump(+Kind, -Key, -N, -Term) is nondet.
%
%   The items of this kind.  N is 0 where the table does not number its items.

durable_dump(Kind, Key, N, Term) :-
    dump(Kind, Key, N, Term).
durable_dump(Kind, Key, N, Term) :-
    \+ dumps(Kind),
    fact_table(Kind, Key, N, Term, Fact),
    call(Fact),
    ( var(N) -> N = 0 ; true ).

dumps(Kind) :-
    clause(dump(Kind, _, _, _), _),
    !.

%!  durable_restore(+Kind, +Key, +N, +Term) is semidet.
%
%   Put the item where it was.  Fails if no owner knows items like this.

durable_restore(Kind, _, _, _) :-
    on_demand_load(durable, Kind),
    fail.
durable_restore(Kind, Key, N, Term) :-
    restore(Kind, Key, N, Term),
    !.
durable_restore(Kind, Key, N, Term) :-
    fact_table(Kind, Key, N, Term, Fact),
    !,
    assertz(Fact).
