:- module(typhon_cell, []).

/** <module> Cells: processes for agents of untrusted owners

The interface of the option cell(Kind) of hosts, see doc/security.md.
cells_list/1 lists the processes, which the operating system isolates.
*/

:- use_module(cell/cell_hosts, []).
:- use_module(cell/gatekeeper, []).

:- reexport(cell/cells, [cells_list/1]).
