:- use_module(library(lists), [member/2]).
:- use_module(library(typhon/kernel)).
:- use_module(library(typhon/kernel/base/server)).
:- use_module(library(typhon/kernel/host), [time_now/1, time_state/1]).
:- use_module(library(typhon/options/virtual)).

/*  Agents without threads, sockets and processes: main/0 prints a fact for
    each step, see test_single.pl and test_wasm.pl. */

main :-
    host_start(a),
    host_start(b),
    host_start(full, [capacity(1)]),
    link(a, b),
    forall(step(Name, Goal), tell(Name, Goal)),
    forall(member(Host, [a, b, full]), host_stop(Host)),
    forall(virtual_step(Name, Goal), tell(Name, in_virtual_time(Goal))),
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
    (   between(1, 100, _),
        agents_run(0.1),
        agent_property(Agent, facts(Facts)),
        member(count(Count), Facts),
        Count > 20
    ->  More = many
    ;   More = few
    ),
    agent_dispose(Agent).

%   An agent that never sleeps delays neither a sleeping one nor the caller.

busy(Outcome) :-
    create([ (:- agent(busy, [])), (main :- move(b), move(a), main) ],
           Busy, [host(a)]),
    create([ (:- agent(sleeper, [])), (main :- sleep(0.05)) ],
           Sleeper, [host(a)]),
    agents_run(0.2),
    agent_join(Sleeper, Outcome, 10),
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

                /*******************************
                *          VIRTUAL TIME        *
                *******************************/

virtual_step(virtual_time_jumps, jumps).
virtual_step(virtual_timeout, virtual_timeout).
virtual_step(virtual_nothing_can_happen, virtual_never).
virtual_step(virtual_random_is_apart, random_apart).
virtual_step(virtual_state, virtual_saved).
virtual_step(virtual_steps, stepwise).
virtual_step(virtual_slices, slices).
virtual_step(virtual_pace, paces).
virtual_step(virtual_program, beside) :-
    current_prolog_flag(emscripten, true).  % elsewhere engines need threads
virtual_step(virtual_error, loop_fails).

:- meta_predicate in_virtual_time(1, -).

in_virtual_time(Goal, Result) :-
    setup_call_cleanup(
        ( host_start(v, [clock(virtual)]),
          host_start(w, [clock(virtual)]) ),
        once(call(Goal, Result)),
        ( host_stop(v), host_stop(w) )).

%   The agent is at w after 2, at v after 4 seconds, and so on.

commuter(Rounds, Agent) :-
    agent_create(clauses([ (:- agent(commuter, [state([left/1])])),
                           (main :- retract(left(0))),
                           (main :- retract(left(N)), N1 is N-1,
                                    assertz(left(N1)),
                                    sleep(2), move(w), sleep(2), move(v),
                                    main) ]),
                 Agent, [host(v), facts([left(Rounds)])]).

jumps(Outcome-Now) :-
    commuter(3, Agent),
    agent_join(Agent, Outcome, 100),
    time_now(Now).

virtual_timeout(Outcome-Now) :-
    commuter(3, Agent),
    agent_join(Agent, Outcome, 7),
    time_now(Now),
    agent_dispose(Agent).

virtual_never(_) :-
    agent_create(clauses([ (:- agent(waiter, [])), (main :- receive(_)) ]),
                 Agent, [host(v)]),
    agent_join(Agent, _, inf).

%   What agents draw, and what the caller draws, does not depend on each other.

random_apart(Same) :-
    draws([], Drawn1, Agent1),
    draws([_, _, _], Drawn2, Agent2),
    ( Drawn1-Agent1 == Drawn2-Agent2 -> Same = same ; Same = different ).

draws(More, Mine, Theirs) :-
    typhon_time:time_seed(1),
    set_random(seed(7)),
    gambler(Theirs0),
    set_random(seed(7)),
    maplist([X]>>random_between(1, 1 000 000, X), More),
    set_random(seed(7)),
    random_between(1, 1 000 000, Before),
    gambler(Theirs1),
    random_between(1, 1 000 000, After),
    Mine = Before-After,
    Theirs = Theirs0-Theirs1.

gambler(Result) :-
    agent_create(clauses([ (:- agent(gambler, [])),
                           (main :- random_between(1, 1 000 000, X),
                                    result(X)) ]),
                 Agent, [host(v)]),
    agent_result(Agent, Result, 1).

virtual_saved(Name/Arity) :-
    time_state(State),
    functor(State, Name, Arity).

%   A step is to the next instant at which something is due.

stepwise(Times) :-
    commuter(2, _),
    findall(Now, ( between(1, 4, _), step(Now) ), Times).

step(Now) :-
    virtual_pace(step),
    run_for(10, rests),
    time_now(Now).

run_for(Seconds, When) :-
    message_queue_create(Queue),
    typhon_virtual:virtual_run(Queue, inf, Seconds, When),
    message_queue_destroy(Queue).

%   With no real time left, time stands still; then it runs on.

slices(Times) :-
    commuter(2, Agent),
    virtual_pace(rate(inf)),
    run_for(0, after(Seconds)),
    Seconds =:= 0,
    time_now(T0),
    run_for(10, rests),
    time_now(T1),
    agent_join(Agent, done, 1),
    Times = [T0, T1].

%   Hundred virtual seconds a second.

paces(Waits-Now) :-
    commuter(1, _),
    virtual_pace(rate(100)),
    run_for(10, after(Seconds)),
    ( Seconds > 0, Seconds =< 0.1 -> Waits = soon ; Waits = Seconds ),
    agents_run(5),
    time_now(Now),
    virtual_pace(free).

%   A program that waits runs beside the caller.

beside(Times) :-
    typhon_virtual:virtual_program(user:twice, Engine),
    engine_next(Engine, virtual_wait(Queue1, Stamp1)),
    virtual_pace(rate(inf)),
    typhon_virtual:virtual_run(Queue1, Stamp1, 10, How1),
    engine_post(Engine, How1, virtual_wait(Queue2, Stamp2)),
    typhon_virtual:virtual_run(Queue2, Stamp2, 10, How2),
    engine_post(Engine, How2, ended),
    engine_destroy(Engine),
    retract(result(Result)),
    Times = [How1, How2|Result].

:- dynamic result/1.

twice :-
    commuter(1, Agent),
    agent_join(Agent, Outcome, 3),
    agent_join(Agent, Outcome1, 3),
    time_now(Now),
    assertz(result([Outcome, Outcome1, Now])).

%   A limit of the caller ends the agent that reaches it, not the loop.

loop_fails(Outcome) :-
    commuter(1 000 000, Agent),
    call_with_inference_limit(agent_join(Agent, _, inf), 100 000, _),
    catch(agent_dispose(Agent), error(existence_error(_, _), _), true),
    commuter(1, Other),
    agent_join(Other, Outcome, 100).

%   Features that browsers lack, and whether there is another thread.

foreign_parts(Parts) :-
    findall(Name,
            ( member(Name, [socket, process, time, ssl, unix]),
              file_name_extension(Name, pl, File),
              source_file(Path),
              file_base_name(Path, File),
              \+ sub_atom(Path, _, _, _, '/typhon/') ),
            Parts).
