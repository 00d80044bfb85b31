:- module(test_nxt_fixtures,
          [ with_peer/3,                % -Peer, -Port, :Goal
            with_peer/4,                % +Name, +Options, -Peer, :Goal
            peer_command/2,             % +Peer, +Line
            peer_received/2,            % +Peer, -Telegram
            with_brick/3,               % -Brick, -Port, :Goal
            with_brick/4,               % +Name, +Options, -Brick, :Goal
            brick_ask/3,                % +Brick, +Line, -Answer
            connected/4,                % +Name, +Port, +Options, :Goal
            helper_pid/1                % -Pid
          ]).

/** <module> Peers of the bridge to NXT bricks

A peer is nxt_peer.py, whose answers a test defines; a brick is the simulated
one.  Both are processes of their own behind pseudo-terminals.

*Threading*: one test at a time.
*/

:- use_module(common).
:- use_module(slowness, [patience/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3]).
:- use_module(library(typhon/nxt)).

:- meta_predicate
    with_peer(-, -, 0),
    with_peer(+, +, -, 0),
    with_brick(-, -, 0),
    with_brick(+, +, -, 0),
    connected(+, +, +, 0).

%!  with_peer(-Peer, -Port, :Goal) is semidet.
%!  with_peer(+Name, +Options, -Peer, :Goal) is semidet.
%
%   Calls Goal once while a peer is running at Port, or is connected as Name.

with_peer(Peer, Port, Goal) :-
    project_file('test/lib/nxt_peer.py', File),
    with_python([File], Peer,
                ( peer_received(Peer, Port),
                  call(Goal)
                )).

with_peer(Name, Options, Peer, Goal) :-
    with_peer(Peer, Port, connected(Name, Port, Options, Goal)).

with_python(Args, far(In, Out), Goal) :-
    no_leaks(setup_call_cleanup(
                 process_create('/usr/bin/python3', Args,
                                [ stdin(pipe(In)), stdout(pipe(Out)),
                                  process(Pid)
                                ]),
                 ( set_stream(Out, timeout(60)),
                   once(Goal) ),
                 end_python(In, Out, Pid))).

%   Both end with their standard input.

end_python(In, Out, Pid) :-
    close(In, [force(true)]),
    close(Out, [force(true)]),
    process_wait(Pid, _).

%!  peer_command(+Peer, +Line) is det.
%
%   Set its reaction to the next telegram.

peer_command(far(In, _), Line) :-
    format(In, '~w~n', [Line]),
    flush_output(In).

%!  peer_received(+Peer, -Telegram:atom) is det.
%
%   The next telegram, hexadecimal; waits for it.

peer_received(far(_, Out), Telegram) :-
    read_line_to_string(Out, Line),
    assertion(string(Line)),
    atom_string(Telegram, Line).

%!  with_brick(-Brick, -Port, :Goal) is semidet.
%!  with_brick(+Name, +Options, -Brick, :Goal) is semidet.

with_brick(Brick, Port, Goal) :-
    project_file('bridges/nxt/brick.py', File),
    with_tmp_dir(brick_in(File, Brick, Port, Goal)).

brick_in(File, Brick, Port, Goal, Dir) :-
    directory_file_path(Dir, brick, Port),
    with_python([File, '--pty', Port, '--until-eof'], Brick,
                ( answer(Brick, ready(_)),
                  call(Goal)
                )).

%   Calls of a test may need longer on a slow machine, too.

with_brick(Name, Options, Brick, Goal) :-
    patience(3, Seconds),
    append(Options, [deadline(Seconds)], Options1),
    with_brick(Brick, Port, connected(Name, Port, Options1, Goal)).

answer(far(_, Out), Term) :-
    read(Out, Term0),
    assertion(Term0 \== end_of_file),
    Term = Term0.

%!  brick_ask(+Brick, +Line, -Answer) is det.
%
%   The answer of the simulated brick to a line, a term.

brick_ask(Brick, Line, Answer) :-
    peer_command(Brick, Line),
    answer(Brick, Answer).

%!  connected(+Name, +Port, +Options, :Goal) is semidet.

connected(Name, Port, Options, Goal) :-
    setup_call_cleanup(
        nxt_connect(Name, Port, Options),
        once(Goal),
        nxt_disconnect(Name)).

%!  helper_pid(-Pid) is semidet.
%
%   The one helper that is running.

helper_pid(Pid) :-
    typhon_helper_requests:helper_pid(nxt(_), Pid).
