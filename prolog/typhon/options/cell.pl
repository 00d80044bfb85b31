:- module(typhon_cell, []).

/** <module> Cells: the system's wall around agents of untrusted owners

The option cell(Kind) of hosts, see doc/security.md.  This is the interface of
the layer.
*/

:- use_module(cell/cell_hosts, []).
:- use_module(cell/gatekeeper, []).
