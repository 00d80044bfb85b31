:- module(typhon_trails, []).

/** <module> Trails: which hosts have had an agent, and what they did with it

The option trail(Boolean) of hosts that have keys.  This is the interface of
the layer.
*/

:- use_module(trail/trail, []).
:- reexport(trail/trail_verified, [agent_trail/2]).
