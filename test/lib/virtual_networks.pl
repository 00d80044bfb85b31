:- module(test_virtual_networks,
          [ network_shape/5,            % +Topology, +Options, -N, -Names, -Edges
            network_history/5           % +Topology, +Options, +Until, -Shape,
                                        % -Changes
          ]).
:- use_module(common, [with_tmp_dir/1]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(typhon)).

/** <module> Networks in virtual time, with numbers for hosts

*Threading*: one network at a time.
*/

%!  network_shape(+Topology, +Options, -N, -Names, -Edges) is det.
%
%   A network of Topology has N hosts with Names and these Edges, pairs I-J of
%   positions among the hosts.

network_shape(Topology, Options, N, Names, Edges) :-
    with_network(Topology, Options, shape(N, Names, Edges)).

:- meta_predicate with_network(+, +, 1).

with_network(Topology, Options, Goal) :-
    setup_call_cleanup(
        network_start(Topology, Network, [clock(virtual)|Options]),
        once(call(Goal, Network)),
        network_stop(Network)).

shape(N, Names, Edges, Network) :-
    numbered_hosts(Network, Hosts, Numbers),
    length(Hosts, N),
    maplist(name, Hosts, Names),
    numbered_edges(Network, Numbers, Edges).

name(Address, Name) :-
    atomic_list_concat([Name, _], @, Address).

numbered_hosts(Network, Hosts, Numbers) :-
    network_property(Network, hosts(Hosts)),
    findall(Host-I, nth1(I, Hosts, Host), Pairs),
    dict_pairs(Numbers, numbers, Pairs).

numbered_edges(Network, Numbers, Edges) :-
    network_property(Network, edges(Addresses)),
    findall(I-J,
            ( member(A-B, Addresses),
              get_dict(A, Numbers, I), get_dict(B, Numbers, J) ),
            Edges).

%!  network_history(+Topology, +Options, +Until, -Shape, -Changes) is det.
%
%   In a network of Topology the links change until the time Until.  Shape is
%   shape(N, First, Last): the number of hosts, and the edges at the beginning
%   and at the end; Changes are Time-link(I, J) and Time-unlink(I, J), I < J.

network_history(Topology, Options, Until, Shape, Changes) :-
    with_tmp_dir(history(Topology, Options, Until, Shape, Changes)).

history(Topology, Options, Until, shape(N, First, Last), Changes, Dir) :-
    directory_file_path(Dir, 'links.pl', File),
    with_network(Topology, [log(File, [links])|Options],
                 advanced(Until, N, Numbers, First, Last)),
    log_events(File, Events),
    findall(Time-Change,
            ( member(event(Time, Host, none, What), Events),
              Time > 0, Time < Until,
              numbered(What, Host, Numbers, Change) ),
            Changes).

advanced(Until, N, Numbers, First, Last, Network) :-
    numbered_hosts(Network, Hosts, Numbers),
    length(Hosts, N),
    numbered_edges(Network, Numbers, First),
    network_advance(Network, Until),
    numbered_edges(Network, Numbers, Last).

%   Both hosts report a change of their link.

numbered(What, Host, Numbers, Change) :-
    What =.. [Name, Other],
    get_dict(Host, Numbers, I),
    get_dict(Other, Numbers, J),
    I < J,
    Change =.. [Name, I, J].
