:- module(typhon_travel, []).

/** <module> How agents and their mail get about

Transfers, which are transactions, and what is known of where agents went.
This is the door of the layer: who is above takes what it needs from here.
*/

:- reexport(travel/hop,
            [ hop/5, hop_clone/6, hop_given_up/2, hop_out_of_touch/1, hop_state/2
            ]).
:- use_module(travel/arrival, []).
:- reexport(travel/whereabouts,
            [ agent_born/2, agent_ended/3, outcome_wait/3, whereabouts/2
            ]).
:- reexport(travel/post, [post/3, post_via/4]).
