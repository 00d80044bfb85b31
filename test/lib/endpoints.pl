:- module(test_endpoints,
          [ with_endpoint/1,            % :Goal
            with_endpoint/2,            % +Options, :Goal
            endpoint_port/1,            % -Port
            port_of/2,                  % +Address, -Port
            with_client/3,              % -In, -Out, :Goal
            with_listener/3,            % +Queue, -Address, :Goal
            with_peer_process/2,        % -Address, :Goal
            with_peer_process/5         % +Options, -Pid, -InOut, -Address,
                                        % :Goal
          ]).

/** <module> An endpoint in this process, and what connects to it

*Threading*: one test at a time.
*/

:- use_module(common, [no_leaks/1, project_file/2, with_swipl/5]).
:- use_module(library(option), [option/3]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(socket),
              [ tcp_bind/2, tcp_close_socket/1, tcp_connect/2, tcp_listen/2,
                tcp_open_socket/3, tcp_socket/1 ]).
:- use_module(library(typhon/kernel/wire),
              [endpoint_address/1, endpoint_start/4, endpoint_stop/0]).

:- meta_predicate
    with_endpoint(0),
    with_endpoint(+, 0),
    with_client(-, -, 0),
    with_listener(+, -, 0),
    with_peer_process(-, 0),
    with_peer_process(+, -, -, -, 0).

%!  with_endpoint(:Goal) is semidet.
%!  with_endpoint(+Options, :Goal) is semidet.
%
%   Call Goal once while the endpoint runs, which leaves nothing.

with_endpoint(Goal) :-
    with_endpoint([], Goal).

with_endpoint(Options, Goal) :-
    no_leaks(setup_call_cleanup(
                 endpoint_start(localhost, 0, Options, _),
                 once(Goal),
                 endpoint_stop)).

%!  endpoint_port(-Port:integer) is det.
%!  port_of(+Address, -Port:integer) is det.

endpoint_port(Port) :-
    endpoint_address(Address),
    port_of(Address, Port).

port_of(Address, Port) :-
    atomic_list_concat([_, PortText], :, Address),
    atom_number(PortText, Port).

%!  with_client(-In, -Out, :Goal) is semidet.
%
%   Goal is called with the streams, of octets, of a connection to the endpoint.

with_client(In, Out, Goal) :-
    setup_call_cleanup(
        ( endpoint_port(Port),
          tcp_socket(Socket),
          tcp_connect(Socket, '127.0.0.1':Port),
          tcp_open_socket(Socket, In, Out),
          set_stream(In, encoding(octet)),
          set_stream(Out, encoding(octet)),
          set_stream(In, timeout(20)) ),
        once(Goal),
        ( close(Out, [force(true)]), close(In, [force(true)]) )).

%!  with_listener(+Queue, -Address, :Goal) is semidet.
%
%   So many connections to Address may wait to be accepted, which none is.

with_listener(Queue, Address, Goal) :-
    setup_call_cleanup(
        ( tcp_socket(Socket),
          tcp_bind(Socket, '127.0.0.1':Port),
          tcp_listen(Socket, Queue),
          atomic_list_concat(['127.0.0.1', Port], :, Address) ),
        once(Goal),
        tcp_close_socket(Socket)).

%!  with_peer_process(-Address, :Goal) is semidet.
%!  with_peer_process(+Options, -Pid, -InOut, -Address, :Goal) is semidet.
%
%   Goal is called while a process of endpoint_peer.pl serves at Address.
%   InOut are the streams that write to and read from it.  Options: port(Port);
%   setup(Goal), in that process.

with_peer_process(Address, Goal) :-
    with_peer_process([], _, _, Address, Goal).

with_peer_process(Options, Pid, In-Out, Address, Goal) :-
    option(port(Port), Options, 0),
    option(setup(Setup), Options, true),
    project_file('test/lib/endpoint_peer.pl', File),
    format(atom(Serve), '~q,serve(~d)', [Setup, Port]),
    with_swipl(['-g', Serve, File], Pid, In, Out,
               ( read_line_to_string(Out, Line),
                 atom_string(Address, Line),
                 call(Goal) )).
