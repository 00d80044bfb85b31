:- module(typhon_language, []).

/** <module> What agents can say

The predicates that agents find on every host, and where they go next.
This is the door of the layer: who is above takes what it needs from here.
*/

:- use_module(language/vocabulary, []).
:- reexport(language/strategy).
:- reexport(language/pheromone).
