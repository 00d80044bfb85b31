:- module(typhon_identities, []).

/** <module> Identity: owners, births, signatures, authors and seals

What the keys of processes and authors prove of agents.  This is the interface
of the layer.
*/

:- reexport(identity/signatures, [file_sign/2]).
:- use_module(identity/authors, []).
:- use_module(identity/owner, []).
:- use_module(identity/birth, []).
:- use_module(identity/speakers, []).
:- use_module(identity/seals, [seal/3, unseal/2]).

%   Agents find these on every host.

:- typhon_vocabulary:import(typhon_seals:seal/3).
:- typhon_vocabulary:import(typhon_seals:unseal/2).
