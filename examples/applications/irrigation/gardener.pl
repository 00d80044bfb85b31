:- agent(gardener, [state([field/2, strategy/1, map/3, depletion/1, crop/1,
                           hour/1, due/1, pending/1, reached/0,
                           gateway/1])]).

/*  Irrigates a field by a model of its water, which the agent carries there.

    Facts: field(Host, Number); map(FC, WP, Zr), a survey of the soil;
    strategy(Strategy):

      carried   moves to the field as soon as there is a link, and stays
      central   stays at the office; a gateway at the field passes readings and
                orders on while there is a link
      timer     opens the valve every three days, for the need of the crop by
                the table without rain; timer_less, less the mean rain

    The place of the field offers MQTT's subscribe/2 and publish/2, those of
    library(typhon/mqtt) or of a simulation.  The topic field/N/moisture has
    JSON once in an hour, of the form _{hour:H, moisture:Share, et0:Mm,
    rain:Mm}; a message at field/N/valve, _{mm:Mm}, opens the valve for that
    amount.
*/

overlay('crop takes, of ET0', bar, log(calibrated(Host, Kc)), Host-Kc).
overlay('irrigated, mm', bar, log(irrigated(Host, Mm)), Host-add(Mm)).

guess(1.0).                     % Kc of the table
holds(0.75).                    % share of sprinkler water that reaches roots
trusted(0.04).                  % share of the difference that corrects D
learnt(0.001).                  % share of the difference that corrects Kc
dose(timer, 20).                % mm in three days: 15 of them reach the roots
dose(timer_less, 16).
rate(5).                        % mm/h of the valve

main :-
    strategy(Strategy),
    guess(Kc),
    assertz(crop(Kc)),
    assertz(depletion(0)),
    assertz(hour(-1)),
    assertz(due(0)),
    assertz(pending(0)),
    begin(Strategy).

begin(central) :-
    receive(_-gateway(Agent)),
    assertz(gateway(Agent)),
    work.
begin(carried) :-
    go,
    work.
begin(Timer) :-
    dose(Timer, Mm),
    go,
    clockwork(Mm).

go :-
    field(Host, Number),
    (   linked(Host),
        catch(move(Host), error(_, _), fail)
    ->  assertz(reached),
        topic(Number, moisture, Topic),
        subscribe(Topic, [as(latest)])
    ;   sleep(3600),
        go
    ).

linked(Host) :-
    neighbours(Hosts),
    memberchk(Host, Hosts).

topic(Number, Name, Topic) :-
    format(atom(Topic), 'field/~w/~w', [Number, Name]).

clockwork(Mm) :-
    open_valve(Mm),
    sleep(259200),              % three days
    clockwork(Mm).

                /*******************************
                *           READINGS           *
                *******************************/

work :-
    reading(Reading),
    hour(Before),
    get_dict(hour, Reading, Hour),
    (   Hour > Before
    ->  calibrate(Reading, Before),
        decide(Hour)
    ;   true
    ),
    work.

%   At the field the latest reading is a fact, which is read twice in an hour.

reading(Reading) :-
    reached,
    !,
    sleep(1800),
    (   field(_, Number),
        topic(Number, moisture, Topic),
        sense(mqtt-message(Topic, Reading, _))
    ->  true
    ;   reading(Reading)
    ).
reading(Reading) :-
    receive(_-reading(Reading)).

%   The balance predicts the depletion; the reading corrects it, and corrects
%   the need of the crop, if the balance is repeatedly wrong in one direction.
%   For hours without a reading the mean is assumed.

calibrate(Reading, Before) :-
    _{hour:Hour, moisture:Moisture, et0:Et0, rain:Rain} :< Reading,
    map(FC, WP, Zr),
    crop(Kc0),
    depletion(D0),
    ( Before < 0 -> Missed = 0 ; Missed is Hour-Before-1 ),
    stress(D0, FC, WP, Zr, Ks),
    arrived(Missed, Water),
    Expected is max(0, D0 + Ks*Kc0*(Et0 + Missed*5/24) - Rain - Water),
    Seen is 1000*Zr*(FC-Moisture),
    Error is Seen-Expected,
    ( Before < 0 -> Gain = 1 ; trusted(Gain) ),
    D is max(0, Expected + Gain*Error),
    learnt(Share),
    ( Before < 0 -> Kc = Kc0 ; Kc is max(0.4, min(1.6, Kc0+Share*Error)) ),
    retractall(depletion(_)),
    retractall(crop(_)),
    retractall(hour(_)),
    assertz(depletion(D)),
    assertz(crop(Kc)),
    assertz(hour(Hour)).

arrived(Missed, Water) :-
    retract(pending(Mm)),
    rate(Rate),
    Given is min(Mm, Rate*(Missed+1)),
    Left is Mm-Given,
    assertz(pending(Left)),
    holds(Share),
    Water is Share*Given.

stress(D, FC, WP, Zr, Ks) :-
    TAW is 1000*(FC-WP)*Zr,
    Ks is max(0, min(1, (TAW-D)/(0.5*TAW))).

                /*******************************
                *          IRRIGATION          *
                *******************************/

%   Decides once a day, before dawn: enough water that the crop has no stress
%   today, and a tenth of the soil stays free for rain.  A lost order is
%   repeated.

decide(Hour) :-
    due(Due),
    Hour >= Due,
    wanted(Mm),
    ( Mm =:= 0 -> true ; open_valve(Mm) ),
    !,
    Next is 24*(Hour//24) + 28,
    retractall(pending(_)),
    assertz(pending(Mm)),
    retractall(due(_)),
    assertz(due(Next)).
decide(_).

wanted(Mm) :-
    map(FC, WP, Zr),
    depletion(D),
    crop(Kc),
    field(Host, _),
    log(calibrated(Host, Kc)),
    TAW is 1000*(FC-WP)*Zr,
    holds(Share),
    (   D + 5*Kc > 0.45*TAW
    ->  Mm is max(0, D - 0.1*TAW)/Share
    ;   Mm = 0
    ).

open_valve(Mm) :-
    reached,
    !,
    field(Host, Number),
    topic(Number, valve, Topic),
    publish(Topic, _{mm:Mm}),
    log(irrigated(Host, Mm)).
open_valve(Mm) :-
    field(Host, _),
    linked(Host),
    gateway(Agent),
    send(Agent, valve(Mm)),
    log(irrigated(Host, Mm)).
