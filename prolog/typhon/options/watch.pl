:- module(typhon_watching, []).

/** <module> Watching

What happens on hosts anywhere, as it happens.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(watch/watches, [watch/3, unwatch/1]).
:- use_module(watch/telling, []).
:- reexport('watch/overview').
:- reexport('watch/metrics').
