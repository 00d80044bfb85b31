:- module(test_clone_bomb, []).

/** <module> A clone bomb on a trusted host

    sh -c 'ulimit -v KILOBYTES; exec swipl test/lib/clone_bomb.pl'

An agent clones itself, and so do its clones, until the host refuses a clone.
Then the bomb is stopped; after its agents have ended another agent runs there
to its end, and `well` is printed.

*Threading*: the main thread waits for the others.
*/

:- use_module(common).
:- use_module(library(typhon)).

:- initialization(main, main).

:- public main/0.

main :-
    host_start(a),
    thread_self(Me),
    watch(a, refusal(Me), Watch),
    agent_create(clauses([ (:- agent(bomb, [])),
                           (main :-
                                \+ sense(stop),
                                catch(clone(_), error(Formal, _), true),
                                next(Formal)),
                           (next(Formal) :- var(Formal), !, main),
                           next(_) ]), _, [host(a)]),
    thread_get_message(Me, refused(Reason), [timeout(240)]),
    unwatch(Watch),
    remote(a, leave(stop)),
    wait_until(( host_property(a, load(Load)), Load < 200 ), 240),
    wait_until(begins, 60),
    format('well, ~w~n', [Reason]).

begins :-
    catch(agent_create(clauses([ (:- agent(small, [])), main ]), Agent,
                       [host(a)]),
          error(move_refused(_, _), _), fail),
    agent_join(Agent, done, 60).

refusal(Thread, event(_, _, _, refused(_, Reason))) :-
    thread_send_message(Thread, refused(Reason)).
