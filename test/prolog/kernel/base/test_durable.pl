:- module(test_durable, []).

:- use_module('../../../../prolog/typhon/kernel/base/durable').
:- use_module('../../../lib/common').
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(random), [random_member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/on_demand), [on_demand_load/2]).

%   Options have tables, too.

:- forall(member(Seam-What, [host_option-journal, durable-birth, durable-stands]),
          on_demand_load(Seam, What)).

:- begin_tests(durable, [setup(set_random(seed(7)))]).

%   The facts of each table, with any values, are restored from their items in
%   their order.

test(facts_are_restored_from_their_items,
     [forall(fact_kind(Kind)), Restored == Facts]) :-
    emptied(Kind),
    findall(Fact, ( between(1, 50, _), random_fact(Kind, Fact) ), Facts),
    maplist(assertz, Facts),
    findall(item(Key, N, Term),
            ( member(Fact, Facts), fact_item(Kind, Key, N, Term, Fact) ),
            Items),
    emptied(Kind),
    forall(member(item(Key, N, Term), Items),
           durable_restore(Kind, Key, N, Term)),
    facts(Kind, Restored),
    emptied(Kind).

%   Each item that a table has restored is dumped unchanged.

test(restored_items_are_dumped,
     [ forall(dumped_table(Kind, Form)),
       true(Missing == []) ]) :-
    no_leaks(setup_call_cleanup(host_start(here, [concurrency(2)]),
                                restored(Kind, Form, Items, Dumped),
                                host_stop(here))),
    assertion(Items \== []),
    findall(Item, ( member(Item, Items), \+ memberchk(Item, Dumped) ), Missing).

restored(Kind, Form, Items, Dumped) :-
    findall(item(Kind, Key, N, Form),
            ( between(1, 5, I), example(Kind, I, Key, N, Form) ), Items),
    forall(member(item(_, Key, N, Term), Items),
           durable_restore(Kind, Key, N, Term)),
    findall(item(Kind, Key, N, Form), durable_dump(Kind, Key, N, Form), Dumped),
    forall(( member(item(_, Key, N, Term), Items),
             forgotten(Kind, Key, N, Term) ),
           true).

test(item_of_an_unknown_table_is_ignored, fail) :-
    durable_restore(no_such_kind, key, 0, term).

test(item_of_another_arity_is_ignored, fail) :-
    durable_restore(outcome, key, 0, no_pair).

%   The tables of facts.

fact_table(Fact, Module, Kind, Key, N, Term) :-
    typhon_durable:item_table(Kind, Key, N, Term, Module:Fact,
                              Module:assertz(Restored)),
    Restored == Fact.

fact_kind(Kind) :-
    fact_table(_, _, Kind, _, _, _).

fact_item(Kind, Key, N, Term, Module:Fact) :-
    fact_table(Fact, Module, Kind, Key, N, Term),
    ( var(N) -> N = 0 ; true ),
    ( var(Term) -> Term = '' ; true ).

%   The record of an agent is an item of journals; typhon_journaled_agents
%   makes it of other tables.

dumped_table(Kind, Form) :-
    typhon_durable:item_table(Kind, _, _, Form, Dump, _),
    Dump \= _:fail.

                /*******************************
                *            EXAMPLES          *
                *******************************/

%   example(+Kind, +I, -Key, -N, ?Form): the I-th item.

example(Kind, _, Key, N, Form) :-
    fact_kind(Kind),
    random_fact(Kind, Fact),
    fact_item(Kind, Key, N, Form, Fact).
example(link, I, Key, 0, link(here, Address, I)) :-
    atom_concat('far@127.0.0.1:', I, Address),
    atomic_list_concat([here, Address], ' ', Key).
example(tuple, I, here, I, '$by'(I, Value)) :-
    random_fact_term(Value).
example(fact, _, here, none, Value) :-
    random_fact_term(Value).
example(payload, I, Key, 0, payload(here, payload(Name, [Name/1], Clauses))) :-
    atom_concat(shop, I, Name),
    atomic_list_concat([here, Name], ' ', Key),
    random_value(Value),
    Head =.. [Name, Value],
    Clauses = [(Head:-true)].
example(place, 1, here, 0, state([open/1], [(open(Value):-true)])) :-
    random_value(Value).
example(counts, 1, here, 0, [0, 3, 0.5, 2.5, 1.5, 2, 0.25, 0.5, 0.25]).
example(turns, 1, here, 1, []).
example(flag, _, Name, N, '') :-
    random_member(Name, [outcomes, results, clones, typhon_agent_id]),
    flag(Name, N, N).
example(birth, I, Id, 0, Birth) :-
    far_agent(I, Id),
    random_value(Birth).
example(born, I, Id, 0, born(Address, I, here)) :-
    far_agent(I, Id),
    random_value(Address).
example(gone, I, Id, 0, gone(Address, I, unknown)) :-
    far_agent(I, Id),
    random_value(Address).
example(agent, I, Id, 0, gone(Address, I, Process)) :-
    far_agent(I, Id),
    random_value(Address),
    random_value(Process).
example(wait, I, Id, 0, Letter) :-
    far_agent(I, Id),
    random_value(Letter).
example(backlog, I, Id, I, [Letter1, Letter2]) :-
    far_agent(I, Id),
    maplist(random_value, [Letter1, Letter2]).
example(mail, I, Id, 0, Message) :-
    far_agent(I, Id),
    random_value(Message).
example(program, 1, Hash, 0, Sent) :-
    resting(_),
    durable_dump(program, Hash, 0, Sent).
example(stands, 1, Copy, 0, Agent) :-
    resting(Id),
    durable_dump(stands, Id, 0, Agent),
    agent_dispose(Id),
    atom_concat('copy-', Id, Copy).
example(order, 1, Id, 0, asked(Order, queue(none))) :-
    resting(Id),
    random_value(Order).

far_agent(I, Id) :-
    format(atom(Id), 'far.mark.~d@there@127.0.0.1:1', [I]).

resting(Id) :-
    agent_create(clauses([ (:- agent(rests, [])), (main :- receive(never)) ]),
                 Id, [host(here)]),
    wait_until(agent_property(Id, state(waiting)), 5).

random_fact_term(f(Value)) :-
    random_value(Value).

random_fact(Kind, Module:Fact) :-
    fact_table(Fact, Module, Kind, Key, N, Term),
    term_variables(Fact, Vars),
    maplist(random_value, Vars),
    assertion(ground(Key-Fact)),
    ignore(( N = 0, Term = '' )).

random_value(Value) :-
    random_member(Value, [ 0, -17, 3.5, 'an atom', [], "text", 1267650600228229,
                           f('X', [1,2|tail]), '$VAR'(1), {a}, "\u1234" ]).

                /*******************************
                *            TABLES            *
                *******************************/

general(Kind, Module:General) :-
    fact_table(Fact, Module, Kind, _, _, _),
    functor(Fact, Name, Arity),
    functor(General, Name, Arity).

emptied(Kind) :-
    general(Kind, General),
    retractall(General).

facts(Kind, Facts) :-
    general(Kind, General),
    findall(General, call(General), Facts).

forgotten(Kind, _, _, _) :-
    fact_kind(Kind),
    !,
    emptied(Kind).
forgotten(turns, Host, _, _) :-
    durable_restore(turns, Host, 0, []).
forgotten(birth, Id, _, _) :-
    retractall(typhon_birth:known(Id, _)).
forgotten(born, Id, _, _) :-
    retractall(typhon_whereabouts:born(Id, _, _, _)).
forgotten(Kind, Id, _, _) :-
    memberchk(Kind, [gone, agent]),
    retractall(typhon_whereabouts:forward(Id, _, _, _)).
forgotten(Kind, Id, _, _) :-
    memberchk(Kind, [wait, backlog]),
    typhon_mail:backlog_all(Id, _).
forgotten(mail, Id, _, _) :-
    typhon_mailbox:mail_all(Id, _).
forgotten(Kind, Id, _, _) :-
    memberchk(Kind, [stands, order]),
    agent_dispose(Id).

:- end_tests(durable).
