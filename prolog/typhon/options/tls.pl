:- module(typhon_tls, []).

/** <module> TLS: the option tls(Directory) of hosts

It is loaded when the endpoint starts with this option, or where the
environment variable `TYPHON_TLS` is set; what refuses peers that have it is
there before.  This is the interface of the layer.
*/

:- use_module(tls/tls_mismatch, []).
