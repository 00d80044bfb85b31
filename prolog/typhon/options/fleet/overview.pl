:- module(typhon_fleet_overview,
          [ overview_of_fleet/3,        % +Fleet, +Addresses, -Hosts
            host_here/1                 % +Host
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module('../../kernel/host', [host/3]).
:- use_module(engine, [engine_script/4]).
:- use_module(members, [fleet_host/3, must_be_fleet/1]).

/** <module> The hosts of a fleet, with all that the engine has about them

*Threading*: any thread that may wait.
*/

%!  overview_of_fleet(+Fleet, +Addresses, -Hosts) is det.
%!  host_here(+Host) is semidet.
%
%   See fleet_overview/3 and fleet_here/1.

overview_of_fleet(Fleet, Addresses, Hosts) :-
    must_be_fleet(Fleet),
    engine_script(Fleet, overview, Addresses, Rows),
    maplist(row, Rows, Hosts).

row([Address0,Load0,State0,Since0,Parked|Tags0],
    host(Address, State, Load, Tags, Since, Parked)) :-
    maplist(atom_string, [Address,State|Tags], [Address0,State0|Tags0]),
    number_string(Load, Load0),
    (   Since0 == ""
    ->  Since = unknown
    ;   number_string(Milliseconds, Since0),
        Since is Milliseconds/1000.0
    ).

host_here(Name) :-
    (   fleet_host(Name, Fleet, _)
    ->  true
    ;   existence_error(fleet_of_host, Name)
    ),
    host(Name, Address, _),
    overview_of_fleet(Fleet, [Address], [host(Address, up, _, _, _, _)]).
