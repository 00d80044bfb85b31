:- module(test_durable, []).

:- use_module('../../../../prolog/typhon/kernel/base/durable').
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(random), [random_member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/on_demand), [on_demand_load/2]).

%   The journal has a table, too.

:- on_demand_load(open_store, any).

:- begin_tests(durable).

%   The facts of each table, with any values, come back from their items as they
%   were, in their order.

test(facts_come_back_from_their_items,
     [ setup(set_random(seed(7))), forall(table(Kind)),
       Restored == Facts ]) :-
    emptied(Kind),
    findall(Fact, ( between(1, 50, _), random_fact(Kind, Fact) ), Facts),
    maplist(assertz, Facts),
    findall(item(Key, N, Term),
            ( member(Fact, Facts),
              typhon_durable:fact_table(Kind, Key, N, Term, Fact) ), Items),
    emptied(Kind),
    forall(member(item(Key, N, Term), Items),
           durable_restore(Kind, Key, N, Term)),
    facts(Kind, Restored),
    emptied(Kind).

test(items_of_a_table_are_dumped,
     [ setup(set_random(seed(8))), forall(dumped_table(Kind)),
       Dumped == Items ]) :-
    emptied(Kind),
    findall(Fact, ( between(1, 50, _), random_fact(Kind, Fact) ), Facts),
    maplist(assertz, Facts),
    findall(Key-Term, ( member(Fact, Facts), item(Kind, Key, Term, Fact) ),
            Items),
    findall(Key-Term, durable_dump(Kind, Key, _, Term), Dumped),
    emptied(Kind).

test(no_kind_has_two_tables, Kinds == Once) :-
    findall(Kind, table(Kind), Kinds0),
    msort(Kinds0, Kinds),
    sort(Kinds0, Once).

test(item_of_no_table_is_not_restored, fail) :-
    durable_restore(no_such_kind, key, 0, term).

test(item_of_another_shape_is_not_restored, fail) :-
    durable_restore(outcome, key, 0, no_pair).

table(Kind) :-
    typhon_durable:fact_table(Kind, _, _, _, _).

%   The others have a dump of their own.

dumped_table(Kind) :-
    table(Kind),
    \+ clause(typhon_durable:dump(Kind, _, _, _), _).

item(Kind, Key, Term, Fact) :-
    typhon_durable:fact_table(Kind, Key, _, Term, Fact).

general(Kind, Module:General) :-
    typhon_durable:fact_table(Kind, _, _, _, Module:Fact),
    functor(Fact, Name, Arity),
    functor(General, Name, Arity).

emptied(Kind) :-
    general(Kind, General),
    retractall(General).

facts(Kind, Facts) :-
    general(Kind, General),
    findall(General, call(General), Facts).

random_fact(Kind, Fact) :-
    typhon_durable:fact_table(Kind, Key, N, Term, Fact),
    term_variables(Key-N-Term-Fact, Vars),
    maplist(random_value, Vars).

random_value(Value) :-
    random_member(Value, [ 0, -17, 3.5, 'an atom', [], "text", 1267650600228229,
                           f('X', [1,2|tail]), '$VAR'(1), {a}, "\u1234" ]).

:- end_tests(durable).
