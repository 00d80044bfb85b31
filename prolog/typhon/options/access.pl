:- module(typhon_access, []).

/** <module> Access: which processes may do what on a host

The options peer(Rules) and audit(File) of hosts.  This is the interface of
the layer.
*/

:- use_module(access/access_rules, []).
