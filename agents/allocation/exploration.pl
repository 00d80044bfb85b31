/*  How far an allocator goes, and how long it rests: what the equations of
    mobility.pl and backoff.pl are applied to.  To be included.
*/

                /*******************************
                *           MIGRATION          *
                *******************************/

%   Where there is no way on the resource decays, too: who is cut off does
%   not keep robots from others.

migrate :-
    sojourn(Visited, _, _, _),
    discovered(Found),
    parameter(cd, Cd),
    chi(Chi0),
    decayed(Chi0, Found, Visited, Cd, Chi),
    keep(chi(Chi)),
    parameter(strategy, Strategy),
    (   next_host(Strategy, Host)
    ->  catch(move(Host), error(_, _), Arrived = false),
        landed(Arrived)
    ;   pause
    ).

landed(Arrived) :-
    var(Arrived),
    !,
    count(migration, 1),
    here(Host),
    retract(trail(Trail0)),
    findall(Other, held(Other, _, _, _, _), Wanted),
    neighbours(Neighbours),
    stepped(Host, Neighbours, Wanted, Trail0, Trail),
    assertz(trail(Trail)),
    retract(sojourn(Visited, Hops0, Rewards, Penalties)),
    Hops is Hops0 + 1,
    assertz(sojourn(Visited, Hops, Rewards, Penalties)),
    visited(Host).
landed(false) :-
    count(refusal, 1),
    pause.

visited(Host) :-
    retract(sojourn(Visited0, Hops, Rewards, Penalties)),
    Visited is Visited0 + 1,
    assertz(sojourn(Visited, Hops, Rewards, Penalties)),
    (   found(Host)
    ->  true
    ;   assertz(found(Host))
    ).

discovered(Count) :-
    aggregate_all(count, found(_), Count).

pause :-
    parameter(pause, Seconds),
    sleep(Seconds).

                /*******************************
                *      REWARDS, PENALTIES      *
                *******************************/

%   gain(+Reserved): a robot was reserved, beside so many.

gain(Reserved) :-
    retract(sojourn(Visited, Hops, Rewards0, Penalties)),
    Rewards is Rewards0 + 1,
    assertz(sojourn(Visited, Hops, Rewards, Penalties)),
    frequency(Rewards, Hops, Frequency),
    task(_, Teams, _),
    required(Teams, Required),
    chi(Chi0),
    rewarded(Chi0, Frequency, Required, Reserved, Chi),
    keep(chi(Chi)).

%   suffer: a robot it could use was reserved already.

suffer :-
    retract(sojourn(Visited, Hops, Rewards, Penalties0)),
    Penalties is Penalties0 + 1,
    assertz(sojourn(Visited, Hops, Rewards, Penalties)),
    frequency(Penalties, Hops, Frequency),
    task(_, Teams, _),
    required(Teams, Required),
    reserved(Reserved),
    chi(Chi0),
    penalised(Chi0, Frequency, Penalties, Required, Reserved, Chi),
    keep(chi(Chi)).

%   Where it begins it has not yet moved.

frequency(Times, Hops, Frequency) :-
    Frequency is Times/max(1, Hops).

                /*******************************
                *           BACK-OFF           *
                *******************************/

%   Robots that are executing are of no use to others as yet.

back_off :-
    let_go([reserved, done]),
    keep(stage(resting)),
    theta(Theta),
    retract(backoffs(Count0)),
    Count is Count0 + 1,
    assertz(backoffs(Count)),
    parameter(bi_max, Maximum),
    turn(Turn),
    interval(Theta, Count, Maximum, Turn, Interval),
    log(backoff(Interval)),
    now(Now),
    Until is Now + Interval,
    rest(Until),
    restart.

theta(Theta) :-
    parameter(backoff, constant),
    !,
    sojourn(_, _, Rewards, _),
    parameter(bi_min, Minimum),
    bid_time(Rewards, Minimum, Theta).
theta(Theta) :-
    discovered(Found),
    hop_time(HopTime),
    reach_time(Found, HopTime, Theta).

%   As the host keeps it: the mean of the hops to it.

hop_time(Seconds) :-
    here(Host),
    typhon:host_property(Host, hop_time(in, stats(_, _, Seconds, _))),
    !.

rest(Until) :-
    attend,
    now(Now),
    Left0 is Until - Now,
    (   Left0 > 0
    ->  soon(Left0, Left),
        (   receive(From-Message, Left)
        ->  heed(Message, From)
        ;   true
        ),
        rest(Until)
    ;   true
    ).

restart :-
    discovered(Found),
    parameter(cd, Cd),
    parameter(alpha_k, Threshold),
    restarted(Found, Cd, Threshold, Chi),
    keep(chi(Chi)),
    keep(sojourn(0, 0, 0, 0)),
    (   held(_, _, _, _, _)
    ->  true
    ;   here(Host),
        keep(trail([Host]))
    ).

seed_chance :-
    parameter(seed, Seed0),
    self(Me),
    (   integer(Seed0)
    ->  typhon_chance:chance_hash(Seed0-Me, Seed)
    ;   Seed is random(1<<30)
    ),
    typhon_chance:chance_seed(Seed, Chance),
    keep(chance(Chance)).

turn(Turn) :-
    retract(chance(Chance0)),
    typhon_chance:chance_float(Turn, Chance0, Chance),
    assertz(chance(Chance)).
