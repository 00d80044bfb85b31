:- module(typhon_tls, []).

/** <module> TLS: the option tls(Directory) of hosts

The module of TLS connections, typhon_secure, is loaded when the endpoint starts
with this option, or with the environment variable `TYPHON_TLS`.  This module,
the interface of the layer, serves also processes without TLS: it reports peers
that use TLS.

*Threading*: any thread; no state.
*/

:- multifile
    typhon_handshake:other_line/2,
    typhon_transport:first_byte/2,
    typhon_transport:misfit/4,
    typhon_transport:refusal/2.

typhon_transport:first_byte(0x16, tls).         % of each TLS record

%   The server sends this line to a client of the other kind.

typhon_transport:misfit(plain, tls, "typhon tls", tls(missing)).
typhon_transport:misfit(tls, plain, "typhon plain", tls(unknown)).

typhon_handshake:other_line("typhon tls", tls(wanted)).

                 /*******************************
                 *         DESCRIPTIONS         *
                 *******************************/

typhon_transport:refusal(tls(Why), Text) :-
    (   said(Why, Text0)
    ->  Text = Text0
    ;   flaw(Why, Flaw)
    ->  atom_concat('its certificate ', Flaw, Text)
    ;   Why = his(His),
        flaw(His, Flaw)
    ->  atom_concat('it reports that our certificate ', Flaw, Text)
    ;   format(atom(Text), 'TLS failed: ~p', [Why])
    ).

said(missing, 'it connects without TLS').
said(wanted, 'it requires TLS, and we have no keys').
said(unknown, 'it uses TLS, and we have no keys').
said(plain, 'it does not use TLS').
said('peer did not return a certificate', 'it sent no certificate').
said('unsupported protocol', 'it does not use TLS 1.3').
said('version too low', 'it does not use TLS 1.3').

flaw(expired, 'has expired').
flaw(revoked, 'is revoked').
flaw(wrong_use, 'is not a host certificate').
flaw(self_made, 'is self-signed').
flaw(foreign, 'was issued by another authority').
