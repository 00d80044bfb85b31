:- agent(room, [state([cell/1, rule/1, signs/1, exit/0, peer/2, heard/4, over/1,
                       told/2, way/2, alarmed/0])]).

/*  The detector and the exit sign of one cell of a building.

    The tuple space of its host has smoke(PerMetre), the reading of the
    detector, and sign(To) and alarm, which this agent leaves.  It sends its
    neighbours its reading, its confirmed value, and the walking time from its
    cell to an exit: air(Cell, Reading, Smoke, Seconds, To).

    rule(Rule) decides when there is an alarm, above 0.035 per metre (0.15 dB/m,
    as of optical detectors): `single`, at once; `verified`, after half a minute
    above it; `gossip`, if a neighbour reads at least a quarter of it.
    signs(gradient): signs point to the nearest exit, with the smoke on the way
    as a cost; signs(fixed): to the nearest exit without a fire.
*/

overlay(alarm, label, log(alarm(_)), alarm).
overlay('exit sign', label, log(sign(To)), To).

threshold(0.035).
every(1).                       % seconds from one reading to the next
verification(30).               % seconds
silence(12).                    % seconds until data of a neighbour expire

main :-
    receive(_-peers(Peers)),
    forall(member(Cell-Agent, Peers), assertz(peer(Cell, Agent))),
    now(Now),
    watch(Now).

watch(Next) :-
    now(Now),
    Wait is Next-Now,
    (   Wait > 0,
        receive(_-Message, Wait)
    ->  after(Message, Next)
    ;   every(Pause),
        look,
        Later is Next+Pause,
        watch(Later)
    ).

after(burnt, _) :-
    !,
    silent.
after(Message, Next) :-
    told(Message),
    watch(Next).

silent :-
    receive(_),
    silent.

told(air(Cell, Reading, Smoke, Way)) :-
    now(Now),
    retractall(heard(Cell, _, _, _)),
    assertz(heard(Cell, Reading-Smoke, Way, Now)),
    route.
told(alarm) :-
    sound.
told(reset) :-
    retractall(alarmed),
    retractall(over(_)),
    ignore(take(alarm)).

look :-
    reading(Reading),
    now(Now),
    overdue(Reading, Now),
    (   \+ alarmed,
        rule(Rule),
        alarming(Rule, Reading, Now)
    ->  cell(Cell),
        log(alarm(Cell)),
        sound
    ;   true
    ),
    route,
    ( news(Now) -> tell(Now) ; true ).

reading(Reading) :-
    ( sense(smoke(Reading)) -> true ; Reading = 0 ).

                /*******************************
                *             ALARM            *
                *******************************/

overdue(Reading, Now) :-
    threshold(Least),
    (   Reading < Least
    ->  retractall(over(_))
    ;   over(_)
    ->  true
    ;   assertz(over(Now))
    ).

alarming(single, _, _) :-
    over(_).
alarming(verified, _, Now) :-
    over(Since),
    verification(Seconds),
    Now-Since >= Seconds.
alarming(gossip, _, Now) :-
    over(_),
    supported(Now).

%   A neighbour reads a quarter of the threshold, or has recently.

supported(Now) :-
    threshold(Least),
    heard(_, Reading-_, _, At),
    Reading >= Least/4,
    silence(Silence),
    Now-At < Silence,
    !.

sound :-
    alarmed,
    !.
sound :-
    assertz(alarmed),
    leave(alarm),
    forall(peer(_, Agent), send(Agent, alarm)).

                /*******************************
                *             SIGNS            *
                *******************************/

%   way(Seconds, To): To is `out` at an exit, `none` if no way is known.

route :-
    best(Seconds, To),
    (   way(_, To)
    ->  true
    ;   ( take(sign(_)) -> true ; true ),
        leave(sign(To)),
        log(sign(To))
    ),
    retractall(way(_, _)),
    assertz(way(Seconds, To)).

best(0, out) :-
    exit,
    !.
best(Seconds, To) :-
    cell(Cell),
    signs(Signs),
    now(Now),
    findall(S-Next,
            ( heard(Next, _-Smoke, There-Via, At),
              Via \== Cell,             % not back to this cell
              walk(Signs, Smoke, Now-At, Walk),
              S is There+Walk,
              S < 500 ),
            Ways),
    msort(Ways, [Seconds-To|_]),
    !.
best(500, none).

%   walk(+Signs, +Smoke, +Age, -Seconds): for 5 m.  In smoke people are slower
%   (Frantzich and Nilsson), and a way with less of it is preferred: a second in
%   smoke of 0.5 per metre counts as three.  At 1 per metre people turn back.

walk(fixed, _, _, 4.2).
walk(gradient, Smoke, Age, Seconds) :-
    silence(Silence),
    Age < Silence,
    Smoke < 1,
    Seconds is 4.2/(1 - 0.0807*Smoke)*(1 + 4*Smoke).

                /*******************************
                *            GOSSIP            *
                *******************************/

%   The reading of a single detector alone does not count as smoke.

believed(Reading, Now, Smoke) :-
    (   rule(gossip),
        \+ supported(Now)
    ->  Smoke = 0
    ;   Smoke = Reading
    ).

news(Now) :-
    told(Reading0-Seconds0, At),
    !,
    reading(Reading),
    way(Seconds, _),
    threshold(Least),
    ( Now-At >= 5
    ; abs(Reading-Reading0) > max(Least/8, Reading0/5)
    ; abs(Seconds-Seconds0) > 1 ),
    !.
news(_).

tell(Now) :-
    cell(Cell),
    reading(Reading),
    believed(Reading, Now, Smoke),
    way(Seconds, To),
    retractall(told(_, _)),
    assertz(told(Reading-Seconds, Now)),
    forall(peer(_, Agent),
           send(Agent, air(Cell, Reading, Smoke, Seconds-To))).
