:- module(test_parked, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/travel),
              [ transfer_arrived/1, transfer_open/1, transfer_parked/1,
                transfer_stays/2 ]).

/** <module> Agents that wait for a host that cannot be reached

An option parks them; here the suite does so.

*Threading*: one test at a time; the hook runs in any thread.
*/

:- dynamic
    parking/0,                          % agents are taken over
    offered/2.                          % Transfer, Seconds

:- multifile typhon_transfer:parks/2.

typhon_transfer:parks(Transfer, Seconds) :-
    test_parked:taken(Transfer, Seconds).

taken(Transfer, Seconds) :-
    assertz(offered(Transfer, Seconds)),
    parking.

:- meta_predicate while_parking(0).

while_parking(Goal) :-
    retractall(offered(_, _)),
    setup_call_cleanup(assertz(parking), Goal, retractall(parking)).

park_no_more :-
    retractall(parking).

%   offer(-Transfer, -Seconds): the only one so far.

offer(Transfer, Seconds) :-
    wait_until(offered(_, _), 20),
    findall(T-S, retract(offered(T, S)), [Transfer-Seconds]).

offers(Count) :-
    findall(T, offered(T, _), Ts),
    length(Ts, Count).

nowhere(Host) :-
    free_port(Port),
    format(atom(Host), 'nowhere@127.0.0.1:~d', [Port]).

%   mover(+Move, -Agent): its result is the error of Move, or `none`, and the
%   host where it is then.

mover(Move, Agent) :-
    mover(Move, Agent, []).

mover(Move, Agent, Options) :-
    create([ (main :- catch(( Move, R = none ), error(R, _), true),
                      here(Here), result(R-Here)) ],
           Agent, [host(alpha)|Options]).

said(Move, Result) :-
    mover(Move, Agent),
    agent_result(Agent, Result, 20).

:- begin_tests(parked).

test(move_with_a_wait_is_a_move,
     [ forall(member(Options, [[wait(10)], [wait(inf)], []])),
       Result == none-Beta ]) :-
    with_hosts([alpha],
               with_peers([beta],
                          ( peer_host(beta, Beta),
                            said(move(Beta, Options), Result) ))).
test(host_of_this_process_needs_no_wait, Result == none-Beta) :-
    with_hosts([alpha, beta],
               ( address(beta, Beta), said(move(beta, [wait(1)]), Result) )).
test(agent_that_is_there_goes_on, Result == none-Alpha) :-
    with_hosts([alpha],
               ( address(alpha, Alpha),
                 said(move(alpha, [wait(1)]), Result) )).
test(refusal_is_raised_at_the_move,
     Result == move_refused(Beta, capacity)-Alpha) :-
    with_hosts([alpha],
               with_peers([beta-[host([capacity(0)])]],
                          ( peer_host(beta, Beta),
                            address(alpha, Alpha),
                            said(move(Beta, [wait(10)]), Result) ))).
test(without_an_option_no_agent_waits,
     Result == host_unreachable(Host)-Alpha) :-
    nowhere(Host),
    with_hosts([alpha],
               ( address(alpha, Alpha),
                 said(move(Host, [wait(1000)]), Result) )).
test(plain_move_is_not_parked, Result-Offers == host_unreachable(Host)-0) :-
    nowhere(Host),
    with_hosts([alpha],
               while_parking(( said(move(Host), Result-_),
                               offers(Offers) ))).
test(order_is_not_parked, Formal-Offers == host_unreachable(Host)-0) :-
    nowhere(Host),
    with_hosts([alpha],
               while_parking(
                   ( create([on_message(_, _)], A, [host(alpha)]),
                     catch(agent_move(A, Host, [wait(10)]), error(Formal, _),
                           true),
                     offers(Offers) ))).
test(static_agent_is_not_parked,
     Result-Offers == permission_error(move, static_agent, A)-0) :-
    nowhere(Host),
    with_hosts([alpha],
               while_parking(( mover(move(Host, [wait(9)]), A,
                                     [static(true)]),
                               agent_result(A, Result-_, 20),
                               offers(Offers) ))).
test(parked_agent_stays_when_the_time_is_over,
     [ forall(member(Options, [[], [hop_time(uniform(0.01, 0.02))]])),
       Result == host_unreachable(Host)-Alpha ]) :-
    nowhere(Host),
    with_hosts([alpha-Options],
               while_parking(
                   ( address(alpha, Alpha),
                     mover(move(Host, [wait(100)]), A),
                     offer(Transfer, Seconds),
                     assertion(( Seconds > 0, Seconds =< 100 )),
                     assertion(transfer_open(Transfer)),
                     assertion(agent_property(A, host(Alpha))),
                     transfer_stays(Transfer, host_unreachable(Host)),
                     agent_result(A, Result, 20) ))).
test(agent_may_wait_without_end, Seconds == inf) :-
    nowhere(Host),
    with_hosts([alpha],
               while_parking(( mover(move(Host, [wait(inf)]), A),
                               offer(_, Seconds),
                               agent_dispose(A),
                               agent_join(A, disposed, 20) ))).
test(no_seconds_are_left_of_a_wait_that_is_over, Seconds == 0.0) :-
    nowhere(Host),
    with_hosts([alpha],
               while_parking(( mover(move(Host, [wait(-1)]), A),
                               offer(Transfer, Seconds),
                               transfer_stays(Transfer,
                                              host_unreachable(Host)),
                               joined(A, done) ))).
test(parked_agent_is_sent_when_its_host_is_back, Result == none-Beta) :-
    with_hosts([alpha],
               with_peers([beta],
                          while_parking(
                              ( peer_host(beta, Beta),
                                peer_kill(beta),
                                mover(move(Beta, [wait(100)]), A),
                                offer(Transfer, _),
                                agent_send(A, hello),
                                park_no_more,
                                peer_restart(beta),
                                typhon_transfer:again(Transfer),
                                agent_result(A, Result, 20) )))).
test(parked_agent_keeps_its_mail_and_its_goals,
     Facts == [[user-one, user-two, host_unreachable(Host)]]) :-
    nowhere(Host),
    with_hosts([alpha],
               while_parking(
                   ( create([ (main :- receive(A1),
                                       catch(move(Host, [wait(9)]),
                                             error(E, _), true),
                                       receive(A2), result([A1,A2,E])) ],
                            A, [host(alpha)]),
                     agent_send(A, one),
                     offer(Transfer, _),
                     agent_send(A, two),
                     assertion(( agent_property(A, goals(Goals)),
                                 Goals = [catch(_, _, _)|_] )),
                     transfer_stays(Transfer, host_unreachable(Host)),
                     agent_result(A, Result, 20),
                     Facts = [Result] ))).
test(agent_that_is_sent_is_parked_no_more) :-
    nowhere(Host),
    with_hosts([alpha],
               while_parking(( mover(move(Host, [wait(9)]), A),
                               offer(Transfer, _),
                               assertion(transfer_parked(Transfer)),
                               typhon_transfer:transfer_unpark(Transfer),
                               assertion(\+ transfer_parked(Transfer)),
                               transfer_stays(Transfer,
                                              host_unreachable(Host)),
                               joined(A, done) ))).
test(parked_agent_may_have_gone) :-
    nowhere(Host),
    with_hosts([alpha],
               while_parking(
                   ( mover(move(Host, [wait(100)]), A),
                     offer(Transfer, _),
                     transfer_arrived(Transfer),
                     assertion(\+ transfer_open(Transfer)),
                     assertion(typhon_travel:whereabouts(A, Host)),
                     typhon_travel:agent_ended(A, disposed, 2, []) ))).
test(wrong_option_is_an_error_at_the_move,
     [ forall(member(Options-Formal,
                     [ [wiat(1)]-domain_error(move_option, wiat(1)),
                       [wait(soon)]-type_error(number, soon),
                       wait(1)-type_error(list, wait(1)),
                       now-type_error(list, now) ])),
       Result-Where == Formal-Alpha ]) :-
    with_hosts([alpha, beta],
               ( address(alpha, Alpha),
                 said(move(beta, Options), Result-Where) )).

:- end_tests(parked).

:- needs([journal]).

:- begin_tests(parked_for_long).

%   over_a_restart(+Host, -Agent, +Seconds, :First, :Second): an agent that waits
%   for Host, First, and Second after a restart.

:- meta_predicate
    over_a_restart(+, -, +, 0, 0),
    with_journal(+, 0).

over_a_restart(Host, A, Seconds, First, Second) :-
    with_tmp_dir(Dir,
        while_parking(
            ( with_journal(Dir,
                           ( mover(move(Host, [wait(Seconds)]), A),
                             offer(_, _),
                             First )),
              with_journal(Dir, Second) ))).

with_journal(Dir, Goal) :-
    setup_call_cleanup(host_start(alpha, [journal(Dir)]),
                       once(Goal), host_stop(alpha)).

test(wait_outlives_the_process, Result == host_unreachable(Host)-Alpha) :-
    nowhere(Host),
    no_leaks(over_a_restart(Host, A, 100, true,
        ( address(alpha, Alpha),
          offer(Transfer, Seconds),
          assertion(( Seconds > 0, Seconds < 100 )),
          transfer_stays(Transfer, host_unreachable(Host)),
          agent_result(A, Result, 20) ))).
test(agent_that_is_parked_no_more_is_sent_again, Result == none-Beta) :-
    no_leaks(with_peers([beta],
               ( peer_host(beta, Beta),
                 peer_kill(beta),
                 over_a_restart(Beta, A, 100,
                                ( park_no_more, peer_restart(beta) ),
                                agent_result(A, Result, 60)) ))).
:- end_tests(parked_for_long).
