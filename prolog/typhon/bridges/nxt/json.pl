:- module(typhon_nxt_json, []).

/** <module> JSON for robots

*Threading*: no state.
*/

:- reexport('../../kernel/base/json').
