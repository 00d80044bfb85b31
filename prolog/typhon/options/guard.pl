:- module(typhon_guard, []).

/** <module> Guards: hosts that check what untrusted agents call

The option policy(Policy) of hosts, see doc/security.md.  This is the interface
of the layer.
*/

:- use_module(guard/sandbox, []).
