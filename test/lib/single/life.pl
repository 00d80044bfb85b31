:- use_module(library(lists), [member/2]).
:- use_module(library(typhon/kernel)).
:- use_module(library(typhon/kernel/base/server)).

/*  Agents without threads, sockets and processes: main/0 prints a fact for
    each step, see test_single.pl and test_wasm.pl. */

main :-
    host_start(a),
    host_start(b),
    host_start(full, [capacity(1)]),
    link(a, b),
    forall(step(Name, Goal), tell(Name, Goal)),
    forall(member(Host, [a, b, full]), host_stop(Host)),
    tell(loaded, foreign_parts).

tell(Name, Goal) :-
    (   catch(call(Goal, Result), error(Formal, _), Result = raised(Formal))
    ->  true
    ;   Result = failed
    ),
    format('~q.~n', [came(Name, Result)]).

step(travels, travels).
step(waits, waits(0.2)).
step(timeout, timeout).
step(nothing_can_happen, never).
step(asleep, sleeps(1)).
step(many_sleep, sleeps(200)).
step(refused, refused).
step(fails, outcome([ (:- agent(f, [])), (main :- fail) ])).
step(raises, outcome([ (:- agent(r, [])), (main :- atom_length(_, _)) ])).
step(runs_for_a_while, runs).
step(always_ready, busy).
step(rests, rests).
step(server_handles, server_handles).
step(server_defers, server_defers).
step(server_raises, server_raises).
step(server_stops_itself, server_stops_itself).
step(server_times_out, server_times_out).

create(Clauses, Agent, Options) :-
    agent_create(clauses(Clauses), Agent, Options).

travels(Outcome-Result) :-
    host_property(b, address(B)),
    create([ (:- agent(traveller, [state([seen/1])])),
             (main :- receive(_-go(Host)), home(Home), move(Host),
                      assertz(seen(Host)), leave(was(here)), sense(was(Where)),
                      clone(Branch),
                      ( Branch = parent(_)
                      -> move(Home), result(Where)
                      ;  true )) ],
           Agent, [host(a)]),
    agent_send(Agent, go(B)),
    agent_join(Agent, Outcome, 10),
    agent_result(Agent, Result, 1).

waiting(Agent) :-
    create([ (:- agent(waiter, [])), (main :- receive(_)) ], Agent, [host(a)]).

waits(Seconds, State) :-
    waiting(Agent),
    agents_run(Seconds),
    agent_property(Agent, state(State)),
    agent_dispose(Agent).

timeout(Outcome) :-
    waiting(Agent),
    agent_join(Agent, Outcome, 0.1),
    agent_dispose(Agent).

never(Outcome) :-
    waiting(Agent),
    catch(agent_join(Agent, Outcome, inf), Error, true),
    agent_dispose(Agent),
    throw(Error).

sleeps(Count, Outcomes) :-
    findall(Agent,
            ( between(1, Count, I), Seconds is 0.1+(I mod 7)*0.01,
              create([ (:- agent(sleeper, [state([long/1])])),
                       (main :- long(S), sleep(S)) ],
                     Agent, [host(a), facts([long(Seconds)])]) ),
            Agents),
    findall(Outcome,
            ( member(Agent, Agents), agent_join(Agent, Outcome, 10) ),
            All),
    sort(All, Outcomes).

refused(Outcome) :-
    waiting(Agent),
    agent_move(Agent, full),
    agents_run(inf),
    host_property(full, address(Full)),
    create([ (:- agent(late, [])), (main :- receive(_-H), move(H)) ],
           Late, [host(a)]),
    agent_send(Late, Full),
    agent_join(Late, raised(error(move_refused(_, Outcome), _)), 10),
    agent_dispose(Agent).

outcome(Clauses, Name) :-
    create(Clauses, Agent, [host(a)]),
    agent_join(Agent, Outcome, 10),
    functor(Outcome, Name, _).

runs(More) :-
    create([ (:- agent(counter, [state([count/1])])),
             (main :- retract(count(N)), N1 is N+1, assertz(count(N1)),
                      sleep(0.001), main) ],
           Agent, [host(a), facts([count(0)])]),
    agents_run(0.3),
    agent_property(Agent, facts(Facts)),
    member(count(Count), Facts),
    agent_dispose(Agent),
    ( Count > 20 -> More = many ; More = Count ).

%   An agent that never sleeps delays neither a sleeping one nor the caller.

busy(Outcome) :-
    create([ (:- agent(busy, [])), (main :- move(b), move(a), main) ],
           Busy, [host(a)]),
    create([ (:- agent(sleeper, [])), (main :- sleep(0.05)) ],
           Sleeper, [host(a)]),
    agents_run(0.2),
    agent_join(Sleeper, Outcome, 0.2),
    agent_dispose(Busy).

rests(Answer) :-
    create([ (:- agent(clerk, [state([asked/1])])),
             (main),
             (on_message(_, Question) :- assertz(asked(Question))) ],
           Agent, [host(b)]),
    agent_send(Agent, first),
    agent_send(Agent, second),
    agents_run(inf),
    agent_property(Agent, facts(Answer)),
    agent_dispose(Agent).

                /*******************************
                *             SERVERS          *
                *******************************/

handle(begin, List, [begun|List]).
handle(stop, List, _) :-
    assertz(ended(List)).
handle(timeout, List, [timeout|List]).
handle(add(X), List, [X|List]).
handle(again(X), List, [X|List]) :-
    server_self(Server),
    server_cast(Server, add(later)),
    server_call_other(List).
handle(soon, List, until(0, [soon|List])).
handle(call(list, Caller), List, List) :-
    server_answer(Caller, List).
handle(call(raise, _), _, _) :-
    throw(error(oops, _)).
handle(call(stop, Caller), List, List) :-
    server_self(Server),
    server_stop(Server),
    server_answer(Caller, stopped).

:- dynamic ended/1, other/1.

%   The handler of one server calls another, and is itself again afterwards.

server_call_other(_) :-
    server_self(Me),
    other(Other),
    server_call(Other, list, 1, [begun]),
    server_self(Me).

server_handles(List-Ended) :-
    started(Server),
    server_cast(Server, add(1)),
    server_call(Server, list, 1, List),
    server_cast(Server, add(2)),
    server_stop(Server),
    retract(ended(Ended)),
    \+ server_cast(Server, add(3)).

server_defers(List) :-
    started(Server),
    started(Other),
    assertz(other(Other)),
    server_cast(Server, again(first)),
    server_call(Server, list, 1, List),
    server_stop(Other),
    server_stop(Server),
    retractall(ended(_)).

server_raises(Error-List) :-
    started(Server),
    catch(server_call(Server, raise, 1, _), error(Error, _), true),
    server_call(Server, list, 1, List),
    server_stop(Server),
    retractall(ended(_)).

server_stops_itself(Answer-Ended) :-
    started(Server),
    server_call(Server, stop, 1, Answer),
    retract(ended(Ended)),
    \+ server_cast(Server, add(3)).

server_times_out(List) :-
    started(Server),
    server_cast(Server, soon),
    server_check(Server),
    server_call(Server, list, 1, List),
    server_stop(Server),
    retractall(ended(_)).

started(Server) :-
    server_start(life, handle, [], Server).

%   Features that browsers lack, and whether there is another thread.

foreign_parts(Parts) :-
    findall(Name,
            ( member(Name, [socket, process, time, ssl, unix]),
              file_name_extension(Name, pl, File),
              source_file(Path),
              file_base_name(Path, File),
              \+ sub_atom(Path, _, _, _, '/typhon/') ),
            Parts).
