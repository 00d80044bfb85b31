:- module(typhon_lifecycle, []).

/** <module> How agents live

They are created, run from one effect to the next, take orders, and end.
This is the door of the layer: who is above takes what it needs from here.
*/

:- reexport(lifecycle/api).
:- use_module(lifecycle/evacuation, []).
