:- module(typhon_wire, []).

/** <module> The wire

Processes that know the same cookie, and what they say to each other, once
and in order.  Nothing here knows of agents.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(wire/endpoint,
            [ endpoint_address/1, endpoint_keys/1, endpoint_listen/2,
              endpoint_listen_end/1, endpoint_open/0, endpoint_process/1,
              endpoint_proof/1, endpoint_start/3, endpoint_start/4,
              endpoint_start_alone/1, endpoint_stop/0 ]).
:- reexport('wire/messaging').
:- reexport(wire/outbox, [frame_fits/1]).
:- reexport(wire/lending, [endpoint_afterwards/1]).
:- reexport('wire/call').
:- reexport('wire/inquiry').
:- reexport(wire/peers,
            [endpoint_flush/1, endpoint_flush/2, endpoint_gone/1,
             endpoint_lasting/1, endpoint_left/1,
             endpoint_missed/2, endpoint_peer/2]).
:- reexport(wire/contacts, [contact_expect/1, contact_expect_no_more/1]).
:- reexport('wire/proofs').
:- reexport(wire/frame, [mobile_term/1]).
:- reexport(wire/handshake, [cookie/1, random_hex/2]).
:- reexport(wire/text, [term_text/2, text_term/2]).
:- reexport(wire/refusals, [tls_text/2]).
