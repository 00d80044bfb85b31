:- module(typhon_cell, []).

/** <module> Cells: processes for agents of untrusted owners

The interface of the option cell(Kind) of hosts, see doc/security.md.  The
operating system isolates the process of a cell.  cells_list/1 lists these processes.
*/

:- use_module(cell/cell_hosts, []).
:- use_module(cell/gatekeeper, []).

:- reexport(cell/cells, [cells_list/1]).
