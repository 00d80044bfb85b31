:- module(typhon_wire, []).

/** <module> The wire

Processes that have the same cookie exchange terms, each once and in order.
This layer does not know of agents.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(wire/addresses, [endpoint_parts/3, must_be_endpoint/1]).
:- reexport(wire/endpoint,
            [ endpoint_address/1, endpoint_ask_all/6, endpoint_call/5,
              endpoint_hand/4, endpoint_listen/2, endpoint_listen_end/1,
              endpoint_open/0, endpoint_option/1, endpoint_post/3,
              endpoint_post_by/4, endpoint_post_up/3, endpoint_process/1,
              endpoint_request/4, endpoint_start/4, endpoint_start_alone/1,
              endpoint_stop/0 ]).
:- reexport(wire/session,
            [ endpoint_hand_over/2, endpoint_hand_to/2, endpoint_handed/2,
              frame_fits/1 ]).
:- reexport(wire/request,
            [endpoint_later/1, endpoint_reply/2, endpoint_reply_later/2]).
:- reexport(wire/kinds, [arrival_permitted/4, right/3]).
:- reexport(wire/reader, [endpoint_afterwards/1]).
:- reexport(wire/connection_manager, [endpoint_flush/1, endpoint_flush/2]).
:- reexport(wire/peer_cache,
            [ peer_expect/1, peer_expect_no_more/1, endpoint_gone/1,
              endpoint_lasting/1, endpoint_left/1, endpoint_missed/2,
              endpoint_peer/2, endpoint_proof/2 ]).
:- reexport(wire/frame, [mobile_term/1]).
:- reexport(wire/handshake, [cookie/1, cookie_given/1, random_hex/2]).
:- reexport(wire/threads, [manager_notify/1]).
:- reexport(wire/transport,
            [ endpoint_own_proof/1, line_read/3, line_write/2, refusal_text/2,
              transport_disagrees/1, transport_octets/1 ]).
