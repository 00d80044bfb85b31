:- module(test_vanishing_relay,
          [ vanishing_start/3,          % +Socket, -Relay, -Port
            vanishing_stop/1,           % +Relay
            vanishing_order/2           % +Relay, +Order
          ]).

/** <module> A server on a simulated machine that can vanish

The server listens at a Unix socket; see vanishing_relay.py, beside this file.

*Threading*: any thread.
*/

:- use_module(common, [project_file/2, python/1]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).

%!  vanishing_start(+Socket, -Relay, -Port) is det.
%!  vanishing_stop(+Relay) is det.
%
%   The server at the file Socket is reachable at Port of 127.0.0.1, too.

vanishing_start(Socket, relay(Pid, In, Out), Port) :-
    project_file('test/lib/vanishing_relay.py', File),
    python(Python),
    process_create(Python, [File, Socket],
                   [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]),
    read_line_to_string(Out, Line),
    number_string(Port, Line).

vanishing_stop(relay(Pid, In, Out)) :-
    close(In),
    close(Out),
    process_wait(Pid, exit(0)).

%!  vanishing_order(+Relay, +Order) is det.
%
%   Its machine does `vanish` or `return`, or its connections `break`.

vanishing_order(relay(_, In, Out), Order) :-
    format(In, '~w~n', [Order]),
    flush_output(In),
    read_line_to_string(Out, "done").
