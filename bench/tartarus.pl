:- use_module(common).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [max_list/2, nth0/3, sum_list/2]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(socket)).

/*  Programs written for Tartarus: hops per second of an agent that moves round
a ring of four platforms, each a process of its own; and the number of agents,
of 35, that return from a thousand hops between two platforms without a pause.
The figures of the original are 740 and 0.

    swipl bench/tartarus.pl -- 2000 */

:- initialization(main, main).

main([Argument]) :-
    atom_number(Argument, Hops),
    with_ring(4, ring(Hops)),
    with_ring(2, back_and_forth(1000, 35)).

ring(Hops, Nodes) :-
    findall(Rate,
            ( between(1, 5, I),
              round_trip(Nodes, I, Hops, Seconds),
              Rate is Hops/Seconds ),
            [_|Rates]),                 % the first one warms up
    max_list(Rates, Best),
    sum_list(Rates, Sum),
    Mean is Sum/4,
    format(atom(Note), 'mean of four ~0f; original 740', [Mean]),
    figure('hops of a Tartarus program, ring of four', Best, '1/s', Note).

back_and_forth(Hops, Agents, Nodes) :-
    aggregate_all(count,
                  ( between(1, Agents, I),
                    round_trip(Nodes, I, Hops, _) ),
                  Home),
    figure('of 35, home after 1000 hops between two', Home, agents,
           'original 0').

%   round_trip(+Nodes, +I, +Hops, -Seconds): time of one agent; Hops is
%   a multiple of the number of nodes.

round_trip([node(_, In, Out)|_], I, Hops, Seconds) :-
    format(In, 'send(walker~d, ~d).~n', [I, Hops]),
    flush_output(In),
    answer(Out, Term),
    Term = home(Seconds).

answer(Out, Term) :-
    repeat,
    read_line_to_string(Out, Line),
    (   Line == end_of_file
    ->  !, fail
    ;   sub_string(Line, 0, _, _, "home(")
    ->  !,
        term_string(Term, Line)
    ).

%   with_ring(+Count, :Goal): calls Goal(Nodes) while there are Count platforms.

with_ring(Count, Goal) :-
    length(Ports, Count),
    free_ports(Ports),
    setup_call_cleanup(
        findall(Node, started(Ports, Node), Nodes),
        call(Goal, Nodes),
        maplist(ended, Nodes)).

%   All sockets are bound before the first is closed, so that all ports differ.

free_ports(Ports) :-
    maplist(bound, Ports, Sockets),
    maplist(tcp_close_socket, Sockets).

bound(Port, Socket) :-
    tcp_socket(Socket),
    tcp_bind(Socket, localhost:Port).

started(Ports, node(Pid, In, Out)) :-
    length(Ports, Count),
    nth0(I, Ports, Port),
    J is (I+1) mod Count,
    nth0(J, Ports, Next),
    current_prolog_flag(executable, Swipl),
    module_property(bench_common, file(Common)),
    file_directory_name(Common, Dir),
    atom_concat(Dir, '/tartarus_walker.pl', Program),
    format(atom(Goal), 'up(~d, ~d)', [Port, Next]),
    process_create(Swipl, ['-q', '-g', Goal, Program],
                   [stdin(pipe(In)), stdout(pipe(Out)), stderr(std),
                    process(Pid)]),
    once(( repeat, read_line_to_string(Out, Line),
           memberchk(Line, ["up", end_of_file]) )).

ended(node(Pid, In, Out)) :-
    close(In),
    process_wait(Pid, _),
    close(Out).
