:- use_module('../../../lib/common').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(random), [random/3, random_between/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/durable),
              [durable/5, durable_assertz/1]).
:- use_module(library(typhon/kernel/base/durable),
              [durable_close/0, durable_closed/0, sync_changes/0,
               unit_of_work/1]).

:- needs([journal]).

:- begin_tests(stop, [cleanup(forget)]).

%   A process with a journal stops its host and starts it again.

:- meta_predicate
    running(+, 0),
    in_thread(0, -).

running(Dir, Goal) :-
    setup_call_cleanup(host_start(alpha, [journal(Dir)]),
                       once(Goal),
                       host_stop(alpha)).

in_thread(Goal, Thread) :-
    thread_create(Goal, Thread).

%   Commits take some time while slow/1 holds.

:- dynamic slow/1.
:- multifile typhon_durable:reached/1.

typhon_durable:reached(in_commit) :-
    plunit_stop:slow(Seconds),
    sleep(Seconds),
    fail.

:- dynamic
    left/2,                             % Key, N
    right/2,                            % Key, N
    result/3,                           % Key, N, Result: ok or Formal
    over/0.

:- durable(stop_left, Key, N, _, left(Key, N)).
:- durable(stop_right, Key, N, _, right(Key, N)).

forget :-
    retractall(slow(_)),
    retractall(left(_, _)),
    retractall(right(_, _)),
    retractall(result(_, _, _)),
    retractall(over).

                /*******************************
                *         UNITS OF WORK        *
                *******************************/

%   Threads record pairs of facts while the journal closes.  Each pair is in it
%   or is not, and sync_changes/0 has reported which.

test(units_of_work_are_whole_and_reported_when_the_journal_closes,
     [forall(member(Slow, [0, 0, 0.02])), setup(forget)]) :-
    no_leaks(with_tmp_dir(units(Slow))).

units(Slow, Dir) :-
    forget,
    assertz(slow(Slow)),
    running(Dir, closed_amid_units),
    retractall(left(_, _)),
    retractall(right(_, _)),
    running(Dir, true),
    findall(Key-N, left(Key, N), Lefts0),
    findall(Key-N, right(Key, N), Rights0),
    findall(Key-N, result(Key, N, ok), Reported0),
    maplist(msort, [Lefts0, Rights0, Reported0], [Lefts, Rights, Reported]),
    assertion(Lefts == Rights),
    assertion(Lefts == Reported),
    forget.

closed_amid_units :-
    findall(Thread,
            ( member(Key, [a, b, c, d]),
              in_thread(record_pairs(Key, 1), Thread) ),
            Threads),
    wait_until(( result(a, N, ok), N > 3 ), 60),
    durable_close,
    forall(member(Thread, Threads), thread_join(Thread, true)).

record_pairs(Key, N) :-
    unit_of_work(( durable_assertz(left(Key, N)),
                   random(0.0, 0.002, Pause),
                   sleep(Pause),
                   durable_assertz(right(Key, N)) )),
    catch(( sync_changes, Result = ok ), error(Result, _), true),
    assertz(result(Key, N, Result)),
    (   Result == ok
    ->  N1 is N+1,
        ( N < 2000 -> record_pairs(Key, N1) ; true )    % it is not reported
    ;   assertion(Result == existence_error(journal, open))
    ).

%   The journal closes in the middle of a step, and the last commit begins when
%   the agent has ended.

test(step_that_the_stop_interrupts_happens_once, [setup(forget)]) :-
    no_leaks(with_tmp_dir(step)).

step(Dir) :-
    kept(Dir, Keeper),
    gate(Gated),
    agent_create(Gated, Agent, [facts([to(Keeper)])]),
    wait_until(result(gate, 1, in), 20),
    with_mutex(typhon_commit,
               ( in_thread(host_stop(alpha), Thread),
                 wait_until(durable_closed, 20),
                 assertz(over),
                 wait_until(\+ typhon_agents:agent(Agent, _, _, _, _), 20) )),
    thread_join(Thread, true),
    running(Dir,
        ( agent_result(Agent, done, 20),
          got(Keeper, [one, two]),
          remote(alpha, findall(X, sense(left(X)), [here])) )),
    forget.

%   A host with an agent that stores its messages.

kept(Dir, Keeper) :-
    host_start(alpha, [journal(Dir)]),
    keeper(Program),
    agent_create(Program, Keeper).

keeper(clauses([ (:- agent(keeper, [state([got/1])])),
                 (on_message(_, M) :- assertz(got(M))) ])).

gate(clauses([ (:- agent(gated, [state([to/1])])),
               (main :- to(To), send(To, one), leave(left(here)),
                        plunit_stop:gate,
                        send(To, two), sleep(0), result(done)) ])).

:- public gate/0.

gate :-
    assertz(result(gate, 1, in)),
    wait_until(over, 20).

got(Keeper, Expected) :-
    wait_until(( agent_property(Keeper, facts(Facts)),
                 findall(M, member(got(M), Facts), Expected) ), 20).

                /*******************************
                *           MESSAGES           *
                *******************************/

%   Threads send numbered messages, and send a number again if agent_send/2 has
%   raised an error.  Meanwhile the host stops and starts.

test(message_is_sent_if_and_only_if_sending_does_not_raise,
     [setup(forget)]) :-
    no_leaks(with_tmp_dir(sent_again)).

sent_again(Dir) :-
    call_cleanup(sent_over_restarts(Dir), ( host_stop(alpha), forget )).

sent_over_restarts(Dir) :-
    assertz(slow(0.02)),
    free_port(Port),
    Options = [journal(Dir), port(Port)],
    host_start(alpha, Options),
    keeper(Program),
    agent_create(Program, Keeper),
    findall(Thread,
            ( member(Key, [a, b, c]),
              in_thread(send_numbers(Key, 1, Keeper), Thread) ),
            Threads),
    call_cleanup(forall(between(1, 12, Round), rested(Round, Options)),
                 ( assertz(over),
                   forall(member(Thread, Threads), thread_join(Thread)) )),
    findall(m(Key, N), result(Key, N, ok), Sent0),
    msort(Sent0, Sent),
    wait_until(all_came(Keeper, Sent), 30).

%   Every other time it stops at once: threads that waited for its start send
%   then.

rested(Round, Options) :-
    random_between(0, 3, More),
    (   Round mod 2 =:= 0
    ->  true
    ;   wait_until(( result(a, N, ok), N >= 2*Round+More ), 60)
    ),
    host_stop(alpha),
    host_start(alpha, Options).

send_numbers(_, _, _) :-
    over,
    !.
send_numbers(Key, N, Keeper) :-
    (   catch(agent_send(Keeper, m(Key, N)), error(_, _), fail)
    ->  assertz(result(Key, N, ok)),
        N1 is N+1
    ;   N1 = N
    ),
    send_numbers(Key, N1, Keeper).

all_came(Keeper, Sent) :-
    agent_property(Keeper, facts(Facts)),
    findall(M, member(got(M), Facts), Got0),
    msort(Got0, Sent).

%   A thread sends when the agents are there again, and changes are not queued
%   yet: it waits.

:- dynamic sends/3.                     % Keeper, Thread, Queue

:- multifile typhon_durable:restored/0.

typhon_durable:restored :-
    retract(plunit_stop:sends(Keeper, Thread, Queue)),
    thread_create(( agent_send(Keeper, early),
                    thread_send_message(Queue, sent) ), Thread),
    (   thread_get_message(Queue, sent, [timeout(0.1)])
    ->  Sent = early
    ;   Sent = waits
    ),
    assertz(plunit_stop:sends(Sent, Thread, Queue)).

test(message_during_the_restart_waits_for_its_end, Sent == waits) :-
    no_leaks(with_tmp_dir(sent_during_the_restart(Sent))).

sent_during_the_restart(Sent, Dir) :-
    kept(Dir, Keeper),
    host_stop(alpha),
    setup_call_cleanup(
        message_queue_create(Queue),
        ( assertz(sends(Keeper, _, Queue)),
          host_start(alpha, [journal(Dir)]),
          retract(sends(Sent, Thread, _)),
          thread_join(Thread),
          host_stop(alpha),
          running(Dir, got(Keeper, [early])) ),
        message_queue_destroy(Queue)).

                /*******************************
                *        TO THE LAST STEP      *
                *******************************/

%   Each of these is a step of a stop.

stop_does(Step) :-
    member(Step,
           [ typhon_durable:durable_close,
             typhon_hosting:evacuate(_, _), typhon_hosts:host_unlink(_, _),
             typhon_events:event(_, _, _, _), typhon_events:events_forget(_),
             typhon_time:clock_clear(_), typhon_place:place_destroy(_),
             typhon_endpoint:endpoint_stop, typhon_time:time_stop,
             typhon_connection_manager:manager_end,
             typhon_durable:durable_end, typhon_code:code_clear ]).

test(host_starts_again_whatever_step_of_its_stop_raises,
     [forall(stop_does(Step))]) :-
    no_leaks(with_tmp_dir(Dir,
        ( kept(Dir, Keeper),
          agent_send(Keeper, one),
          setup_call_cleanup(
              wrap_predicate(Step, stop, Wrapped,
                             plunit_stop:done_and_raise(Wrapped)),
              quietly(host_stop(alpha)),
              unwrapped(Step)),
          running(Dir, got(Keeper, [one])) ))).

unwrapped(Module:Head) :-
    functor(Head, Name, Arity),
    unwrap_predicate(Module:Name/Arity, stop).

:- public done_and_raise/1.

done_and_raise(Goal) :-
    ignore(Goal),
    throw(error(existence_error(journal, open), _)).

:- meta_predicate quietly(0).

quietly(Goal) :-
    setup_call_cleanup(
        asserta((user:message_hook(_, error, _) :- true), Hook),
        Goal,
        erase(Hook)).

test(last_commit_that_fails_does_not_hinder_the_stop, [setup(forget)]) :-
    no_leaks(with_tmp_dir(Dir,
        ( kept(Dir, Keeper),
          agent_send(Keeper, one),
          got(Keeper, [one]),
          sync_changes,
          setup_call_cleanup(
              wrap_predicate(typhon_store:store_commit(_), stop, _,
                             throw(error(resource_error(journal_space), _))),
              quietly(( catch(agent_send(Keeper, two), error(Formal, _), true),
                        host_stop(alpha) )),
              unwrap_predicate(typhon_store:store_commit/1, stop)),
          assertion(Formal == resource_error(journal_space)),
          running(Dir, got(Keeper, [one])) ))).

test(one_of_two_threads_stops_the_host) :-
    no_leaks(with_tmp_dir(both)).

both(Dir) :-
    host_start(alpha, [journal(Dir)]),
    findall(Thread, ( between(1, 2, _), in_thread(host_stop(alpha), Thread) ),
            Threads),
    findall(Status,
            ( member(Thread, Threads), thread_join(Thread, Status) ),
            Statuses),
    assertion(memberchk(true, Statuses)),
    assertion(memberchk(exception(error(existence_error(host, alpha), _)),
                        Statuses)),
    running(Dir, true).

test(stop_goes_on_when_its_caller_is_interrupted) :-
    no_leaks(with_tmp_dir(interrupted)).

interrupted(Dir) :-
    kept(Dir, Keeper),
    with_mutex(typhon_commit,           % the last commit waits
               ( in_thread(host_stop(alpha), Thread),
                 wait_until(durable_closed, 20),
                 thread_signal(Thread, throw(interrupted)),
                 thread_join(Thread, Status) )),
    assertion(Status == exception(interrupted)),
    running(Dir, agent_property(Keeper, state(_))).

test(other_host_starts_while_a_host_stops) :-
    no_leaks(with_tmp_dir(Dir,
        ( forall(between(1, 5, _),
                 ( host_start(alpha, [journal(Dir)]),
                   in_thread(host_stop(alpha), Thread),
                   host_start(beta),
                   thread_join(Thread, true),
                   host_stop(beta) )) ))).

test(join_ends_when_the_host_of_the_agent_stops) :-
    no_leaks(with_tmp_dir(Dir,
        ( kept(Dir, Keeper),
          in_thread(catch(agent_join(Keeper, _, 5), error(_, _), true), Thread),
          host_stop(alpha),
          thread_join(Thread, true),
          running(Dir, agent_property(Keeper, state(_))) ))).

:- end_tests(stop).
