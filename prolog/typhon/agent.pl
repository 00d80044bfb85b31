:- module(typhon_agent, []).

/** <module> What an agent is

The records of the agents that stand in this process.
This is the door of the layer: who is above takes what it needs from here.
*/

:- reexport(agent/agents,
            [ agent/5, agent_all_orders/2, agent_departs/3, agent_enter/5,
              agent_handles/2, agent_home/2, agent_id/3, agent_mail/2,
              agent_module/5, agent_name/3, agent_next_order/2,
              agent_order/2, agent_ordered/1, agent_put/3, agent_put_life/2,
              agent_ready/2, agent_remove/1, agent_state/2, agent_status/3,
              agent_take/2, attach_clauses/3, detach_clauses/2, with_agent/2
            ]).
:- reexport(agent/mailbox,
            [ mail_all/2, mail_back/2, mail_list/2, mail_take/2
            ]).
