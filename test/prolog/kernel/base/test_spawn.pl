:- module(test_spawn, []).
:- use_module(library(plunit)).
:- use_module(library(typhon/kernel/base/prolog_faults)).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(process), [process_kill/2, process_wait/2]).
:- use_module(library(thread), [concurrent_forall/3]).

/** <module> Processes begin one after the other

*Threading*: several threads begin processes, the main thread ends them.
*/

:- dynamic echo/3.                      % Pid, In, Out

begun(_) :-
    forall(between(1, 20, _),
           ( spawn(path(cat), [],
                   [ stdin(pipe(In)), stdout(pipe(Out)), process(Pid),
                     detached(true) ]),
             assertz(echo(Pid, In, Out)) )).

%   The process echoes its input and ends, while all others run.

ended(In, Out) :-
    format(In, 'hello~n', []),
    close(In),
    set_stream(Out, timeout(30)),
    read_string(Out, _, "hello\n").

end_all :-
    forall(retract(echo(Pid, In, Out)),
           ( process_kill(Pid, kill),
             process_wait(Pid, _),
             maplist(closed, [In, Out]) )).

closed(Stream) :-
    close(Stream, [force(true)]).

:- begin_tests(process_creation, [cleanup(end_all)]).

test(concurrent_processes_do_not_share_pipes) :-
    numlist(1, 6, Numbers),
    concurrent_forall(member(N, Numbers), begun(N), [threads(6)]),
    findall(In-Out, echo(_, In, Out), Pipes),
    length(Pipes, 120),
    forall(member(In-Out, Pipes), ended(In, Out)).
test(missing_program, error(existence_error(source_sink, path(no_such)))) :-
    spawn(path(no_such), [], []).

:- end_tests(process_creation).
