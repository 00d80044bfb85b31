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
:- use_module('../lib/settings', [unknown_setting/2]).
:- use_module('../lib/starts', [starts/4]).
:- use_module(library(apply), [foldl/4, include/3, maplist/2, maplist/3]).
:- use_module(library(error),
              [domain_error/2, existence_error/2, must_be/2]).
:- use_module(library(lists),
              [append/3, max_member/2, member/2, memberchk/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(pairs), [pairs_keys/2, pairs_keys_values/3]).

/** <module> Sequences of tasks, for users and programs

Starts a sequence of tasks on hosts, changes it while it runs, and takes back
what was done (thesis sections 5.4 and 5.6.6).  The predicates only change the
tuple spaces of hosts; the agents find the changes there.

Hosts are addresses, so all this works from any process that has the
cookie, and not only where the network was started.

A sequence is named by an atom, so are its tasks, or by a number.  A list
of tasks is a list of Task-Goal in order.  Goal is run by the worker of each
host, and may stop, as in sleep(1).

*Threading*: any thread.
*/

:- multifile typhon_options:declared/4.

%!  sequence_start(+Sequence, +Hosts, +Tasks, +Options, -Agents) is det.
%
%   Hosts get a worker for Sequence, where they have none; other hosts have no
%   part in it.  Agents are the ids of agents that have all been told to
%   begin.  Tasks completed on Hosts before stay completed. Options:
%
%     - agents(+Count): how many agents; default 10, or one on each of
%       `starts`
%     - starts(+Hosts), seed(+Integer): where they start, see starts/4
%     - pool(+Name): hosts have one worker for all sequences of this pool,
%       and execute one task at a time; default each sequence has its own
%     - after(+Pairs): Task-(Other:First): a host that has a part in the
%       sequence Other executes Task when it has completed First of that
%     - settings(+Pairs): Name-Value, to replace what traveller.pl has as
%       the default of `delta`, `theta`, `maximum`, `window`, `patience`:
%       numbers above 0; or of `strategy`, which next_host/2 knows
%
%   @error type_error(pair, X), domain_error(distinct_tasks, Names)
%   @error domain_error(sequence_option, Option)
%   @error domain_error(setting, X): unknown, or no such value
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

%   A host with a plan has a worker, even if that is not free.

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

%   The worker of a pool may be busy, with a sequence of which this is not known.

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

traveller_facts(Options, [setting(start, order)|Facts]) :-
    option(settings(Pairs), Options, []),
    maplist(setting_fact, Pairs, Settings),
    option(after(Afters), Options, []),
    findall(Fact,
            ( option(pool(Pool), Options), Fact = setting(pool, Pool)
            ; member(Task-(Other:First), Afters),
              Fact = after(Task, Other, First) ),
            More),
    append(Settings, More, Facts).

setting_fact(strategy-Strategy, setting(strategy, Strategy)) :-
    ground(Strategy),
    !.
setting_fact(Name-Value, setting(Name, Value)) :-
    memberchk(Name, [delta, theta, maximum, window, patience]),
    number(Value),
    Value > 0,
    !.
setting_fact(Setting, _) :-
    unknown_setting([delta, theta, maximum, window, patience, strategy],
                    Setting).

%   One on each of `starts`, if these are given and their number is not.

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
%   Tasks are the tasks of Sequence from now on.  Said at Hosts; agents
%   that pass there take it up and bring it to all others.  Tasks with a
%   name that Sequence had already are taken for the same, what has been
%   completed stays so.  Those of Hosts that have no part in Sequence are
%   left out.
%
%   @error existence_error(sequence, Sequence): none of Hosts has a part
%   @error errors of sequence_start/5

sequence_change(Sequence, Hosts, Tasks) :-
    must_be(atom, Sequence),
    must_be(list(atom), Hosts),
    check_tasks(Tasks),
    findall(Host-V, plan_at(Sequence, Hosts, Host, V, _), Found),
    pairs_keys_values(Found, Parts, Versions),
    (   Parts == []
    ->  existence_error(sequence, Sequence)
    ;   new_version(Versions, Version),
        maplist(put_plan(plan(Sequence, Version, Tasks)), Parts)
    ).

%   The version of a plan is the time at which it was made, or a moment
%   after the newest one found, where that comes from a faster clock.

new_version(Versions, Version) :-
    get_time(Now),
    foldl(later_than, Versions, Now, Version).

later_than(Found, Version0, Version) :-
    Version is max(Version0, Found + 0.001).

%   A sequence that is started again with the same tasks has the same plan.

version(Sequence, Hosts, Tasks, Version) :-
    findall(V-Ts, plan_at(Sequence, Hosts, _, V, Ts), Plans),
    pairs_keys(Plans, Versions),
    (   max_member(Newest, Versions),
        memberchk(Newest-Found, Plans),
        Found =@= Tasks
    ->  Version = Newest
    ;   new_version(Versions, Version)
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
%   An atomic failure: Task is completed no more at any of Hosts.  A
%   cascaded failure: neither is any later task, and what is executing
%   there of these will have been in vain.  Failed are those of Hosts where
%   Task had been completed; nothing happens at the others.  Each failure
%   is an event failed(Sequence, Task) in the log of the host.
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

%   lost(+Kind, +Sequence, +Task, +Host, -Tasks, -Statuses): what fails are
%   Tasks where their status is one of Statuses.

lost(atomic, _, Task, _, [Task], [completed]).
lost(cascaded, Sequence, Task, Host, [Task|Later], [completed, executing]) :-
    remote(Host, sense(plan(Sequence, _, Tasks))),
    pairs_keys(Tasks, Names),
    append(_, [Task|Later], Names),
    !.

%   Where a cascade began is known to all that it took along: the first ones
%   may have been done again when an agent comes.

mark(atomic, _, failed(atomic)).
mark(cascaded, Task, failed(cascaded(Task))).

%   One goal for all, so that no agent sees a later task missing before the
%   first one.  The new mark comes before the old one goes: an agent must
%   not find neither.

lose(Mark, Sequence, Tasks, Statuses, Goal) :-
    Goal = ( now(Time),
             forall(( member(Task, Tasks),
                      member(Status, Statuses),
                      sense(task(Sequence, Task, Status, _)) ),
                    ( leave(task(Sequence, Task, Mark, Time)),
                      take(task(Sequence, Task, Status, _)),
                      log(failed(Sequence, Task)) )) ).
