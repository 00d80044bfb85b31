:- module(study_run,
          [ run_make/4,                 % +Study, +Case, +Seed, +Directory
            run_log/5,                  % +Study, +Case, +Seed, +File, -Log
            run_again/4,                % +Study, +Case, +Seed, +File
            run_again/5,                % +Study, +Case, +Seed, +File, :Begin
            case_begins/5,              % +Study, +Case0, +Seed, +File, -Case
            study_network/4,            % +Study, +Case, +Log, -Network
            study_run/3,                % +Study, +Case, +Network
            study_view/3                % +Study, +Log, -View
          ]).
:- use_module('../../prolog/typhon/kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../prolog/typhon',
              [log_events/2, network_property/2, network_start/3,
               network_stop/1]).
:- use_module(library(lists), [append/2, append/3, member/2, subtract/3]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(sources, [sources_hash/2]).
:- use_module(store, [log_file/2, result_save/2]).
:- use_module(studies, [study_at_work/1, study_call/2, study_says/2]).

/** <module> One run of a study

*Threading*: one run at a time in a process.  A signal that raises an
exception in the caller ends the run, and the network is stopped.
*/

:- meta_predicate run_again(+, +, +, +, 1).

:- multifile
    prolog:error_message//1.

%!  run_make(+Study, +Case, +Seed, +Directory) is det.
%
%   Makes the run of Case with Seed, and writes its measures and its log below
%   Directory, which must exist.
%
%   @error study_goal_failed(Name/Arity) if network/3, run/2 or view/2 fails
%   @error study_measures(Name, Values) if a measure has several values
%   @error study_processes_ended(Pids) if the network has lost processes

run_make(Study, Case, Seed, Directory) :-
    log_file(Directory, File),
    findall(Fact, environment(Fact), Environment),
    monotonic_time(T0),
    statistics(process_cputime, C0),
    run_log(Study, Case, Seed, File, Log),
    study_view(Study, Log, View),
    measures(Study, View, Measures),
    monotonic_time(T1),
    statistics(process_cputime, C1),
    Wall is T1 - T0,
    Cpu is C1 - C0,
    sources_hash(Study, Hash),
    findall(events(Count), ( get_dict(events, Log, Events),
                             length(Events, Count) ), Counted),
    dict_pairs(Case, _, Pairs),
    findall(parameter(Name, Value), member(Name-Value, Pairs), Parameters),
    append([ [seed(Seed)], Parameters, [sources(Hash)], Environment, Counted,
             [wall(Wall), cpu(Cpu)], Measures ], Facts),
    result_save(Directory, Facts).

%!  study_view(+Study, +Log, -View) is det.
%
%   View is what measure/3 of Study gets.

study_view(Study, Log, View) :-
    (   study_says(Study, view/2)
    ->  must(Study, view(Log, View))
    ;   View = Log
    ).

must(Study, Goal) :-
    (   study_call(Study, Goal)
    ->  true
    ;   functor(Goal, Name, Arity),
        throw(error(study_goal_failed(Name/Arity), _))
    ).

%   A measure/3 that fails has no value in this run.

measures(Study, View, Measures) :-
    findall(Name-Value, study_call(Study, measure(Name, View, Value)), Pairs0),
    sort(Pairs0, Pairs),
    (   append(_, [Name-A, Name-B|_], Pairs)
    ->  throw(error(study_measures(Name, [A, B]), _))
    ;   findall(measure(Name, Value), member(Name-Value, Pairs), Measures)
    ).

                /*******************************
                *          ENVIRONMENT         *
                *******************************/

environment(version(prolog, Version)) :-
    current_prolog_flag(version, Version).
environment(version(typhon, Version)) :-
    module_property(study_run, file(Here)),
    absolute_file_name('../../pack', Pack,
                       [ relative_to(Here), extensions([pl]), access(read),
                         file_errors(fail) ]),
    read_file_to_terms(Pack, Facts, []),
    member(version(Version), Facts).
environment(bits(Bits)) :-
    current_prolog_flag(address_bits, Bits).
environment(processors(Count)) :-
    current_prolog_flag(cpu_count, Count).
environment(load(Load)) :-
    exists_file('/proc/loadavg'),
    setup_call_cleanup(
        open('/proc/loadavg', read, In),
        read_string(In, " ", "", _, Text),
        close(In)),
    number_string(Load, Text).

                /*******************************
                *              LOG             *
                *******************************/

%!  run_log(+Study, +Case, +Seed, +File, -Log) is det.
%
%   Log is a dict with `case`, which also has the `seed` and the `directory`
%   of the run, and, for a study with a network, `hosts` and `events`, which
%   are also in File.

run_log(Study, Case0, Seed, File, Log) :-
    case_begins(Study, Case0, Seed, File, Case),
    (   study_says(Study, network/3)
    ->  network_run(Study, Case, log(File), =(_), Hosts),
        log_events(File, Events),
        Log = log{case:Case, hosts:Hosts, events:Events}
    ;   Log = log{case:Case}
    ).

%!  run_again(+Study, +Case, +Seed, +File) is semidet.
%
%!  run_again(+Study, +Case, +Seed, +File, :Begin) is semidet.
%
%   Repeats the run only for its log in File, which has all kinds of events.
%   Fails if the study has no network.  Calls call(Begin, Network) when the
%   network has started.

run_again(Study, Case, Seed, File) :-
    run_again(Study, Case, Seed, File, =(_)).

run_again(Study, Case0, Seed, File, Begin) :-
    study_says(Study, network/3),
    case_begins(Study, Case0, Seed, File, Case),
    network_run(Study, Case, log(File, [hops, messages, faults, links, hosts]),
                Begin, _).

%!  case_begins(+Study, +Case0, +Seed, +File, -Case) is det.
%
%   Case is Case0 with the seed, and the directory of the log File.

case_begins(Study, Case0, Seed, File, Case) :-
    file_directory_name(File, Directory),
    Case = Case0.put(_{seed:Seed, directory:Directory}),
    study_at_work(Study),
    set_random(seed(Seed)).

network_run(Study, Case, LogOption, Begin, Hosts) :-
    setup_call_cleanup(
        study_network(Study, Case, LogOption, Network),
        ( network_property(Network, hosts(Hosts)),
          network_property(Network, processes(Pids)),
          call(Begin, Network),
          study_run(Study, Case, Network),
          still_there(Pids, Network) ),
        network_stop(Network)).

%   The measures are invalid if the network has lost a process.

still_there(Pids, Network) :-
    network_property(Network, processes(Left)),
    subtract(Pids, Left, Gone),
    (   Gone == []
    ->  true
    ;   throw(error(study_processes_ended(Gone), _))
    ).

%!  study_network(+Study, +Case, +Log, -Network) is det.
%!  study_run(+Study, +Case, +Network) is det.
%
%   Start the network of Case, with the option Log; make the run on it.

study_network(Study, Case, Log, Network) :-
    must(Study, network(Case, Topology, Options0)),
    findall(Option, on_machines(Case, Option), Options1),
    append([ Options0, Options1,
             [ clock(Case.clock), processes(Case.processes), seed(Case.seed),
               Log ] ],
           Options),
    network_start(Topology, Network, Options).

on_machines(Case, Option) :-
    get_dict(on_machines, Case, at(Here, Machines)),
    member(Option, [bind(Here), machines(Machines)]).

study_run(Study, Case, Network) :-
    (   study_says(Study, run/2)
    ->  must(Study, run(Case, Network))
    ;   true
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:error_message(study_goal_failed(PI)) -->
    [ 'The study\'s own ~q failed'-[PI] ].
prolog:error_message(study_processes_ended(Pids)) -->
    [ 'The network has lost its processes ~p'-[Pids] ].
prolog:error_message(study_measures(Name, Values)) -->
    [ 'The measure ~q has several values: ~p'-[Name, Values] ].
