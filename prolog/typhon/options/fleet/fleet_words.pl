:- module(typhon_fleet_words, []).

/** <module> Options by which hosts and agents belong to a fleet

Without these options, and without fleet_join/2, nothing else of this layer is
loaded.
*/

:- multifile typhon_options:declared/4.

typhon_options:declared(host_option, fleet(X), atom, X).
typhon_options:declared(host_option, tags(X), list(atom), X).
