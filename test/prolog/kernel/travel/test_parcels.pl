:- module(test_parcels, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/travel),
              [ parcel_admit/3, parcel_returned/3, transfer_arrived/1,
                transfer_parcel/2 ]).

/** <module> Agents that are kept elsewhere while their host is away

An option keeps them; here the suite does so.

*Threading*: one test at a time; the hook runs in any thread.
*/

:- dynamic
    keeping/0,
    kept/1.                             % Parcel

:- multifile typhon_transfer:parks/2.

typhon_transfer:parks(Transfer, _) :-
    test_parcels:keeping,
    test_parcels:keep(Transfer).

keep(Transfer) :-
    thread_create(keep_now(Transfer), _, [detached(true)]).

keep_now(Transfer) :-
    transfer_parcel(Transfer, Parcel),
    transfer_arrived(Transfer),
    assertz(kept(Parcel)).

:- meta_predicate parcel(-, ?, 0).

%   parcel(-Parcel, +Agent, :Goal): Parcel is that of Agent, which Goal creates.

parcel(Parcel, Agent, Goal) :-
    retractall(kept(_)),
    setup_call_cleanup(
        assertz(keeping),
        ( once(Goal), wait_until(kept(_), 20) ),
        retractall(keeping)),
    kept(Parcel),
    assertion(agent_gone(Agent)).

agent_gone(Agent) :-
    \+ typhon_agents:agent_on(Agent, _).

mover(Host, Agent) :-
    create([ (main :- catch(( move(Host, [wait(99)]), R = none ),
                            error(R, _), true),
                      here(Here), hops(N), receive(_-M),
                      result([R,Here,N,M])) ],
           Agent, [host(alpha)]).

%   away(+Options, -Beta, :Goal): the host Beta of another process is away.

:- meta_predicate away(+, -, 0).

away(Options, Beta, Goal) :-
    with_hosts([alpha],
               with_peers([beta-[host(Options)]],
                          ( peer_host(beta, Beta),
                            peer_kill(beta),
                            once(Goal) ))).

%   admitted_there(+Parcel, -Answer): as text, which another Prolog can read.

admitted_there(Parcel, Answer) :-
    address(alpha, Alpha),
    atomic_list_concat([_,Peer], @, Alpha),
    peer_do(beta, typhon_arrival:parcel_admit(Parcel, Peer, Answer)).

:- begin_tests(parcels).

test(kept_agent_goes_on_when_its_host_is_back,
     Answer-Result == accepted-[none,Beta,1,hello]) :-
    away([], Beta,
         ( parcel(Parcel, A, mover(Beta, A)),
           peer_restart(beta),
           admitted_there(Parcel, Answer),
           wait_until(catch(agent_send(A, hello), error(_, _), fail), 20),
           agent_result(A, Result, 30) )).
test(agent_of_a_parcel_that_comes_twice_exists_once,
     Answers-Count == [accepted,accepted]-1) :-
    away([], Beta,
         ( parcel(Parcel, A, mover(Beta, A)),
           peer_restart(beta),
           admitted_there(Parcel, Answer1),
           admitted_there(Parcel, Answer2),
           Answers = [Answer1,Answer2],
           peer_do(beta, aggregate_all(count,
                                       typhon_agents:agent_on(A, _), Count)),
           agent_dispose(A),
           joined(A, disposed) )).
test(refused_agent_returns_to_the_host_that_it_left,
     Answer-Result
     == refused(capacity)-[move_refused(Beta,capacity),Alpha,2,hello]) :-
    away([capacity(0)], Beta,
         ( address(alpha, Alpha),
           parcel(Parcel, A, mover(Beta, A)),
           peer_restart(beta),
           admitted_there(Parcel, Answer),
           parcel_returned(Parcel, move_refused(Beta, capacity), Back),
           atomic_list_concat([_,Peer], @, Beta),
           parcel_admit(Back, Peer, accepted),
           agent_send(A, hello),
           agent_result(A, Result, 30) )).
test(other_terms_are_refused,
     [ forall(member(Parcel, [ x, _, parcel(_, _, _, _, _),
                               parcel(a, 'alpha@x:1', image, [], p),
                               parcel(a, 'alpha@x:1', _, _, _) ])) ]) :-
    with_hosts([alpha],
               capturing(parcel_admit(Parcel, '127.0.0.1:1', Answer), _)),
    assertion(subsumes_term(refused(_), Answer)).

:- end_tests(parcels).
