:- module(typhon_addresses,
          [ endpoint_parts/3,           % +Endpoint, -Interface, -Port
            must_be_endpoint/1,         % @Endpoint
            must_be_reachable/2,        % +Interface, +Advertised
            stands_for_all/1,           % +Interface
            announced/4                 % +Interface, +Advertised, +Port,
                                        % -Endpoint
          ]).
:- use_module(library(error), [must_be/2]).

/** <module> Addresses of endpoints

An endpoint is `Interface:Port`. Interface is a name or an IPv4 address: the
library(socket) of SWI-Prolog 9.0 has no IPv6.

*Threading*: any thread.
*/

%!  endpoint_parts(+Endpoint, -Interface, -Port) is semidet.

endpoint_parts(Endpoint, Interface, Port) :-
    atom(Endpoint),
    atomic_list_concat([Interface, PortText], :, Endpoint),
    is_interface(Interface),
    atom_number(PortText, Port),
    integer(Port),
    between(0, 65535, Port).

%   Hops check addresses: this one call strips all characters of names.

is_interface(Interface) :-
    Interface \== '',
    split_string(Interface, "",
                 "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ\c
                  0123456789-._",
                 [""]).

%!  must_be_endpoint(@Endpoint) is det.
%
%   @error domain_error(endpoint_address, Endpoint)

must_be_endpoint(Endpoint) :-
    endpoint_parts(Endpoint, _, _),
    !.
must_be_endpoint(Endpoint) :-
    outside(endpoint_address, Endpoint).

outside(Domain, Culprit) :-
    throw(error(domain_error(Domain, Culprit),
                context(_, 'write a name or an IPv4 address, and :PORT for a \c
                            port; IPv6 addresses are not supported'))).

%!  must_be_reachable(+Interface, +Advertised) is det.
%
%   Peers can reach an endpoint that listens at Interface and announces
%   Advertised, `Name` or `Name:Port`, or `none` if it announces Interface.
%
%   @error domain_error(interface, Interface)
%   @error domain_error(advertised_address, Advertised)
%   @error permission_error(announce, interface, Interface) if it stands for all
%   interfaces

must_be_reachable(Interface, Advertised) :-
    must_be(atom, Interface),
    must_be(atom, Advertised),
    (   is_interface(Interface)
    ->  true
    ;   outside(interface, Interface)
    ),
    (   Advertised == none
    ->  must_be_one(Interface)
    ;   advertised_name(Advertised, Name)
    ->  must_be_one(Name)
    ;   outside(advertised_address, Advertised)
    ).

advertised_name(Advertised, Name) :-
    (   endpoint_parts(Advertised, Name, Port)
    ->  Port > 0
    ;   is_interface(Advertised),
        Name = Advertised
    ).

must_be_one(Interface) :-
    \+ stands_for_all(Interface),
    !.
must_be_one(Interface) :-
    throw(error(permission_error(announce, interface, Interface),
                context(_, 'give advertise(Address) or --advertise=ADDRESS: \c
                            the name or address by which peers reach it'))).

%!  stands_for_all(+Interface) is semidet.
%
%   Interface is that of an address of zeros, as `0.0.0.0` or `0`.

stands_for_all(Interface) :-
    forall(sub_atom(Interface, _, 1, _, Char),
           memberchk(Char, ['0', '.', x, 'X'])).

%!  announced(+Interface, +Advertised, +Port, -Endpoint:atom) is det.
%
%   Endpoint is the address that peers get of an endpoint that listens at Port
%   of Interface.

announced(_, Advertised, _, Advertised) :-
    endpoint_parts(Advertised, _, _),
    !.
announced(Interface, Advertised, Port, Endpoint) :-
    (   Advertised == none
    ->  Name = Interface
    ;   Name = Advertised
    ),
    atomic_list_concat([Name, Port], :, Endpoint).
