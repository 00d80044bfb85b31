:- module(sieve_run,
          [ sieve_run/3                 % +Options, +Directory, -Rounds
          ]).
:- use_module('../../prolog/typhon',
              [ log_events/2, network_property/2, network_start/3,
                network_stop/1, remote/2
              ]).
:- use_module('../../prolog/typhon/base/chance', [chance_sample/5, chance_seed/2]).
:- use_module('../../agents/sieve/operator',
              [antigen_attack/2, sieve_start/3]).
:- use_module('../lib/progress', [progress/4, progress_done/1]).
:- use_module(rounds,
              [application/2, event_rounds/3, plan/2, plan_rounds/2]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3]).
:- use_module(library(option), [option/2]).

/** <module> Rounds of attacks on a network with an idiotypic sieve

*Threading*: one run at a time; it is the caller's thread that waits.  A
signal that raises an exception there ends the run, and the network is
stopped.
*/

%!  sieve_run(+Options, +Directory, -Rounds) is det.
%
%   Rounds is what happened, see sieve_rounds.  The event log is
%   Directory/events.pl.  All of these Options are required:
%
%     - topology(T), processes(P), hop_time(Min-Max), clock(Rate),
%       dynamic(Model), seed(S)
%       Of network_start/3; Model may be `none`.
%     - capacity(C)
%       Of each host: the population is never above C times the hosts.
%     - figure(Figure)
%       Whose plan it is, see plan/2.
%     - attacked(K)
%       Hosts that each antigen attacks in a round.
%     - round(Seconds)
%       Host seconds from round to round.
%     - settings(Pairs)
%       Of the sieve, see parameters.pl.

sieve_run(Options, Directory, Rounds) :-
    make_directory_path(Directory),
    directory_file_path(Directory, 'events.pl', Log),
    option(topology(Topology), Options),
    network_options(Options, Log, NetworkOptions),
    setup_call_cleanup(
        network_start(Topology, Network, NetworkOptions),
        perform(Network, Options, Starts),
        network_stop(Network)),
    log_events(Log, Events),
    event_rounds(Events, Starts, Rounds).

network_options(Options, Log,
                [ processes(Processes), seed(Seed), log(Log), clock(Rate),
                  hop_time(uniform(Min, Max)), hosts([capacity(Capacity)])
                | More
                ]) :-
    option(processes(Processes), Options),
    option(seed(Seed), Options),
    option(clock(Rate), Options),
    option(hop_time(Min-Max), Options),
    option(capacity(Capacity), Options),
    option(dynamic(Model), Options),
    (   Model == none
    ->  More = []
    ;   More = [dynamic(Model)]
    ).

perform(Network, Options, Starts) :-
    network_property(Network, hosts(Hosts)),
    option(seed(Seed), Options),
    option(settings(Settings), Options),
    option(figure(Figure), Options),
    application(Figure, Application),
    sieve_start(Hosts, Application, [settings([seed-Seed|Settings])]),
    plan(Figure, Plan),
    plan_rounds(Plan, Rounds),
    chance_seed(Seed, Chance),
    length(Rounds, Total),
    message_queue_create(Never),
    call_cleanup(attack(Rounds, at(Hosts, Options, Never, Total), Chance,
                        Starts),
                 ( message_queue_destroy(Never),
                   progress_done(user_error) )).

%   The queue is one that nobody sends to: a wait that can be interrupted.

attack([], _, _, []).
attack([Antigens|Rounds], At, Chance0, [Start|Starts]) :-
    At = at(Hosts, Options, Never, Total),
    length(Rounds, Left),
    Done is Total - Left,
    progress(user_error, Done, Total, rounds),
    Hosts = [First|_],
    remote(First, now(Start)),
    option(attacked(Count), Options),
    attack_each(Antigens, Count, Hosts, Chance0, Chance),
    await(First, Start, Options, Never),
    attack(Rounds, At, Chance, Starts).

%   Hosts that are attacked in one round are different ones, as long as
%   there are any.

attack_each(Antigens, Count, Hosts, Chance0, Chance) :-
    length(Antigens, Kinds),
    All is Kinds * Count,
    chance_sample(All, Hosts, Attacked, Chance0, Chance),
    attack_in_turn(Antigens, Count, Attacked).

attack_in_turn([], _, []).
attack_in_turn([Antigen|Antigens], Count, Attacked0) :-
    length(Hosts, Count),
    append(Hosts, Attacked, Attacked0),
    antigen_attack(Hosts, Antigen),
    attack_in_turn(Antigens, Count, Attacked).

await(Host, Start, Options, Never) :-
    option(round(Seconds), Options),
    option(clock(Rate), Options),
    remote(Host, now(Now)),
    Left is (Start + Seconds - Now)/Rate,
    (   Left > 0
    ->  \+ thread_get_message(Never, _, [timeout(Left)])
    ;   true
    ).
