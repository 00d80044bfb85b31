:- module(sync_operator,
          [ sequence_start/5,           % +Sequence, +Hosts, +Tasks, +Options,
                                        % -Agents
            sequence_change/3,          % +Sequence, +Hosts, +Tasks
            task_fail/4,                % +Sequence, +Task, +Hosts, -Failed
            tasks_fail/4                % +Sequence, +Task, +Hosts, -Failed
          ]).
:- use_module('../../prolog/typhon',
              [agent_create/3, agent_send/2, remote/2]).
:- use_module('../../prolog/typhon/kernel/base/options', [check_options/2]).
:- use_module('../../prolog/typhon/kernel/program/paths', []).
:- use_module('../lib/settings', [setting_facts/3]).
:- use_module('../lib/starts', [starts/4]).
:- use_module(library(apply), [foldl/4, include/3, maplist/2, maplist/3]).
:- use_module(library(error),
              [domain_error/2, existence_error/2, must_be/2]).
:- use_module(library(lists),
              [append/3, max_member/2, member/2, memberchk/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(pairs), [pairs_keys/2, pairs_keys_values/3]).

/** <module> Sequences of tasks, for users and programs

Starts a sequence of tasks on hosts, changes it while it runs, and reverts
completed tasks (thesis sections 5.4 and 5.6.6).  The predicates only change
the tuple spaces of hosts; the agents find the changes there.

Hosts are addresses, so these predicates work from any process with the
cookie, and not only where the network was started.

An atom or a number names a task, an atom a sequence.  A list of tasks is a
list of Task-Goal in order.  The worker of each host runs Goal, which may
stop, as in sleep(1).

*Threading*: any thread.
*/

:- multifile
    agent_settings:takes/4,
    typhon_options:declared/4.

%!  sequence_start(+Sequence, +Hosts, +Tasks, +Options, -Agents) is det.
%
%   Each of Hosts gets a worker for Sequence, if it has none; other hosts take
%   no part.  Agents are the ids of agents, all of which have been sent the
%   message to begin.  Tasks completed on Hosts before stay completed. Options:
%
%     - agents(+Count): number of agents; default 10, or one on each of
%       `starts`
%     - starts(+Hosts), seed(+Integer): where they start, see starts/4
%     - pool(+Name): hosts have one worker for all sequences of this pool,
%       and execute one task at a time; default each sequence has its own
%     - after(+Pairs): Task-(Other:First): a host that takes part in the
%       sequence Other executes Task only after First of Other
%     - settings(+Pairs): Name-Value, to replace the defaults in traveller.pl
%
%   @error type_error(pair, X), domain_error(distinct_tasks, Names)
%   @error domain_error(sequence_option, Option)
%   @error domain_error(setting, X): unknown, or not in its range
%   @error host_unreachable(Host), existence_error(host, Host) and others
%   of agent_create/3

sequence_start(Sequence, Hosts, Tasks, Options, Agents) :-
    must_be(atom, Sequence),
    must_be(list(atom), Hosts),
    check_tasks(Tasks),
    check_options(sequence_option, Options),
    traveller_facts(Options, Settings),
    count(Options, Count),
    starts(Count, Hosts, Options, Starts),
    version(Sequence, Hosts, Tasks, Version),
    Plan = plan(Sequence, Version, Tasks),
    option(pool(Pool), Options, Sequence),
    maplist(take_part(Plan, Pool), Hosts),
    maplist(create_traveller([Plan|Settings]), Starts, Agents),
    forall(member(Agent, Agents), agent_send(Agent, begin)).

check_tasks(Tasks) :-
    must_be(list(pair), Tasks),
    pairs_keys(Tasks, Names),
    forall(member(Task, Names), must_be(atomic, Task)),
    sort(Names, Distinct),
    (   length(Names, Count),
        length(Distinct, Count)
    ->  true
    ;   domain_error(distinct_tasks, Names)
    ).

%   A host with a plan has a worker, even if that is busy.

take_part(Plan, Pool, Host) :-
    Plan = plan(Sequence, _, _),
    (   remote(Host, ( sense(plan(Sequence, _, _))
                     ; sense(pool(Pool))
                     ; sense(worker(Pool, _)) ))
    ->  true
    ;   agent_create(agents(sync/worker), _,
                     [host(Host), static(true), facts([sequence(Pool)])]),
        mark_pool(Pool, Sequence, Host)
    ),
    put_plan(Plan, Host).

%   The worker of a pool may be busy with another sequence; then only this
%   mark shows that it exists.

mark_pool(Sequence, Sequence, _) :-
    !.
mark_pool(Pool, _, Host) :-
    remote(Host, leave(pool(Pool))).

put_plan(Plan, Host) :-
    Plan = plan(Sequence, _, _),
    remote(Host, ( ignore(take(plan(Sequence, _, _))), leave(Plan) )).

create_traveller(Facts, Host, Agent) :-
    agent_create(agents(sync/traveller), Agent,
                 [host(Host), facts(Facts)]).

                /*******************************
                *            OPTIONS           *
                *******************************/

typhon_options:declared(sequence_option, agents(X), nonneg, X).
typhon_options:declared(sequence_option, starts(X), list(atom), X).
typhon_options:declared(sequence_option, seed(X), integer, X).
typhon_options:declared(sequence_option, pool(X), atom, X).
typhon_options:declared(sequence_option, after(X), list(pair), X).
typhon_options:declared(sequence_option, settings(X), list, X).

agent_settings:takes(sequence_start, [agents(sync/traveller)], [start], refused).

traveller_facts(Options, [setting(start, order)|Facts]) :-
    setting_facts(sequence_start, Options, Settings),
    option(after(Afters), Options, []),
    findall(Fact,
            ( option(pool(Pool), Options), Fact = setting(pool, Pool)
            ; member(Task-(Other:First), Afters),
              Fact = after(Task, Other, First) ),
            More),
    append(Settings, More, Facts).

%   The default is one agent on each of `starts`, if that option is given.

count(Options, Count) :-
    option(starts(Given), Options, []),
    (   Given = [_|_],
        is_list(Given)
    ->  length(Given, Default)
    ;   Default = 10
    ),
    option(agents(Count), Options, Default).

                /*******************************
                *            CHANGES           *
                *******************************/

%!  sequence_change(+Sequence, +Hosts, +Tasks) is det.
%
%   Tasks replace the tasks of Sequence.  The change is written at Hosts;
%   agents that visit them carry it to all others.  A task whose name Sequence
%   already had counts as the same task; if completed, it stays completed.
%   Those of Hosts that take no part in Sequence are skipped.
%
%   @error existence_error(sequence, Sequence): none of Hosts takes part
%   @error errors of sequence_start/5

sequence_change(Sequence, Hosts, Tasks) :-
    must_be(atom, Sequence),
    must_be(list(atom), Hosts),
    check_tasks(Tasks),
    findall(Host-V, plan_at(Sequence, Hosts, Host, V, _), Found),
    pairs_keys_values(Found, Parts, Versions),
    (   Parts == []
    ->  existence_error(sequence, Sequence)
    ;   new_version(Parts, Versions, Version),
        maplist(put_plan(plan(Sequence, Version, Tasks)), Parts)
    ).

%   The version of a plan is its creation time, by the clock of a host, or
%   slightly more than the newest version found, if that was made on a faster
%   clock.

new_version(Hosts, Versions, Version) :-
    ( Hosts = [Host|_] -> remote(Host, now(Now)) ; Now = 0 ),
    foldl(later_than, Versions, Now, Version).

later_than(Found, Version0, Version) :-
    Version is max(Version0, Found + 0.001).

%   A sequence that is started again with the same tasks keeps its plan.

version(Sequence, Hosts, Tasks, Version) :-
    findall(V-Ts, plan_at(Sequence, Hosts, _, V, Ts), Plans),
    pairs_keys(Plans, Versions),
    (   max_member(Newest, Versions),
        memberchk(Newest-Found, Plans),
        Found =@= Tasks
    ->  Version = Newest
    ;   new_version(Hosts, Versions, Version)
    ).

plan_at(Sequence, Hosts, Host, Version, Tasks) :-
    member(Host, Hosts),
    remote(Host, sense(plan(Sequence, Version, Tasks))).

                /*******************************
                *           FAILURES           *
                *******************************/

%!  task_fail(+Sequence, +Task, +Hosts, -Failed) is det.
%!  tasks_fail(+Sequence, +Task, +Hosts, -Failed) is det.
%
%   task_fail/4 is an atomic failure: Task is no longer completed at any of
%   Hosts.  tasks_fail/4 is a cascaded failure: the same for Task and all
%   later tasks, and executions of these are discarded when they end.  Failed
%   are those of Hosts where Task had been completed; the others do not
%   change.  Each failure is an event failed(Sequence, Task) in the log of the
%   host.
%
%   @error host_unreachable(Host)

task_fail(Sequence, Task, Hosts, Failed) :-
    include(fails(Sequence, Task, atomic), Hosts, Failed).

tasks_fail(Sequence, Task, Hosts, Failed) :-
    include(fails(Sequence, Task, cascaded), Hosts, Failed).

fails(Sequence, Task, Kind, Host) :-
    remote(Host, sense(task(Sequence, Task, completed, _))),
    lost(Kind, Sequence, Task, Host, Tasks, Statuses),
    mark(Kind, Task, Mark),
    lose(Mark, Sequence, Tasks, Statuses, Goal),
    remote(Host, Goal).

%   lost(+Kind, +Sequence, +Task, +Host, -Tasks, -Statuses): Tasks whose status
%   is one of Statuses fail.

lost(atomic, _, Task, _, [Task], [completed]).
lost(cascaded, Sequence, Task, Host, [Task|Later], [completed, executing]) :-
    remote(Host, sense(plan(Sequence, _, Tasks))),
    pairs_keys(Tasks, Names),
    append(_, [Task|Later], Names),
    !.

%   All tasks of a cascade are marked with its first task, since the first ones
%   may have been completed again when an agent arrives.

mark(atomic, _, failed(atomic)).
mark(cascaded, Task, failed(cascaded(Task))).

%   One goal for all tasks, so that no agent finds a later task missing before
%   the first one.  The new mark is left before the old tuple is taken: an
%   agent must always find one of them.

lose(Mark, Sequence, Tasks, Statuses, Goal) :-
    Goal = ( now(Time),
             forall(( member(Task, Tasks),
                      member(Status, Statuses),
                      sense(task(Sequence, Task, Status, _)) ),
                    ( leave(task(Sequence, Task, Mark, Time)),
                      take(task(Sequence, Task, Status, _)),
                      log(failed(Sequence, Task)) )) ).
