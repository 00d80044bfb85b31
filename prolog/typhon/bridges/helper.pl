:- module(typhon_helper, []).

/** <module> Helpers: processes that do for us what others do better

A helper is a process at the other end of two pipes, nearly always a Python
program that begins with `bridges/lib/helper.py`.  It knows a robot, a
broker or a middleware; we ask it, and it tells us what happens there.  This
is the door of the layer; it knows nothing of hosts and agents.

    ?- helper_python([], Python),
       helper_file('mqtt/bridge.py', File),
       helper_open(mqtt(alpha), command(Python, ['-u', File]),
                   [restart(always)]),
       helper_ask(mqtt(alpha), _{do:connect, url:URL}, 5, Answer).

Answer is ok(Reply), a dict or whatever JSON there is, or what went wrong,
see helper_ask/4.  What a helper says unasked, {"event": ...}, goes to the
hook typhon_helper_owner:heard(Name, Dict), and what one that was started
again has to be told first comes from the hook
typhon_helper_owner:again(Name, Request).  Names are ground terms of the
caller's choice, one for each helper.
*/

:- reexport(helper/owner, [json_value/1]).
:- reexport(helper/process, [helper_file/2, helper_python/2]).
:- reexport(helper/requests,
            [ helper_ask/4, helper_close/1, helper_failure/3, helper_note/2,
              helper_open/3, helper_pid/2, helper_tell/2 ]).
