:- module(typhon_gpio, []).

/** <module> Pins of a board as services of a place

    :- use_module(library(typhon/gpio)).

    ?- host_start(alpha),
       gpio_start(alpha, [relay=output(17), door=input(4)], []).

Agents on alpha can then read and set pins by pin/2, and learn of their edges by
pin_watch/1.  See doc/boards.md.
*/

:- use_module(tools/user_errors, [user_errors/1]).
:- reexport(bridges/common/starting, [gpio_start/3, gpio_stop/1]).
:- use_module('bridges/gpio/service', []).

:- user_errors(typhon_gpio).
