:- module(test_networks,
          [ with_network/4,             % +Topology, +Options, -Network, :Goal
            with_network/5,             % +Topology, +Options, -Network, -Hosts,
                                        % :Goal
            with_loaded_network/3,      % +File, -Network, :Goal
            with_logged_network/6       % +Topology, +Options, -Hosts, -File,
                                        % :Goal, -Events
          ]).
:- use_module(common, [no_leaks/1, with_tmp_dir/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(typhon)).

/** <module> Networks that run during a goal

*Threading*: the caller's thread.
*/

:- meta_predicate
    checked(0),
    running(0, -, 0),
    with_network(+, +, -, 0),
    with_network(+, +, -, -, 0),
    with_loaded_network(+, -, 0),
    with_logged_network(+, +, -, -, 0, -).

%!  with_network(+Topology, +Options, -Network, :Goal) is semidet.
%!  with_network(+Topology, +Options, -Network, -Hosts, :Goal) is semidet.
%
%   Calls Goal, which may stop Network itself, once. Nothing may be left
%   afterwards, unless hosts ran here before.

with_network(Topology, Options, Network, Goal) :-
    running(network_start(Topology, Network, Options), Network, Goal).

running(Start, Network, Goal) :-
    checked(setup_call_cleanup(Start, once(Goal), stopped(Network))).

%   Hosts that run before keep their connections to processes of the network.

checked(Goal) :-
    (   host_property(_, state(_))
    ->  once(Goal)
    ;   no_leaks(Goal)
    ).

stopped(Network) :-
    catch(network_stop(Network), error(existence_error(network, _), _), true).

with_network(Topology, Options, Network, Hosts, Goal) :-
    with_network(Topology, Options, Network,
                 ( network_property(Network, hosts(Hosts)), Goal )).

%!  with_loaded_network(+File, -Network, :Goal) is semidet.
%
%   As with_network/4, with the Network that was saved in File.

with_loaded_network(File, Network, Goal) :-
    running(network_load(File, Network, []), Network, Goal).

%!  with_logged_network(+Topology, +Options, -Hosts, -File, :Goal, -Events)
%!  is semidet.
%
%   Calls Goal once with the Hosts of a network that logs to File. Events are
%   those of the whole life of the network.

with_logged_network(Topology, Options, Hosts, File, Goal, Events) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'events.pl', File),
          with_network(Topology, [log(File)|Options], _, Hosts, Goal),
          log_events(File, Events) )).
