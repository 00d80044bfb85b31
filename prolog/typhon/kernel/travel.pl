:- module(typhon_travel, []).

/** <module> The travel of agents and messages

Agents and messages are transferred between hosts in transactions; the home of
an agent records where the agent is.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(travel/hop, [ hand_over/5, hop/6, hop_at_once/6, hop_clone/6,
                       transfer_parcel/2 ]).
:- reexport(travel/transfer,
            [ in_doubt/1, move_awaited/2, move_failed/2, move_over/2,
              out_of_touch/1, transfer_again/2, transfer_arrived/1,
              transfer_given_up/2, transfer_held/2, transfer_open/1,
              transfer_parked/1, transfer_stays/2, transfer_traveller/3 ]).
:- reexport(travel/arrival, [parcel_admit/3, parcel_returned/3]).
:- reexport(travel/whereabouts,
            [ agent_born/2, agent_ended/4, agent_ends/2, agent_faulty/5,
              agent_known_at/2, agent_outcome/2, agent_resumed/3,
              agent_resumed_from/3, end_noted/4, ended_agent/1, home_agents/1,
              home_agents_at/2, home_knows/4, outcome_wait/3, whereabouts/2 ]).
:- reexport(travel/outcomes, [clone_born/2, clones_ask/3, results_ask/4]).
:- reexport(travel/mail,
            [ mail_admit/3, mail_again/2, mail_lost/3, post/3, post_on/2,
              post_tried/0, post_via/4, retries_go_on/0 ]).
:- reexport(travel/sender_authorization,
            [ mail_accepted/5, peer_may_send_for/3, sender_accepted/1,
              senders_check/1, senders_checked/0, with_proof/5 ]).
:- reexport(travel/news, [news_carried/1, news_hurry/0, news_send/3]).
