:- module(typhon_watched,
          [ watched_places/2            % +Hosts, -Places
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module('../../kernel/wire', [endpoint_address/1]).
:- use_module('../../kernel/host', [address_parts/3, host_resolve/2]).
:- use_module('../../network', [network_hosts/2]).

/** <module> Which hosts are to be watched, and where they are

*Threading*: any thread.
*/

%!  watched_places(+Hosts, -Places) is det.
%
%   Hosts is a host, name or address, a network, or a list of such.  Places
%   are place(Endpoint, Wanted, Whose): Wanted is `all` where the process
%   carries hosts of a network and nothing else, otherwise a list of names.
%   Whose is carried(Addresses), the hosts of a network, or asked(Hosts), pairs
%   Name-Host of what was asked for and has to be there.
%
%   @error existence_error(host, Host), ambiguous_host(Name, Addresses)

watched_places(Hosts, Places) :-
    listed(Hosts, List),
    findall(Endpoint-What,
            ( member(One, List), watched(One, Endpoint, What) ),
            Pairs0),
    sort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    findall(place(Endpoint, Wanted, Whose),
            ( member(Endpoint-Whats, Groups),
              wanted(Whats, Wanted),
              whose(Whats, Whose) ),
            Places).

listed(Hosts, Hosts) :-
    is_list(Hosts),
    !.
listed(Host, [Host]).

watched(One, Endpoint, What) :-
    must_be(atom, One),
    (   hosts_of_network(One, Addresses)
    ->  member(Address, Addresses),
        address_parts(Address, Name, Endpoint),
        (   endpoint_address(Endpoint)
        ->  What = part(Name)
        ;   What = carried(Address)
        )
    ;   host_resolve(One, Where),
        at(Where, One, Endpoint, What)
    ).

hosts_of_network(Network, Addresses) :-
    catch(network_hosts(Network, Addresses),
          error(existence_error(network, _), _),
          fail).

at(local(Name), One, Endpoint, host(Name, One)) :-
    endpoint_address(Endpoint),
    !.
at(remote(Address, Name, Endpoint), _, Endpoint, host(Name, Address)).

wanted(Whats, Wanted) :-
    (   memberchk(carried(_), Whats)
    ->  Wanted = all
    ;   findall(Name,
                ( member(host(Name, _), Whats)
                ; member(part(Name), Whats) ),
                Names),
        sort(Names, Wanted)
    ).

whose(Whats, Whose) :-
    findall(Name-Host, member(host(Name, Host), Whats), Asked),
    (   Asked == []
    ->  findall(Address, member(carried(Address), Whats), Addresses),
        Whose = carried(Addresses)
    ;   Whose = asked(Asked)
    ).
