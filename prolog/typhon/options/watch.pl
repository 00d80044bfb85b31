:- module(typhon_watching, []).

/** <module> Watching

What happens on hosts anywhere, as it happens.
This is the door of the layer: who is above takes what it needs from here.
*/

:- reexport(watch/watches, [watch/3, unwatch/1]).
:- use_module(watch/telling, []).
:- reexport('watch/overview').
:- reexport('watch/metrics').
