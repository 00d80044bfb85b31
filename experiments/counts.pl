/*  Hops of agents, messages between agents, and memory of agents and hosts, in
    runs of studies.

        swipl experiments/counts.pl -- 5.5 --set topology=grid --runs 3

    Logs of studies have neither hops nor messages, because of their number, so
    the runs are repeated. Memory is sampled each `every` host seconds; the
    greatest values are printed.  `--help` lists the options.
*/

:- module(counts, []).
:- use_module('../prolog/typhon/kernel/base/names', [counted/3]).
:- use_module('../app/typhon/arguments', [arguments/3]).
:- use_module('../prolog/typhon', [log_events/2]).
:- use_module(engine/cases, [case_name/3]).
:- use_module(engine/catalogue, [studies_named/2]).
:- use_module(engine/plan, [plans/3, planned/4]).
:- use_module(engine/program, [run_option/4, run_program/1]).
:- use_module(engine/memory, [memory_peaks/1, memory_watch/2]).
:- use_module(engine/run, [run_again/5]).
:- use_module(engine/studies, [study_load/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/2, option/3]).

:- initialization(main, main).

:- public main/1.

opt_type(Name, Name, Type) :-
    own(Name),
    run_option(Name, Type, _, _).
opt_type(every, every, number).

opt_help(help(header),
"Counts hops and messages of runs of studies, and the memory of agents and hosts\n").
opt_help(help(usage), " -- STUDY ... [options]").
opt_help(Name, Help) :-
    run_option(Name, _, _, Help).
opt_help(every, "Host seconds from one sample of the memory to the next [2]").

opt_meta(Name, Meta) :-
    run_option(Name, _, Meta, _).

own(Name) :-
    member(Name, [runs, seed, set, list]).

main(Argv) :-
    run_program(( arguments(Argv, Names, Options),
                  command(Names, Options) )).

command(Names, Options) :-
    studies_named(Names, Files),
    maplist(study_load, Files, Studies),
    plans(Studies, Options, Plans),
    forall(planned(Plans, Options, _, Run), counted(Run, Options)).

counted(run(Study, Case, Seed), Options) :-
    option(list(true), Options),
    !,
    case_name(Study, Case, Name),
    format('~w, seed ~w~n', [Name, Seed]).
counted(run(Study, Case, Seed), Options) :-
    option(every(Every), Options, 2),
    tmp_file_stream(Log, Stream, [encoding(utf8)]),
    close(Stream),
    run_again(Study, Case, Seed, Log, memory_watch(Every)),
    log_events(Log, Events),
    delete_file(Log),
    event_count(Events, left(_), Hops),
    event_count(Events, sent(_), Messages),
    aggregate_all(max(T), member(event(T, _, _, _), Events), End),
    case_name(Study, Case, Name),
    counted(Hops, hop, Moved),
    counted(Messages, message, Sent),
    format('~w, seed ~w: ~w, ~w, ~1f s~n', [Name, Seed, Moved, Sent, End]),
    memory_peaks(Peaks),
    forall(member(What-Peak, Peaks), format('  ~w ~D', [What, Peak])),
    nl.

event_count(Events, What, Count) :-
    aggregate_all(count, member(event(_, _, _, What), Events), Count).
