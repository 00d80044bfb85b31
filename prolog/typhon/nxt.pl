:- module(typhon_nxt, []).

/** <module> LEGO Mindstorms NXT robots

    :- use_module(library(typhon/nxt)).

The whole interface to NXT bricks with LEGO's firmware, on a serial line
(Bluetooth) or TCP.  It is not part of library(typhon), and needs Python 3
with pyserial.  Nothing is defined here: see the modules in bridges/nxt/.

  | connection, sounds, display | typhon/bridges/nxt/brick       |
  | motors                      | typhon/bridges/nxt/motors      |
  | sensors                     | typhon/bridges/nxt/sensors     |
  | files and programs          | typhon/bridges/nxt/files       |
  | the names of SWI-PRO-NXT    | typhon/bridges/nxt/swi_pro_nxt |
*/

:- use_module(kernel/base/on_demand, []).
:- use_module(bridges/common/error_texts, []).
:- use_module(tools/user_errors, [user_errors/1]).
:- use_module(tools/old_settings, []).
:- reexport('bridges/nxt/brick').
:- reexport('bridges/nxt/motors').
:- reexport('bridges/nxt/sensors').
:- reexport('bridges/nxt/files').
:- if(exists_source(bridges/nxt/swi_pro_nxt)).
:- reexport('bridges/nxt/swi_pro_nxt').
:- endif.

:- user_errors(typhon_nxt).
