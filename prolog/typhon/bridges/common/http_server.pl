:- module(typhon_http_server,
          [ http_server_open/4,         % +Server, +Address, +Most, :Serve
            http_server_close/1,        % +Server
            client_becomes/1,           % +State
            http_head/4,                % +In, +Most, +Deadline, -Bytes
            http_before/2,              % +Deadline, +In
            with_bytes/3,               % :Write, -In, :Goal
            crew_start/4,               % +Owner, +Role, :Goal, :Release
            crew_end/1                  % +Owner
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [resource_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(memfile),
              [ free_memory_file/1, new_memory_file/1, open_memory_file/4 ]).
:- use_module(library(socket),
              [ tcp_accept/3, tcp_bind/2, tcp_close_socket/1,
                tcp_listen/2, tcp_open_socket/2, tcp_open_socket/3,
                tcp_setopt/2, tcp_socket/1 ]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../kernel/base/error_text', [is_abort/1]).
:- use_module('../../kernel/base/options', [blaming/2]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).

/** <module> HTTP server for untrusted clients

Servers of library(http/thread_httpd) do not bound the head of a request, and
their timeouts apply to one wait, not to a whole request.  So this module has
its own threads, heads and bodies; the library parses a head from memory.

Each client has a thread, up to a maximum.  At the maximum, a new client
displaces a client that has not sent a whole request.  It is chosen among the
clients of the address with most connections; there, a client between two
requests before a client in the middle of a request; and among these, the
oldest.  So incomplete requests occupy connections only while no other client
needs them, and clients of one address do not displace those of an address with
fewer.  If every client is being served, the new one is refused.

The threads of one owner are a crew, which ends with its owner.  A thread of a
crew that ends earlier is detached.

*Threading*: an acceptor, and a thread for each client.
*/

:- meta_predicate
    http_server_open(+, +, +, 2),
    with_bytes(1, -, 0).

:- dynamic
    listens/2,                  % Server, Socket
    client/5.                   % Server, Thread, Ip, Since, State

%!  http_server_open(+Server, +Address, +Most, :Serve) is det.
%!  http_server_close(+Server) is det.
%
%   Start Server, a ground term, at Address, Interface:Port.  For each client,
%   at most Most at a time, call(Serve, In, Out) runs on byte streams, which are
%   closed afterwards.  Serve reports its progress by client_becomes/1; a new
%   client is `reading`.  For a client to be refused In is `none`: then Serve
%   runs in the acceptor and must not wait.  http_server_close/1 ends all
%   threads of Server.
%
%   @error socket_error(Code, Message)

http_server_open(Server, Interface:Port, Most, Serve) :-
    tcp_socket(Socket),
    catch(( tcp_setopt(Socket, reuseaddr),
            blaming(port(Port), tcp_bind(Socket, Interface:Port)),
            tcp_listen(Socket, 64),
            close_on_exec(Socket),
            functor(Server, Name, _),
            crew_start(Server, Name,
                       typhon_http_server:accept_all(Server, Socket, Most,
                                                     Serve),
                       true) ),
          Ball,
          ( tcp_close_socket(Socket), throw(Ball) )),
    assertz(listens(Server, Socket)).

%   A process that is started later must not inherit the socket: it would occupy
%   the port as long as it runs.

close_on_exec(Socket) :-
    tcp_open_socket(Socket, Stream),
    set_stream(Stream, close_on_exec(true)).

http_server_close(Server) :-
    (   retract(listens(Server, Socket))
    ->  crew_end(Server),
        tcp_close_socket(Socket)
    ;   true
    ).

                /*******************************
                *            CLIENTS           *
                *******************************/

accept_all(Server, Socket, Most, Serve) :-
    set_prolog_flag(stream_type_check, loose), % library(http) needs that; the
    repeat,                             % threads of clients inherit it
    catch(accept(Server, Socket, Most, Serve), error(Formal, _),
          accept_failed(Server, Formal)),
    fail.

accept_failed(Server, Formal) :-
    debug(typhon(clients), '~w: a client is lost: ~p', [Server, Formal]),
    sleep(0.1).                         % probably out of file descriptors

accept(Server, Socket, Most, Serve) :-
    tcp_accept(Socket, Client, Ip),
    sig_atomic(admit(Server, Client, Ip, Most, Serve)).

admit(Server, Client, Ip, Most, Serve) :-
    open_streams(Client, In, Out),
    (   has_slot(Server, Most)
    ->  functor(Server, Name, _),
        catch(crew_start(Server, Name,
                         typhon_http_server:serve(Server, Ip, Serve, In, Out),
                         typhon_http_server:client_ended(In, Out)),
              error(_, _),
              refuse_client(Serve, In, Out))
    ;   refuse_client(Serve, In, Out)
    ).

open_streams(Socket, In, Out) :-
    catch(( tcp_setopt(Socket, nodelay),
            tcp_open_socket(Socket, In, Out) ),
          error(Formal, Context),
          ( tcp_close_socket(Socket),
            throw(error(Formal, Context)) )),
    forall(member(Stream, [In, Out]),
           ( set_stream(Stream, encoding(octet)),
             set_stream(Stream, newline(posix)),
             set_stream(Stream, close_on_exec(true)) )).

refuse_client(Serve, In, Out) :-
    catch(ignore(call(Serve, none, Out)), error(_, _), true),
    close_streams(In, Out).

close_streams(In, Out) :-
    catch(close(Out, [force(true)]), error(_, _), true),
    catch(close(In, [force(true)]), error(_, _), true).

serve(Server, Ip, Serve, In, Out) :-
    thread_self(Me),
    monotonic_time(Now),
    assertz(client(Server, Me, Ip, Now, reading)),
    catch(ignore(call(Serve, In, Out)), error(Formal, _),
          debug(typhon(clients), '~w: a client goes: ~p', [Server, Formal])).

client_ended(In, Out) :-
    thread_self(Me),
    retractall(client(_, Me, _, _, _)),
    close_streams(In, Out).

%!  client_becomes(+State) is semidet.
%
%   Set the state of the client of this thread:
%
%     - `idle`: between two requests
%     - `reading`: in the middle of a request
%     - `busy`: being served
%     - `apart`: no longer counted, nor displaced
%
%   Fails if the client has been displaced.

client_becomes(State) :-
    sig_atomic(becomes(State)).

becomes(State) :-
    thread_self(Me),
    retract(client(Server, Me, Ip, _, _)),
    !,
    monotonic_time(Now),
    assertz(client(Server, Me, Ip, Now, State)).

%   has_slot(+Server, +Most): fails if no client can be displaced.

has_slot(Server, Most) :-
    aggregate_all(count, ( client(Server, _, _, _, State0),
                           State0 \== apart ), Count),
    (   Count < Most
    ->  true
    ;   victim(Server, Thread),
        retract(client(Server, Thread, _, _, State)),
        gives_way(State, _)
    ->  catch(thread_signal(Thread, typhon_http_server:end_if_displaced),
              error(_, _), true)
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

%   The signal may have arrived before the client began, or while it ended.

end_if_displaced :-
    thread_self(Me),
    (   client(_, Me, _, _, _)
    ->  true
    ;   throw(crew_end)
    ).

                /*******************************
                *       HEADS AND BODIES       *
                *******************************/

%!  http_before(+Deadline, +In) is det.
%
%   Set the timeout of In to the time left until Deadline.  With `none` the
%   caller limits the time.
%
%   @error timeout_error(read, In)

http_before(none, _) :-
    !.
http_before(Deadline, In) :-
    monotonic_time(Now),
    Left is Deadline-Now,
    (   Left > 0
    ->  set_stream(In, timeout(Left))
    ;   throw(error(timeout_error(read, In), _))
    ).

%!  http_head(+In, +Most, +Deadline, -Bytes:list) is semidet.
%
%   Bytes are the head of a request: all bytes up to and including an empty
%   line. Fails at the end of In.
%
%   @error resource_error(http_head) if there are more than Most bytes,
%   timeout_error(read, In)

http_head(In, Most, Deadline, Bytes) :-
    head(In, Most, 0'\n, Deadline, Bytes).

%   Last is the previous byte other than a carriage return.

head(In, Most, Last, Deadline, [Byte|Bytes]) :-
    http_before(Deadline, In),
    get_byte(In, Byte),
    Byte \== -1,
    (   Most =:= 0
    ->  resource_error(http_head)
    ;   Byte == 0'\n,
        Last == 0'\n
    ->  Bytes = []
    ;   ( Byte == 0'\r -> Next = Last ; Next = Byte ),
        Most1 is Most-1,
        head(In, Most1, Next, Deadline, Bytes)
    ).

%!  with_bytes(:Write, -In, :Goal) is semidet.
%
%   Run Goal once; the stream In has the bytes that call(Write, Out) writes.

with_bytes(Write, In, Goal) :-
    setup_call_cleanup(
        new_memory_file(File),
        ( setup_call_cleanup(
              open_memory_file(File, write, Out, [encoding(octet)]),
              call(Write, Out),
              close(Out)),
          setup_call_cleanup(
              open_memory_file(File, read, In, [encoding(octet)]),
              once(Goal),
              close(In)) ),
        free_memory_file(File)).

                /*******************************
                *     THREADS OF AN OWNER      *
                *******************************/

:- meta_predicate crew_start(+, +, 0, 0).

:- dynamic crew/2.                      % Owner, Thread

%!  crew_start(+Owner, +Role:atom, :Goal, :Release) is det.
%
%   Run Goal in a new thread of the crew of Owner.  Release runs when the thread
%   ends, even if it has not reached Goal.
%
%   @error the errors of thread_create/3

crew_start(Owner, Role, Goal, Release) :-
    flag(typhon_crew, Number, Number+1),
    atomic_list_concat([typhon, Role, Number], '_', Alias),
    sig_atomic(create(Owner, Goal, Release, Alias)).

create(Owner, Goal, Release, Alias) :-
    thread_create(typhon_http_server:work(Goal), Thread,
                  [ alias(Alias), at_exit(Release) ]),
    assertz(crew(Owner, Thread)),
    thread_send_message(Thread, crew_begin).

work(Goal) :-
    call_cleanup(
        catch(( thread_get_message(crew_begin),
                ignore(Goal) ),
              Ball,
              report_end(Ball)),
        release_thread).

report_end(crew_end) :-
    !.
report_end(Ball) :-
    is_abort(Ball),
    !.
report_end(Ball) :-
    print_message(error, Ball).

%   Exactly one thread retracts the fact, and that one detaches or joins the
%   thread.

release_thread :-
    thread_self(Me),
    (   retract(crew(_, Me))
    ->  thread_detach(Me)
    ;   true
    ).

%!  crew_end(+Owner) is det.
%
%   End and join all threads of the crew of Owner, also busy ones.

crew_end(Owner) :-
    in_own_thread(typhon_http_server:end_all(Owner)).

end_all(Owner) :-
    findall(Thread, crew(Owner, Thread), Threads),
    forall(( member(Thread, Threads), retract(crew(Owner, Thread)) ),
           end(Thread, 0.001)),
    (   crew(Owner, _)
    ->  end_all(Owner)
    ;   true
    ).

%   A signal that arrives just before a thread blocks does not wake it, so the
%   signal is repeated.

end(Thread, Wait) :-
    (   thread_property(Thread, status(running))
    ->  catch(thread_signal(Thread, typhon_http_server:end_once),
              error(_, _), true),
        sleep(Wait),
        Wait1 is min(0.1, 2*Wait),
        end(Thread, Wait1)
    ;   thread_join(Thread, _)
    ).

end_once :-
    (   nb_current(typhon_crew_ending, true)
    ->  true
    ;   nb_setval(typhon_crew_ending, true),
        throw(crew_end)
    ).
