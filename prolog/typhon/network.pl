:- module(typhon_network, []).

/** <module> Networks

Many hosts in one or more processes, their links, and their log.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(network/networks,
            [network_start/3, network_stop/1, network_property/2]).
:- reexport(network/appointments, [network_advance/2, network_at/3]).
:- reexport(network/saving, [network_save/2]).
:- reexport(network/loading, [network_load/3]).
:- reexport(network/log, [log_server_start/2, log_server_stop/1]).
:- reexport(network/log_file, [log_events/2]).
