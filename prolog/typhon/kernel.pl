:- module(typhon_kernel, []).

/** <module> The kernel alone

Hosts and agents without options, networks, bridges and most tools.  This part
runs in a Prolog without threads, sockets and processes, such as SWI-Prolog
compiled to WebAssembly.  There agents have their turns while the caller waits,
see agents_run/1 and typhon_single, and other processes cannot be reached.  In
a Prolog with threads it is library(typhon) without its top level.
*/

:- use_module(kernel/base/compiling, [compiling_begin/1, compiling_end/1]).

:- compiling_begin(Flags),
   nb_setval(typhon_flags, Flags).

:- use_module(tools/user_errors, [user_errors/1]).
:- reexport(tools/administration,
            [ host_change/2, host_property/2, link/2, link/3, unlink/2,
              remote/2, agent_change/2, agent_property/2 ]).
:- reexport(tools/checks, [agent_check/1, agent_check/2]).
:- reexport(tools/source_view, [agent_listing/1]).
:- reexport(kernel/host,
            [ host_start/1, host_start/2, host_stop/1, agents_run/1 ]).
:- reexport(kernel/lifecycle,
            [ agent_create/2, agent_create/3, agent_send/2,
              agent_move/2, agent_move/3, agent_clone/2, agent_resume/1,
              agent_dispose/1, agent_dispose/2, agent_join/3,
              agent_result/3, payload_attach/2, payload_detach/2
            ]).
:- use_module(kernel/vocabulary, []).
:- use_module(options/migration, []).
:- use_module(kernel/base/error_lines, []).
:- use_module(tools/messages, []).
:- use_module(tools/problem_text, []).
:- use_module(tools/event_text, []).

:- user_errors(typhon_kernel).

:- nb_getval(typhon_flags, Flags),
   compiling_end(Flags),
   nb_delete(typhon_flags).
