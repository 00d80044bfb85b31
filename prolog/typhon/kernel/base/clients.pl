:- module(typhon_clients,
          [ clients_start/4,            % +Server, +Socket, +Most, :Serve
            clients_end/1,              % +Server
            client_becomes/1            % +State
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(socket),
              [ tcp_accept/3, tcp_close_socket/1, tcp_open_socket/3,
                tcp_setopt/2 ]).
:- use_module(crew, [crew_end/1, crew_start/4]).

/** <module> Threads for the clients of a server

Each client has a thread, up to a bound.  If there are as many, a client that
has not sent a whole request gives way to the newcomer: one of the address that
has most connections; of these, one between two requests before one in the
middle of a request; of these, the oldest.  So half requests can hold
connections only as long as no other client wants them, and clients of one
address do not displace those of others that have fewer.  If every client is
being served, the newcomer is sent away.

*Threading*: an acceptor, and a thread for each client.
*/

:- meta_predicate clients_start(+, +, +, 2).

:- dynamic
    client/5.                   % Server, Thread, Ip, Since, State

%!  clients_start(+Server, +Socket, +Most, :Serve) is det.
%!  clients_end(+Server) is det.
%
%   From now on call(Serve, In, Out) serves each client that connects to Socket,
%   Most at a time, in streams of bytes that are closed afterwards.  Serve says
%   how far it is by client_becomes/1; a new client is `reading`.  In is `none`
%   for a client that is to be sent away: Serve runs in the acceptor then and
%   must not wait.  clients_end/1 ends all threads of Server, a ground term; the
%   socket remains open.

clients_start(Server, Socket, Most, Serve) :-
    functor(Server, Name, _),
    crew_start(Server, Name,
               typhon_clients:accept_all(Server, Socket, Most, Serve), true).

clients_end(Server) :-
    crew_end(Server).

accept_all(Server, Socket, Most, Serve) :-
    repeat,
    catch(accept(Server, Socket, Most, Serve), error(Formal, _),
          accept_failed(Server, Formal)),
    fail.

accept_failed(Server, Formal) :-
    debug(typhon(clients), '~w: a client is lost: ~p', [Server, Formal]),
    sleep(0.1).                         % out of descriptors, most likely

accept(Server, Socket, Most, Serve) :-
    tcp_accept(Socket, Client, Ip),
    sig_atomic(admit(Server, Client, Ip, Most, Serve)).

admit(Server, Client, Ip, Most, Serve) :-
    open_streams(Client, In, Out),
    (   has_slot(Server, Most)
    ->  functor(Server, Name, _),
        catch(crew_start(Server, Name,
                         typhon_clients:serve(Server, Ip, Serve, In, Out),
                         typhon_clients:left(In, Out)),
              error(_, _),
              send_away(Serve, In, Out))
    ;   send_away(Serve, In, Out)
    ).

open_streams(Socket, In, Out) :-
    catch(( tcp_setopt(Socket, nodelay),
            tcp_open_socket(Socket, In, Out) ),
          error(Formal, Context),
          ( tcp_close_socket(Socket),
            throw(error(Formal, Context)) )),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)).

send_away(Serve, In, Out) :-
    catch(ignore(call(Serve, none, Out)), error(_, _), true),
    close_streams(In, Out).

close_streams(In, Out) :-
    catch(close(Out, [force(true)]), error(_, _), true),
    catch(close(In, [force(true)]), error(_, _), true).

serve(Server, Ip, Serve, In, Out) :-
    thread_self(Me),
    get_time(Now),
    assertz(client(Server, Me, Ip, Now, reading)),
    catch(ignore(call(Serve, In, Out)), error(Formal, _),
          debug(typhon(clients), '~w: a client goes: ~p', [Server, Formal])).

left(In, Out) :-
    thread_self(Me),
    retractall(client(_, Me, _, _, _)),
    close_streams(In, Out).

%!  client_becomes(+State) is semidet.
%
%   The client of this thread is `idle`, between two requests, `reading` one, or
%   `busy`: it is being served; or it is `apart`: it does not count any more.
%   Fails if it has had to give way.

client_becomes(State) :-
    sig_atomic(becomes(State)).

becomes(State) :-
    thread_self(Me),
    retract(client(Server, Me, Ip, _, _)),
    !,
    get_time(Now),
    assertz(client(Server, Me, Ip, Now, State)).

%   has_slot(+Server, +Most): fails if no client can give way.

has_slot(Server, Most) :-
    aggregate_all(count, ( client(Server, _, _, _, State0),
                           State0 \== apart ), Count),
    (   Count < Most
    ->  true
    ;   victim(Server, Thread),
        retract(client(Server, Thread, _, _, State)),
        gives_way(State, _)
    ->  catch(thread_signal(Thread, typhon_clients:give_way), error(_, _),
              true)
    ).

victim(Server, Victim) :-
    findall(rank(Free, Rank, Since)-Thread,
            ( client(Server, Thread, Ip, Since, State),
              gives_way(State, Rank),
              aggregate_all(count, client(Server, _, Ip, _, _), Held),
              Free is -Held ),
            Ranked),
    keysort(Ranked, [_-Victim|_]).

gives_way(idle, 0).
gives_way(reading, 1).

%   It may have been signalled before it began, or while it ended.

give_way :-
    thread_self(Me),
    (   client(_, Me, _, _, _)
    ->  true
    ;   throw(crew_end)
    ).
