:- module(allocation_run,
          [ allocation_run/3            % +Options, +Directory, -Result
          ]).
:- use_module('../lib/follow', [new_lines/4]).
:- use_module(ground, [options_case/2]).
:- use_module(mechanisms,
              [mechanism/2, mechanism_account/3, mechanism_allocate/4,
               mechanism_start/3]).
:- use_module(metrics, [allocation_measures/2, communications/2]).
:- use_module(network, [await_end/5, on_network/5]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(option), [option/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> Several allocators that want the same robots

One run of a mechanism: all allocators begin at once; it ends when all tasks
are completed and all robots free, or at a limit.

*Threading*: as on_network/5.
*/

%!  allocation_run(+Options, +Directory, -Result) is det.
%
%   Options, all required, are those of on_network/5, and
%
%     - duration(Seconds)
%       that a robot takes to execute its task
%     - bi_min(Seconds), bi_max(Seconds)
%       of the equations 7.5 and 7.7
%     - slack(Seconds)
%       that auctioneers wait beyond the way there and back
%     - limit(HostSeconds)
%
%   Result is a list: the measures of allocation_measures/2, and
%
%     - ended(Bool): whether all was over before the limit
%     - load(Wall, Cpu, Hops, Hop): see on_network/5
%
%   @error reservation_faults(Faults)

allocation_run(Options, Directory, [ended(Ended), Load|Measures]) :-
    directory_file_path(Directory, 'events.pl', Log),
    on_network(Options, Directory, perform(Options, Log), Events, Load),
    ended(Events, Options, Ended),
    allocation_measures(Events, Measures).

ended(Events, Options, Ended) :-
    option(allocators(Count), Options),
    findall(Task, member(event(_, _, _, completed(Task)), Events), Tasks),
    (   length(Tasks, Count)
    ->  Ended = true
    ;   Ended = false
    ).

perform(Options, Log, Hosts, ground(_, _, Starts), Ended) :-
    options_case(Options, case(Mechanism, _, _, _, Required, Allocators)),
    mechanism_start(Mechanism, Hosts, Options),
    numlist(1, Allocators, Names),
    option(duration(Seconds), Options),
    findall(task(Name, [Required-[push]], [duration(Seconds)]),
            member(Name, Names), Tasks),
    pairs_keys_values(Pairs, Tasks, Starts),
    mechanism_allocate(Mechanism, Pairs, Options, _),
    mechanism(Mechanism, Title),
    await_end(Log, Names, Options, Title, Ended),
    mechanism_account(Mechanism, Hosts, Total),
    await_account(Log, Total, 200).

%   The log has what nodes have sent.

await_account(Log, Total, Tries) :-
    new_lines(Log, 0, _, Lines),
    findall(Event,
            ( member(Line, Lines),
              sub_string(Line, _, _, _, "communications"),
              term_string(Event, Line) ),
            Events),
    communications(Events, Sum),
    (   Sum >= Total
    ->  true
    ;   Tries > 0,
        sleep(0.1),
        Tries1 is Tries - 1,
        await_account(Log, Total, Tries1)
    ).
