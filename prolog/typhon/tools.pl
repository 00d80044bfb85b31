:- module(typhon_people, []).

/** <module> For people

Tables, and the texts of errors and reports.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(tools/inventory,
            [ host_report/2, inventory/4, inventory_agents/2,
              inventory_hosts/4 ]).
:- reexport(tools/supervision_tree, [supervision_tree/3]).
:- reexport(tools/event_text, [own_event/1]).
