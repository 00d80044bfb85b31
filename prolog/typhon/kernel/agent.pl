:- module(typhon_agent, []).

/** <module> Agents

The records, modules, mailboxes and images of the agents in this process, and
the gate that an agent passes on its way into a host.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(agent/agents,
            [ agent/5, agent_claim/3, agent_enter/5, agent_enter/3,
              agent_extras_load/1, agent_extras_missing/1, agent_remove/3,
              agent_hand_over/4, agent_here/5, agent_mail/2, agent_mobile/6,
              agent_move/5, agent_note/3, agent_on/2, agent_replace/6,
              agent_put/3, agent_put_life/2, agent_ready/2, agent_remove/2,
              agent_rest/3, agent_rests/3, agent_departing/7, agent_status/3,
              agent_take/3, agent_thawed/5, agent_under_way/6, agent_wakes/2,
              is_life/1, life_before/2, life_clone/3, life_extras/2,
              life_hop/3, life_hops/2,
              life_may_move/2, life_parent/2, life_payloads/2, make_life/5,
              set_extras_of_life/3, set_payloads_of_life/3, state_destroy/2 ]).
:- reexport(agent/agent_module,
              [ agent_add/2, agent_clauses/3, agent_code/2, agent_declare/2,
                agent_handles/2, agent_links/4, agent_module/4,
                agent_module/5, agent_relink/2, agent_build/5,
                agent_state/2, agent_state_mobile/4, agent_variant/2 ]).
:- reexport('agent/identity').
:- reexport('base/text', [is_printable/1]).
:- reexport('agent/gate').
:- reexport('agent/image').
:- reexport('agent/results').
:- reexport(agent/mailbox,
            [ agent_order/2, agent_ordered/1, agent_orders/2, agent_unorder/2,
              mail_all/2, mail_back/2, mail_count/2, mail_fitting/4,
              mail_full/2, mail_list/2, mail_take/2, mail_waits/1 ]).
