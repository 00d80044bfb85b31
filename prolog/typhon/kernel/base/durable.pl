:- module(typhon_durable,
          [ durable/5,                  % +Kind, ?Key, ?N, ?Term, :Fact
            durable/6,                  % +Kind, ?Key, ?N, ?Term, :Dump,
                                        % :Restore
            durable_kinds/2,            % +Last, -Kinds
            durable_order/2,            % +Kind, -Order
            durable_assertz/1,          % :Fact
            durable_retractall/1,       % :Fact
            durable_dump/4,             % +Kind, -Key, -N, -Term
            durable_restore/4           % +Kind, +Key, +N, +Term
          ]).
:- use_module(durable_changes,
              [ durable_drop_all/2, durable_number/1, durable_on/0,
                durable_put/4 ]).
:- use_module(library(lists), [append/3, subtract/3]).
:- use_module(index, [part_joins/3]).
:- use_module(on_demand, [on_demand_load/2]).

/** <module> Tables that outlive the process

Data that outlives the process consists of items, item(Kind, Key, N, Term): a
journal records them as they change, a saved network holds all of them.  The
owner of a table declares it once.  A table of facts needs only the item of a
fact:

    :- durable(outcome, Id, _, Outcome-Hops, outcome(Id, Outcome, Hops)).

Where the items are not facts, as in a mailbox, which is a queue, the owner
declares how to list them, and how to restore one:

    :- durable(mail, Id, N, Message, mail_item(Id, N, Message),
               mail_restore(Id, N, Message)).

N is 0, and Term is '', where the table has none.

*Threading*: dump while nothing changes; restore before agents run.
*/

:- meta_predicate
    durable(+, ?, ?, ?, 0),
    durable(+, ?, ?, ?, 0, 0),
    durable_assertz(0),
    durable_retractall(0).

:- multifile
    restored/0,                 % called when all items are restored
    recover/0,                  % restore the items of the journal
    tidy/0,                     % called before any peer is admitted
    go_on/0.                    % resume all that was restored

:- dynamic item_table/6.        % Kind, Key, N, Term, Dump, Restore: Dump is
                                % Module:Fact for a table of facts

%!  durable(+Kind, ?Key, ?N, ?Term, :Fact) is det.
%!  durable(+Kind, ?Key, ?N, ?Term, :Dump, :Restore) is det.
%
%   Directives.  The items of this Kind are the facts Fact; or Dump enumerates
%   them, and Restore restores one.  Several tables may have one Kind: the
%   first one that accepts an item restores it.

durable(Kind, Key, N, Term, Module:Fact) :-
    durable(Kind, Key, N, Term, Module:Fact, Module:assertz(Fact)).

%   A file that is loaded again declares its tables again.

durable(Kind, Key, N, Term, Dump, Restore) :-
    Table = item_table(Kind, Key, N, Term, Dump, Restore),
    copy_term(Table, General),
    (   call(General),
        General =@= Table
    ->  true
    ;   assertz(Table)
    ).

%!  durable_kinds(+Last:list, -Kinds:list) is det.
%
%   The kinds of all declared tables, also of options that are not loaded, in
%   the order in which items are restored.  Those of Last come last, because
%   their items refer to items of the others.

durable_kinds(Last, Kinds) :-
    findall(Kind,
            (   item_table(Kind, _, _, _, _, _)
            ;   part_joins(durable, Kind, _)
            ),
            Kinds0),
    sort(Kinds0, All),
    subtract(All, Last, First),
    append(First, Last, Kinds).

%!  durable_order(+Kind, -Order) is det.
%
%   Order is `numbers` if the items of Kind have numbers, and are restored in
%   ascending order, else `any`.

durable_order(Kind, Order) :-
    (   item_table(Kind, _, _, _, _, _),
        \+ ( item_table(Kind, _, N, _, _, _), N \== 0 )
    ->  Order = any
    ;   Order = numbers
    ).

%!  durable_assertz(:Fact) is det.
%
%   Add Fact to a table of facts, as its newest item.
%
%   @error representation_error(_): no item can have this key

durable_assertz(Module:Fact) :-
    (   durable_on
    ->  once(item_table(Kind, Key, N, Term, Module:Fact, _)),
        ( var(N) -> durable_number(N) ; true ),
        no_term(Term),
        durable_put(Kind, Key, N, Term)
    ;   true
    ),
    assertz(Module:Fact).

%!  durable_retractall(:Fact) is det.
%
%   Remove the facts that match Fact, the key of which is bound.

durable_retractall(Module:Fact) :-
    (   durable_on
    ->  once(item_table(Kind, Key, _, _, Module:Fact, _)),
        durable_drop_all(Kind, Key)
    ;   true
    ),
    retractall(Module:Fact).

%!  durable_dump(+Kind, -Key, -N, -Term) is nondet.

durable_dump(Kind, Key, N, Term) :-
    item_table(Kind, Key, N, Term, Dump, _),
    call(Dump),
    ( var(N) -> N = 0 ; true ),
    no_term(Term).

no_term(Term) :-
    ( var(Term) -> Term = '' ; true ).

%!  durable_restore(+Kind, +Key, +N, +Term) is semidet.
%
%   Restore the item. Fails if no table accepts it.

durable_restore(Kind, Key, N, Term) :-
    on_demand_load(durable, Kind),
    item_table(Kind, Key, N, Term, _, Restore),
    call(Restore),
    !.
