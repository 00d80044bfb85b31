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

default(cd, 5, range(0, 50, 0.1), "of equation 7.3").
default(alpha_k, 0.01, range(0, 1, 0.001),
        "at or below it the resource is exhausted").
default(chi, 10, range(0, 100, 0.1), "mobility resource of a new allocator").
default(bi_min, 10, range(0, 100, 0.5), "seconds, of constant back-off").
default(bi_max, 500, range(0, 2000, 1.0), "seconds, of equation 7.5").
default(beta, 1, range(0, 5, 0.5),
        "exponent of equation 7.5 at the first back-off").
default(backoff, adaptive, [adaptive, constant],
        "constant: equation 7.7 for 7.6").
default(strategy, conscientious, ground, "of migration, see next_host/2").
default(sharing, none, [none, own, shared], "of places of robots, see news.pl").
default(children, 1, range(1, 10, 1),
        "child agents that share the de-allocation").
default(child_life, 300, range(0, 3000, 1.0), "seconds").
default(patience, 20, range(1, 200, 0.5),
        "seconds before a robot counts as silent").
default(monitor, 10, range(1, 100, 0.5), "seconds between status requests").
default(pause, 1, range(0.1, 20, 0.1),
        "seconds, where no neighbour is reachable").
default(start, now, [now, order], "order: waits for the message begin").
default(seed, random, [random, range(0, 2147483647, 1)],
        "of the intervals of back-off").

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
