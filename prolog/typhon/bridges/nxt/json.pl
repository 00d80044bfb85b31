:- module(typhon_nxt_json, []).

/** <module> JSON for robots, and for who reads what they say

*Threading*: no state.
*/

:- reexport('../../kernel/base/json').
