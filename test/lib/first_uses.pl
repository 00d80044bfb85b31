:- module(test_first_uses, [first_uses/1]).
:- use_module('../../app/packaging/parts', [installed/1]).
:- use_module(common, [with_tmp_dir/1]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(typhon)).

/** <module> First uses of what the library loads later

*Threading*: the main thread.
*/

:- multifile user:prolog_load_file/2.
:- dynamic
    user:prolog_load_file/2,
    began/2.                            % Spec, Mutexes that the thread held

%   first_uses(-Held) is det: Held are pairs Spec-Mutexes of files of Typhon that
%   a thread began to load while it held mutexes, but for those of Prolog.
%   Libraries of Prolog call nothing of Typhon.

first_uses(Held) :-
    asserta((user:prolog_load_file(_:Spec, _) :-
                 Spec \= library(_),
                 test_first_uses:begins(Spec))),
    with_tmp_dir(uses),
    findall(Spec, began(Spec, _), Specs),
    length(Specs, Count),
    must_be(between(50, 10000), Count),
    findall(Spec-Mutexes, ( began(Spec, Mutexes), Mutexes \== [] ), Held).

:- public begins/1.

begins(Spec) :-
    thread_self(Me),
    findall(Mutex,
            ( mutex_property(Mutex, status(locked(Me, _))),
              \+ sub_atom(Mutex, 0, _, _, $) ),
            Mutexes),
    assertz(began(Spec, Mutexes)),
    fail.

uses(Dir) :-
    host_start(a),
    host_start(b, [policy(guarded), cell(none), quota([inferences(100000)])]),
    forall(use(Goal, Dir), ignore(catch(Goal, error(_, _), true))),
    host_stop(a),
    host_stop(b).

use(agent_ends([(main :- move(b), sleep(0), result(1))]), _).
use(agent_ends([(main :- sleep(0), X = y, Z is X+1, result(Z))]), _).
use(agent_ends([(main :- sleep(0), fail), (on_message(_, _))]), _).
use(agent_ends([(main :- attach(clauses([(:- payload(p, [])), q(1)])), q(X),
                         result(X))]), _).
use(agent_ends([(main :- send(mqtt, x), send(unknown, x), sleep(0))]), _).
use(agent_ends([(main :- next_host(random, H), move(H))]), _) :-
    installed(migration).
use(agent_ends([(main :- clone(_), offer(service), sleep(0))]), _).
use(remote(a, true), _).
use(host_change(a, policy(guarded)), _).
use(kept(Dir), Dir).
use(( agent_ends([(main :- receive(x, 0.1) -> true ; true)]), agents, hosts ), _).
use(( network_start(ring(3), Network, []), network_stop(Network) ), _).
use(( watch(a, [_]>>true, Watch), unwatch(Watch) ), _).

agent_ends(Clauses) :-
    agent_create(clauses([(:- agent(first, []))|Clauses]), Agent, [host(a)]),
    agent_join(Agent, _, 5),
    agent_dispose(Agent).

kept(Dir) :-
    directory_file_path(Dir, saved, File),
    agent_create(clauses([ (:- agent(kept, [])), (main :- receive(_)) ]), Agent,
                 [host(a)]),
    agent_trace(Agent, [goals]),
    agent_listing(Agent),
    agent_save(Agent, File),
    agent_dispose(Agent),
    agent_load(File, Again),
    agent_dispose(Again).
