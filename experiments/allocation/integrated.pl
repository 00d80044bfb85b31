:- module(allocation_integrated,
          [ integrated_run/3,           % +Options, +Directory, -Result
            integrated_measures/4,      % +Events, +Names, +Tasks, -Measures
            integrated_claims/2         % +Runs, -Claims
          ]).
:- use_module('../../agents/allocation/sequence', [sequence_allocate/7]).
:- use_module('../sync/metrics',
              [executions/2, out_of_order/2, overlaps/2]).
:- use_module(metrics, [communications/2, from_first/2]).
:- use_module(network, [await_end/5, on_network/5]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/4]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [last/2, member/2, memberchk/2, numlist/3, subtract/3]).
:- use_module(library(option), [option/2]).

/** <module> Allocation, then synchronised execution, on the same robots

For each of several sequences of tasks an allocator finds and holds robots
(chapter 7), and agents whose number regulates itself have them execute the
sequence in step (chapter 6).  All sequences want the same kind of robots,
of which there are not enough for two at once.

*Threading*: as on_network/5; a thread for each sequence.
*/

%!  integrated_run(+Options, +Directory, -Result) is det.
%
%   Options, all required, are those of on_network/5, limit(HostSeconds) and
%   tasks(M), task_time(Seconds): the length of each sequence.  Result is a
%   list: the measures of integrated_measures/4 and
%
%     - ended(Bool): whether all sequences were completed before the limit
%     - load(Wall, Cpu, Hops, Hop): see on_network/5
%
%   @error reservation_faults(Faults)

integrated_run(Options, Directory, [ended(Ended), Load|Measures]) :-
    directory_file_path(Directory, 'events.pl', Log),
    option(allocators(Count), Options),
    findall(Name, ( between(1, Count, I), atom_concat(sequence, I, Name) ),
            Names),
    on_network(Options, Directory, perform(Names, Options, Log), Events,
               Load),
    option(tasks(Tasks), Options),
    integrated_measures(Events, Names, Tasks, Measures),
    memberchk(sequences(Sequences), Measures),
    (   length(Sequences, Count)
    ->  Ended = true
    ;   Ended = false
    ).

perform(Names, Options, Log, _, ground(_, _, Starts), Ended) :-
    setup_call_cleanup(
        maplist(begin(Options), Names, Starts, Threads),
        await_end(Log, Names, Options, sequences, Ended),
        maplist(end, Threads)).

begin(Options, Name, Host, Thread) :-
    option(tasks(Count), Options),
    option(task_time(Seconds), Options),
    option(required(Required), Options),
    option(limit(Limit), Options),
    option(seed(Seed), Options),
    numlist(1, Count, Numbers),
    findall(Task-sleep(Seconds), member(Task, Numbers), Tasks),
    thread_create(
        sequence_allocate(Name, [Required-[push]], Host, Tasks,
                          [ deadline(Limit),
                            allocation([settings([seed-Seed])]),
                            population([seed(Seed)]) ],
                          _, _),
        Thread).

%   The network is about to be stopped: whoever still waits is to leave.

end(Thread) :-
    catch(thread_signal(Thread, throw(over)), error(_, _), true),
    thread_join(Thread, _).

                /*******************************
                *           MEASURES           *
                *******************************/

%!  integrated_measures(+Events, +Names:list(atom), +Tasks:integer,
%!                      -Measures:list) is det.
%
%   Measures are tasks(Tasks), the length of each sequence, and
%
%     - sequences(List): of those of Names that were completed,
%       sequence(Name, Robots, Times, Executions).  Robots are those that
%       were allocated, Times is times(Begun, Allocated, Completed) in host
%       seconds since the first has begun, Executions are those of
%       executions/2, at these times, too
%     - strangers(Hosts): that executed a task of a sequence, but were not
%       allocated to it
%     - communications(N): of the allocators
%
%   Events are in order of time.

integrated_measures(Events0, Names, Tasks,
                    [ tasks(Tasks), sequences(Sequences),
                      strangers(Strangers), communications(Sum) ]) :-
    from_first(Events0, Events),
    findall(Sequence,
            ( member(Name, Names), sequence(Events, Name, Sequence) ),
            Sequences),
    findall(Host,
            ( member(sequence(_, Robots, _, Executions), Sequences),
              findall(Where, member(execution(_, Where, _, _), Executions),
                      Hosts),
              subtract(Hosts, Robots, Others),
              member(Host, Others) ),
            Strangers0),
    sort(Strangers0, Strangers),
    communications(Events, Sum).

%   A robot that is replaced is allocated anew: the last time counts.

sequence(Events, Name,
         sequence(Name, Robots, times(Begun, Allocated, Completed),
                  Executions)) :-
    memberchk(event(Begun, _, _, begun(Name)), Events),
    memberchk(event(Completed, _, _, completed(Name)), Events),
    findall(Time-Hosts, member(event(Time, _, _, allocated(Name, Hosts)),
                               Events),
            All),
    last(All, Allocated-Robots),
    findall(event(Time, Host, Agent, What),
            ( member(event(Time, Host, Agent, What), Events),
              step(What, Name) ),
            Steps),
    executions(Steps, Executions).

step(executing(Name, _), Name).
step(completed(Name, _), Name).

                /*******************************
                *            CLAIMS            *
                *******************************/

%!  integrated_claims(+Runs, -Claims) is det.
%
%   What is to be expected of Runs, pairs Seed-Result.

integrated_claims(Runs, Claims) :-
    findall(claim(Text, Held, Found),
            ( expected(Text, Test), judged(Runs, Test, Held, Found) ),
            Claims).

expected('every sequence is completed before the limit', ended).
expected('each of the robots allocated to a sequence executes each task of \c
it once', complete).
expected('nobody else executes any', strangers).
expected('no task begins before all its robots have completed the one \c
before', overlaps).
expected('all tasks are executed in order', order).
expected('no robot executes for two sequences at once', apart).

judged(Runs, Test, Held, Found) :-
    length(Runs, Count),
    findall(Note, ( member(_-Result, Runs), bad(Test, Result, Note),
                    Note \== 0 ),
            Notes),
    length(Notes, Bad),
    Good is Count - Bad,
    (   Bad =:= 0,
        Count > 0
    ->  Held = true
    ;   Held = false
    ),
    found(Notes, Good, Count, Found).

found([], Good, Count, Found) :-
    !,
    format(atom(Found), '~d of ~d runs', [Good, Count]).
found(Notes, Good, Count, Found) :-
    atomic_list_concat(Notes, ', ', Text),
    format(atom(Found), '~d of ~d runs (exceptions: ~w)',
           [Good, Count, Text]).

%   bad(+Test, +Result, -Count): so many things are not as expected.

bad(ended, Result, Count) :-
    (   memberchk(ended(true), Result)
    ->  Count = 0
    ;   Count = 1
    ).
bad(complete, Result, Count) :-
    memberchk(sequences(Sequences), Result),
    memberchk(tasks(Tasks), Result),
    aggregate_all(count,
                  ( member(sequence(_, Robots, _, Executions), Sequences),
                    member(Robot, Robots),
                    between(1, Tasks, Task),
                    \+ once_executed(Executions, Task, Robot) ),
                  Count).
bad(strangers, Result, Count) :-
    memberchk(strangers(Hosts), Result),
    length(Hosts, Count).
bad(overlaps, Result, Count) :-
    findall(Overlap,
            ( sequence_executions(Result, Executions),
              overlaps(Executions, List), member(Overlap, List) ),
            Overlaps),
    length(Overlaps, Count).
bad(order, Result, Count) :-
    findall(X,
            ( sequence_executions(Result, Executions),
              out_of_order(Executions, List), member(X, List) ),
            Xs),
    length(Xs, Count).
bad(apart, Result, Count) :-
    memberchk(sequences(Sequences), Result),
    findall(span(Name, Host, Start, End),
            ( member(sequence(Name, _, _, Executions), Sequences),
              member(execution(_, Host, Start, End), Executions) ),
            Spans),
    aggregate_all(count,
                  ( member(span(Name1, Host, Start1, End1), Spans),
                    member(span(Name2, Host, Start2, End2), Spans),
                    Name1 @< Name2, Start1 < End2, Start2 < End1 ),
                  Count).

sequence_executions(Result, Executions) :-
    memberchk(sequences(Sequences), Result),
    member(sequence(_, _, _, Executions), Sequences).

once_executed(Executions, Task, Robot) :-
    aggregate_all(count, member(execution(Task, Robot, _, _), Executions),
                  1).
