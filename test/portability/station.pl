/* One host of the ring, in a process of its own:

       swipl -g station test/portability/station.pl -- NAME [text]

   prints its address and ends with its input. With `text`, it takes no
   records of any peer.
*/

:- use_module('../lib/common').
:- use_module(library(settings), [set_setting/2]).
:- use_module(library(typhon)).

% Other processes do not have these, and text must not depend on them.

:- op(700, xfx, ===>).
:- op(200, fy, prefix).

station :-
    current_prolog_flag(argv, [Name|Modes]),
    forall(member(text, Modes), set_setting(typhon_handshake:records, false)),
    station(Name),
    halt.

station(Name) :-
    project_file('test/portability/terms.pl', Terms),
    host_start(Name, [consult([Terms])]),
    host_property(Name, address(Address)),
    format('~w~n', [Address]),
    flush_output,
    read(user_input, _),
    host_stop(Name).
