:- module(typhon_clocks,
          [ clock_set/3,                % +Host, +Epoch, +Rate
            clock_clear/1,              % +Host
            clock/3,                    % ?Host, ?Epoch, ?Rate
            host_time/2,                % +Host, -Seconds
            real_time/3                 % +Host, +Seconds, -Stamp
          ]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(time, [time_now/1]).

/** <module> The clocks of hosts

A host has a clock: host seconds are (real time - Epoch) * Rate.  The default,
epoch 0 and rate 1, is the time of day, but for what the clock of the computer
was set by.  Hosts of one network share epoch and rate, so that agents and experiments are written in host seconds and run as
fast as Rate says.

*Threading*: any thread.
*/

:- dynamic clock/3.             % Host, Epoch, Rate

%!  clock(?Host, ?Epoch, ?Rate) is nondet.
%
%   The clocks that clock_set/3 has set.

%!  clock_set(+Host, +Epoch, +Rate) is det.
%
%   Epoch is a time stamp in real seconds, Rate a positive number.

clock_set(Host, Epoch, Rate) :-
    must_be(number, Epoch),
    must_be(number, Rate),
    (   Rate > 0
    ->  true
    ;   domain_error(clock_rate, Rate)
    ),
    clock_clear(Host),
    assertz(clock(Host, Epoch, Rate)).

%!  clock_clear(+Host) is det.

clock_clear(Host) :-
    retractall(clock(Host, _, _)).

%!  host_time(+Host, -Seconds:float) is semidet.
%
%   The clock of Host shows Seconds. Fails if Host has no clock.

host_time(Host, Seconds) :-
    clock(Host, Epoch, Rate),
    time_now(Now),
    Seconds is (Now-Epoch)*Rate.

%!  real_time(+Host, +Seconds, -Stamp:float) is semidet.
%
%   Stamp is the real time at which the clock of Host shows Seconds.

real_time(Host, Seconds, Stamp) :-
    clock(Host, Epoch, Rate),
    Stamp is Epoch+Seconds/Rate.
