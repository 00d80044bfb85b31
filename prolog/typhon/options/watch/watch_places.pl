:- module(typhon_watch_places,
          [ place_begin/3,              % +Watch, +Asked, -Events
            places_forget/1,            % +Watch
            place_at/4,                 % +Watch, ?Peer, ?State, -Endpoint
            place_cut/3,                % +Watch, +Endpoint, -Wanted
            place_answered/4,           % +Watch, +Endpoint, +Result, -Events
            place_due/3,                % +Watch, -Endpoint, -Again
            place_started/4,            % +Watch, +Peer, +Host, +Clock
            place_stopped/2             % +Watch, +Host
          ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../../kernel/base/monotonic', [deadline/2]).
:- use_module('../../kernel/host', [address_parts/3]).
:- use_module(event_sender, [time_at/2]).

/** <module> The processes that a watch receives events from

The places of a watch are the processes that have watched hosts; each is
identified by the endpoint to which requests are sent.  Peer is the address of
the endpoint of the process, by which it identifies itself.  State is

  | up                 | connected                                           |
  | cut(Pause)         | disconnected; a new request has been sent           |
  | down(Again, Pause) | no answer; send a new request at the time Again     |

After a connection has broken, the process gets a new request to watch.  If it
has no record of the watch, as after a restart, events are missing: the watch
reports all its earlier hosts as lost, and its present ones as started.

*Threading*: the thread of the watch.
*/

:- dynamic
    place/4,                    % Watch, Endpoint, Peer, Wanted
    state/3,                    % Watch, Endpoint, State
    runs/4.                     % Watch, Endpoint, Host, Clock: is running

first_pause(1).
longest_pause(60).

%!  place_begin(+Watch, +Asked, -Events:list) is det.
%!  places_forget(+Watch) is det.
%
%   Add a place to Watch, or remove all its places.  Asked is asked(Endpoint,
%   Wanted, Answer): Answer is that of the process, or gone(Hosts) for a process
%   of a network that has ended.  Events are to be reported.

place_begin(Watch, asked(Endpoint, Wanted, Answer), Events) :-
    (   Answer = watching(Peer, _, Hosts)
    ->  assertz(place(Watch, Endpoint, Peer, Wanted)),
        put_state(Watch, Endpoint, up),
        forall(member(Host-Clock, Hosts),
               assertz(runs(Watch, Endpoint, Host, Clock))),
        Events = []
    ;   Answer = gone(Hosts),
        findall(Event,
                ( member(Host, Hosts),
                  clock_of_others(Watch, Clock),
                  event_now(lost, Host, Clock, Event) ),
                Events)
    ).

%   Hosts of a network have the same clock, so a lost host has that of another.

clock_of_others(Watch, Clock) :-
    (   runs(Watch, _, _, Clock0)
    ->  Clock = Clock0
    ;   Clock = clock(0, 1)
    ).

places_forget(Watch) :-
    retractall(place(Watch, _, _, _)),
    retractall(state(Watch, _, _)),
    retractall(runs(Watch, _, _, _)).

put_state(Watch, Endpoint, State) :-
    retractall(state(Watch, Endpoint, _)),
    assertz(state(Watch, Endpoint, State)).

event_now(What, Host, Clock, event(Time, Host, none, What)) :-
    time_at(Clock, Time).

%!  place_at(+Watch, ?Peer, ?State, -Endpoint) is nondet.
%!  place_due(+Watch, -Endpoint, -Again) is nondet.
%
%   Endpoint is a place of Watch with Peer and State; a new request to it is due
%   at the time Again, in seconds.

place_at(Watch, Peer, State, Endpoint) :-
    place(Watch, Endpoint, Peer, _),
    state(Watch, Endpoint, State).

place_due(Watch, Endpoint, Again) :-
    state(Watch, Endpoint, down(Again, _)).

                /*******************************
                *         CUT AND LOST         *
                *******************************/

%!  place_cut(+Watch, +Endpoint, -Wanted) is det.
%!  place_answered(+Watch, +Endpoint, +Result, -Events:list) is det.
%
%   The place is disconnected: a new request for Wanted is to be sent to it.
%   The request has the Result of endpoint_request/4: Events are to be reported.

place_cut(Watch, Endpoint, Wanted) :-
    place(Watch, Endpoint, _, Wanted),
    !,
    (   state(Watch, Endpoint, down(_, Pause))
    ->  true
    ;   first_pause(Pause)
    ),
    put_state(Watch, Endpoint, cut(Pause)).

place_answered(Watch, Endpoint, answer(watching(_, New, Hosts)), Events) :-
    !,
    (   New == true
    ->  all_lost(Watch, Endpoint, Lost)
    ;   Lost = []
    ),
    put_state(Watch, Endpoint, up),
    findall(Event,
            ( member(Host-Clock, Hosts),
              newly_runs(Watch, Endpoint, Host, Clock),
              event_now(started, Host, Clock, Event) ),
            Started),
    append(Lost, Started, Events).
place_answered(Watch, Endpoint, _, Events) :-
    state(Watch, Endpoint, cut(Pause)),
    !,
    all_lost(Watch, Endpoint, Events),
    (   still_wanted(Watch, Endpoint, Events)
    ->  again_later(Watch, Endpoint, Pause)
    ;   retractall(place(Watch, Endpoint, _, _)),
        retractall(state(Watch, Endpoint, _))
    ).
place_answered(_, _, _, []).

newly_runs(Watch, Endpoint, Host, Clock) :-
    \+ runs(Watch, _, Host, _),
    assertz(runs(Watch, Endpoint, Host, Clock)).

all_lost(Watch, Endpoint, Events) :-
    findall(Event,
            ( runs(Watch, Endpoint, Host, Clock),
              event_now(lost, Host, Clock, Event) ),
            Events),
    retractall(runs(Watch, Endpoint, _, _)).

%   Another process may get the port later, so of a process of a network only
%   the hosts that were lost are requested again.

still_wanted(Watch, Endpoint, Lost) :-
    place(Watch, Endpoint, Peer, Wanted),
    !,
    (   Wanted == all
    ->  Lost = [_|_],
        findall(Name,
                ( member(event(_, Host, _, _), Lost),
                  address_parts(Host, Name, _) ),
                Names),
        retractall(place(Watch, Endpoint, _, _)),
        assertz(place(Watch, Endpoint, Peer, Names))
    ;   true
    ).

again_later(Watch, Endpoint, Pause) :-
    deadline(Pause, Again),
    longest_pause(Longest),
    Next is min(Longest, 2*Pause),
    put_state(Watch, Endpoint, down(Again, Next)).

%!  place_started(+Watch, +Peer, +Host, +Clock) is semidet.
%!  place_stopped(+Watch, +Host) is det.
%
%   Note that Host has started, or has stopped.  place_started/4 fails if Host
%   was already known as started.

place_started(Watch, Peer, Host, Clock) :-
    place(Watch, Endpoint, Peer, _),
    !,
    newly_runs(Watch, Endpoint, Host, Clock).

place_stopped(Watch, Host) :-
    retractall(runs(Watch, _, Host, _)).
