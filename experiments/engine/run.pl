:- module(study_run,
          [ run_make/4,                 % +Study, +Case, +Seed, +Directory
            run_log/5                   % +Study, +Case, +Seed, +File, -Log
          ]).
:- use_module('../../prolog/typhon',
              [log_events/2, network_property/2, network_start/3,
               network_stop/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(studies, [has_network/1, study_call/2]).
:- use_module(store, [result_save/2]).


/** <module> One run of a study

*Threading*: one run at a time in a process.  A signal that raises an
exception in the caller ends the run, and the network is stopped.
*/

:- multifile
    prolog:error_message//1.

%!  run_make(+Study, +Case, +Seed, +Directory) is det.
%
%   Make the run of Case with Seed, and write what was measured and its log
%   below Directory, which must be there.
%
%   @error study_goal_failed(Goal) if run/2 or view/2 fails

run_make(Study, Case, Seed, Directory) :-
    directory_file_path(Directory, 'events.pl', File),
    get_time(T0),
    statistics(process_cputime, C0),
    run_log(Study, Case, Seed, File, Log),
    view(Study, Log, View),
    findall(measure(Name, Value),
            study_call(Study, measure(Name, View, Value)), Measures),
    get_time(T1),
    statistics(process_cputime, C1),
    Wall is T1 - T0,
    Cpu is C1 - C0,
    dict_pairs(Case, _, Pairs),
    findall(parameter(Name, Value), member(Name-Value, Pairs), Parameters),
    findall(Fact, environment(Fact), Environment),
    append(Environment, [wall(Wall), cpu(Cpu)|Measures], Facts0),
    append([seed(Seed)|Parameters], Facts0, Facts),
    result_save(Directory, Facts).

view(Study, Log, View) :-
    (   predicate_property(Study:view(_, _), number_of_clauses(N)),
        N > 0
    ->  must(Study, view(Log, View))
    ;   View = Log
    ).

must(Study, Goal) :-
    (   study_call(Study, Goal)
    ->  true
    ;   functor(Goal, Name, Arity),
        throw(error(study_goal_failed(Name/Arity), _))
    ).

environment(version(prolog, Version)) :-
    current_prolog_flag(version, Version).
environment(bits(Bits)) :-
    current_prolog_flag(address_bits, Bits).
environment(processors(Count)) :-
    current_prolog_flag(cpu_count, Count).
environment(load(Load)) :-
    catch(setup_call_cleanup(
              open('/proc/loadavg', read, In),
              read_string(In, " ", "", _, Text),
              close(In)),
          error(_, _),
          fail),
    number_string(Load, Text).

%!  run_log(+Study, +Case, +Seed, +File, -Log) is det.
%
%   Log is a dict with `case`, which also has the `seed`, and, of a study with
%   a network, `hosts` and `events`, which are in File too.

run_log(Study, Case0, Seed, File, Log) :-
    has_network(Study),
    !,
    Case = Case0.put(seed, Seed),
    must(Study, network(Case, Topology, Options0)),
    append(Options0,
           [ clock(Case.clock), processes(Case.processes), seed(Seed),
             log(File) ],
           Options),
    set_random(seed(Seed)),
    setup_call_cleanup(
        network_start(Topology, Network, Options),
        ( network_property(Network, hosts(Hosts)),
          must(Study, run(Case, Network)) ),
        network_stop(Network)),
    log_events(File, Events),
    Log = log{case:Case, hosts:Hosts, events:Events}.
run_log(_, Case0, Seed, _, log{case:Case}) :-
    Case = Case0.put(seed, Seed),
    set_random(seed(Seed)).

prolog:error_message(study_goal_failed(PI)) -->
    [ 'The study\'s own ~q failed'-[PI] ].
