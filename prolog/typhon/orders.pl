:- module(typhon_orders,
          [ order_do/2                  % +Order, -Answer
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(endpoint, [endpoint_flush/2]).
:- use_module(host, [host_link/2, host_neighbours/2, host_unlink/2]).
:- use_module(hosting, [host_property/2, host_start/2, host_stop/1]).

/** <module> What a network asks of a process that carries its hosts

The same orders are done by direct call for hosts of this process and by
request in a child. Whole lists go in one order: a network of a thousand
hosts is a few requests.

*Threading*: any thread.
*/

%!  order_do(+Order, -Answer) is det.
%
%   Orders and their answers:
%
%     - hosts(Specs)
%       Starts a host for each Name-Options, or none. Answer is the list
%       of their addresses.
%     - stop(Names)
%       Stops these hosts; `ok`. One that is gone already is no error.
%     - stop
%       Stops all hosts of the process; `ok`.
%     - flush(Seconds, Peers)
%       `ok` when all that the process has sent to the endpoints Peers has
%       arrived, else `late`.
%     - link(Pairs), unlink(Pairs)
%       One direction of a link for each Name-Address; `ok`.
%     - neighbours(Names)
%       Answer is the list of their lists of neighbours; `[]` for a host
%       that is gone.
%
%   @error what host_start/2 throws

order_do(hosts(Specs), Addresses) :-
    start_all(Specs, []),
    findall(Address,
            ( member(Name-_, Specs), host_property(Name, address(Address)) ),
            Addresses).
order_do(stop(Names), ok) :-
    forall(member(Name, Names), stop_host(Name)).
order_do(stop, ok) :-
    findall(Name, host_property(Name, address(_)), Names),
    order_do(stop(Names), ok).
order_do(flush(Seconds, Peers), Answer) :-
    (   endpoint_flush(Seconds, Peers)
    ->  Answer = ok
    ;   Answer = late
    ).
order_do(link(Pairs), ok) :-
    forall(member(Name-Address, Pairs), host_link(Name, Address)).
order_do(unlink(Pairs), ok) :-
    forall(member(Name-Address, Pairs), host_unlink(Name, Address)).
order_do(neighbours(Names), Lists) :-
    maplist(host_neighbours, Names, Lists).

start_all([], _).
start_all([Name-Options|Specs], Started) :-
    catch(host_start(Name, Options), Error, true),
    (   var(Error)
    ->  start_all(Specs, [Name|Started])
    ;   forall(member(Host, Started), stop_host(Host)),
        throw(Error)
    ).

stop_host(Name) :-
    catch(host_stop(Name), error(existence_error(host, _), _), true).
