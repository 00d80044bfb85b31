/*  The allocation of tasks to robots: Figures 7.1 to 7.5 of the thesis, and
    what goes beyond it.

        swipl experiments/allocation.pl -- --figure 7.1 --runs 3

    `--help` lists the parameters.
*/

:- module(allocation, []).
:- use_module(allocation/batch, [case_runs/3, make_runs/3]).
:- use_module(allocation/beyond,
              [beyond/2, beyond_cases/3, show_beyond/5]).
:- use_module(allocation/cases, [figure/3, figure_cases/4]).
:- use_module(allocation/claims, [allocation_claims/4]).
:- use_module(allocation/integrated, [integrated_run/3]).
:- use_module(allocation/report,
              [ print_cases/3, print_parameters/2, save_figure/5,
                save_result/2
              ]).
:- use_module(allocation/run, [allocation_run/3]).
:- use_module(allocation/urgent, [urgent_run/3]).
:- use_module(lib/command, [acceptable/3, command/5, range/1]).
:- use_module(lib/report,
              [claims_sentence/2, print_claims/2, save_facts/2]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(main), [argv_options/3, main/0]).
:- use_module(library(option), [option/2]).

:- initialization(main, main).

:- public main/1.

opt_type(figure,     figure,     atom).
opt_type(runs,       runs,       natural).
opt_type(seed,       seed,       integer).
opt_type(jobs,       jobs,       natural).
opt_type(clock,      clock,      number).
opt_type(hop_time,   hop_time,   term).
opt_type(hosts,      hosts,      natural).
opt_type(degree,     degree,     number).
opt_type(dynamic,    dynamic,    term).
opt_type(processes,  processes,  natural).
opt_type(eligible,   eligible,   natural).
opt_type(required,   required,   natural).
opt_type(allocators, allocators, natural).
opt_type(duration,   duration,   number).
opt_type(bi_min,     bi_min,     number).
opt_type(bi_max,     bi_max,     number).
opt_type(slack,      slack,      number).
opt_type(limit,      limit,      number).
opt_type(tasks,      tasks,      natural).
opt_type(task_time,  task_time,  number).
opt_type(late,       late,       number).
opt_type(priority,   priority,   number).
opt_type(deadline,   deadline,   number).
opt_type(mechanism,  mechanism,  atom).
opt_type(links,      links,      atom).
opt_type(single,     single,     boolean).
opt_type(out,        out,        atom).

opt_help(help(header), "Tasks that want the same robots, allocated by mobile \c
agents, by Murdoch and\nby ANTA (thesis chapter 7)\n").
opt_help(help(usage), " -- [options]").
opt_help(figure,     "7.1, 7.2, 7.3, 7.4, 7.5, integrated, urgent or all \c
[all]").
opt_help(runs,       "Runs of each case, with consecutive seeds [3]").
opt_help(seed,       "The first seed [1]").
opt_help(jobs,       "Runs at the same time [2]").
opt_help(clock,      "Host seconds in a real second [4]").
opt_help(hop_time,   "MIN-MAX host seconds that a hop takes [0.05-0.15]").
opt_help(hosts,      "Hosts; Figure 7.5: from half to twice as many [100]").
opt_help(degree,     "Links of a host, on average [6]").
opt_help(dynamic,    "How links come and go [links(uniform(10,20),0.5,0.5)]").
opt_help(processes,  "Processes that the hosts of one network live in [2]").
opt_help(eligible,   "Robots that can do the tasks [15]").
opt_help(required,   "Robots that each task needs; Figure 7.4: of one to \c
five times as many that are eligible [10]").
opt_help(allocators, "Most tasks at the same time [5]").
opt_help(duration,   "Host seconds that a robot takes for its part [5]").
opt_help(bi_min,     "Seconds, of equation 7.7 [10]").
opt_help(bi_max,     "Seconds, of equation 7.5 [500]").
opt_help(slack,      "Host seconds that auctioneers wait beyond the way \c
there and back [4]").
opt_help(limit,      "Host seconds after which a run is ended [5000]").
opt_help(tasks,      "Length of each sequence, for integrated [3]").
opt_help(task_time,  "Host seconds of each of its tasks [5]").
opt_help(late,       "Host seconds until the last task comes, for urgent [3]").
opt_help(priority,   "Of it, in a single run [0]").
opt_help(deadline,   "Of all tasks, in a single run; 0 is none [0]").
opt_help(mechanism,  "Of a single run: proposed, constant, murdoch, anta \c
[proposed]").
opt_help(links,      "Of a single run: dynamic or static [dynamic]").
opt_help(single,     "Make one run in this process, without pictures [false]").
opt_help(out,        "Directory for tables, pictures and runs \c
[out/allocation]").

opt_meta(figure,    'FIGURE').
opt_meta(hop_time,  'MIN-MAX').
opt_meta(dynamic,   'MODEL').
opt_meta(mechanism, 'NAME').
opt_meta(links,     'HOW').
opt_meta(out,       'DIRECTORY').

defaults([ figure(all), runs(3), seed(1), jobs(2), clock(4),
           hop_time(0.05-0.15), hosts(100), degree(6),
           dynamic(links(uniform(10,20),0.5,0.5)), processes(2),
           eligible(15), required(10), allocators(5), duration(5),
           bi_min(10), bi_max(500), slack(4), limit(5000),
           tasks(3), task_time(5), late(3), priority(0), deadline(0),
           mechanism(proposed), links(dynamic), single(false),
           out('out/allocation')
         ]).

main(Argv) :-
    argv_options(Argv, Positional, Given),
    defaults(Defaults),
    command(Positional, Given, Defaults, check, run).

check(Options) :-
    option(figure(Figure), Options),
    acceptable(( Figure == all ; known(Figure) ), figure, Figure),
    forall(( member(Name, [clock, limit]), value(Name, Options, Value) ),
           acceptable(Value > 0, Name, Value)),
    forall(choice(Name, Choices),
           ( value(Name, Options, Value),
             acceptable(memberchk(Value, Choices), Name, Value) )),
    option(hop_time(HopTime), Options),
    acceptable(range(HopTime), hop_time, HopTime),
    option(hosts(Hosts), Options),
    option(eligible(Eligible), Options),
    acceptable(Eligible =< Hosts, eligible, Eligible),
    option(required(Required), Options),
    acceptable(Required =< Eligible, required, Required),
    option(allocators(Allocators), Options),
    acceptable(Allocators =< Hosts, allocators, Allocators).

choice(mechanism, [proposed, constant, murdoch, anta]).
choice(links, [dynamic, static]).

value(Name, Options, Value) :-
    Option =.. [Name, Value],
    option(Option, Options).

run(Options) :-
    option(single(true), Options),
    !,
    option(out(Out), Options),
    make_directory_path(Out),
    option(figure(Figure), Options),
    single(Figure, Options, Out, Result),
    save_result(Out, Result).
run(Options) :-
    print_parameters(user_output, Options),
    option(figure(Wanted), Options),
    findall(Figure, ( known(Figure), wanted(Wanted, Figure) ), Figures),
    findall(Case,
            ( member(Figure, Figures), needs(Figure, Options, Case) ),
            Cases),
    make_runs(Cases, Options, Outcomes),
    forall(member(Figure, Figures), make_figure(Figure, Options)),
    (   member(failed(_), Outcomes)
    ->  halt(1)
    ;   true
    ).

single(integrated, Options, Out, Result) :-
    !,
    integrated_run(Options, Out, Result).
single(urgent, Options, Out, Result) :-
    !,
    urgent_run(Options, Out, Result).
single(_, Options, Out, Result) :-
    allocation_run(Options, Out, Result).

known(Figure) :-
    figure(Figure, _, _).
known(Figure) :-
    beyond(Figure, _).

wanted(all, _) :-
    !.
wanted(Figure, Figure).

needs(Figure, Options, Case) :-
    figure(Figure, _, _),
    figure_cases(Figure, Options, Shown, Others),
    ( member(_-Case, Shown) ; member(Case, Others) ).
needs(Figure, Options, Case) :-
    beyond(Figure, _),
    beyond_cases(Figure, Options, Cases),
    member(_-Case, Cases).

                /*******************************
                *            FIGURES           *
                *******************************/

%   Runs that failed were told, and are left out.

make_figure(Figure, Options) :-
    beyond(Figure, Title),
    !,
    beyond_cases(Figure, Options, Cases),
    findall(Key-Runs,
            ( member(Key-Case, Cases), case_runs(Options, Case, Runs) ),
            Data),
    format('~nFigure ~w: ~w~n', [Figure, Title]),
    option(out(Out), Options),
    subtitle(Options, Subtitle),
    show_beyond(Figure, Out, Subtitle, Data, Claims),
    tell_claims(Figure, Options, Data, Claims).
make_figure(Figure, Options) :-
    figure_cases(Figure, Options, Cases, _),
    findall(Case, needs(Figure, Options, Case), All0),
    sort(All0, All),
    findall(Case-Runs,
            ( member(Case, All), case_runs(Options, Case, Runs) ),
            Data),
    option(out(Out), Options),
    subtitle(Options, Subtitle),
    save_figure(Out, Figure, Subtitle, Cases, Data),
    figure(Figure, Title, _),
    format('~nFigure ~w: ~w~n', [Figure, Title]),
    print_cases(user_output, Cases, Data),
    allocation_claims(Figure, Cases, Data, Claims),
    tell_claims(Figure, Options, Data, Claims).

tell_claims(Figure, Options, Data, Claims0) :-
    option(runs(Runs), Options),
    made_claim(Runs, Data, Made),
    Claims = [Made|Claims0],
    print_claims(user_output, Claims),
    claims_sentence(Claims, Sentence),
    option(out(Out), Options),
    format('~w~nTables and pictures: ~w/allocation-~w*~n',
           [Sentence, Out, Figure]),
    atomic_list_concat(['allocation-', Figure, '-claims.pl'], Name),
    directory_file_path(Out, Name, File),
    save_facts(File, Claims).

%   A run in which a robot is reserved twice, or left reserved, fails.

made_claim(Wanted, Data,
           claim('no robot is reserved twice, or left reserved', Held,
                 Found)) :-
    length(Data, Cases),
    Expected is Cases*Wanted,
    findall(Result, ( member(_-Runs, Data), member(_-Result, Runs) ),
            Results),
    length(Results, Count),
    (   Count =:= Expected
    ->  Held = true
    ;   Held = false
    ),
    format(atom(Found), 'so the logs of ~d of ~d runs', [Count, Expected]).

subtitle(Options, Subtitle) :-
    option(runs(Runs), Options),
    option(clock(Rate), Options),
    option(hop_time(Min-Max), Options),
    option(duration(Seconds), Options),
    option(bi_min(BIMin), Options),
    option(bi_max(BIMax), Options),
    format(atom(Subtitle), 'hop ~w to ~w s, host clock ×~w, execution ~w s, \c
BI_{min} ~w s, BI_{max} ~w s, ~w runs',
           [Min, Max, Rate, Seconds, BIMin, BIMax, Runs]).
