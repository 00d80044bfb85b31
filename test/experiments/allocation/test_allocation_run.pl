:- module(test_allocation_run, []).
:- use_module('../../lib/common', [project_file/2, run_swipl/5, with_tmp_dir/1]).
:- use_module(library(apply)).
:- use_module(library(csv)).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(readutil)).
:- use_module(library(typhon), [remote/2]).
:- use_module('../../../experiments/allocation/cases').
:- use_module('../../../experiments/allocation/claims').
:- use_module('../../../experiments/allocation/ground').
:- use_module('../../../experiments/allocation/integrated').
:- use_module('../../../experiments/allocation/metrics').
:- use_module('../../../experiments/allocation/network').
:- use_module('../../../experiments/allocation/urgent').
:- use_module('../../../experiments/allocation/watch').

/** <module> The experiments with allocation

Measures and claims of logs and results that are made by hand; and one small
run by the command line.
*/

%   A log: two tasks; a backs off twice, b once; b is completed first.

log([ e(5, h1, a1, begun(a)),
      e(5.5, h2, b1, begun(b)),
      e(6, r1, robot, reserved(r1, a1, a)),
      e(7, h1, a1, backoff(2)),
      e(7, r1, robot, released(r1, a1, a)),
      e(8, r1, robot, reserved(r1, b1, b)),
      e(9, h2, b1, backoff(4)),
      e(10, h1, a1, backoff(9)),
      e(11, h2, b1, allocated(b, [r1])),
      e(12, r1, robot, executed(r1, b1, b)),
      e(13, h2, b1, completed(b)),
      e(13, r1, robot, released(r1, b1, b)),
      e(13, h2, b1, communications(migration, 7)),
      e(14, h2, c1, communications(child, 2)),
      e(14.5, r1, robot, reserved(r1, a1, a)),
      e(15, h1, a1, completed(a)),
      e(15, h1, a1, communications(migration, 30)),
      e(15, r1, robot, released(r1, a1, a))
    ]).

events(Es, Events) :-
    findall(event(T, H, A, W), member(e(T, H, A, W), Es), Events).

log_events(Events) :-
    log(Es),
    events(Es, Events).

:- begin_tests(allocation_measures).

test(measures) :-
    log_events(Events),
    allocation_measures(Events, Measures),
    Measures == [ communications(39), kinds([child-2, migration-37]),
                  time(10), backoffs(1.5), interval(5),
                  completed([b-8, a-10]) ].
test(nothing_happened, Measures ==
         [ communications(0), kinds([]), time(none), backoffs(0),
           interval(none), completed([]) ]) :-
    allocation_measures([], Measures).
test(a_measure_is_a_number, Values == [3]) :-
    findall(Value,
            ( member(Result, [[time(3)], [time(none)], [interval(3)]]),
              measure(time, Result, Value) ),
            Values).

%   State of the watch after each event: how many tasks done, whether over.

test(watched, Over == [15.0]) :-
    log(Es0),
    append([ e(1, h1, 'allocator.1', created), e(1, h2, 'robot.1', created)
           | Es0 ],
           [ e(15.0, h1, 'allocator.1', ended(done)) ], Es),
    events(Es, Events),
    watch_start([a, b], State),
    over(Events, State, Over).
test(not_over_as_long_as_a_robot_is_held, fail) :-
    log(Es0),
    append(Es, [_], Es0),
    events(Es, Events),
    watch_start([a, b], State0),
    foldl(watch, Events, State0, State),
    watch_done(State, 2),
    watch_held(State, [r1]),
    watch_over(State).
test(missed_is_done, true(watch_over(State))) :-
    watch_start([a], State0),
    watch(event(1, h, x, missed(a, 10)), State0, State).

over([], _, []).
over([Event|Events], State0, Over) :-
    watch(Event, State0, State),
    (   watch_over(State)
    ->  Event = event(Time, _, _, _),
        Over = [Time|Rest]
    ;   Over = Rest
    ),
    over(Events, State, Rest).

:- end_tests(allocation_measures).

:- begin_tests(allocation_cases).

base([hosts(100), eligible(15), required(10), allocators(5)]).

test(counts, Counts == ['7.1'-15-0, '7.2'-15-3, '7.3'-10-0, '7.4'-15-0,
                        '7.5'-4-2]) :-
    base(Options),
    findall(Figure-Count-More,
            ( figure(Figure, _, _),
              figure_cases(Figure, Options, Cases, Others),
              length(Cases, Count), length(Others, More) ),
            Counts).
test(density, Eligible == [10, 20, 30, 40, 50]) :-
    base(Options),
    figure_cases('7.4', Options, Cases, _),
    findall(E, member(E-case(anta, dynamic, 100, E, 10, 5), Cases),
            Eligible).
test(sizes, Sizes == [50-10-5, 100-20-10, 150-30-15, 200-40-20]) :-
    base(Options),
    figure_cases('7.5', Options, Cases, _),
    findall(N-E-R, member(N-case(_, _, N, E, R, 5), Cases), Sizes).

%   The same robots for every mechanism; fewer are among the more.

test(same_ground) :-
    numlist(1, 100, Hosts),
    ground(case(proposed, dynamic, 100, 15, 10, 5), 7, Hosts, Ground),
    ground(case(murdoch, static, 100, 15, 10, 5), 7, Hosts, Ground),
    ground(case(proposed, dynamic, 100, 10, 10, 3), 7, Hosts, Less),
    ground(case(proposed, dynamic, 100, 15, 10, 5), 8, Hosts, Other),
    Ground = ground(Able, Others, Starts),
    append(Able, Others, All),
    msort(All, Hosts),
    length(Able, 15),
    length(Starts, 5),
    sort(Starts, Distinct),
    length(Distinct, 5),
    Less = ground(Able1, _, Starts1),
    append(Able1, _, Able),
    append(Starts1, _, Starts),
    Other \== Ground.

:- end_tests(allocation_cases).

                /*******************************
                *             CLAIMS           *
                *******************************/

%   results(+Communications, +Time, -Runs): of three seeds.

results(Communications, Time, Runs) :-
    findall(Seed-[ ended(true), communications(C), time(Time), backoffs(1),
                   interval(4), completed([]) ],
            ( member(Seed, [1, 2, 3]), C is Communications + Seed - 2 ),
            Runs).

%   Five allocators at most; the numbers grow as the thesis has it.

claimed(Proposed, Murdoch, Text, Held) :-
    findall(K-case(M, dynamic, 100, 15, 10, K),
            ( member(M, [proposed, murdoch, anta]), between(1, 5, K) ),
            Cases),
    findall(Case-Runs,
            ( member(K-Case, Cases),
              Case = case(M, _, _, _, _, _),
              memberchk(M-Step, [ proposed-Proposed, murdoch-Murdoch,
                                  anta-Murdoch ]),
              Communications is K*Step,
              results(Communications, K, Runs) ),
            Data),
    allocation_claims('7.1', Cases, Data, Claims),
    member(claim(Text0, Held, _), Claims),
    sub_atom(Text0, _, _, _, Text),
    !.

:- begin_tests(allocation_claims).

test(as_in_the_thesis, Helds == [true, true, true, true]) :-
    findall(Held,
            ( member(Text, [ 'fewer than 10,000', 'proposed: least',
                             'Murdoch: more than 50,000',
                             'Murdoch: communications rise' ]),
              claimed(1000, 20000, Text, Held) ),
            Helds).
test(can_fail, Helds == [false, false, false, false]) :-
    findall(Held,
            ( member(Text, [ 'fewer than 10,000', 'proposed: least',
                             'Murdoch: more than 50,000',
                             'Murdoch: communications rise' ]),
              claimed(2500, 2400, Text, Held) ),
            Helds).
test(equal_is_not_sooner, Held == false) :-
    claimed(1000, 20000, 'sooner than Murdoch', Held).
test(same_trend, Helds == [true, false, false]) :-
    findall(Held,
            ( member(Rise, [7, 9, -1]), trend(Rise, Held) ), Helds).
test(nothing_known_does_not_hold, Helds == [false]) :-
    findall(Held,
            ( allocation_claims('7.4', [], [], Claims),
              member(claim(_, Held, _), Claims) ),
            Helds0),
    sort(Helds0, Helds).
test(runs_that_did_not_end_are_told_and_not_counted,
     Held-Found == false-'1 of 2') :-
    Case = case(proposed, dynamic, 100, 20, 10, 5),
    Data = [Case-[ 1-[ended(true), communications(9), time(1), backoffs(1),
                      interval(1)],
                   2-[ended(false), communications(90000), time(none),
                      backoffs(1), interval(1)] ]],
    allocation_claims('7.5', [100-Case], Data, Claims),
    Claims = [claim(_, Held, Found)|_],
    member(claim(Text, true, _), Claims),
    sub_atom(Text, _, _, _, '20,000'),
    !.

%   Times that rise by 4, and by Rise.

trend(Rise, Held) :-
    findall(K-case(M, dynamic, 100, 15, 10, K),
            ( member(M, [proposed, constant]), member(K, [1, 2]) ), Cases),
    findall(Case-Runs,
            ( member(K-Case, Cases), Case = case(M, _, _, _, _, _),
              memberchk(M-Step, [proposed-4, constant-Rise]),
              Time is 50 + K*Step,
              results(1, Time, Runs) ),
            Data),
    allocation_claims('7.3', Cases, Data, Claims),
    member(claim(Text, Held, _), Claims),
    sub_atom(Text, _, _, _, trend),
    !.

sequence_log(Where,
             [ e(1, h, x, begun(s)), e(3, h, x, allocated(s, [r1, r2])),
               e(4, r1, w, executing(s, 1)), e(5, r1, w, completed(s, 1)),
               e(4, r2, w, executing(s, 1)), e(6, r2, w, completed(s, 1)),
               e(7, r1, w, executing(s, 2)), e(8, r1, w, completed(s, 2)),
               e(7, Where, w, executing(s, 2)),
               e(9, Where, w, completed(s, 2)),
               e(10, h, x, completed(s)) ]).

sequence_helds(Where, Helds) :-
    sequence_log(Where, Es),
    events(Es, Events),
    integrated_measures(Events, [s], 2, Measures),
    integrated_claims([1-[ended(true)|Measures]], Claims),
    findall(Held, member(claim(_, Held, _), Claims), Helds).

test(sequence, Helds == [true, true, true, true, true, true]) :-
    sequence_helds(r2, Helds).
test(sequence_of_a_stranger,
     Helds == [true, false, false, true, false, true]) :-
    sequence_helds(r3, Helds).

test(urgent, Late-Others-Missed-Overdue == 4-7-[c]-[0.5-3]) :-
    events([ e(0, h, x, begun(a)), e(1, h, y, begun(b)),
             e(2, h, z, begun(c)), e(5, h, y, completed(b)),
             e(7, h, x, completed(a)), e(12.5, h, z, missed(c, 10)),
             e(15, r, r, released(r, z, c)) ],
           Events),
    urgent_measures(Events, b, Measures),
    memberchk(late(Late), Measures),
    memberchk(others(Others), Measures),
    memberchk(missed(Missed), Measures),
    memberchk(overdue(Overdue), Measures).

:- end_tests(allocation_claims).

                /*******************************
                *              RUNS            *
                *******************************/

%   A network on which somebody logs what must never happen.

faulty(Log, Ended, Error) :-
    with_tmp_dir(faulty_in(Log, Ended, Error)).

faulty_in(Log, Ended, Error, Dir) :-
    Options = [ mechanism(proposed), links(static), hosts(3), eligible(2),
                required(1), allocators(1), degree(2), processes(1),
                hop_time(0.1-0.2), clock(20), seed(1) ],
    catch(( on_network(Options, Dir, told(Log, Ended), _, _),
            Error = none ),
          error(Error, _), true).

told(Log, Ended, [Host|_], _, Ended) :-
    sub_atom(Host, Before, _, _, @),
    sub_atom(Host, 0, Before, _, Name),
    forall(member(What, Log),
           remote(Host, typhon_hosts:host_log(Name, someone, What))).

:- begin_tests(allocation_experiment).

test(robot_that_is_reserved_twice,
     Error == reservation_faults([twice(r, a, b)])) :-
    faulty([reserved(r, a, x), reserved(r, b, y)], false, Error0),
    timeless(Error0, Error).
test(robot_that_is_left_reserved,
     Error == reservation_faults([held(r, a, x)])) :-
    faulty([reserved(r, a, x)], true, Error).
test(robot_that_is_held_when_a_run_is_cut_short, Error == none) :-
    faulty([begun(x), reserved(r, a, x)], false, Error).
test(robot_that_is_held_for_ever,
     Error == reservation_faults([held(r, a, x)])) :-
    faulty([begun(x), reserved(r, a, x), completed(x)], false, Error).

timeless(reservation_faults([twice(R, A, B, _)|_]),
         reservation_faults([twice(R, A, B)])).

test(small_figure) :-
    with_tmp_dir(figure_made).

small([ '--hosts', '8', '--degree', '3', '--eligible', '3', '--required',
        '2', '--allocators', '1', '--clock', '40', '--duration', '1' ]).

run(Dir, More, Out) :-
    project_file('experiments/allocation.pl', Script),
    small(Small),
    append([[Script, '--', '--out', Dir], More, Small], Arguments),
    run_swipl(Arguments, [timeout(120)], exit(0), Out, _).

figure_made(Dir) :-
    run(Dir, ['--figure', '7.3', '--runs', '1', '--jobs', '2'], Out),
    forall(member(Text, [ "Host clock", "constant back-off",
                          "so the logs of 2 of 2 runs",
                          "before the limit: 2 of 2" ]),
           sub_string(Out, _, _, _, Text)),
    directory_file_path(Dir, 'allocation-7.3.csv', Csv),
    csv_read_file(Csv, [_|Rows]),
    length(Rows, 2),
    forall(member(Row, Rows),
           ( arg(8, Row, true), arg(9, Row, Communications),
             Communications > 0 )),
    directory_file_path(Dir, 'allocation-7.3-claims.pl', Claims),
    read_file_to_terms(Claims, Facts, []),
    memberchk(claim(_, _, _), Facts).

%   What the nodes have counted is in the log to the last message.

test(one_auction) :-
    with_tmp_dir(auctioned).

auctioned(Dir) :-
    run(Dir, ['--single', '--mechanism', murdoch], _),
    directory_file_path(Dir, 'result.pl', File),
    read_file_to_terms(File, [result(Result)], []),
    memberchk(ended(true), Result),
    memberchk(completed([1-_]), Result),
    memberchk(kinds(Kinds), Result),
    forall(member(Kind, [announce, award, bid, release, start]),
           memberchk(Kind-_, Kinds)),
    memberchk(communications(Sum), Result),
    findall(Count, member(_-Count, Kinds), Counts),
    sum_list(Counts, Sum).

test(no_such_figure, Status-Known == exit(1)-true) :-
    project_file('experiments/allocation.pl', Script),
    run_swipl([Script, '--', '--figure', '7.9'], [], Status, _, Err),
    (   sub_string(Err, _, _, _, "figure")
    ->  Known = true
    ;   Known = false
    ).

:- end_tests(allocation_experiment).
