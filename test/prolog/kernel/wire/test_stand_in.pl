:- module(test_stand_in, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire/handshake), [hello/4]).
:- use_module(library(typhon/kernel/wire/session),
              [session_close/2, session_open/4]).

/** <module> Processes that stand in for others

One has the address and the id of the other, and listens elsewhere.

*Threading*: one test at a time; a connection asks in its own thread.
*/

:- dynamic leads/2.                     % Address, Real

:- multifile typhon_connection:leads_to/2.

typhon_connection:leads_to(Address, Real) :-
    test_stand_in:leads(Address, Real).

%   standing_in(-Beta, :Goal): the host Beta of another process has an address
%   at which no process listens.

:- meta_predicate standing_in(-, 0).

standing_in(Beta, Goal) :-
    free_port(Known),
    atom_concat('127.0.0.1:', Known, Address),
    with_hosts([alpha],
               with_peers([beta-[host([advertise(Address)])]],
                          ( peer_host(beta, Own),
                            atomic_list_concat([Name,Real], @, Own),
                            atomic_list_concat([Name,Address], @, Beta),
                            setup_call_cleanup(
                                assertz(leads(Address, Real)),
                                Goal,
                                retractall(leads(_, _))) ))).

%   opens(+Start, -Formal): a session with that start of a process.

opens(Process-Start, Proof, Formal) :-
    hello(Process, Start, '127.0.0.1:1', Hello),
    atomic_list_concat([Process,Start], '.', Key),
    catch(( session_open(Key, Hello-Proof, text, Session),
            session_close(Session, _),
            Formal = none ),
          error(Formal, _), true).

:- begin_tests(stand_in).

test(host_is_found_where_its_address_leads) :-
    standing_in(Beta, remote(Beta, true)).
test(agents_have_the_address_in_their_ids, Home == Beta) :-
    standing_in(Beta,
                ( create([on_message(_, _)], A, [host(Beta)]),
                  agent_property(A, home(Home)),
                  assertion(sub_atom(A, _, _, 0, Beta)),
                  agent_dispose(A),
                  joined(A, disposed) )).
test(agent_goes_there_and_back, Result == [Beta,Alpha]) :-
    standing_in(Beta,
                ( address(alpha, Alpha),
                  create([ (main :- move(Beta), here(B), move(Alpha),
                                    here(A), result([B,A])) ], Agent,
                         [host(alpha)]),
                  agent_result(Agent, Result, 20) )).
test(address_that_leads_nowhere_is_unreachable,
     error(host_unreachable(Beta))) :-
    standing_in(Beta, ( retractall(test_stand_in:leads(_, _)),
                        remote(Beta, true) )).
test(earlier_start_of_a_process_is_refused,
     Formals == [none,none,none,Refused,none]) :-
    Refused = permission_error(authenticate, peer, superseded),
    findall(F, ( member(N, [1,2,2,1,3]), opens(jtest1-N, cookie, F) ),
            Formals).
test(starts_of_other_processes_and_proofs_do_not_count,
     Formals == [none,none,none]) :-
    findall(F, ( member(P-N-Proof, [ jtest2-5-cookie, jtest3-1-cookie,
                                     jtest2-1-certificate(other) ]),
                 opens(P-N, Proof, F) ),
            Formals).

:- end_tests(stand_in).
