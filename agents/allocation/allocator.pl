:- agent(allocator,
         [ state([task/3, setting/2, chi/1, sojourn/4, found/1, trail/1,
                  held/5, achieved/1, backoffs/1, until/1, chance/1,
                  sent/2, stage/1])
         ]).
:- include(mobility).
:- include(backoff).
:- include(needs).
:- include(way).
:- include(exploration).
:- include(tell).
:- include(dealings).
:- include(deallocation).

/*  The allocator of a task: thesis section 7.4.  A mobile agent that finds
    as many robots as its task needs, reserves them by negotiation with
    their static agents, has them execute the task, and lets them go.

    It searches conscientiously as long as its mobility resource lasts.
    When that is used up it backs off: children of it let the robots go, and
    it rests for a while, so that others can complete.

    Facts: task(Name, Teams, Details), see needs.pl; setting(Name, Value)
    replaces a default.  Its payload defines agreed(+Cost, +Details,
    +Backoffs), which is true if a robot is to be reserved for that cost.

        chi(Chi)                the mobility resource
        sojourn(Visited, Hops, Rewards, Penalties)
                                since it began to search, or last rested
        found(Host)             the distinct robots ever discovered
        trail(Hosts)            how it came here, see way.pl
        held(Host, Robot, Ref, Team, Phase)
                                its robots; Phase is `reserved`, `started`
                                or `done`
        achieved(Team)          for each robot that has done its part and
                                has been let go
        backoffs(Count), until(Deadline), sent(Kind, Count)
        stage(Stage)            `waiting`, `searching`, `resting`,
                                `executing`, for who asks from outside
*/

default(cd, 5).
default(alpha_k, 0.01).         % below it the resource is used up
default(chi, 10).               % the resource of one that knows nothing
default(bi_min, 10).            % seconds, of constant back-off
default(bi_max, 500).
default(backoff, adaptive).     % or `constant`: equation 7.7 for 7.6
default(strategy, conscientious).
default(children, 1).           % among which the robots to free are shared
default(child_life, 300).       % seconds
default(patience, 20).          % seconds to wait for a robot's answer
default(monitor, 10).           % seconds between looks at silent robots
default(pause, 1).              % seconds, where there is no way on
default(start, now).            % or `order`: waits for the message `begin`
default(seed, random).

parameter(Name, Value) :-
    (   setting(Name, Value0)
    ->  Value = Value0
    ;   default(Name, Value)
    ).

main :-
    keep(stage(waiting)),
    await_order,
    prepare,
    catch(accomplish, missed, miss),
    report.

await_order :-
    parameter(start, order),
    !,
    receive(_-begin).
await_order.

prepare :-
    task(Name, _, Details),
    detail(deadline, Details, never, Deadline),
    set_deadline(Deadline),
    parameter(chi, Chi),
    keep(chi(Chi)),
    keep(backoffs(0)),
    seed_chance,
    log(begun(Name)),
    here(Host),
    keep(trail([Host])),
    keep(sojourn(0, 0, 0, 0)),
    visited(Host).

set_deadline(never) :-
    !,
    keep(until(never)).
set_deadline(Seconds) :-
    now(Now),
    Until is Now + Seconds,
    keep(until(Until)).

%   Until all its robots have done their part; those that fail meanwhile
%   are replaced.

accomplish :-
    search,
    execute(Outcome),
    accomplished(Outcome).

accomplished(done) :-
    task(Name, _, _),
    log(completed(Name)),
    let_go([done]).
accomplished(missing) :-
    accomplish.

miss :-
    task(Name, _, Details),
    detail(deadline, Details, never, Deadline),
    log(missed(Name, Deadline)),
    let_go([reserved, started, done]).

                /*******************************
                *             SEARCH           *
                *******************************/

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
    proceed,
    search.

proceed :-
    complete,
    !.
proceed :-
    chi(Chi),
    parameter(alpha_k, Threshold),
    exhausted(Chi, Threshold),
    !,
    back_off.
proceed :-
    migrate.

complete :-
    task(_, Teams, _),
    required(Teams, Required),
    reserved(Required).

%   reserved(-Count): robots it has, or that have done their part.

reserved(Count) :-
    aggregate_all(count, ( held(_, _, _, _, _) ; achieved(_) ), Count).

                /*******************************
                *           EXECUTION          *
                *******************************/

%   Outcome is `done`, or `missing` as soon as robots must be replaced.

execute(Outcome) :-
    keep(stage(executing)),
    findall(Host, held(Host, _, _, _, reserved), Hosts),
    start(Hosts),
    supervise(Outcome).

start(Hosts) :-
    task(_, _, Details),
    detail(duration, Details, 5, Seconds),
    detail(goal, Details, sleep(Seconds), Goal),
    forall(( member(Host, Hosts), held(Host, Robot, Ref, _, _) ),
           start(Host, Robot, Ref, Goal)).

start(Host, Robot, Ref, Goal) :-
    mark(Ref, started),
    (   post(Host, Robot, start(Ref, Goal))
    ->  true
    ;   give_up(Host, Ref, unreachable)
    ).

%   supervise(+Asked, +Look, -Outcome): at the time Look it asks those
%   that have not finished how they are.  Asked are the robots that have not
%   answered since the last time.

supervise(Outcome) :-
    look_again(Look),
    supervise([], Look, Outcome).

supervise(_, _, missing) :-
    \+ complete,
    !.
supervise(_, _, done) :-
    \+ ( held(_, _, _, _, Phase), Phase \== done ),
    !.
supervise(Asked, Look, Outcome) :-
    check_deadline,
    now(Now),
    Left is max(0, Look - Now),
    soon(Left, Seconds),
    (   receive(From-Message, Seconds)
    ->  heed(Message, From),
        subtract(Asked, [From], Asked1),
        supervise(Asked1, Look, Outcome)
    ;   inquire(Asked, Asked1),
        look_again(Look1),
        supervise(Asked1, Look1, Outcome)
    ).

look_again(Look) :-
    now(Now),
    parameter(monitor, Seconds),
    Look is Now + Seconds.

%   Who did not answer the last time is given up.

inquire(Asked, Asking) :-
    forall(( held(Host, Robot, Ref, _, started),
             memberchk(Robot, Asked) ),
           give_up(Host, Ref, silent)),
    forall(held(Host, Robot, Ref, _, started),
           ignore(post(Host, Robot, status(Ref)))),
    findall(Robot, held(_, Robot, _, _, started), Asking).

mark(Ref, Phase) :-
    (   retract(held(Host, Robot, Ref, Team, _))
    ->  assertz(held(Host, Robot, Ref, Team, Phase))
    ;   true
    ).

                /*******************************
                *             TIME             *
                *******************************/

check_deadline :-
    until(never),
    !.
check_deadline :-
    until(Until),
    now(Now),
    (   Now >= Until
    ->  throw(missed)
    ;   true
    ).

%   soon(+Seconds0, -Seconds): not beyond the deadline.

soon(Seconds, Seconds) :-
    until(never),
    !.
soon(Seconds0, Seconds) :-
    until(Until),
    now(Now),
    Seconds is max(0, min(Seconds0, Until - Now)).

keep(Fact) :-
    functor(Fact, Name, Arity),
    functor(Old, Name, Arity),
    retractall(Old),
    assertz(Fact).
