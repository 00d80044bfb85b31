:- module(typhon_identities, []).

/** <module> Identity: owners, births, signatures, authors and seals

The keys of processes and authors prove facts of agents.  All processes keep
signatures of programs, and agents find seal/3 on all hosts; the other modules
are loaded in processes that have keys.  This is the interface of the layer.
*/

:- reexport(identity/signatures, [file_sign/2]).
:- use_module(identity/seals, []).
