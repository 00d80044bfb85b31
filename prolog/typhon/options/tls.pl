:- module(typhon_tls, []).

/** <module> TLS: the option tls(Directory) of hosts

What carries bytes by TLS, typhon_secure, is loaded when the endpoint starts
with this option, or where the environment variable `TYPHON_TLS` is set.  Here
is what a process without it needs: it reports peers that have TLS all the same.
This is the interface of the layer.

*Threading*: any thread; no state.
*/

:- multifile
    typhon_handshake:other_line/2,
    typhon_refusals:text/2,
    typhon_transport:first_byte/2,
    typhon_transport:misfit/4.

%   A TLS record begins with this. The line is for clients of the other kind.

typhon_transport:first_byte(0x16, tls).

typhon_transport:misfit(plain, tls, "typhon tls", tls(missing)).
typhon_transport:misfit(tls, plain, "typhon plain", tls(unknown)).

typhon_handshake:other_line("typhon tls", tls(wanted)).

                 /*******************************
                 *           IN WORDS           *
                 *******************************/

%   What is wrong with a peer.

typhon_refusals:text(tls(Why), Text) :-
    (   said(Why, Text0)
    ->  Text = Text0
    ;   flaw(Why, Flaw)
    ->  atom_concat('its certificate ', Flaw, Text)
    ;   Why = his(His),
        flaw(His, Flaw)
    ->  atom_concat('it says that our certificate ', Flaw, Text)
    ;   format(atom(Text), 'TLS failed: ~p', [Why])
    ).

said(missing, 'it speaks without TLS').
said(wanted, 'it wants TLS, and we have no keys').
said(unknown, 'it speaks TLS, and we have no keys').
said(plain, 'it does not speak TLS').
said('peer did not return a certificate', 'it shows no certificate').
said('unsupported protocol', 'it does not speak TLS 1.3').
said('version too low', 'it does not speak TLS 1.3').

flaw(expired, 'has expired').
flaw(revoked, 'is revoked').
flaw(wrong_use, 'is not that of a host').
flaw(self_made, 'is signed by itself').
flaw(foreign, 'is of another authority').
