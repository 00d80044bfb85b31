:- module(test_nxt_faults, []).

/** <module> Faults of the bridge to NXT bricks

Every error with its context, recovery after it, calls that wait for others,
and the state after the death of one of the three processes.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/texts', [write_file/3]).
:- needs(['python3-serial']).
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/nxt_fixtures').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(process), [process_create/3, process_kill/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/nxt)).

error_of(Goal, Formal, Context) :-
    catch(( call(Goal) -> true ; true ), error(Formal0, Context0), true),
    Formal = Formal0,
    Context = Context0.

:- begin_tests(nxt_ports).

test(no_such_port, E-W == existence_error(nxt_port, Port)-nxt(b, open)) :-
    Port = '/dev/no_such_nxt',
    no_leaks(error_of(nxt_connect(b, Port), E, context(W, _))).
test(port_without_a_process, E == existence_error(nxt_port, Port)) :-
    free_port(Number),
    format(atom(Port), 'socket://127.0.0.1:~d', [Number]),
    error_of(nxt_connect(b, Port), E, _).
test(no_such_protocol, E == existence_error(nxt_port, 'foo://x')) :-
    error_of(nxt_connect(b, 'foo://x'), E, _).
test(file_is_no_serial_line, E == nxt_error(open_failed, b)) :-
    project_file('pack.pl', File),
    error_of(nxt_connect(b, File), E, _).
test(permission) :-
    project_file('test/lib/nxt_wrapper.py', Python),
    with_peer(Peer, Port,
              ( peer_command(Peer, forbid),
                peer_received(Peer, forbidden),
                error_of(nxt_connect(b, Port, [python(Python)]), E, _)
              )),
    assertion(E == permission_error(open, nxt_port, Port)).
test(locked) :-
    with_peer(Peer, Port,
              ( peer_command(Peer, lock),
                peer_received(Peer, locked),
                error_of(nxt_connect(b, Port), E, _)
              )),
    assertion(E == permission_error(lock, nxt_port, Port)).
test(connected_twice, E == permission_error(connect, nxt_brick, b)) :-
    with_peer(_, Port,
              connected(b, Port, [], error_of(nxt_connect(b, Port), E, _))).
test(not_connected, E == existence_error(nxt_brick, b)) :-
    error_of(nxt_battery(b, _), E, _).
test(no_python, E == existence_error(python, '/no/python')) :-
    no_leaks(error_of(nxt_connect(b, '/dev/x', [python('/no/python')]),
                      E, _)).
test(no_pyserial, E-Found == existence_error(python_module, serial)-true) :-
    with_tmp_dir(no_pyserial(E, Context)),
    '$messages':translate_message(error(E, Context), Lines, []),
    with_output_to(codes(Codes),
                   print_message_lines(current_output, '', Lines)),
    string_codes(Text, Codes),
    ( sub_string(Text, _, _, _, "python3-serial") -> Found = true
    ; Found = Text ).
test(options, E == domain_error(nxt_option, colour(red))) :-
    error_of(nxt_connect(b, '/dev/x', [colour(red)]), E, _).

no_pyserial(E, Context, Dir) :-
    directory_file_path(Dir, python, File),
    write_file(File, '#!/bin/sh~nexec /usr/bin/python3 -S "$@"~n', []),
    process_create(path(chmod), ['+x', File], []),
    error_of(nxt_connect(b, '/dev/x', [python(File)]), E, Context).

:- end_tests(nxt_ports).

:- begin_tests(nxt_answers).

test(silent, E-W == timeout_error(nxt('GETBATTERYLEVEL'), b)-
                    nxt(b, 'GETBATTERYLEVEL')) :-
    after(silence, E, context(W, _)).
test(half_a_reply, E == timeout_error(nxt('GETBATTERYLEVEL'), b)) :-
    after('raw 0500020b', E, _).
test(garbage, E == nxt_error(garbage, b)) :-
    after('raw deadbeef00112233445566778899', E, _).
test(short_reply, E == nxt_error(garbage, b)) :-
    after('answer 020b00', E, _).
test(refused) :-
    with_peer(b, [], Peer,
        forall(refusal(Byte, Name),
               ( atom_concat('answer 020b', Byte, Line),
                 peer_command(Peer, Line), error_of(nxt_battery(b, _), E, C),
                 assertion(E == nxt_error(refused(Name), b)),
                 assertion(C = context(nxt(b, 'GETBATTERYLEVEL'), _)) ))).
test(late_replies_are_dropped, MilliVolts == 8000) :-
    with_peer(b, [deadline(30)], Peer,
        ( peer_command(Peer, 'raw 0500020b00e803'),
          peer_command(Peer, 'answer 020b00401f'),
          nxt_battery(b, 1000),
          nxt_battery(b, MilliVolts) )).
test(line_lost, E == nxt_error(line_lost, b)) :-
    with_peer(Peer, Port,
        connected(b, Port, [deadline(30)],
            ( peer_command(Peer, 'lose 0500020b'),
              error_of(nxt_battery(b, _), E, _),
              error_of(nxt_battery(b, _), Later, _) ))),
    assertion(memberchk(Later, [ existence_error(nxt_port, Port),
                                 nxt_error(open_failed, b) ])).
test(restored_line) :-
    with_brick(b, [], Brick,
        ( nxt_touch(b, 1, _),
          brick_ask(Brick, 'fault cut', ok),
          error_of(nxt_touch(b, 1, _), E, _),
          brick_ask(Brick, restore, _),
          wait_until(catch(nxt_touch(b, 1, _), error(_, _), fail), 20) )),
    assertion(memberchk(E, [ nxt_error(line_lost, b),
                             timeout_error(nxt(sensor), b) ])).
test(low_battery, MilliVolts == 5500) :-
    with_brick(b, [], Brick,
        ( brick_ask(Brick, 'fault battery 5500', ok),
          nxt_battery(b, MilliVolts) )).

%   refusal(StatusByte, Name)

refusal('20', pending).
refusal('40', mailbox_empty).
refusal('81', no_more_handles).
refusal('82', no_space).
refusal('83', no_more_files).
refusal('84', end_of_file_expected).
refusal('85', end_of_file).
refusal('86', not_a_linear_file).
refusal('87', file_not_found).
refusal('88', handle_closed).
refusal('89', no_linear_space).
refusal('8a', undefined).
refusal('8b', file_busy).
refusal('8c', no_write_buffers).
refusal('8d', cannot_append).
refusal('8e', file_full).
refusal('8f', file_exists).
refusal('90', module_not_found).
refusal('91', out_of_bounds).
refusal('92', illegal_file_name).
refusal('93', illegal_handle).
refusal(bd, request_failed).
refusal(be, unknown_opcode).
refusal(bf, insane_packet).
refusal(c0, out_of_range).
refusal(dd, bus_error).
refusal(de, no_memory_in_buffer).
refusal(df, channel_invalid).
refusal(e0, channel_not_configured).
refusal(ec, no_active_program).
refusal(ed, illegal_size).
refusal(ee, illegal_mailbox).
refusal(ef, bad_field).
refusal(f0, bad_port).
refusal(fb, out_of_memory).
refusal(ff, bad_arguments).
refusal('77', status_119).

%   after(What, Error, Context): the error after the peer has done What; the
%   next call succeeds.

after(What, Error, Context) :-
    with_peer(b, [deadline(2)], Peer,
        ( peer_command(Peer, What),
          error_of(nxt_battery(b, _), Error, Context),
          peer_command(Peer, 'answer 020b00401f'),
          nxt_battery(b, MilliVolts) )),
    assertion(MilliVolts == 8000).

:- end_tests(nxt_answers).

:- begin_tests(nxt_helpers).

test(killed, E == nxt_error(helper_died(killed(9)), b)) :-
    with_peer(b, [deadline(60)], Peer,
        ( thread_self(Me),
          helper_pid(Pid),
          thread_create(( error_of(nxt_battery(b, _), F, _),
                          thread_send_message(Me, said(F)) ),
                        Thread),
          peer_received(Peer, '000b'),
          process_kill(Pid, kill),
          thread_get_message(Me, said(E), [timeout(20)]),
          thread_join(Thread, _),
          peer_command(Peer, 'answer 020b00401f'),
          nxt_battery(b, MilliVolts),
          helper_pid(Other) )),
    assertion(MilliVolts == 8000),
    assertion(Other \== Pid).
test(killed_while_idle, MilliVolts == 8000) :-
    with_peer(b, [], Peer,
        ( helper_pid(Pid),
          process_kill(Pid, kill),
          wait_until(\+ helper_pid(_), 20),
          wait_until(answers(Peer, MilliVolts), 60) )).
test(stuck, E == nxt_error(helper_died(stuck), b)) :-
    with_peer(b, [deadline(0.2)], Peer,
        ( helper_pid(Pid),
          process_kill(Pid, stop),
          error_of(nxt_battery(b, _), E, _),
          wait_until(\+ helper_pid(Pid), 20),
          wait_until(answers(Peer, MilliVolts), 60) )),
    assertion(MilliVolts == 8000).

%   A late answer is dropped.

answers(Peer, MilliVolts) :-
    peer_command(Peer, 'answer 020b00401f'),
    catch(nxt_battery(b, MilliVolts), error(_, _), fail).

test(disconnected_during_a_call, E == existence_error(nxt_brick, b)) :-
    with_peer(Peer, Port,
              ( nxt_connect(b, Port, [deadline(60)]),
                thread_self(Me),
                thread_create(( error_of(nxt_battery(b, _), F, _),
                                thread_send_message(Me, said(F))
                              ), Thread),
                peer_received(Peer, '000b'),
                nxt_disconnect(b),
                thread_get_message(Me, said(E), [timeout(20)]),
                thread_join(Thread, _)
              )).
test(prolog_dies) :-
    with_brick(Brick, Port, prolog_dies(Brick, Port)).

%   The helper stops the motors and ends.

prolog_dies(Brick, Port) :-
    format(atom(Goal),
           'nxt_connect(b,~q),nxt_run(b,a,50),\c
            typhon_helper_requests:helper_pid(nxt(_),P),\c
            print(P),nl,thread_get_message(x)',
           [Port]),
    project_file('prolog/typhon/nxt.pl', File),
    with_swipl(['-q', '-g', Goal, File], Pid, _, Out,
               ( read_line_to_string(Out, Line),
                 number_string(Helper, Line),
                 brick_ask(Brick, 'motor A', Runs),
                 assertion(Runs = motor(a, 50, _, _, _, _, _)),
                 process_kill(Pid, kill),
                 wait_until(brick_ask(Brick, 'motor A',
                                      motor(a, 0, _, _, _, _, _)), 20),
                 format(atom(Proc), '/proc/~d/cmdline', [Helper]),
                 wait_until(\+ exists_file(Proc), 20)
               )).

:- end_tests(nxt_helpers).

:- begin_tests(concurrent_nxt_calls).

test(calls_are_serialized, Heard == [ '000b', '000b', '000b', '000b' ]) :-
    with_peer(b, [deadline(30)], Peer,
        ( forall(between(1, 4, _), peer_command(Peer, 'late 0.05 020b00401f')),
          threads(4, nxt_battery(b, 8000)),
          numlist(1, 4, Ns),
          maplist(hear(Peer), Ns, Heard) )).
test(answers_are_not_mixed_up) :-
    with_brick(b, [deadline(30)], Brick,
        ( brick_ask(Brick, 'set 4 99', ok),
          brick_ask(Brick, 'set 1 1', ok),
          threads([ many(nxt_ultrasonic(b, 4, 99)), many(nxt_touch(b, 1, true)),
                    many(nxt_tacho(b, a, 0)),
                    many(nxt_file_exists(b, 'Demo.rxe')) ]) )).
test(two_bricks_at_once) :-
    with_peer(Slow, Port1,
              with_peer(Fast, Port2,
                        connected(slow, Port1, [deadline(60)],
                                  connected(fast, Port2, [],
                                            at_once(Slow, Fast))))).

test(threads_are_named_after_their_brick, Count == 2) :-
    with_brick(b, [deadline(30)], _,
        ( nxt_battery(b, _),
          aggregate_all(count, thread_of(b), Count) )).

thread_of(Brick) :-
    atomic_list_concat([typhon_nxt_, Brick, '_'], Start),
    thread_property(_, alias(Alias)),
    atom_concat(Start, _, Alias).

%   The slow brick has not answered when the fast one has.

at_once(Slow, Fast) :-
    thread_self(Me),
    thread_create(( nxt_battery(slow, V), thread_send_message(Me, slow(V)) ),
                  Thread),
    peer_received(Slow, '000b'),
    peer_command(Fast, 'answer 020b00401f'),
    nxt_battery(fast, 8000),
    assertion(\+ thread_peek_message(Me, slow(_))),
    peer_command(Slow, 'now 020b00a00f'),
    thread_get_message(Me, slow(V1), [timeout(20)]),
    thread_join(Thread, _),
    assertion(V1 == 4000).

hear(Peer, _, Heard) :-
    peer_received(Peer, Heard).

many(Goal) :-
    forall(between(1, 30, _), assertion(Goal)).

threads(N, Goal) :-
    findall(Goal, between(1, N, _), Goals),
    threads(Goals).

threads(Goals) :-
    findall(Thread,
            ( member(Goal, Goals),
              thread_create(Goal, Thread)
            ),
            Threads),
    maplist(thread_join, Threads, Statuses),
    forall(member(Status, Statuses), assertion(Status == true)).

:- end_tests(concurrent_nxt_calls).

:- begin_tests(nxt_agents).

test(services, Outcome-MilliVolts == done-[8000]) :-
    with_peer(b, [], Peer,
        ( peer_command(Peer, 'answer 020b00401f'),
          with_hosts([alpha-[services(library(typhon/nxt))]],
                     ( create([ (main :- nxt_battery(b, V), leave(volts(V))) ],
                              Agent),
                       joined(Agent, Outcome),
                       tuples_of(alpha, MilliVolts) )) )).
test(agent_gets_the_error,
     Errors == [timeout_error(nxt('GETBATTERYLEVEL'), b)]) :-
    with_peer(b, [deadline(2)], _,
        with_hosts([alpha-[services(library(typhon/nxt))]],
                   ( create([ ( main :- catch(nxt_battery(b, _), error(E, _),
                                              true),
                                leave(volts(E)) ) ],
                            Agent),
                     joined(Agent, _), tuples_of(alpha, Errors) ))).

test(consulted, Outcome-Values == done-[near]) :-
    with_brick(Brick, Port,
               ( brick_ask(Brick, 'set 4 12', ok),
                 connected(lizzy, Port, [],
                           with_tmp_dir(consulted(Outcome, Values))) )).

%   As in doc/robots.md.

consulted(Outcome, Values, Dir) :-
    directory_file_path(Dir, 'lizzy.pl', File),
    write_file(File, ':- use_module(library(typhon/nxt)).~n\c
                      obstacle :- nxt_ultrasonic(lizzy, 4, D), D < 20.~n', []),
    with_hosts([alpha-[consult(File)]],
               ( create([ (main :- obstacle, leave(volts(near))) ], Agent),
                 joined(Agent, Outcome),
                 tuples_of(alpha, Values) )).

tuples_of(Host, Values) :-
    address(Host, Address),
    remote(Address, findall(V, sense(volts(V)), Values)).

:- end_tests(nxt_agents).
