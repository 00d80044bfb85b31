:- module(typhon_node,
          [ node_main/0
          ]).

:- prolog_load_context(directory, Dir),
   file_directory_name(Dir, Library),
   asserta(user:file_search_path(library, Library)).

:- use_module(library(typhon), []).
:- use_module(library(debug), [debug/3]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(lists), [member/2]).
:- use_module(orders, [order_do/2]).
:- use_module(endpoint,
              [ endpoint_address/1, endpoint_reply/2 ]).
:- use_module(process, [process_acquire/2, process_release/1]).

/** <module> The main program of a process that carries hosts of a network

Started by the room `children` as `swipl -g node_main node.pl`. The first
line of standard input is node(Cookie, Interface, StopSeconds). When the
endpoint listens, one line is written:

    typhon_node <Interface>:<Port> <Pid>

From then on orders come over the wire, as requests of kind `node`. The
process stops in order, hosts first, then what is still to be sent, when
its standard input ends or on SIGTERM and SIGINT, and at the latest
StopSeconds later it is gone, whatever hangs.

*Threading*: the main thread carries orders out, one after the other; that
the process is alive the thread of the connection says itself. One thread
waits for the end of standard input, and one for the order to stop: it sees
to it that there is an end.
*/

:- multifile
    typhon_endpoint:requested/4.

%!  node_main
%
%   Never returns: the process ends.

node_main :-
    set_stream(user_input, encoding(utf8)),
    set_stream(user_output, encoding(utf8)),
    set_stream(user_output, buffer(line)),
    read_term(user_input, node(Cookie, Interface, Seconds), []),
    setenv('TYPHON_COOKIE', Cookie),
    thread_create(see_to_end(Seconds), _,
                  [alias(typhon_end), detached(true)]),
    on_signal(term, _, typhon_node:on_stop_signal),
    on_signal(int, _, typhon_node:on_stop_signal),
    process_acquire(node, [bind(Interface)]),
    endpoint_address(Endpoint),
    thread_create(watch_input, _, [detached(true)]),
    current_prolog_flag(pid, Pid),
    format('typhon_node ~w ~d~n', [Endpoint, Pid]),
    flush_output,
    serve,
    stop.

on_stop_signal(_) :-
    thread_send_message(typhon_end, stop).

%   Nothing more is expected on standard input but its end.

watch_input :-
    repeat,
    catch(get_char(user_input, Char), error(io_error(_, _), _),
          Char = end_of_file),
    Char == end_of_file,
    !,
    thread_send_message(typhon_end, stop).

see_to_end(Seconds) :-
    thread_get_message(stop),
    thread_send_message(main, stop),
    thread_self(Me),
    \+ thread_get_message(Me, never, [timeout(Seconds)]),
    current_prolog_flag(pid, Pid),
    process_kill(Pid, kill).

                /*******************************
                *            ORDERS            *
                *******************************/

typhon_endpoint:requested(node, alive, _, ReplyTo) :-
    !,
    endpoint_reply(ReplyTo, done(ok)).
typhon_endpoint:requested(node, Order, _, ReplyTo) :-
    thread_send_message(main, order(Order, ReplyTo)).

serve :-
    thread_get_message(Message),
    (   Message = order(Order, ReplyTo)
    ->  answer(Order, Answer),
        endpoint_reply(ReplyTo, Answer),
        serve
    ;   Message == stop
    ->  true
    ;   debug(typhon(network), 'unexpected message: ~p', [Message]),
        serve
    ).

%   The context of an error may hold what cannot travel: its text does.

answer(Order, Answer) :-
    catch(answer_(Order, Answer), Error, raised(Error, Answer)).

answer_(Order, Answer) :-
    (   order_do(Order, Value)
    ->  Answer = done(Value)
    ;   Answer = raised(system_error(failed(Order)), "")
    ).

raised(Error, raised(Formal, Text)) :-
    '$messages':translate_message(Error, Lines, []),
    with_output_to(string(Text),
                   print_message_lines(current_output, '', Lines)),
    (   Error = error(Formal, _)
    ->  true
    ;   Formal = system_error(Text)
    ).

stop :-
    order_do(stop, ok),
    process_release(node),
    halt(0).
