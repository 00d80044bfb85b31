:- use_module(common).
:- use_module('../test/lib/redis', [redis_address/2, with_redis/3]).
:- use_module('../test/lib/stores', [commit/1, with_store/3]).
:- use_module('../experiments/engine/numbers', [median/2]).
:- use_module(traveller).
:- use_module(library(typhon)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [delete_directory_and_contents/1]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).

/*  The cost of a journal: the hops of bench/hops.pl without a journal, and
    with one in both processes; and the time in which a process with many
    agents restarts. Hops are counted for some seconds, alternately, in
    rounds; the result is the median, for ratios the median of the ratios of
    each round.

    For agents with large states: the cost of a turn that changes one fact, and
    the messages per second of an agent that stores all its messages.

    For back ends: commits of three items of 300 bytes in SQLite and in the
    engine of a fleet, Redis, in turn, where nothing else is committed.

    swipl bench/journal.pl -- unpinned
    swipl bench/journal.pl -- states
    swipl bench/journal.pl -- commits */

:- initialization(main, main).

main([unpinned]) :-
    rounds(Rounds),
    findall(Round, ( between(1, Rounds, _), round(Round) ), All),
    forall(figure_of(Name, Unit, Round, Value, Note),
           ( findall(Value, member(Round, All), Values),
             median(Values, Median),
             figure(Name, Median, Unit, Note) )),
    states,
    commits,
    recovery(100000).
main([states]) :-
    states.
main([commits]) :-
    commits.

rounds(3).

%   Results of a round: hops per second of one agent and of a hundred, in each
%   configuration, and syncs per second of the disk alone.

round(round(none(A1, _), normal(B1, B100), full(C1, C100), Syncs)) :-
    rates(none, A1, _),
    rates(normal, B1, B100),
    rates(full, C1, C100),
    syncs(Syncs).

figure_of('1 agent without a journal: hops per second', '1/s',
          round(none(V, _), _, _, _), V, '').
figure_of('1 agent, sync(normal): hops per second', '1/s',
          round(_, normal(V, _), _, _), V, '').
figure_of('1 agent, sync(full): hops per second', '1/s',
          round(_, _, full(V, _), _), V, '').
figure_of('a hop with sync(normal)', times,
          round(none(A, _), normal(B, _), _, _), A/B, 'one without').
figure_of('100 agents, sync(normal): hops per second', '1/s',
          round(_, normal(_, V), _, _), V, '').
figure_of('100 agents, sync(full): hops per second', '1/s',
          round(_, _, full(_, V), _), V, '').
figure_of('the same for each time that the disk alone syncs', '',
          round(_, _, full(_, V), Syncs), V/Syncs, '').
figure_of('the disk alone syncs, times per second', '1/s',
          round(_, _, _, Syncs), Syncs, '').

rates(Sync, One, Hundred) :-
    with_directory(rates(Sync, One, Hundred)).

:- meta_predicate with_directory(1).

with_directory(Goal) :-
    tmp_file(journal, Dir),
    make_directory(Dir),
    setup_call_cleanup(true, once(call(Goal, Dir)),
                       delete_directory_and_contents(Dir)).

rates(Sync, One, Hundred, Dir) :-
    here(Sync, Dir, Options),
    setup_call_cleanup(
        host_start(here, Options),
        with_other(Sync, Dir, both(One, Hundred)),
        host_stop(here)).

here(none, _, []) :-
    !.
here(Sync, Dir, [journal(Own), sync(Sync)]) :-
    atom_concat(Dir, '/here', Own).

both(One, Hundred, Peer) :-
    rate(1, 1, Peer, _),                % warm up
    rate(1, 3, Peer, One),
    rate(100, 4, Peer, Hundred).

%   rate(+Agents, +Seconds, +Peer, -PerSecond)

rate(Agents, Seconds, Peer, PerSecond) :-
    walker(Program),
    get_time(Start),
    Until is Start+Seconds,
    findall(Agent,
            ( between(1, Agents, _),
              agent_create(Program, Agent,
                           [facts([left(0), peer(Peer), until(Until)])]) ),
            All),
    aggregate_all(sum(Hops),
                  ( member(Agent, All),
                    agent_result(Agent, Hops, 300) ),
                  Sum),
    get_time(End),
    PerSecond is Sum/(End-Start).

%   Like the agent of bench/hops.pl, but ends at the time Until.

walker(clauses([ (:- agent(walker,
                           [state([left/1,peer/1,fact/2,until/1])])),
                 (main :- until(Until), get_time(Now), Now > Until, !,
                          left(N), result(N)),
                 (main :- retract(left(N0)), N is N0+2, assertz(left(N)),
                          peer(P), move(P), home(H), move(H), main)
               | Rest ])) :-
    traveller(clauses([_, _, _|Rest])).

:- meta_predicate with_other(+, +, 1).

with_other(Sync, Dir, Goal) :-
    module_property(bench_traveller, file(File)),
    (   Sync == none
    ->  Options = []
    ;   atom_concat(Dir, '/there', There),
        Options = [journal(There), sync(Sync)]
    ),
    format(atom(Start),
           'typhon:host_start(peer, ~q), typhon:host_property(peer, \c
            address(A)), writeln(A), read(_)', [Options]),
    setup_call_cleanup(
        process_create(path(swipl), ['-q', '-g', Start, '-t', halt, File],
                       [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]),
        ( read_line_to_string(Out, Line),
          atom_string(Address, Line),
          call(Goal, Address) ),
        ( close(In), process_wait(Pid, _), close(Out) )).

%   Writes of the length of a page in the directory of the journals, each on the
%   disk before the next.

syncs(PerSecond) :-
    with_directory(syncs(PerSecond)).

syncs(PerSecond, Dir) :-
    atom_concat('of=', Dir, Of0),
    atom_concat(Of0, '/disk', Of),
    Count = 400,
    atom_concat('count=', Count, Many),
    seconds(( process_create(path(dd), ['if=/dev/zero', Of, 'bs=4096', Many,
                                        'oflag=dsync', 'status=none'],
                             [process(Pid)]),
              process_wait(Pid, exit(0)) ), Seconds),
    PerSecond is Count/Seconds.

                /*******************************
                *         LARGE STATES         *
                *******************************/

states :-
    forall(member(Facts, [100, 16000, 100000]),
           with_directory(state_of(Facts))),
    with_directory(collected(20000)).

state_of(Facts, Dir) :-
    host_start(here, [journal(Dir)]),
    findall(fact(I, value(I)), between(1, Facts, I), State),
    Turns = 2000,
    agent_create(clauses([ (:- agent(changes, [state([fact/2,left/1])])),
                           (main :- receive(_), turn),
                           (turn :- left(0), !, result(done)),
                           (turn :- retract(left(N0)), N is N0-1,
                                    assertz(left(N)),
                                    retract(fact(I0, V)), I is -I0,
                                    assertz(fact(I, V)),
                                    sleep(0),
                                    turn) ]),
                 Agent, [facts([left(Turns)|State])]),
    agent_send(Agent, first),
    cpu_seconds(agent_result(Agent, done, 600), Seconds),
    format(atom(Name), 'CPU of a turn that changes one fact of ~D', [Facts]),
    figure(Name, 1000*Seconds/Turns, ms),
    host_stop(here).

:- meta_predicate cpu_seconds(0, -).

cpu_seconds(Goal, Seconds) :-
    statistics(process_cputime, Start),
    once(Goal),
    statistics(process_cputime, End),
    Seconds is End-Start.

%   The last thousand messages are counted.

collected(Count, Dir) :-
    host_start(here, [journal(Dir)]),
    agent_create(clauses([ (:- agent(collects, [state([got/2])])),
                           (on_message(From, Message) :-
                                assertz(got(From, Message))) ]),
                 Agent, [host(here)]),
    Before is Count-1000,
    send_and_wait(Agent, 1, 1000, First),
    send_and_wait(Agent, 1001, Before, _),
    Next is Before+1,
    send_and_wait(Agent, Next, Count, Last),
    figure('messages per CPU second kept by an agent that has none', 1000/First,
           '1/s'),
    format(atom(Name), 'messages per CPU second kept by one that has ~D', [Before]),
    figure(Name, 1000/Last, '1/s'),
    host_stop(here).

send_and_wait(Agent, From, To, Seconds) :-
    cpu_seconds(( forall(between(From, To, I), agent_send(Agent, message(I))),
              repeat,
              sleep(0.01),
              agent_property(Agent, state(resident)),
              agent_property(Agent, mailbox([])),
              ! ),
                Seconds).

                /*******************************
                *           BACK ENDS          *
                *******************************/

%   Redis writes what it commits to its disk at once, as SQLite with sync(full),
%   or each second.

commits :-
    forall(member(Sync-Fsync, [normal-everysec, full-always]),
           with_redis(['--appendfsync', Fsync], Redis,
                      with_directory(commits(Sync, Fsync, Redis)))).

commits(Sync, Fsync, Redis, Dir) :-
    redis_address(Redis, Address),
    setup_call_cleanup(fleet_join(bench, [redis(Address), fsync(Fsync)]),
                       compare_commits(Sync, Dir),
                       fleet_leave(bench)).

compare_commits(Sync, Dir) :-
    rounds(Rounds),
    findall(A-B,
            ( between(1, Rounds, _),
              commit_seconds(Dir, Sync, B),
              commit_seconds(redis('bench/a'), Sync, A) ),
            Pairs),
    findall(Ratio, ( member(A-B, Pairs), Ratio is A/B ), Ratios),
    median(Ratios, Median),
    last(Pairs, A-B),
    format(atom(Name), 'a commit in Redis, sync(~w)', [Sync]),
    format(atom(Note), '~3g ms against ~3g (one in SQLite)', [1000*A, 1000*B]),
    figure(Name, Median, times, Note).

commit_seconds(Where, Sync, Seconds) :-
    Count = 1000,
    format(string(Text), '~`xt~300|', []),
    with_store(Where, Sync,
               ( commit([a-k-0-Text]),
                 seconds(forall(between(1, Count, N),
                                ( N1 is N+1, N2 is N+2,
                                  commit([ a-k-N-Text, a-l-N1-Text,
                                           a-m-N2-Text ]) )),
                         All) )),
    Seconds is All/Count.

                /*******************************
                *           RECOVERY           *
                *******************************/

recovery(Count) :-
    with_directory(recovery(Count)).

recovery(Count, Dir) :-
    Program = clauses([ (:- agent(waits, [state([fact/2])])),
                        (on_message(_, _) :- true) ]),
    findall(fact(I, value(I)), between(1, 8, I), Facts),
    host_start(here, [journal(Dir)]),
    seconds(forall(between(1, Count, _),
                   agent_create(Program, _, [facts(Facts)])), Made),
    figure('agents created per second', Count/Made, '1/s'),
    host_stop(here),
    seconds(host_start(here, [journal(Dir)]), Seconds),
    host_property(here, load(Load)),
    Load =:= Count,
    format(atom(Name), '~D agents are there again', [Count]),
    figure(Name, Seconds, s),
    statistics(process_cputime, Cpu0),
    sleep(2),
    statistics(process_cputime, Cpu1),
    Share is (Cpu1-Cpu0)/2,
    figure('processors that they take while they wait', Share, '').
