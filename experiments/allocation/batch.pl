:- module(allocation_batch,
          [ make_runs/3,                % +Cases, +Options, -Outcomes
            case_runs/3                 % +Options, +Case, -Runs
          ]).
:- use_module('../lib/jobs', [job_directory/3, jobs_run/3]).
:- use_module(report, [load_result/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, numlist/3]).
:- use_module(library(option), [option/2]).

/** <module> The runs of cases, each in a process of its own

A case is case(Mechanism, Links, Hosts, Eligible, Required, Allocators), or
beyond(Figure, Given): a run of `integrated` or `urgent`, see beyond.pl, with
the options Given.

*Threading*: as jobs_run/3.
*/

%!  make_runs(+Cases, +Options, -Outcomes) is det.
%
%   Make what is not there yet of the runs of Cases; a case that is listed
%   twice is run once.  The first run of every case comes first.  Auctions,
%   which need the processor, and others are mixed.  Options are those of
%   the experiment, the seeds, out(Directory) and jobs(N) among them.
%   Outcomes are those of jobs_run/3.

make_runs(Cases0, Options, Outcomes) :-
    mixed(Cases0, Cases),
    seeds(Options, Seeds),
    findall(Job,
            ( member(Seed, Seeds), member(Case, Cases),
              job(Options, Seed, Case, Job) ),
            Jobs),
    root(Options, Root),
    option(jobs(N), Options),
    jobs_run(Jobs, [out(Root), jobs(N)], Outcomes).

mixed(Cases0, Cases) :-
    sort(Cases0, Distinct),
    findall(Hash-Case,
            ( member(Case, Distinct), term_hash(Case, Hash) ),
            Pairs),
    keysort(Pairs, Sorted),
    findall(Case, member(_-Case, Sorted), Cases).

%!  case_runs(+Options, +Case, -Runs:list(pair)) is det.
%
%   Runs are Seed-Result, of the runs of Case that there are.

case_runs(Options, Case, Runs) :-
    seeds(Options, Seeds),
    root(Options, Root),
    findall(Seed-Result,
            ( member(Seed, Seeds),
              job(Options, Seed, Case, Job),
              job_directory(Job, Root, Directory),
              load_result(Directory, Result) ),
            Runs).

root(Options, Root) :-
    option(out(Out), Options),
    directory_file_path(Out, runs, Root).

seeds(Options, Seeds) :-
    option(seed(First), Options),
    option(runs(Runs), Options),
    Last is First + Runs - 1,
    numlist(First, Last, Seeds).

job(Options, Seed, Case, job(Name, Script, Arguments)) :-
    script(Script),
    case_options(Case, Name0, Given),
    findall(Option,
            ( inherited(Case, Options, Option),
              functor(Option, Key, 1),
              functor(Other, Key, 1),
              \+ memberchk(Other, Given) ),
            Inherited),
    append([seed(Seed), single(true)|Given], Inherited, All),
    maplist(argument, All, Arguments),
    atomic_list_concat([Name0, seed, Seed], -, Name).

script(Script) :-
    module_property(allocation_batch, file(File)),
    file_directory_name(File, Directory),
    atom_concat(Directory, '.pl', Script).

case_options(case(Mechanism, Links, Hosts, Eligible, Required, Allocators),
             Name,
             [ mechanism(Mechanism), links(Links), hosts(Hosts),
               eligible(Eligible), required(Required),
               allocators(Allocators) ]) :-
    atomic_list_concat([ Mechanism, Links, Hosts, Eligible, Required,
                         Allocators ], -, Name).
case_options(beyond(Figure, Given), Name, [figure(Figure)|Given]) :-
    findall(Part, ( member(Option, Given), Option =.. Parts,
                    member(Part, Parts) ),
            Parts),
    atomic_list_concat([Figure|Parts], -, Name).

inherited(Case, Options, Option) :-
    inherited(Case, Names),
    member(Name, Names),
    Option =.. [Name, _],
    option(Option, Options).

inherited(case(_, _, _, _, _, _), Names) :-
    common(Names).
inherited(beyond(_, _), Names) :-
    common(Names0),
    append([ hosts, eligible, required, allocators, tasks, task_time, late,
             priority, deadline ],
           Names0, Names).

common([ clock, hop_time, degree, dynamic, processes, duration, bi_min,
         bi_max, slack, limit ]).

argument(Option, Argument) :-
    Option =.. [Name, Value],
    (   atom(Value)
    ->  format(atom(Argument), '--~w=~w', [Name, Value])
    ;   format(atom(Argument), '--~w=~q', [Name, Value])
    ).
