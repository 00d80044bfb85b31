:- module(typhon_lifecycle, []).

/** <module> The lifecycle of agents

Agents are created, run in turns, take orders, and end.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(lifecycle/creation,
            [ agent_begin/4, agent_create/2, agent_create/3,
              agent_create_by/4, not_static/2 ]).
:- reexport('lifecycle/order_client').
:- reexport('lifecycle/disposal').
:- reexport(lifecycle/questions,
            [ agent_ask/4, agent_ask_here/4, agent_named/2,
              question_answered/2 ]).
:- reexport(lifecycle/ending,
            [agent_end/2, agent_end/3, held_parts/3]).
:- reexport(lifecycle/orders, [order_take/2]).
:- reexport('lifecycle/turn').
:- reexport('lifecycle/join').
