:- module(typhon_tls, []).

/** <module> TLS: the option tls(Directory) of hosts

This is the interface of the layer.
*/

:- use_module(tls/secure, []).
:- use_module(tls/tls_text, []).
