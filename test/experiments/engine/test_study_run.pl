:- module(test_study_run, []).

% One run: its input, the files that it leaves, and its repetition.

:- use_module('../../lib/common').
:- use_module('../../lib/study_files',
              [save_lines/3, study_command/4, with_study_file/4]).
:- use_module('../../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../../experiments/engine/run').
:- use_module('../../../experiments/engine/studies', [study_load/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [directory_file_path/3, directory_member/3,
               make_directory_path/1]).
:- use_module(library(lists), [last/2, member/2, nth1/3, subtract/3]).
:- use_module(library(gensym), [gensym/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).

agent([ ':- agent(walker, [state([steps/1])]).',
        'steps(20).',
        'main :- retract(steps(N)), N > 0, !, N1 is N-1,',
        '    assertz(steps(N1)), next_host(random, Host), move(Host),',
        '    random_between(1, 1000, R), log(step(N, R)), sleep(1), main.',
        'main.' ]).

study([ 'study(toy, "A toy").',
        'vary(hosts, [5, 6]).',
        'fixed(hop_time, 0.1-0.5, assumed("so")).',
        'network(Case, ring(N), [hop_time(uniform(A, B))]) :-',
        '    N = Case.hosts, A-B = Case.hop_time.',
        'run(Case, Network) :-',
        '    Case.seed < 100,',
        '    typhon:network_property(Network, hosts([Home|_])),',
        '    study_walker(Walker),',
        '    findall(A, ( between(1, 3, _),',
        '                 typhon:agent_create(Walker, A, [host(Home)]) ),',
        '            Agents),',
        '    forall(member(A, Agents),',
        '           typhon:agent_join(A, done, 1000)).',
        'study_walker(File) :-',
        '    source_file(study_walker(_), Here), file_directory_name(Here, D),',
        '    atom_concat(D, \'/walker.pl\', File).',
        'measure(steps, Log, Count) :-',
        '    aggregate_all(count, member(event(_, _, _, step(_, _)),',
        '                                Log.events), Count).',
        'measure(hosts, Log, Count) :- length(Log.hosts, Count).',
        'measure(drawn, _, X) :- random_between(1, 1000000, X).',
        'real([hosts=5], [clock=50]).',
        'progress(_, step(_, _), 60).'
      ]).

:- meta_predicate with_walkers(-, -, 0).

with_walkers(Dir, File, Goal) :-
    study(Lines),
    agent(Agent),
    with_study_file(Lines, Dir, File,
                    ( save_lines(Dir, 'walker.pl', Agent), Goal )).

%   made(+Dir, +File, +N, +Seed, -Log, -Result): the run of case N, in a
%   directory of its own.

made(Dir, File, N, Seed, Log, Result) :-
    gensym(run, Name),
    directory_file_path(Dir, Name, Run),
    make_directory_path(Run),
    study_load(File, Study),
    study_cases(Study, [], Cases),
    nth1(N, Cases, Case),
    run_make(Study, Case, Seed, Run),
    text(Run, 'events.pl', Log),
    text(Run, 'result.pl', Result).

text(Run, Name, Text) :-
    directory_file_path(Run, Name, File),
    read_file_to_string(File, Text, [encoding(utf8)]).

drawn(Result, Drawn) :-
    setup_call_cleanup(
        open_string(Result, In),
        ( repeat, read(In, measure(drawn, Drawn)) ),
        close(In)),
    !.

kept(Dir, Out, Start, Text) :-
    directory_file_path(Dir, Out, Below),
    directory_member(Below, File, [recursive(true), matches('events.pl')]),
    file_directory_name(File, Run),
    file_base_name(Run, Base),
    sub_atom(Base, 0, _, _, Start),
    !,
    text(Run, 'events.pl', Text).

runs_made(Dir, Count) :-
    directory_file_path(Dir, out, Out),
    aggregate_all(count, directory_member(Out, _, [ recursive(true),
                                                    matches('result.pl') ]),
                  Count).

what_was_measured(Dir, File) :-
    made(Dir, File, 1, 1, _, Result),
    forall(member(Part, [ "measure(steps,60)", "measure(hosts,5)",
                          "seed(1)", "parameter(hosts,5)", "events(" ]),
           assertion(once(sub_string(Result, _, _, _, Part)))).

run_that_fails(Dir, File) :-
    made(Dir, File, 1, 100, _, _).

computes(Result, Dir, File) :-
    study_load(File, Study),
    study_cases(Study, [], [Case]),
    run_make(Study, Case, 5, Dir),
    text(Dir, 'result.pl', Result),
    directory_file_path(Dir, 'events.pl', Events),
    assertion(\+ exists_file(Events)).

:- meta_predicate with_lines(+, -, -, 0).

with_lines(Lines, Dir, File, Goal) :-
    with_study_file(['study(other, "Other").'|Lines], Dir, File, Goal).

:- begin_tests(study_run).

test(same_seed_same_run) :-
    with_walkers(Dir, File,
        ( made(Dir, File, 1, 7, Log, Result),
          made(Dir, File, 2, 8, _, _),
          made(Dir, File, 1, 7, Again, ResultAgain),
          assertion(Log == Again),
          maplist(drawn, [Result, ResultAgain], [Drawn, DrawnAgain]),
          assertion(Drawn == DrawnAgain),
          made(Dir, File, 1, 8, Other, _),
          assertion(Log \== Other) )).

%   In workers, one of which makes all runs, and in a session by itself.

test(in_a_worker_and_elsewhere) :-
    with_walkers(Dir, File,
        ( made(Dir, File, 2, 2, Log, _),
          study_command(Dir, [ File, '--runs', 2, '--jobs', 1, '--logs',
                               '--out', all ], exit(0), _),
          kept(Dir, all, 'hosts=6,seed=2', InWorker),
          assertion(Log == InWorker),
          study_command(Dir, [ File, '--case', 2, '--seed', 2, '--logs',
                               '--out', one ], exit(0), _),
          kept(Dir, one, 'hosts=6,seed=2', ByItself),
          assertion(Log == ByItself) )).

%   There are two runs in virtual time and one in real time.

test(one_case_on_sockets, [nondet, Row == ["5", "5", "inside"]]) :-
    with_walkers(Dir, File,
        ( study_command(Dir, [File, '--runs', 2, '--out', out], exit(0), _),
          runs_made(Dir, Virtual),
          study_command(Dir, [ File, '--runs', 2, '--out', out, '--real',
                               '--real-runs', 1 ], exit(0),
                        Text),
          runs_made(Dir, All),
          assertion(All =:= Virtual+1),
          sub_string(Text, _, _, _, "on sockets  verdict"),
          split_string(Text, "\n", "", Lines),
          member(Line, Lines),
          split_string(Line, " ", " ", Words0),
          subtract(Words0, [""], Words),
          Words = ["hosts"|Row],
          last(Row, "inside") )).
test(watched_in_real_time, nondet) :-
    with_walkers(Dir, File,
        ( study_command(Dir, [ File, '--runs', 1, '--set', 'hosts=5',
                               '--set', 'clock=50' ], exit(0), Text) )),
    sub_string(Text, _, _, _, "/60 events").
test(measured_values) :-
    with_walkers(Dir, File, what_was_measured(Dir, File)).
test(no_resources_are_left) :-
    no_leaks(with_walkers(Dir, File, what_was_measured(Dir, File))).
test(run_fails, error(study_goal_failed(run/2))) :-
    with_walkers(Dir, File, run_that_fails(Dir, File)).
test(network_stops_when_the_run_fails) :-
    no_leaks(catch(with_walkers(Dir, File, run_that_fails(Dir, File)),
                   error(_, _), true)).

test(lost_process, error(study_processes_ended([_]))) :-
    no_leaks(with_lines([ 'fixed(clock, 50, assumed("so")).',
                          'fixed(processes, 2, assumed("so")).',
                          'network(_, ring(4), []).',
                          'run(_, Network) :-',
                          '    typhon:network_property(Network, processes(Pids)),',
                          '    last(Pids, Pid),',
                          '    process_kill(Pid, kill),',
                          '    repeat,',
                          '    typhon:network_property(Network, processes(Left)),',
                          '    Left \\== Pids, !.',
                          'measure(m, _, 1).' ],
                        Dir, File, computes(_, Dir, File))).

test(computes, nondet) :-
    with_lines([ 'measure(m, Log, M) :- M is 2*Log.case.seed.',
                 'measure(n, Log, M) :- M = Log.case.directory, fail.',
                 'measure(l, _, [a, "b", 1.5]).' ], Dir, File,
               computes(Result, Dir, File)),
    sub_string(Result, _, _, _, "measure(m,10)"),
    sub_string(Result, _, _, _, "measure(l,[a,\"b\",1.5])"),
    \+ sub_string(Result, _, _, _, "measure(n").
test(view, nondet) :-
    with_lines([ 'view(Log, V) :- V is Log.case.seed + 1.',
                 'measure(m, View, View).' ], Dir, File, computes(Result, Dir,
                                                                  File)),
    sub_string(Result, _, _, _, "measure(m,6)").
test(view_fails, error(study_goal_failed(view/2))) :-
    with_lines([ 'view(_, _) :- fail.', 'measure(m, View, View).' ],
               Dir, File, computes(_, Dir, File)).
test(same_value_twice, nondet) :-
    with_lines([ 'measure(m, _, X) :- member(X, [1, 1]).' ],
               Dir, File, computes(Result, Dir, File)),
    sub_string(Result, _, _, _, "measure(m,1)").
test(two_values, error(study_measures(m, [1, 2]))) :-
    with_lines([ 'measure(m, _, X) :- member(X, [1, 2]).' ], Dir, File,
               computes(_, Dir, File)).
test(seed_of_the_run_is_that_of_its_network, nondet) :-
    with_lines([ 'network(_, ring(3), []).',
                 'run(Case, Network) :-',
                 '    typhon:network_property(Network, seed(Seed)),',
                 '    Seed =:= Case.seed.',
                 'measure(m, Log, N) :- length(Log.hosts, N).' ], Dir, File,
         ( study_load(File, Study),
           study_cases(Study, [], [Case]),
           run_make(Study, Case, 5, Dir),
           text(Dir, 'result.pl', Result) )),
    sub_string(Result, _, _, _, "measure(m,3)").
test(network_without_run, nondet) :-
    with_lines([ 'network(_, ring(3), []).',
                 'measure(m, Log, N) :- length(Log.hosts, N).' ], Dir, File,
        ( study_load(File, Study),
          study_cases(Study, [], [Case]),
          run_make(Study, Case, 5, Dir),
          text(Dir, 'result.pl', Result) )),
    sub_string(Result, _, _, _, "measure(m,3)").

:- end_tests(study_run).

