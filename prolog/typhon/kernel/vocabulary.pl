:- module(typhon_language, []).

/** <module> What agents can say

The predicates that agents find on every host, and where they go next.
This is the interface of the layer: higher layers only load it.
*/

:- use_module(vocabulary/vocabulary, []).
