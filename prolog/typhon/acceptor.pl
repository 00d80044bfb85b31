:- module(typhon_acceptor,
          [ accept_all/2                % +Socket, +Me
          ]).

/** <module> Taking connections

_Threading_: accept_all/2 is the goal of a crew thread, which is woken by a
signal: closing the socket would not wake it. Every client gets a thread of
its own, few at a time until they have proved themselves.
*/

:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(socket), [tcp_accept/3, tcp_close_socket/1]).
:- use_module(connection, [incoming/4]).
:- use_module(crew, [crew_spawn/2]).

:- setting(strangers, positive_integer, 32,
           "Connections at a time that have not proved themselves").

:- dynamic
    stranger/1.                         % Socket

%!  accept_all(+Socket, +Me)
%
%   Serve all who connect to Socket, Me being our hello, until stopped by
%   an exception of the crew.

accept_all(Socket, Me) :-
    repeat,
    catch(accept(Socket, Me), error(Formal, Context), report(Formal, Context)),
    fail.

accept(Socket, Me) :-
    tcp_accept(Socket, Client, ip(A, B, C, D)),
    sig_atomic(admit(Client, ip(A, B, C, D), Me)).

admit(Client, ip(A, B, C, D), Me) :-
    atomic_list_concat([A, B, C, D], '.', Ip),
    setting(strangers, Max),
    predicate_property(stranger(_), number_of_clauses(Count)),
    (   Count < Max
    ->  assertz(stranger(Client)),
        crew_spawn(serve(Client, Ip, Me), _)
    ;   tcp_close_socket(Client),
        print_message(warning, typhon(endpoint, turned_away(Ip, strangers)))
    ).

serve(Client, Ip, Me) :-
    Welcomed = retractall(stranger(Client)),
    call_cleanup(incoming(Client, Ip, Welcomed, Me), Welcomed).

%   Out of descriptors, most likely: they come back.

report(Formal, Context) :-
    print_message(error, error(Formal, Context)),
    sleep(0.1).
