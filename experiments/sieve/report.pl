:- module(sieve_report,
          [ print_parameters/2,         % +Stream, +Options
            figure_table/3,             % +CaseRuns, -Header, -Rows
            load_rounds/2               % +Directory, -Rounds
          ]).
:- use_module(claims, [kind_name/2]).
:- use_module('../lib/report', [print_options/3, print_settings/3]).
:- use_module(rounds, [population/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth1/3]).
:- use_module(library(readutil), [read_file_to_terms/3]).

:- dynamic setting/2.
:- include('../../agents/sieve/parameters').

/** <module> The numbers behind the figures of the sieve

*Threading*: no state; any thread.
*/

%!  print_parameters(+Stream, +Options) is det.
%
%   A table of Options, and of what agents have by default where
%   settings(Pairs) says nothing else.

print_parameters(Stream, Options) :-
    memberchk(settings(Settings), Options),
    print_options(Stream, Options, []),
    nl(Stream),
    findall(Name-Value, ( default(Name, Value), Name \== seed ), Defaults),
    print_settings(Stream, Defaults, Settings).

%!  figure_table(+CaseRuns, -Header, -Rows) is det.
%
%   For each case, run, round and kind: the population at the end of the
%   round, how many were generated in it by cloning and by hosts, and how
%   many died of suppression and of age.  CaseRuns are Case-Runs, Runs pairs
%   Seed-Rounds.

figure_table(CaseRuns,
             [case, seed, round, antibody, population, cloned, generated,
              suppressed, aged], Rows) :-
    findall([Case, Seed, Round, Name|Counts],
            ( member(Case-Runs, CaseRuns),
              member(Seed-Rounds, Runs),
              nth1(Round, Rounds, round(Events)),
              population(Rounds, Round, Population),
              kind(Population, Events, Kind),
              kind_name(Kind, Name),
              counts(Kind, Population, Events, Counts)
            ),
            Rows).

kind(Population, Events, Kind) :-
    findall(K, ( member(_-K, Population)
               ; member(born(_, K), Events)
               ; member(died(_, K), Events) ),
            Kinds0),
    sort(Kinds0, Kinds),
    member(Kind, Kinds).

counts(Kind, Population, Events,
       [Count, Cloned, Generated, Suppressed, Aged]) :-
    (   member(Count0-Kind, Population)
    ->  Count = Count0
    ;   Count = 0
    ),
    count(Events, born(clone, Kind), Cloned),
    count(Events, born(host, Kind), Generated),
    count(Events, died(suppressed, Kind), Suppressed),
    count(Events, died(aged, Kind), Aged).

count(Events, Event, Count) :-
    aggregate_all(count, member(Event, Events), Count).

%!  load_rounds(+Directory, -Rounds) is semidet.
%
%   What a run has left there; fails if it did not come so far.

load_rounds(Directory, Rounds) :-
    directory_file_path(Directory, 'rounds.pl', File),
    exists_file(File),
    read_file_to_terms(File, [rounds(Rounds)], [encoding(utf8)]).
