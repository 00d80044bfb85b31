:- module(typhon_identities, []).

/** <module> Identity: owners, births, signatures, authors and seals

What the keys of processes and authors prove of agents.  Signatures of programs
are kept in all processes, and agents find seal/3 on all hosts; the rest is
loaded in processes that have keys.  This is the interface of the layer.
*/

:- reexport(identity/signatures, [file_sign/2]).
:- use_module(identity/seals, []).
