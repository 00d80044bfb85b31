:- module(typhon_helper, []).

/** <module> Helpers: external processes for tasks outside of Prolog

A helper is a process at the other end of two pipes, nearly always a Python
program that begins with `bridges/lib/helper.py`.  It communicates with a robot,
a broker or a middleware, answers requests and reports events.  This is the
interface of the layer, which is independent of hosts and agents.

    ?- helper_python([], Python),
       helper_file('mqtt/bridge.py', File),
       helper_open(mqtt(alpha), command(Python, ['-u', File]),
                   [restart(always)]),
       helper_ask(mqtt(alpha), _{do:connect, url:URL}, 5, Answer).

Answer is ok(Reply), a dict or another JSON value, or a description of the
error, see helper_ask/4; helper_call/5 raises errors.  Unsolicited messages of a
helper, {"event": ...}, are passed to the hook
typhon_helper_owner:handle_message(Name, Dict).  A restarted
helper first gets the requests of the hook typhon_helper_owner:again(Name,
Request).  Names are ground terms chosen by the caller, one for each helper.
*/

:- reexport(helper/process, [helper_file/2, helper_python/2]).
:- reexport(helper/requests,
            [ helper_ask/4, helper_call/5, helper_close/1, helper_note/2,
              helper_open/3, helper_pid/2, helper_send/2 ]).
