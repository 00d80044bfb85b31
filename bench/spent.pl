:- module(bench_spent,
          [ spent/4                     % +Hosts, :Goal, -Hops, -Cpu
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../prolog/typhon', [host_property/2, remote/2]).

/** <module> The cost of hops

*Threading*: any thread; no state.
*/

:- meta_predicate spent(+, 0, -, -).

%!  spent(+Hosts, :Goal, -Hops, -Cpu) is det.
%
%   Calls Goal.  Hops is the number of hops that ended at Hosts meanwhile, Cpu
%   the processor time of all processes, in microseconds for each hop.

spent(Hosts, Goal, Hops, Cpu) :-
    arrived(Hosts, Hops0),
    processor_time(Hosts, Cpu0),
    call(Goal),
    processor_time(Hosts, Cpu1),
    arrived(Hosts, Hops1),
    Hops is Hops1 - Hops0,
    Cpu is (Cpu1 - Cpu0) / Hops * 1.0e6.

arrived(Hosts, Count) :-
    aggregate_all(sum(N),
                  ( member(Host, Hosts),
                    host_property(Host, hop_time(in, stats(N, _, _, _))) ),
                  Count).

%   Asks one host of each other process, and adds the time of this process.

processor_time(Hosts, Seconds) :-
    statistics(process_cputime, Own),
    findall(Endpoint-Host,
            ( member(Host, Hosts),
              atomic_list_concat([_, Endpoint], @, Host) ),
            Pairs0),
    sort(1, @<, Pairs0, Pairs),
    (   Pairs = [_]                     % the hosts are in this process
    ->  Seconds = Own
    ;   aggregate_all(sum(S),
                      ( member(_-Host, Pairs),
                        remote(Host, statistics(process_cputime, S)) ),
                      There),
        Seconds is Own + There
    ).
