:- module(typhon_virtual_time, []).

/** <module> Virtual time

The runtime of hosts with the option clock(virtual).  This is the interface of
the layer.
*/

:- use_module(virtual/virtual, []).
