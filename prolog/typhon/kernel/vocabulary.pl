:- module(typhon_language, []).

/** <module> What agents can say

The predicates that agents find on every host, and where they go next.
This is the door of the layer: who is above needs no more of it than that it
is there.
*/

:- use_module(vocabulary/vocabulary, []).
