:- module(typhon_lifecycle, []).

/** <module> The lifecycle of agents

Agents are created, run in turns, take orders, and end.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(lifecycle/creation,
            [ agent_begin/4, agent_create/2, agent_create/3,
              agent_create_by/4 ]).
:- reexport(lifecycle/questions,
            [ agent_answer/3, agent_ask/4, agent_ask_here/4, agent_clone/2,
              agent_move/2, agent_move/3, agent_named/2, agent_resume/1,
              agent_send/2, order_give/3, payload_attach/2, payload_detach/2,
              question_answered/2 ]).
:- reexport('lifecycle/disposal').
:- reexport(lifecycle/ending,
            [ agent_end/2, agent_end/3, agent_join/3, agent_result/3,
              held_parts/3 ]).
:- reexport(lifecycle/orders, [order_take/2]).
:- reexport('lifecycle/turn').
