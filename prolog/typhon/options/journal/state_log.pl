:- module(typhon_state_log,
          [ state_log_begin/1,          % +Module
            state_log_changes/2,        % +Module, -Changes
            state_log_end/1,            % +Module
            state_replayed/3            % +State, +Changes, -Latest
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(gensym), [gensym/2]).
:- use_module(library(lists), [max_list/2, member/2]).
:- use_module(library(solution_sequences), [offset/2]).
:- use_module('../../kernel/program', [clause_parts/3]).
:- use_module('../../kernel/agent', [agent_add/2, agent_state/2]).

/** <module> The log of changes of an agent's state

The state of an agent is its dynamic predicates, see typhon_agent_module.  The
log of a module lists the changes since the last query, so that the cost of a
change does not depend on the size of the state:

  - edit(Erased, First, Last): clauses of a predicate were erased, others were
    added before the rest, in this order, and after it.  Erased has K-Clause:
    of the clauses that existed at the last query and are variants of Clause,
    the one after K others, once those earlier in Erased are gone.
  - set(Name/Arity, Clauses): the predicate is dynamic, and has these clauses
  - gone(Name/Arity): the predicate is no longer dynamic

A listener of the predicate, see prolog_listen/2, reports its clauses as they
are added and erased.  A predicate has no listener before the first query that
finds it, nor after abolish/1, which clears the flag that marks predicates with
a listener.  Clauses are also counted.  If a report was lost, as after a signal
at that moment, or a transaction was rolled back, the change is the whole
predicate.

The log is a temporary module of its own, with

  - counted(Name, Arity, Count, Uncounted): number of clauses at the last
    query, and of changes since they were really counted
  - added(Ref, Name, Arity, End): since then, at the `first` or `last` end
  - erased(Name, Arity, K, Clause), in this order
  - unsure(Name, Arity): a report was lost
  - queried_until(Generation): generation of the newest change at the last query

Thread-local predicates are recorded whole each time.  Versions 9 and 10 of
SWI-Prolog crash when such a predicate has a listener and its module is
destroyed.

*Threading*: the thread to which the agent belongs.
*/

%!  state_log_begin(+Module) is det.
%!  state_log_end(+Module) is det.
%
%   Begin a log of the changes from now on; end it.

state_log_begin(Module) :-
    log_of(Module, Log),
    forget_all(Log),
    declare(Log),
    findall(Last,
            ( predicate(Module, Head, Last),
              listened(Head, Module, Log) ),
            Generations),
    max_list([0|Generations], Until),
    assertz(Log:queried_until(Until)).

listened(Head, Module, Log) :-
    functor(Head, Name, Arity),
    listen(Head, Module, Log),
    count(Head, Module, Count),
    assertz(Log:counted(Name, Arity, Count, 0)).

state_log_end(Module) :-
    log_of(Module, Log),
    (   current_module(Log)
    ->  forall(Log:counted(Name, Arity, _, _),
               unlisten(Module, Log, Name, Arity)),
        '$destroy_module'(Log)
    ;   true
    ).

log_of(Module, Log) :-
    atom_concat(Module, ' log', Log).

forget_all(Log) :-
    (   current_module(Log)
    ->  '$destroy_module'(Log)
    ;   true
    ).

declare(Log) :-
    set_module(Log:class(temporary)),
    set_module(Log:base(system)),
    dynamic([ Log:counted/4, Log:added/4, Log:erased/4, Log:unsure/2,
              Log:queried_until/1 ]).

                /*******************************
                *           LISTENERS          *
                *******************************/

%   `clausable` has no effect on dynamic predicates; abolish/1 clears it
%   together with the listeners, so it marks predicates with a listener.

has_listener(Head, Module) :-
    '$get_predicate_attribute'(Module:Head, clausable, 1).

listen(Head, Module, _) :-
    has_listener(Head, Module),
    !.
listen(Head, Module, _) :-
    '$get_predicate_attribute'(Module:Head, (thread_local), 1),
    !.
listen(Head, Module, Log) :-
    functor(Head, Name, Arity),
    '$set_predicate_attribute'(Module:Head, clausable, true),
    prolog_listen(Module:Name/Arity,
                  typhon_state_log:changed(Module, Log, Name, Arity)).

unlisten(Module, Log, Name, Arity) :-
    functor(Head, Name, Arity),
    (   current_module(Module),
        has_listener(Head, Module)
    ->  prolog_unlisten(Module:Name/Arity,
                        typhon_state_log:changed(Module, Log, Name, Arity)),
        '$set_predicate_attribute'(Module:Head, clausable, false)
    ;   true
    ).

:- public changed/6.

%   changed(+Module, +Log, +Name, +Arity, +Action, +Context): called before a
%   clause is erased, and after one was added.

changed(Module, Log, Name, Arity, Action, Context) :-
    sig_atomic(report(Action, Context, Name, Arity, Module, Log)).

report(assertz, Ref, Name, Arity, _, Log) =>
    assertz(Log:added(Ref, Name, Arity, last)).
report(asserta, Ref, Name, Arity, _, Log) =>
    assertz(Log:added(Ref, Name, Arity, first)).
report(retract, Ref, _, _, _, Log), retract(Log:added(Ref, _, _, _)) =>
    true.
report(retract, Ref, Name, Arity, Module, Log) =>
    clause_at(Ref, Module, Clause),
    (   ordinal(Clause, Ref, Module, Log, K)
    ->  assertz(Log:erased(Name, Arity, K, Clause))
    ;   assertz(Log:unsure(Name, Arity))
    ).
report(rollback(_), _, Name, Arity, _, Log) =>
    assertz(Log:unsure(Name, Arity)).
report(_, _, _, _, _, _) =>             % begin or end of retractall/1
    true.

%   ordinal(+Clause, +Ref, +Module, +Log, -K): K other variants of Clause that
%   existed at the last query are before Ref.

ordinal(Clause, Ref, Module, Log, K) :-
    Count = count(0),
    variant_at(Clause, Module, Other),
    (   Other == Ref
    ->  !,
        arg(1, Count, K)
    ;   \+ Log:added(Other, _, _, _),
        arg(1, Count, K0),
        K1 is K0+1,
        nb_setarg(1, Count, K1),
        fail
    ).

%   variant_at(+Clause, +Module, -Ref) is nondet: Ref is a variant of Clause;
%   the solutions are in the order of the clauses.

variant_at(Clause, Module, Ref) :-
    copy_term(Clause, Copy),
    clause_parts(Copy, Head, Body),
    clause(Module:Head, Body, Ref),
    clause_at(Ref, Module, Found),
    Found =@= Clause.

clause_at(Ref, Module, Clause) :-
    clause(Module:Head, Body, Ref),
    clause_term(Head, Body, Clause).

%   A fact is stored as its head alone.

clause_term(Head, true, Clause) =>
    Clause = Head.
clause_term(Head, Body, Clause) =>
    Clause = (Head:-Body).

                /*******************************
                *            CHANGES           *
                *******************************/

%!  state_log_changes(+Module, -Changes:list) is semidet.
%
%   Changes of the state since the last query.  Fails if there is no log.

state_log_changes(Module, Changes) :-
    log_of(Module, Log),
    current_module(Log),
    changes_since_query(Module, Log, Changes).

changes_since_query(Module, Log, Changes) :-
    retract(Log:queried_until(Since)),
    findall(Change, gone(Module, Log, Change), Gone),
    findall(Head-Last, changed_since(Since, Module, Head, Last), Heads),
    changes(Heads, Module, Log, Since, Until, Gone, Changes),
    assertz(Log:queried_until(Until)).

gone(Module, Log, gone(Name/Arity)) :-
    Log:counted(Name, Arity, _, _),
    functor(Head, Name, Arity),
    \+ '$get_predicate_attribute'(Module:Head, (dynamic), 1),
    forget(Log, Name, Arity),
    retractall(Log:counted(Name, Arity, _, _)).

forget(Log, Name, Arity) :-
    retractall(Log:added(_, Name, Arity, _)),
    retractall(Log:erased(Name, Arity, _, _)),
    retractall(Log:unsure(Name, Arity)).

%   changed_since(+Since, +Module, -Head, -Last) is nondet: the predicate
%   changed after Since; without a listener it may have changed.

changed_since(Since, Module, Head, Last) :-
    predicate(Module, Head, Last),
    (   Last > Since
    ->  true
    ;   \+ has_listener(Head, Module)
    ).

%   predicate(+Module, -Head, -Last) is nondet: a predicate of the state, and
%   the generation of its last change.

predicate(Module, Head, Last) :-
    '$c_current_predicate'(_, Module:Head),
    '$get_predicate_attribute'(Module:Head, (dynamic), 1),
    \+ '$get_predicate_attribute'(Module:Head, imported, _),
    (   '$get_predicate_attribute'(Module:Head, last_modified_generation,
                                   Last0)
    ->  Last = Last0
    ;   Last = 0
    ).

changes([], _, _, Until, Until, Changes, Changes).
changes([Head-Last|Heads], Module, Log, Until0, Until, Changes0, Changes) :-
    Until1 is max(Last, Until0),
    (   change(Head, Module, Log, Change)
    ->  Changes1 = [Change|Changes0]
    ;   Changes1 = Changes0
    ),
    changes(Heads, Module, Log, Until1, Until, Changes1, Changes).

%   change(+Head, +Module, +Log, -Change) is semidet: fails if nothing changed.

change(Head, Module, Log, Change) :-
    functor(Head, Name, Arity),
    (   has_listener(Head, Module),
        edited(Head, Module, Log, Change0, Counted)
    ->  Change = Change0
    ;   set_anew(Head, Module, Log, Change, Counted)
    ),
    forget(Log, Name, Arity),
    retractall(Log:counted(Name, Arity, _, _)),
    assertz(Log:Counted),
    Change \== edit([], [], []).

count(Head, Module, Count) :-
    (   '$get_predicate_attribute'(Module:Head, number_of_clauses, Count0)
    ->  Count = Count0
    ;   Count = 0
    ).

%   edited(+Head, +Module, +Log, -Edit, -Counted) is semidet: fails if a report
%   was lost, or if all the clauses are shorter than the changes.

edited(Head, Module, Log, edit(Erased, First, Last),
       counted(Name, Arity, Count, Uncounted)) :-
    functor(Head, Name, Arity),
    \+ Log:unsure(Name, Arity),
    Log:counted(Name, Arity, Count0, Uncounted0),
    findall(K-Clause, Log:erased(Name, Arity, K, Clause), Erased),
    added(first, Name, Arity, Module, Log, First),
    added(last, Name, Arity, Module, Log, Last),
    length(Erased, Lost),
    length(First, Before),
    length(Last, After),
    Count is Count0-Lost+Before+After,
    Uncounted1 is Uncounted0+Lost+Before+After,
    Lost+Before+After =< Count,
    verified(Head, Module, Count, Uncounted1, Uncounted).

verified(Head, Module, Count, Uncounted0, Uncounted) :-
    (   Uncounted0 =< Count//8          % counting takes time linear in Count
    ->  Uncounted = Uncounted0
    ;   count(Head, Module, Count),
        Uncounted = 0
    ).

added(End, Name, Arity, Module, Log, Clauses) :-
    findall(Clause,
            ( Log:added(Ref, Name, Arity, End),
              clause_at(Ref, Module, Clause) ),
            Clauses).

set_anew(Head, Module, Log, set(Name/Arity, Clauses),
         counted(Name, Arity, Count, 0)) :-
    functor(Head, Name, Arity),
    listen(Head, Module, Log),
    findall(Clause,
            ( clause(Module:Head, Body),
              clause_term(Head, Body, Clause) ),
            Clauses),
    length(Clauses, Count).

%!  state_replayed(+State, +Changes:list, -Latest) is det.
%
%   Latest is State after Changes, each a list as of state_log_changes/2, the
%   oldest first.
%
%   @error existence_error(clause, Clause): Changes do not belong to State

state_replayed(state(Empty, Clauses), Changes, Latest) :-
    gensym('typhon replay ', Module),
    setup_call_cleanup(
        set_module(Module:class(temporary)),
        ( set_module(Module:base(system)),
          forall(member(PI, Empty), dynamic(Module:PI)),
          agent_add(Clauses, Module),
          forall(( member(List, Changes), member(Change, List) ),
                 replay(Change, Module)),
          agent_state(Module, Latest) ),
        '$destroy_module'(Module)).

replay(edit(Erased, First, Last), Module) =>
    forall(member(K-Clause, Erased), erased(K, Clause, Module)),
    forall(member(Clause, First), asserta(Module:Clause)),
    agent_add(Last, Module).
replay(set(Name/Arity, Clauses), Module) =>
    functor(Head, Name, Arity),
    dynamic(Module:Name/Arity),
    retractall(Module:Head),
    agent_add(Clauses, Module).
replay(gone(PI), Module) =>
    abolish(Module:PI).

erased(K, Clause, Module) :-
    (   nth_variant(K, Clause, Module, Ref)
    ->  erase(Ref)
    ;   existence_error(clause, Clause)
    ).

nth_variant(K, Clause, Module, Ref) :-
    offset(K, variant_at(Clause, Module, Ref)),
    !.
