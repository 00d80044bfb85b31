:- use_module(common).
:- use_module(library(typhon)).
:- use_module(library(socket)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).

/*  The cost of unauthenticated clients for working agents: hops per second
between two processes while a third makes a thousand malformed connections a
second to one of them, against the same without it.  The third process uses the
same processors: the share of this is measured with a flood of a listener that
only closes connections. */

:- initialization(main, main).

main([_]) :-
    host_start(here),
    with_peer([env], hops_in_a_flood),
    host_stop(here).

hops_in_a_flood(Peer) :-
    rate(3000, Peer, _),                % warm up
    host_property(here, address(Here)),
    port(Here, Port),
    findall(rates(Alone, Elsewhere, Flooded),
            ( between(1, 3, _),
              rate(4000, Peer, Alone),
              with_listener(Other, with_flood(Other, rate(4000, Peer,
                                                          Elsewhere))),
              with_flood(Port, rate(4000, Peer, Flooded)) ),
            Rates),
    sums(Rates, Alone1, Elsewhere1, Flooded1),
    ratio('hops of ten agents while strangers come', Flooded1, Alone1,
          '1/s', 'no client'),
    ratio('the same, against strangers elsewhere', Flooded1, Elsewhere1,
          '1/s', 'they go to another port').

sums(Rates, A, E, F) :-
    findall(X, member(rates(X, _, _), Rates), As), sum_list(As, A0),
    findall(X, member(rates(_, X, _), Rates), Es), sum_list(Es, E0),
    findall(X, member(rates(_, _, X), Rates), Fs), sum_list(Fs, F0),
    A is A0/3, E is E0/3, F is F0/3.

port(Host, Port) :-
    atomic_list_concat([_, Text], ':', Host),
    atom_number(Text, Port).

%   The rate of ten agents.

rate(Hops, Peer, Rate) :-
    Each is Hops//20,
    Program = clauses([ (:- agent(traveller, [state([left/1,peer/1])])),
                        (main :- left(0), !),
                        (main :- retract(left(N)), N1 is N-1,
                                 assertz(left(N1)), peer(P), move(P),
                                 home(H), move(H), main) ]),
    seconds(( findall(Agent,
                      ( between(1, 10, _),
                        agent_create(Program, Agent,
                                     [facts([left(Each), peer(Peer)])]) ),
                      Agents),
              forall(member(Agent, Agents), agent_join(Agent, done, 300)) ),
            Seconds),
    Rate is 20*Each/Seconds.

                /*******************************
                *           STRANGERS          *
                *******************************/

:- meta_predicate
    with_flood(+, 0),
    with_listener(-, 0).

%   The flood process prints a line when it begins, and ends with its input.

with_flood(Port, Goal) :-
    current_prolog_flag(executable, Swipl),
    source_file(main(_), File),
    format(atom(Flood), 'flood(~d)', [Port]),
    setup_call_cleanup(
        process_create(Swipl, ['-q', '-g', Flood, '-t', halt, File],
                       [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]),
        ( read_line_to_string(Out, _), call(Goal) ),
        ( close(In), read_line_to_string(Out, Said), close(Out),
          process_wait(Pid, _) )),
    format(user_error, '% ~s~n', [Said]).

%   A thousand connections a second, as far as that is possible.

flood(Port) :-
    format('begin~n'), flush_output,
    thread_self(Me),
    thread_create(( read_line_to_string(user_input, _),
                    thread_send_message(Me, stop) ), _, [detached(true)]),
    get_time(Start),
    flood(Port, Start, 0).

flood(_, Start, Count) :-
    thread_peek_message(stop),
    !,
    get_time(Now),
    Rate is Count/(Now-Start),
    format('~0f strangers a second~n', [Rate]).
flood(Port, Start, Count) :-
    catch(stranger(Port), error(_, _), true),
    Count1 is Count+1,
    get_time(Now),
    Early is Start+Count1/1000-Now,
    (   Early > 0
    ->  sleep(Early)
    ;   true
    ),
    flood(Port, Start, Count1).

stranger(Port) :-
    tcp_socket(Socket),
    tcp_connect(Socket, '127.0.0.1':Port),
    tcp_open_socket(Socket, In, Out),
    call_cleanup(( format(Out, "GET / HTTP/1.0\r\n\r\n", []),
                   flush_output(Out) ),
                 ( close(Out, [force(true)]), close(In, [force(true)]) )).

with_listener(Port, Goal) :-
    tcp_socket(Socket),
    tcp_bind(Socket, '127.0.0.1':Port),
    tcp_listen(Socket, 128),
    setup_call_cleanup(
        thread_create(close_all(Socket), Thread),
        call(Goal),
        ( thread_signal(Thread, throw(stop)),
          tcp_socket(Last),
          tcp_connect(Last, '127.0.0.1':Port),
          tcp_close_socket(Last),
          thread_join(Thread, _),
          tcp_close_socket(Socket) )).

close_all(Socket) :-
    repeat,
    tcp_accept(Socket, Client, _),
    tcp_close_socket(Client),
    fail.
