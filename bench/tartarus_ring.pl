:- module(bench_tartarus_ring,
          [ with_ring/2,                % +Count, :Goal
            round_trip/4                % +Nodes, +I, +Hops, -Seconds
          ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [nth0/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(socket)).
:- use_module(common).

/** <module> Platforms of Tartarus, each in a process, and an agent that walks

The platforms are those of library(tartarus), or of the file that the
environment variable TARTARUS names.

*Threading*: one thread.
*/

:- meta_predicate with_ring(+, 1).

%!  round_trip(+Nodes, +I, +Hops, -Seconds) is semidet.
%
%   The time of one agent; Hops is a multiple of the number of nodes.

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

%!  with_ring(+Count, :Goal) is semidet.
%
%   Calls Goal(Nodes) while there are Count platforms.

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
