:- module(test_brick_faults, []).
:- use_module('../../lib/common').
:- needs(['python3-serial']).
:- use_module('../../lib/nxt_bricks').
:- use_module(library(plunit)).
:- use_module(library(filesex), [directory_file_path/3, link_file/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_create/3, process_kill/2]).

/** <module> Faults, start and end of the simulated brick

On a pseudo-terminal and over TCP alike.
*/

%   A brick with a pseudo-terminal and a TCP port, and a line of one kind.

with_both(Kind, Args, Brick, Line, Goal) :-
    with_tmp_dir(both(Kind, Args, Brick, Line, Goal)).

both(Kind, Args, Brick, Line, Goal, Dir) :-
    directory_file_path(Dir, nxt, Link),
    with_brick(['--pty', Link, '--tcp', 0|Args], Brick,
               ( place(Kind, Brick, Place),
                 with_line(Place, Line, Goal)
               )),
    assertion(\+ exists_file(Link)).

place(Kind, Brick, Place) :-
    brick_place(Brick, 'NXT', Place),
    functor(Place, Kind, 1),
    !.

kind(pty).
kind(tcp).

seconds(Goal, Seconds) :-
    get_time(Before),
    call(Goal),
    get_time(After),
    Seconds is After-Before.

version('0288007c011d01').

:- begin_tests(brick_faults).

test(silence, [forall(kind(Kind)), Reply == '020d00c0270900']) :-
    with_both(Kind, [], Brick, Line,
              ( tell(Brick, 'fault silence for 2'),
                send(Line, '0188'),
                send(Line, '0188'),
                exchange(Line, '000d', Reply),
                ask(Brick, count, count(1, 1)) )).
test(fault_of_the_command_line, Statuses == ['00', dd, '00']) :-
    with_both(tcp, ['--fault', 'refuse 0xDD after 1 for 1'], _, Line,
              findall(Status,
                      ( member(_, [1, 2, 3]),
                        exchange(Line, '0188', Reply),
                        sub_atom(Reply, 4, 2, _, Status)
                      ),
                      Statuses)).
test(delay, [true((Reply == Version, Seconds >= 0.4))]) :-
    version(Version),
    with_both(pty, [], Brick, Line,
              ( tell(Brick, 'fault delay 0.4'),
                seconds(exchange(Line, '0188', Reply), Seconds) )).
test(garbage, [forall(kind(Kind)), true((Garbage \== Frame,
                                         Reply == Version))]) :-
    version(Version),
    Frame = [7,0, 0x02,0x88,0x00,0x7c,0x01,0x1d,0x01],
    with_both(Kind, [], Brick, Line,
              ( tell(Brick, 'fault garbage for 1'),
                send(Line, '0188'),
                receive_bytes(Line, 9, Garbage),
                exchange(Line, '0188', Reply) )).
test(connection_cut_in_the_middle,
     [forall(kind(Kind)), Bytes == [7,0, 0x02,0x88]]) :-
    version(Version),
    with_both(Kind, [], Brick, Line,
              ( tell(Brick, 'fault cut after 1'),
                exchange(Line, '0188', Version),
                send(Line, '0188'),
                receive_bytes(Line, 9, Bytes),
                wait_until(place_is_gone(Kind, Brick), 10),
                ask(Brick, restore, brick('NXT', Pty, Tcp)),
                member(Place, [Pty, Tcp]),
                functor(Place, Kind, 1),
                with_line(Place, Again, exchange(Again, '0188', Version)) )).
test(connection_cut_and_restored, Reply == Version) :-
    version(Version),
    with_both(tcp, [], Brick, Line,
              ( tell(Brick, 'fault cut 0.2 for 1'),
                send(Line, '0188'),
                receive_bytes(Line, 9, _),
                place(tcp, Brick, Place),
                wait_until(reachable(Place), 20),
                with_line(Place, Again, exchange(Again, '0188', Reply)) )).
test(battery_runs_down, Levels == ['020b00781e', '020b007017']) :-
    with_both(tcp, ['--fault', 'battery 6000 after 1'], _, Line,
              findall(Reply,
                      ( member(_, [1, 2]), exchange(Line, '000b', Reply) ),
                      Levels)).

:- end_tests(brick_faults).

place_is_gone(pty, Brick) :-
    place(pty, Brick, pty(Link)),
    \+ exists_file(Link).
place_is_gone(tcp, Brick) :-
    place(tcp, Brick, Place),
    \+ reachable(Place).

reachable(Place) :-
    catch(with_line(Place, _, true), error(socket_error(_, _), _), fail).

bad_line(Line) :-
    member(Line, [ jump, 'fault', 'fault fire', 'fault delay', 'fault cut x',
                   'fault silence after', 'set 1', 'set 5 1', 'set 1 x',
                   'load d 1', 'motor', 'advance -1', 'plug 1 nose' ]).

:- begin_tests(brick_life).

test(leaves_nothing_behind) :-
    version(Version),
    no_leaks(with_both(pty, [], _, Line, exchange(Line, '0188', Version))).
test(lines_written_by_both_sides_at_once, [A, B] == [Version, Version]) :-
    version(Version),
    with_both(pty, [], Brick, Line,
              ( place(tcp, Brick, Place),
                with_line(Place, Other,
                          ( exchange(Other, '0188', B),
                            exchange(Line, '0188', A) )) )).
test(clients_connect_one_after_another, [forall(kind(Kind))]) :-
    version(Version),
    with_both(Kind, [], Brick, Line,
              ( exchange(Line, '0188', Version),
                close_line(Line),
                place(Kind, Brick, Place),
                with_line(Place, Next, exchange(Next, '0188', Version)) )).
test(control_bytes_get_through, Reply == '0213000d06030411130d00') :-
    with_both(pty, [], _, Line,
              ( exchange(Line, '000044656d6f2e727865', '020000'),
                exchange(Line, '00090306030411130d00', '020900'),
                exchange(Line, '0013030d01', Long) )),
    sub_atom(Long, 0, 22, _, Reply).
test(ends_on_a_signal, [forall(member(Signal, [term, int])),
                        Status == exit(0)]) :-
    with_tmp_dir(ends_on(Signal, Status)).
test(existing_file_is_not_replaced, [true(Text == "mine\n")]) :-
    with_tmp_dir(refuses_file(Text)).
test(replaces_a_stale_link) :-
    with_tmp_dir(replaces_link).
test(bad_arguments, [forall(member(Args, [ [], ['--fault', none],
                                           ['--tcp', x],
                                           ['--tcp', 0, '--port', '5=touch'],
                                           ['--tcp', 0, '--port', '1=ear']
                                         ])),
                     Status == exit(2)]) :-
    run_brick(Args, Status).
test(bad_lines, Good == []) :-
    with_brick(['--tcp', 0], Brick,
               findall(Line,
                       ( bad_line(Line),
                         ask(Brick, Line, Answer),
                         Answer \= error(_)
                       ),
                       Good)).

:- end_tests(brick_life).

ends_on(Signal, Status, Dir) :-
    directory_file_path(Dir, nxt, Link),
    with_brick(['--pty', Link], Brick,
               ( Brick = sim(Pid, _, _, _),
                 process_kill(Pid, Signal),
                 end_status(Pid, 20, Status) )),
    \+ read_link(Link, _, _).

refuses_file(Text, Dir) :-
    directory_file_path(Dir, nxt, File),
    setup_call_cleanup(open(File, write, Out), writeln(Out, mine),
                       close(Out)),
    run_brick(['--pty', File], exit(1)),
    setup_call_cleanup(open(File, read, In), read_string(In, _, Text),
                       close(In)).

replaces_link(Dir) :-
    version(Version),
    directory_file_path(Dir, nxt, Link),
    link_file('/dev/pts/9999', Link, symbolic),
    with_brick(['--pty', Link], Brick,
               ( place(pty, Brick, Place),
                 with_line(Place, Line, exchange(Line, '0188', Version)) )).

run_brick(Args, Status) :-
    python(Python),
    project_file('bridges/nxt/brick.py', File),
    process_create(Python, [File, '--until-eof'|Args],
                   [stdin(null), stdout(null), stderr(null), process(Pid)]),
    end_status(Pid, 30, Status).
