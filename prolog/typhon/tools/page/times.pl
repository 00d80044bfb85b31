:- module(typhon_page_times,
          [ times_start/0,
            times_stop/0,
            times_of/1,                 % +Hosts
            page_time/2,                % +Stamp, -Time
            page_time/3                 % +Host, +HostTime, -Time
          ]).
:- use_module(library(lists), [member/2]).

/** <module> One time for all that a page shows

Networks have clocks of their own.  A page has that of the network that it was
shown first, or else begins at 0 when it is started, and converts what other
clocks show.

*Threading*: any thread.
*/

:- dynamic
    reference/2,                % Epoch, Rate
    clock_of/3.                 % Host, Epoch, Rate

%!  times_start is det.
%!  times_stop is det.

times_start :-
    times_stop.

times_stop :-
    retractall(reference(_, _)),
    retractall(clock_of(_, _, _)).

%!  times_of(+Hosts) is det.
%
%   Hosts, as of survey_hosts/4, say what clocks they have.

times_of(Hosts) :-
    with_mutex(typhon_page_times,
               ( forall(member(Host, Hosts), note(Host)),
                 choose(Hosts) )).

note(host(Address, _, _, _, _, _, _, clock(Epoch, Rate))) =>
    (   clock_of(Address, Epoch, Rate)
    ->  true
    ;   retractall(clock_of(Address, _, _)),
        assertz(clock_of(Address, Epoch, Rate))
    ).
note(_) =>
    true.

%   That of hosts without a network, the time of day, says too much.  Virtual
%   time stands for itself.

choose(_) :-
    reference(_, _),
    !.
choose(Hosts) :-
    memberchk(host(_, _, _, _, _, _, _, virtual), Hosts),
    !.
choose(_) :-
    clock_of(_, Epoch, Rate),
    Epoch > 0,
    !,
    assertz(reference(Epoch, Rate)).
choose(_) :-
    get_time(Now),
    assertz(reference(Now, 1)).

%!  page_time(+Stamp, -Time) is det.
%!  page_time(+Host, +HostTime, -Time) is det.
%
%   Time of the page at Stamp, in real time, `null` if it has no clock that
%   goes on; or when the clock of Host, an address, shows HostTime.

page_time(Stamp, Time) :-
    reference(Epoch, Rate),
    !,
    Time is (Stamp-Epoch)*Rate.
page_time(_, null).

page_time(Host, HostTime, Time) :-
    reference(Epoch, Rate),
    clock_of(Host, Epoch1, Rate1),
    ( Epoch1 =\= Epoch ; Rate1 =\= Rate ),
    !,
    Time is (Epoch1+HostTime/Rate1-Epoch)*Rate.
page_time(_, Time, Time).
