:- module(chaos_faults,
          [ scenario/3,                 % ?Name, -Share, -Description
            schedule/5,                 % +Scenario, +Seed, +Seconds, +Names,
                                        % -Events
            fault/1,                    % +Fault
            heal/1                      % +Scenario
          ]).

/** <module> The schedule of faults

A schedule is a list of Time-Event, ordered, times in seconds from the start.
It follows from the scenario, the seed, the seconds and the names of the
processes alone.  An event is a fault, or an order to the agents, see
chaos_work:

  | cut(P, How)            | close the connections that go to P: fin, rst   |
  | after(P, Way, Bytes)   | after so many more bytes                       |
  | hold(P, Way)           | let nothing through, until release(P, Way)     |
  | delay(P, Way, Seconds) | let it through later                           |
  | stop(P), cont(P)       | SIGSTOP, SIGCONT                               |
  | kill(P), start(P)      | SIGKILL; again, at the same address            |
  | busy(Seconds)          | a busy process beside them                     |

*Threading*: for the main thread.
*/

:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(random),
              [random/1, random_between/3, random_member/2]).
:- use_module(cluster).

%!  scenario(?Name, -Share, -Description) is nondet.
%
%   Share is its part of a hundred seconds when all scenarios run.

scenario(calm,   10, 'no faults at all').
scenario(cuts,   35, 'connections are cut, held and slowed down').
scenario(stops,  20, 'processes are stopped, too, and the machine is busy').
scenario(kills,  25, 'processes are killed, too, and started again').
scenario(deaths, 10, 'and one of them is not started again').

%   stream(?Scenario, ?Kind, -Pause): Pause is the average interval, in
%   seconds, between events of this Kind.

stream(cuts,   cut,   0.4).
stream(cuts,   after, 0.5).
stream(cuts,   hold,  2).
stream(cuts,   delay, 3).
stream(stops,  cut,   1).
stream(stops,  after, 2).
stream(stops,  stop,  1.5).
stream(stops,  busy,  10).
stream(kills,  cut,   1).
stream(kills,  after, 1).
stream(kills,  hold,  4).
stream(kills,  stop,  4).
stream(kills,  kill,  5).
stream(deaths, Kind,  Pause) :-
    stream(kills, Kind, Pause).
stream(_,      sprint, 2).
stream(_,      victim, 2).
stream(_,      order, 0.3).
stream(_,      look,  0.3).
stream(_,      tell,  0.2).

%!  schedule(+Scenario, +Seed, +Seconds, +Names, -Events) is det.

schedule(Scenario, Seed, Seconds, Names, Events) :-
    set_random(seed(Seed)),
    findall(Stream,
            ( stream(Scenario, Kind, Pause),
              times(0.5, Pause, Kind, Seconds, Names, Stream)
            ),
            Streams0),
    append(Streams0, Events0),
    death(Scenario, Seconds, Names, Events0, Events1),
    keysort(Events1, Events).

times(Now, Pause, Kind, Seconds, Names, Events) :-
    random(X),
    Time is Now+2*X*Pause,
    (   Time >= Seconds
    ->  Events = []
    ;   random_member(Name, Names),
        kind(Kind, Name, Time, Next, Events, Rest),
        times(Next, Pause, Kind, Seconds, Names, Rest)
    ).

%   kind(+Kind, +Name, +Time, -Next, -Events, ?Rest): a fault with a duration
%   has an end; the next fault of its kind comes after it.

kind(cut, P, T, T, [T-cut(P, How)|Rest], Rest) :-
    random_member(How, [fin,rst]).
kind(after, P, T, T, [T-after(P, Way, Bytes)|Rest], Rest) :-
    way(Way),
    random(X),
    Bytes is integer(10**(1+4*X)).
kind(hold, P, T, Next, [T-hold(P, Way),Next-release(P, Way)|Rest], Rest) :-
    way(Way),
    duration([0.1,0.5,1,2,7], D),
    Next is T+D.
kind(delay, P, T, Next,
     [T-delay(P, Way, Seconds),Next-delay(P, Way, 0)|Rest], Rest) :-
    way(Way),
    random_member(Seconds, [0.001,0.01,0.05]),
    duration([1,2,4], D),
    Next is T+D.
kind(stop, P, T, Next, [T-stop(P),Next-cont(P)|Rest], Rest) :-
    duration([0.1,0.3,1,2,6], D),
    Next is T+D.
kind(kill, P, T, Next,
     [T-kill(P),Back-start(P),Back-settlers(P)|Rest], Rest) :-
    duration([0.2,0.5,1,3,7], D),
    Back is T+D,
    Next is Back+1.
kind(busy, _, T, Next, [T-busy(5)|Rest], Rest) :-
    Next is T+10.
kind(sprint, P, T, T, [T-sprint(P, Journeys)|Rest], Rest) :-
    random_between(10, 200, Journeys).
kind(victim, P, T, T, [T-victim(P, Program),End-dispose(Q)|Rest], Rest) :-
    random_member(Program, [sprinter,sprinter,heavy]),
    random_member(Q, [P,any]),
    random(X),
    End is T+0.5+2*X.
kind(order, P, T, T, [T-order(P, X)|Rest], Rest) :-
    random(X).
kind(look, P, T, T, [T-look(P, X)|Rest], Rest) :-
    random(X).
kind(tell, P, T, T, [T-tell(P, X)|Rest], Rest) :-
    random(X).

way(Way) :-
    random_member(Way, [up,down]).

duration(Lengths, Duration) :-
    random_member(Longest, Lengths),
    random(X),
    Duration is X*Longest.

%   In `deaths` the last process dies in the middle, and is not restarted.

death(deaths, Seconds, Names, Events0, Events) :-
    !,
    append(_, [Name], Names),
    Half is Seconds/2,
    findall(Time-Event,
            ( member(Time-Event, Events0),
              \+ ( Event = start(Name), Time >= Half ),
              \+ ( Event = settlers(Name), Time >= Half ) ),
            Events1),
    Events = [Half-kill(Name)|Events1].
death(_, _, _, Events, Events).

                /*******************************
                *             DOING            *
                *******************************/

%!  fault(+Fault) is semidet.
%
%   Fails if Fault is none of the faults above.

fault(cut(P, How))       :- proxy([cut,P,How]).
fault(after(P, Way, N))  :- proxy([after,P,Way,N]).
fault(hold(P, Way))      :- proxy([hold,P,Way]).
fault(release(P, Way))   :- proxy([release,P,Way]).
fault(delay(P, Way, S))  :- proxy([delay,P,Way,S]).
fault(stop(P))           :- cluster_signal(P, stop).
fault(cont(P))           :- cluster_signal(P, cont).
fault(kill(P))           :- ( lives(P) -> cluster_kill(P) ; true ).
fault(start(P))          :- ( lives(P) -> true ; cluster_start(P) ).
fault(busy(Seconds))     :- cluster_busy(Seconds).

proxy(Words) :-
    cluster_proxy(Words, ok).

lives(Name) :-
    cluster_running(Names),
    memberchk(Name, Names).

%!  heal(+Scenario) is det.
%
%   End all faults, and restart dead processes, except in `deaths`.

heal(Scenario) :-
    proxy([heal]),
    cluster_names(Names),
    forall(member(Name, Names), fault(cont(Name))),
    (   Scenario == deaths
    ->  true
    ;   forall(member(Name, Names), fault(start(Name)))
    ).
