:- module(typhon_snapshot, []).

/** <module> All that a process knows, at a moment

A network is saved so.  This is the interface of the layer: higher layers
import from here.
*/

:- reexport('snapshot/process_dump').
