:- module(lasting_node, []).

/** <module> A process with a journal, which dies at its steps

    swipl node.pl -- NAME PORT DIR SYNC SEED [ENGINE]

Starts the host NAME, with its journal in DIR, or in the engine at the port
ENGINE, if that is not `none`; prints `ready`; ends with its standard input, from
which it takes terms:

  - dies(P): at each step of the journal, see crash_point/1, it kills itself
    with probability P from now on
  - power(P): after each commit it arranges, with probability P, a simulated
    power failure during the next one
  - cut: its connections break
  - rest: its host stops and starts again
  - slow(S): each commit takes S seconds more
  - look: it prints its pending data for others, then `looked`

Before the simulated power failure the files of the journal, which are fully
synced, are copied; then it dies during one more commit. It sends nothing
meanwhile. power.pl does the rest.

*Threading*: the main thread; steps in any.
*/

:- use_module('../../../prolog/typhon').
:- use_module(power, [power_copy/1]).
:- use_module(library(lists), [member/2, numlist/3, sum_list/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(random), [random_between/3]).

:- initialization(main, main).

:- dynamic
    probability/2,                      % Of, P
    journal/1,                          % Dir
    slow/1,                             % Seconds that each commit takes more
    begins/2,                           % Name, Options of its host
    fails/0.                            % the power fails

:- multifile
    typhon_durable:reached/1,
    typhon_store:fenced/1.

typhon_durable:reached(in_commit) :-
    slow(Seconds),
    sleep(Seconds),                     % a wait with a deadline may not end in
    fail.                               % sig_atomic/1
typhon_durable:reached(Point) :-
    \+ fails,
    happens(dies),
    !,
    format(user_error, 'dies at ~w~n', [Point]),
    die.
typhon_durable:reached(after_commit) :-
    fails,
    !,
    wait_for_death.
typhon_durable:reached(after_commit) :-
    happens(power),
    !,
    journal(Dir),
    power_copy(Dir),
    assertz(fails).
typhon_durable:reached(in_commit) :-
    fails,
    !,
    thread_create(die_soon, _, [detached(true)]).

happens(What) :-
    probability(What, P),
    P > 0,
    random_float < P.

die :-
    current_prolog_flag(pid, Pid),
    process_kill(Pid, kill),
    wait_for_death.

wait_for_death :-
    thread_self(Me),
    thread_get_message(Me, '$never').

%   While the next commit writes or syncs, or just after it.

die_soon :-
    random_between(0, 30000, Steps),
    numlist(0, Steps, List),
    sum_list(List, _),
    die.

:- public main/1.

main([Name, Port, Dir, Sync, Seed]) :-
    main([Name, Port, Dir, Sync, Seed, none]).
main([Name, Port0, Dir, Sync, Seed0, Engine]) :-
    atom_number(Port0, Port),
    atom_number(Seed0, Seed),
    set_random(seed(Seed)),
    set_prolog_flag(verbose, silent),
    assertz(journal(Dir)),
    obey_first,
    journal_option(Engine, Name, Dir, Journal),
    assertz(begins(Name, [sync(Sync), port(Port)|Journal])),
    begin,
    format('ready~n'),
    flush_output,
    repeat,
    read_term(Order, []),
    (   Order == end_of_file
    ->  !,
        halt
    ;   obey(Order),
        fail
    ).

%   The engine may be away.

journal_option(none, _, Dir, [journal(Dir)]) :-
    !.
journal_option(Engine, Name, _, [journal(redis(Path)), fleet(lab)]) :-
    atom_number(Engine, Port),
    atom_concat('lab/', Name, Path),
    patiently(fleet_join(lab, [ redis('127.0.0.1':Port), lease(1.5),
                                fsync(always) ])).

begin :-
    begins(Name, Options),
    patiently(host_start(Name, Options)).

:- meta_predicate patiently(0).

patiently(Goal) :-
    (   catch(Goal, error(Formal, Context),
              ( Formal = journal_unreachable(_, _) -> fail
              ; Formal = resource_error(fleet(_)) -> fail
              ; throw(error(Formal, Context)) ))
    ->  true
    ;   sleep(0.2),
        patiently(Goal)
    ).

%   What it would send now might contradict what was taken over.

typhon_store:fenced(_) :-
    die.

%   The process may die before it has restarted.

obey_first :-
    read_term(orders(Orders), []),
    forall(member(Order, Orders), obey(Order)).

obey(dies(P)) :-
    now(dies, P).
obey(power(P)) :-
    now(power, P).
obey(cut) :-
    forall(( typhon_session:transport(Key, Thread, _),
             typhon_session:session(Key, Session) ),
           typhon_session:session_locked(
               Session, typhon_session:transport_broken(Key, Thread))).

obey(rest) :-
    begins(Name, _),
    host_stop(Name),
    begin.
obey(slow(Seconds)) :-
    retractall(slow(_)),
    ( Seconds > 0 -> assertz(slow(Seconds)) ; true ).
obey(look) :-
    forall(held(What), format(user_error, '~q~n', [What])),
    format(user_error, 'looked~n', []).

%   Pending data for others, and its owners.

held(out(E, N, K, T)) :- typhon_channel:out(E, N, K, T).
held(had(E, N)) :- typhon_channel:had(E, N).
held(sent(E, N)) :- typhon_channel:sent(E, N).
held(courier(E)) :- typhon_channel:courier(E).
held(seen(E, N)) :- typhon_channel:seen(E, N).
held(ack_scheduled(E)) :- typhon_channel:ack_scheduled(E).
held(waits(Id, Letters, T, S)) :-
    typhon_mail:waits(Id, Q, T, S),
    findall(L, thread_peek(Q, L), Letters).
held(agent(Id, P)) :-
    agent_property(Id, P), \+ P = program(_), \+ P = trace(_).
held(thread(T, S, G)) :-
    thread_property(T, status(S)),
    ( catch(thread_property(T, alias(G)), error(existence_error(thread, _), _), fail)
    ->  true
    ;   G = none
    ).
held(queue(Q, N)) :-
    message_queue_property(Q, size(N)), N > 0.
held(flag(Flag, Value)) :-
    member(Flag, [typhon_journal_awake, typhon_journal_wanted]),
    get_flag(Flag, Value).
held(mutex(Mutex, Status)) :-
    member(Mutex, [typhon_commit, typhon_entries]),
    catch(mutex_property(Mutex, status(Status)), error(_, _), fail).
held(engine(Answer)) :-
    current_predicate(typhon_engine:engine/3),
    catch(typhon_engine:engine(lab, ping, Answer), error(Answer, _), true).
held(signalled(T)) :-
    thread_property(T, alias(Alias)),
    sub_atom(Alias, _, _, _, journal),
    catch(thread_signal(T, backtrace(30)), error(_, _), fail).
held(alarm(A)) :-
    current_predicate(typhon_scheduler:F/N),
    functor(A, F, N),
    predicate_property(typhon_scheduler:A, dynamic),
    clause(typhon_scheduler:A, true).
held(fact(M:A)) :-
    member(M, [ typhon_connection_manager, typhon_session, typhon_peer_cache,
                typhon_hop_ids, typhon_transfer, typhon_arrival,
                typhon_whereabouts, typhon_news, typhon_window,
                typhon_committing, typhon_connection, typhon_reader,
                typhon_engine ]),
    current_predicate(M:F/N),
    F \== text,                        % of scripts
    functor(A, F, N),
    predicate_property(M:A, dynamic),
    clause(M:A, true).

thread_peek(Q, L) :-
    message_queue_property(Q, size(N)),
    between(1, N, _),
    thread_get_message(Q, L, [timeout(0)]),
    thread_send_message(Q, L).

now(What, P) :-
    assertz(probability(What, P)),
    (   clause(probability(What, _), true, First),
        clause(probability(What, _), true, Last),
        First \== Last
    ->  erase(First)
    ;   true
    ).
