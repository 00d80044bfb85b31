:- agent(allocator, [state([task/3, setting/2, backoffs/1, stage/1])]).
:- include('../lib/parameters').
:- include('../lib/keep').
:- include('../lib/await_order').
:- include('../lib/chance').
:- include('../lib/clones').
:- include('../lib/tell').
:- include('common/requirements').
:- include('common/backoff_interval').
:- include('common/communications').
:- include('allocator/mobility_resource').
:- include('allocator/trail').
:- include('allocator/deadline').
:- include('allocator/messages').
:- include('allocator/held_robots').
:- include('allocator/news').
:- include('allocator/attendance').
:- include('allocator/sojourn').
:- include('allocator/rewards').
:- include('allocator/migration').
:- include('allocator/negotiation').
:- include('allocator/deallocation').
:- include('allocator/contention').
:- include('allocator/execution').

/*  The allocator of a task: thesis section 7.4.  A mobile agent that finds
    as many robots as its task needs, reserves them by negotiation with
    their static agents, has them execute the task, and de-allocates them.

    The allocator searches conscientiously as long as its mobility resource
    lasts.  When the resource is exhausted, the allocator backs off: its
    child agents de-allocate the robots, and it stays dormant for a while, so
    that other allocators can complete their tasks.

    This file is an overview; each step is a file in the folder `allocator`,
    which calls no predicate of a file that is included after it.
    doc/allocation.md compares these files with the steps of the thesis.

    Facts: task(Name, Teams, Details), see common/requirements.pl;
    setting(Name, Value) replaces a default.  The payload defines
    agreed(+Cost, +Details, +Backoffs), which is true if the allocator
    reserves a robot for that cost.

        backoffs(Count)         beta, the number of back-offs so far
        stage(Stage)            `waiting`, `searching`, `resting` or
                                `executing`; other programs read it

    The other facts are described in the files that own them.
*/

default(cd, 5).
default(alpha_k, 0.01).         % at or below it the resource is exhausted
default(chi, 10).               % mobility resource of a new allocator
default(bi_min, 10).            % seconds, of constant back-off
default(bi_max, 500).
default(beta, 1).               % of the first back-off; or 0
default(backoff, adaptive).     % or `constant`: equation 7.7 for 7.6
default(strategy, conscientious).
default(sharing, none).         % `own`, `shared`: see news.pl
default(children, 1).           % child agents that share the de-allocation
default(child_life, 300).       % seconds
default(patience, 20).          % seconds before a robot counts as silent
default(monitor, 10).           % seconds between status requests
default(pause, 1).              % seconds, where no neighbour is reachable
default(start, now).            % or `order`: wait for the message `begin`
default(seed, random).

main :-
    keep(stage(waiting)),
    await_order,
    prepare,
    catch(accomplish, missed, miss),
    log_communications.

prepare :-
    task(Name, _, Details),
    detail(deadline, Details, never, Deadline),
    set_deadline(Deadline),
    keep(backoffs(0)),
    self(Me),
    seed_chance(Me),
    log(begun(Name)),
    set_out.

%   Continues until all robots of the task have done their part; robots that
%   fail meanwhile are replaced.

accomplish :-
    search,
    execute(Outcome),
    accomplished(Outcome).

accomplished(done) :-
    task(Name, _, _),
    log(completed(Name)),
    deallocate([done]).
accomplished(missing) :-
    accomplish.

miss :-
    task(Name, _, Details),
    detail(deadline, Details, never, Deadline),
    log(missed(Name, Deadline)),
    deallocate([reserved, started, done]).

                /*******************************
                *             SEARCH           *
                *******************************/

%   Migrate and negotiate, until all the robots required are reserved.

search :-
    complete,
    !,
    task(Name, _, _),
    findall(Host, held(Host, _, _, _, _), Hosts),
    log(allocated(Name, Hosts)).
search :-
    keep(stage(searching)),
    attend,
    negotiate,
    exchange,
    proceed,
    search.

proceed :-
    complete,
    !.
proceed :-
    exhausted,
    !,
    back_off.
proceed :-
    migrate.
