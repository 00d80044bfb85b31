:- module(test_journaled,
          [ agent_survives/1,           % +Backend
            agent_goes_on/3             % +Backend, :Goes, :Returns
          ]).

/** <module> What agents of a process survive, in any back end of the journal

A Backend is backend(Before, Where): a process calls Before, and then has its
journal at Where.

*Threading*: the main thread of a test.
*/

:- use_module(common).
:- use_module(library(process), [process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(typhon)).

:- meta_predicate
    agent_goes_on(+, 0, 0),
    server_returns(+, +, 0, 0),
    killed(+, +, -, 0).

%!  agent_survives(+Backend) is semidet.
%
%   An agent, its messages and facts, survive the death of their process.

agent_survives(Backend) :-
    free_port(Port),
    format(atom(Host), 'alpha@127.0.0.1:~d', [Port]),
    setup_call_cleanup(
        host_start(driver),
        ( killed(Backend, Port, _,
                 ( agent_create(clauses([ (:- agent(waits, [])),
                                          (main :- receive(_-X),
                                                   receive(_-Y),
                                                   result(X+Y)) ]), A,
                                [host(Host)]),
                   agent_send(A, 1),
                   wait_until(agent_property(A, mailbox([])), 5),
                   remote(Host, leave(here)) )),
          killed(Backend, Port, _,
                 ( remote(Host, sense(here)),
                   agent_send(A, 2),
                   agent_result(A, 1+2, 10) )) ),
        host_stop(driver)).

%!  agent_goes_on(+Backend, :Goes, :Returns) is semidet.
%
%   An agent that hops makes all its hops, once, although the server that has
%   the journal Goes, and Returns.

agent_goes_on(Backend, Goes, Returns) :-
    free_port(Port),
    format(atom(Host), 'alpha@127.0.0.1:~d', [Port]),
    setup_call_cleanup(
        host_start(driver),
        killed(Backend, Port, Out, server_returns(Host, Out, Goes, Returns)),
        host_stop(driver)).

server_returns(Host, Out, Goes, Returns) :-
    host_property(driver, address(Other)),
    agent_create(clauses([ (:- agent(goes, [state([made/1, other/1])])),
                           made(0),
                           (main :- made(100), !),
                           (main :- other(Other), home(Home),
                                    goes(Other), goes(Home),
                                    retract(made(N)), N1 is N+1,
                                    assertz(made(N1)),
                                    ( take(made(V)) -> true ; V = 0 ),
                                    V1 is V+1, leave(made(V1)),
                                    main),
                           (goes(H) :- catch(( move(H), Gone = yes ),
                                             error(journal_unreachable(_, _), _),
                                             Gone = no),
                                       ( Gone == yes -> true
                                       ; sleep(0.1), goes(H) )) ]),
                 Agent, [host(Host), facts([other(Other)])]),
    wait_until(( agent_property(Agent, hops(Hops)), Hops > 20 ), 10),
    call(Goes),
    agent_send(Agent, hello),
    read_line_to_string(Out, "unreachable"),
    call(Returns),
    agent_join(Agent, done, 60),
    remote(Host, findall(V, sense(made(V)), [100])).

%   Out reports when the process notices that it cannot commit.

killed(backend(Before, Where), Port, Out, Goal) :-
    project_file('prolog/typhon.pl', Library),
    format(atom(Start), '~q, host_start(alpha, [journal(~q), port(~d)]), \c
                         writeln(ready), flush_output, thread_get_message(x)',
           [Before, Where, Port]),
    format(atom(Tells), '~q',
           [ assertz((user:message_hook(error(journal_unreachable(_, _), _),
                                        error, _) :-
                          writeln(unreachable), flush_output)) ]),
    with_swipl(['-g', Tells, '-g', Start, Library], Pid, _, Out,
               ( read_line_to_string(Out, "ready"),
                 call(Goal),
                 process_kill(Pid, kill),
                 process_wait(Pid, _) )).
