:- module(typhon_agent, []).

/** <module> Agents

The records, modules, mailboxes and images of the agents in this process, and
the gate that an agent passes on its way into a host.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(agent/agents,
            [ agent/5, agent_claim/3, agent_comes/5,
              agent_enter/3, agent_gone/3, agent_handed/4, agent_here/5,
              agent_mail/2, agent_mobile/6, agent_move/5, agent_note/3,
              agent_on/2, agent_passes/6, agent_put/3,
              agent_put_life/2,
              agent_ready/2, agent_remove/3, agent_rest/3,
              agent_rests/3, agent_runs/1, agent_status/3,
              agent_take/3, agent_thawed/5, agent_under_way/6, agent_wakes/2,
              state_destroy/2 ]).
:- reexport(agent/agent_module,
              [ agent_add/2, agent_clauses/3, agent_code/2,
                agent_handles/2, agent_links/4, agent_module/4,
                agent_module/5, agent_relink/2, agent_build/5,
                agent_state/2, agent_state_mobile/3, agent_variant/2 ]).
:- reexport(agent/identity,
            [ agent_home/2, agent_home_endpoint/2, agent_id/3, agent_name/3,
              agent_origin/5, agents_passed/0, is_printable/1,
              must_be_agent_name/1, origin_inherited/3, origin_key/2,
              origin_passed/4, origin_said/2, with_agent/2 ]).
:- reexport(agent/life,
            [ agent_extras_load/1, agent_extras_missing/1, is_life/1,
              life_before/2, life_came/2, life_clone/3, life_goes/3, life_hop/3,
              life_hops/2,
              life_may_move/2,
              life_parent/2, life_payloads/2, life_extras/2,
              make_life/5, set_extras_of_life/3
            ]).
:- reexport('agent/gate').
:- reexport(agent/image,
            [ image_amended/5, image_clone/5, image_enter/4, image_entrant/2,
              image_hash/2, image_held/2, image_hop/6, image_label/2,
              image_module/3, program_missing/2, program_sent/3
            ]).
:- reexport('agent/fault').
:- reexport(agent/payloads,
              [ agent_attach/2, agent_detach/2, agent_payload/3, cloned_put/2,
                is_result_fact/1, no_result_facts/2, not_carried/2,
                payload_marks/2, result_facts/2, result_put/2 ]).
:- reexport(agent/mailbox,
            [ agent_order/2, agent_ordered/1, agent_orders/2, agent_unorder/2,
              mail_all/2, mail_back/2, mail_count/2, mail_list/2, mail_take/2,
              mail_waits/1 ]).
