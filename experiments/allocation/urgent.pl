:- module(allocation_urgent,
          [ urgent_run/3,               % +Options, +Directory, -Result
            urgent_measures/3,          % +Events, +Last, -Measures
            urgent_claims/2             % +Data, -Claims
          ]).
:- use_module('../lib/chart', [median/2]).
:- use_module(mechanisms, [mechanism_allocate/4]).
:- use_module(metrics, [allocation_measures/2]).
:- use_module(network, [await_end/5, on_network/5]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [append/3, max_list/2, member/2, memberchk/2, numlist/3,
               sum_list/2]).
:- use_module(library(option), [option/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> A task that comes late, and is urgent; and deadlines

As allocation_run/3 with the proposed mechanism, but the last task comes
when the others are being allocated.  It may have a priority, and all may
have a deadline.

*Threading*: as on_network/5.
*/

%!  urgent_run(+Options, +Directory, -Result) is det.
%
%   Options are those of allocation_run/3 and, required,
%
%     - late(Seconds)
%       of host time: when the last task comes
%     - priority(N)
%       of the last task; that of the others is 0
%     - deadline(Seconds)
%       of all tasks, from when their allocators begin, or 0: none
%
%   Result is a list: the measures of urgent_measures/3, ended(Bool), whether
%   all was over before the limit, and load(Wall, Cpu, Hops, Hop).
%
%   @error reservation_faults(Faults)

urgent_run(Options, Directory, [ended(Ended), Load|Measures]) :-
    directory_file_path(Directory, 'events.pl', Log),
    option(allocators(Last), Options),
    on_network(Options, Directory, perform(Options, Log), Events, Load),
    urgent_measures(Events, Last, Measures),
    memberchk(completed(Completed), Measures),
    memberchk(missed(Missed), Measures),
    length(Completed, Count1),
    length(Missed, Count2),
    (   Count1 + Count2 =:= Last
    ->  Ended = true
    ;   Ended = false
    ).

perform(Options, Log, _, ground(_, _, Starts), Ended) :-
    option(allocators(Last), Options),
    numlist(1, Last, Names),
    findall(Task, ( member(Name, Names), task(Options, Last, Name, Task) ),
            Tasks),
    pairs_keys_values(Pairs, Tasks, Starts),
    append(Early, [Late], Pairs),
    !,
    mechanism_allocate(proposed, Early, Options, _),
    option(late(Seconds), Options),
    option(clock(Rate), Options),
    Real is Seconds/Rate,
    sleep(Real),
    mechanism_allocate(proposed, [Late], Options, _),
    await_end(Log, Names, Options, tasks, Ended).

task(Options, Last, Name, task(Name, [Required-[push]], Details)) :-
    option(required(Required), Options),
    option(duration(Seconds), Options),
    option(priority(Priority), Options),
    option(deadline(Deadline), Options),
    findall(Detail,
            ( Detail = duration(Seconds)
            ; Name == Last, Detail = priority(Priority)
            ; Deadline > 0, Detail = deadline(Deadline) ),
            Details).

                /*******************************
                *           MEASURES           *
                *******************************/

%!  urgent_measures(+Events, +Last, -Measures:list) is det.
%
%   Measures are those of allocation_measures/2, and
%
%     - late(Seconds): from when the task Last has begun until it was
%       completed, `none` if it was not
%     - others(Mean): the same, of the others that were completed
%     - missed(Tasks)
%     - overdue(List): for each of these the host seconds between its
%       deadline and when it was reported, and until the last of its robots
%       was free: Reported-Free

urgent_measures(Events, Last,
                [ late(Late), others(Others), missed(Missed),
                  overdue(Overdue)
                | Measures ]) :-
    allocation_measures(Events, Measures),
    findall(Task-Seconds, lasted(Events, Task, Seconds), All),
    (   memberchk(Last-Late0, All)
    ->  Late = Late0
    ;   Late = none
    ),
    findall(Seconds, ( member(Task-Seconds, All), Task \== Last ), Rest),
    mean(Rest, Others),
    findall(Task, member(event(_, _, _, missed(Task, _)), Events), Missed),
    findall(Reported-Free, overdue(Events, Reported, Free), Overdue).

lasted(Events, Task, Seconds) :-
    member(event(End, _, _, completed(Task)), Events),
    memberchk(event(Begin, _, _, begun(Task)), Events),
    Seconds is End - Begin.

mean([], none) :-
    !.
mean(Numbers, Mean) :-
    sum_list(Numbers, Sum),
    length(Numbers, Count),
    Mean is Sum/Count.

overdue(Events, Reported, Free) :-
    member(event(Missed, _, _, missed(Task, Deadline)), Events),
    memberchk(event(Begin, _, _, begun(Task)), Events),
    Due is Begin + Deadline,
    Reported is Missed - Due,
    findall(Time, member(event(Time, _, _, released(_, _, Task)), Events),
            Times),
    max_list([Missed|Times], Last),
    Free is Last - Due.

                /*******************************
                *            CLAIMS            *
                *******************************/

%!  urgent_claims(+Data, -Claims) is det.
%
%   Claims are what is to be expected of Data, pairs Case-Runs, with Case
%   one of priority(0), priority(1) and deadline(Seconds).

urgent_claims(Data, Claims) :-
    findall(claim(Text, Held, Found),
            ( expected(Text, Test), judged(Test, Data, Held, Found) ),
            Claims).

expected('the task that comes last is completed sooner if it is urgent',
         sooner).
expected('the others are completed all the same', completed).
expected('with deadlines each task is completed or reported as missed',
         reported).
expected('a missed deadline is reported within 2 s', within(1, 2)).
expected('all robots of a task that is missed are free within 60 s, when \c
they would ask', within(2, 60)).

judged(sooner, Data, Held, Found) :-
    late(priority(0), Data, Without),
    late(priority(1), Data, With),
    (   number(Without), number(With), With < Without
    ->  Held = true
    ;   Held = false
    ),
    format(atom(Found), '~w s, without priority ~w s', [With, Without]).
judged(completed, Data, Held, Found) :-
    findall(Result,
            ( member(Case-Runs, Data), Case = priority(_),
              member(_-Result, Runs) ),
            Results),
    all_ended(Results, Held, Found).
judged(reported, Data, Held, Found) :-
    findall(Result,
            ( member(Case-Runs, Data), Case = deadline(_),
              member(_-Result, Runs) ),
            Results),
    all_ended(Results, Held, Found).
judged(within(Place, Most), Data, Held, Found) :-
    findall(Seconds,
            ( member(_-Runs, Data), member(_-Result, Runs),
              memberchk(overdue(List), Result), member(Pair, List),
              arg(Place, Pair, Seconds) ),
            All),
    length(All, Count),
    max_list([0|All], Longest),
    (   Longest =< Most,
        Count > 0
    ->  Held = true
    ;   Held = false
    ),
    format(atom(Found), 'at most ~2f s, of ~d tasks', [Longest, Count]).

late(Case, Data, Late) :-
    findall(Seconds,
            ( member(Case-Runs, Data), member(_-Result, Runs),
              memberchk(late(Seconds), Result), number(Seconds) ),
            All),
    (   median(All, Median)
    ->  Late is round(Median)
    ;   Late = none
    ).

all_ended(Results, Held, Found) :-
    length(Results, Count),
    aggregate_all(count,
                  ( member(Result, Results),
                    memberchk(ended(true), Result) ),
                  Good),
    (   Good =:= Count,
        Count > 0
    ->  Held = true
    ;   Held = false
    ),
    format(atom(Found), '~d of ~d runs', [Good, Count]).
