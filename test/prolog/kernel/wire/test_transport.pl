:- module(test_transport, []).

/** <module> Tests of transports: a process connects to itself by a test
transport

The client sends `M` before anything else, and the server answers with a line.

*Threading*: the main thread; the hooks run in those of the endpoint.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/endpoints').
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(typhon/kernel/wire)).

:- multifile
    typhon_endpoint:requested/4,
    typhon_kinds:accepts/5,
    typhon_transport:begins/4,
    typhon_transport:ends/1,
    typhon_transport:disagrees/1,
    typhon_transport:first_byte/2,
    typhon_transport:misfit/4,
    typhon_transport:opens/7.

typhon_kinds:accepts(request, proof, mine, none, none).

:- dynamic is_on/0.

typhon_transport:begins(Options, marked, mark(ours), mark(unknown)) :-
    memberchk(marked, Options),
    assertz(is_on).
typhon_transport:ends(marked) :-
    retractall(is_on).
typhon_transport:disagrees(marked) :-
    \+ is_on.
typhon_transport:first_byte(0'M, marked).
typhon_transport:misfit(plain, marked, "typhon marked", no_mark).
typhon_transport:misfit(marked, plain, "typhon plain", a_mark).
typhon_transport:opens(marked, client, In, Out, In, Out, mark(server)) :-
    put_byte(Out, 0'M),
    flush_output(Out),
    get_byte(In, 0'm).
typhon_transport:opens(marked, server, In, Out, In, Out, mark(client)) :-
    get_byte(In, 0'M),
    put_byte(Out, 0'm),
    flush_output(Out).

typhon_endpoint:requested(proof, mine, Peer, ReplyTo) :-
    endpoint_proof(Peer, Proof),
    endpoint_reply(ReplyTo, Proof).

%   server_answer(+Text, -Line): Line is the answer to a client that begins with
%   Text.

server_answer(Text, Line) :-
    with_client(In, Out, ( format(Out, "~w", [Text]),
                           flush_output(Out),
                           read_line_to_string(In, Line) )).

asked(Proof) :-
    endpoint_address(Address),
    endpoint_call(Address, proof, mine, answer(Proof), 10).

:- begin_tests(transport).

test(peer_proves_itself_by_the_transport, Proof == mark(client)) :-
    with_endpoint([marked], asked(Proof)).
test(tcp_peer_has_proved_the_cookie, Proof == cookie) :-
    with_endpoint([], asked(Proof)).
test(own_and_unknown_proofs_are_those_of_the_transport,
     Own-Unknown == mark(ours)-mark(unknown)) :-
    with_endpoint([marked], ( endpoint_own_proof(Own),
                              endpoint_proof('127.0.0.1:1', Unknown) )).
test(plain_client_gets_the_name_of_the_transport, Line == "typhon marked") :-
    with_endpoint([marked], server_answer(typhon, Line)).
test(client_of_a_missing_transport_gets_a_line,
     Line == "typhon plain") :-
    with_endpoint([], server_answer('M', Line)).
test(transport_stops_with_the_endpoint) :-
    with_endpoint([marked], \+ transport_disagrees(marked)),
    transport_disagrees(marked).

:- end_tests(transport).
