% The applications print what their document shows, end at an interrupt, and
% report wrong arguments in one line.

:- module(test_applications, []).
:- use_module('../lib/common').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_kill/2]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_line_to_string/2]).
:- use_module(library(socket),
              [tcp_bind/2, tcp_close_socket/1, tcp_listen/2, tcp_socket/1]).

application(fire, []).
application(irrigation, ['--days=30']).         % of ninety
application(solar, []).
application(warehouse, []).

:- begin_tests(applications).

test(output_is_documented, [forall(application(Name, Options))]) :-
    application_file(Name, File),
    run_swipl([File, '--speed=0'|Options], [timeout(120)], Status, Out, Err),
    assertion(Status-Err == exit(0)-""),
    project_file('doc/applications.md', Document),
    read_file_to_string(Document, Text, [encoding(utf8)]),
    assertion(sub_string(Text, _, _, _, Out)).

%   At this speed the first line of the story is hours away.

test(interrupt_ends_the_program, [forall(application(Name, _))]) :-
    application_file(Name, File),
    current_prolog_flag(executable, Swipl),
    setup_call_cleanup(
        process_create(Swipl, [File, '--port=0', '--speed=0.001'],
                       [process(Pid), stdin(null), stdout(pipe(Out))]),
        ( read_line_to_string(Out, Line),
          assertion(sub_string(Line, 0, _, _, "Open http://localhost:")),
          process_kill(Pid, int),
          wait_for_end(Pid, 30, Status),
          assertion(Status == exit(0)) ),
        ( close(Out),
          catch(stop_process(Pid), error(_, _), true) )).    % has ended

test(wrong_arguments, [forall(wrong(Option, Word))]) :-
    refused(Option, Line),
    assertion(sub_string(Line, _, _, _, Word)).

wrong('--speeed=3', "speeed").
wrong('--speed=fast', "number").
wrong(fast, "fast").
wrong('--rule=guess', "gossip, single, verified").

test(busy_port) :-
    tcp_socket(Socket),
    setup_call_cleanup(
        ( tcp_bind(Socket, localhost:Port),
          tcp_listen(Socket, 1) ),
        ( atom_concat('--port=', Port, Option),
          refused(Option, Line),
          assertion(sub_string(Line, _, _, _, "the port is in use")) ),
        tcp_close_socket(Socket)).

refused(Option, Line) :-
    application_file(fire, File),
    run_swipl([File, Option], [], Status, Out, Err),
    assertion(Status-Out == exit(1)-""),
    split_string(Err, "", "\n", [Line]),
    assertion(\+ sub_string(Line, _, _, _, "\n")).

application_file(Name, File) :-
    atomic_list_concat(['examples/applications/', Name, '.pl'], Path),
    project_file(Path, File).

:- end_tests(applications).
