:- module(typhon_watching, []).

/** <module> Watching

What happens on hosts anywhere, as it happens.
This is the door of the layer: who is above takes what it needs from here.
*/

:- reexport(watching/watches, [watch/3, unwatch/1]).
:- use_module(watching/telling, []).
:- reexport('watching/overview').
:- reexport('watching/metrics').
