:- module(typhon_host_names,
          [ host_resolve/2,             % +Host, -Where
            host_address/2,             % +Host, -Address
            address_parts/3             % ?Address, ?Name, ?Endpoint
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module('../base/text', [is_printable/1]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_parts/3, must_be_endpoint/1]).
:- use_module(hosts, [host/3]).
:- use_module(links, [host_linked/1]).

/** <module> Names and addresses of hosts

Maps the name or address that a caller gives to the location of the host.  A
bare name is looked up first in this process, and then in the other processes
of the networks that this process started.

*Threading*: any thread.
*/

:- multifile
    elsewhere/2,                % ?Name, -Address: a host of a network that
                                % this process started
    typhon_names:known/2,
    prolog:error_message//1,
    error:has_type/2.

%   Completion proposes the hosts of other processes by their addresses.

typhon_names:known(host, Name) :-
    host(Name, _, _).
typhon_names:known(host, Address) :-
    host_linked(Address),
    \+ host(_, Address, _).

%!  address_parts(?Address, ?Name, ?Endpoint) is semidet.
%
%   Address is Name@Endpoint, where Endpoint is 'Interface:Port'.

address_parts(Address, Name, Endpoint) :-
    atom(Address),
    !,
    atomic_list_concat([Name,Endpoint], '@', Address),
    Name \== '',
    Endpoint \== ''.
address_parts(Address, Name, Endpoint) :-
    atomic_list_concat([Name,Endpoint], '@', Address).

error:has_type(host_address, Address) :-
    atom(Address),
    is_address(Address, _, Endpoint),
    endpoint_parts(Endpoint, _, _).

prolog:error_message(type_error(host_address, Address)) -->
    [ '~p is no address NAME@INTERFACE:PORT, with a name or an IPv4 \c
       address (IPv6 addresses are not supported)'-[Address] ].

is_address(Address, Name, Endpoint) :-
    address_parts(Address, Name, Endpoint),
    sub_atom(Endpoint, _, _, _, :),
    is_printable(Address),
    !.

%!  host_resolve(+Host, -Where) is det.
%
%   Where is local(Name) or remote(Address, Name, Endpoint).  Host is an
%   address, the name of a host of this process, or a name that only one host
%   of the networks that this process started has.
%
%   @error existence_error(host, Host)
%   @error domain_error(endpoint_address, Endpoint) of an address
%   @error ambiguous_host(Name, Addresses)

host_resolve(Host, _) :-
    \+ atom(Host),
    !,
    must_be(atom, Host).
host_resolve(Host, local(Host)) :-
    host(Host, _, _),
    !.
host_resolve(Host, local(Name)) :-
    host(Name, Host, _),
    !.
host_resolve(Host, remote(Host, Name, Endpoint)) :-
    is_address(Host, Name, Endpoint),
    !,
    must_be_endpoint(Endpoint).
host_resolve(Name, remote(Address, Name, Endpoint)) :-
    findall(Found, in_other_process(Name, Found), Found0),
    sort(Found0, Addresses),
    the_only(Addresses, Name, Address),
    address_parts(Address, _, Endpoint).

%   elsewhere/2 may still list a host of this process that is stopping.

in_other_process(Name, Address) :-
    elsewhere(Name, Address),
    address_parts(Address, _, Endpoint),
    \+ endpoint_address(Endpoint).

the_only([Address], _, Address) :-
    !.
the_only([], Name, _) :-
    existence_error(host, Name).
the_only([Address|Addresses], Name, _) :-
    throw(error(ambiguous_host(Name, [Address|Addresses]), _)).

%!  host_address(+Host, -Address) is det.
%
%   The address of Host, as in host_resolve/2.

host_address(Host, Address) :-
    host_resolve(Host, Where),
    where_address(Where, Address).

where_address(local(Name), Address) :-
    host(Name, Address, _).
where_address(remote(Address, _, _), Address).
