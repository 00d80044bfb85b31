:- module(test_gpio, []).

/** <module> Pins of a board as services of a place

With the simulated board of gpiozero, and with helpers that are not to be
trusted.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/texts', [write_file/2, write_file/3]).
:- needs([gpio]).
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/shown').
:- use_module('../../../lib/transcript', [transcript_differences/3]).
:- use_module(library(plunit)).
:- use_module(library(filesex), [chmod/2, directory_file_path/3,
                                 make_directory_path/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_create/3, process_kill/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/bridges/helper), [helper_pid/2]).

:- meta_predicate at_board(+, 0), at_board(+, +, 0).

%   at_board(+Pins, :Goal), at_board(+Pins, +Options, :Goal): alpha has a
%   simulated board.

at_board(Pins, Goal) :-
    at_board(Pins, [factory(mock)], Goal).

at_board(Pins, Options, Goal) :-
    capturing(with_hosts([alpha], ( gpio_start(alpha, Pins, Options),
                                    once(Goal) )), _).

value(Name, Value) :-
    remote(alpha, pin(Name, Value0)),
    Value = Value0.

set(Name, Value) :-
    remote(alpha, pin(Name, Value)).

drive(Name, Values) :-
    forall(member(Value, Values), remote(alpha, pin_drive(Name, Value))).

error_of(Goal, Formal) :-
    catch(( remote(alpha, Goal), Formal0 = none ), error(Formal0, _), true),
    Formal = Formal0.

start_error(Pins, Options, Formal) :-
    with_hosts([alpha],
               ( catch(( gpio_start(alpha, Pins, Options), Formal0 = none ),
                       error(Formal0, _), true),
                 catch(gpio_stop(alpha), error(Left, _), true) )),
    ( Formal0 == none -> true ; assertion(Left == existence_error(gpio, alpha)) ),
    Formal = Formal0.

%   watcher(+Goal, +Count, -Agent): an agent that calls Goal, and whose result
%   are the next messages that it gets.

watcher(Goal, Count, Agent) :-
    watcher(Goal, Count, [host(alpha)], Agent).

watcher(Goal, Count, Options, Agent) :-
    create([ (main :- Goal, self(Id), leave(ready(Id)), take(Count, Ms),
              result(Ms)),
             (take(N, Ms) :- (   N > 0
                             ->  receive(gpio-M, 20),
                                 N1 is N-1,
                                 Ms = [M|Rest],
                                 take(N1, Rest)
                             ;   Ms = []
                             )) ], Agent, Options),
    wait_until(remote(alpha, sense(ready(Agent))), 10).

got(Agent, Messages) :-
    agent_result(Agent, Messages, 20).

kill_helper :-
    helper_pid(gpio(alpha), Pid),
    process_kill(Pid, kill),
    wait_until(( helper_pid(gpio(alpha), Other), Other =\= Pid ), 20).

%   with_thermometer(+Text, -File, :Goal): File is what the kernel shows of the
%   thermometer `air` of alpha, at first Text.

:- meta_predicate with_thermometer(+, -, 0).

with_thermometer(Text, File, Goal) :-
    with_tmp_dir(Dir,
                 ( thermometer(Dir, '28-00000a1b2c3d', Text, File),
                   at_board([air=thermometer('28-00000a1b2c3d')],
                            [factory(mock),w1(Dir)], Goal) )).

thermometer(Dir, Name, Text, File) :-
    directory_file_path(Dir, Name, Device),
    make_directory_path(Device),
    directory_file_path(Device, temperature, File),
    write_file(File, Text).

:- begin_tests(gpio_pins).

test(outputs, Values == [0,1,0,1]) :-
    at_board([a=output(17), b=output(18, [initial(1)])],
             ( value(a, A0), set(a, 1), value(a, A1),
               value(b, B1), set(b, 0), value(b, B0) )),
    Values = [A0,A1,B0,B1].
test(value_of_an_output_does_not_depend_on_its_level, Values == [0,1]) :-
    at_board([a=output(17, [active(low)])],
             ( value(a, V0), set(a, 1), value(a, V1) )),
    Values = [V0,V1].
test(inputs, Values == [0,1,0]) :-
    at_board([a=input(4, [pull(down)])],
             ( value(a, V0), drive(a, [1]), value(a, V1), drive(a, [0]),
               value(a, V2) )),
    Values = [V0,V1,V2].
test(pull_up_is_high, Values == [1,0,0,1]) :-
    at_board([a=input(4, [pull(up)]), b=input(5, [pull(up),active(low)])],
             ( value(a, A0), value(b, B0), drive(a, [0]), drive(b, [1]),
               value(a, A1), value(b, B1) )),
    Values = [A0,B0,A1,B1].
test(value_of_an_input_is_compared, true) :-
    at_board([a=input(4)], ( drive(a, [1]), set(a, 1), \+ set(a, 0),
                             value(a, 1) )).
test(pwm, Values == [0.5,0.25]) :-
    at_board([fan=pwm(18, [initial(0.5),frequency(50)])],
             ( value(fan, V0), set(fan, 0.25), value(fan, V1) )),
    Values = [V0,V1].
test(names_of_a_board, Error == permission_error(use, gpio_pin, 17)) :-
    start_error([a=output('BOARD11'), b=output(17)], [factory(mock)], Error).
test(simulated_thermometer, Values == [20.0,-3.5]) :-
    at_board([air=thermometer('28-00000a1b2c3d')],
             ( value(air, V0), drive(air, [-3.5]), value(air, V1) )),
    Values = [V0,V1].
test(thermometer_of_the_kernel, Values == [21.437,-0.062]) :-
    with_thermometer("21437\n", File,
                     ( value(air, V0), write_file(File, "-62\n"),
                       value(air, V1) )),
    Values = [V0,V1].
test(silent_thermometer, Error == gpio_error(silent, alpha)) :-
    with_thermometer("", _, error_of(pin(air, _), Error)).
test(pins_of_a_host, Pins == [led=output, door=input, fan=pwm]) :-
    at_board([led=output(17), door=input(4), fan=pwm(18)],
             remote(alpha, pins(Pins))).

:- end_tests(gpio_pins).

:- begin_tests(gpio_edges).

test(edges_are_messages, Ms == [edge(a, 1),edge(a, 0),edge(a, 1)]) :-
    at_board([a=input(4)], ( watcher(pin_watch(a), 3, A), drive(a, [1,0,1]),
                             got(A, Ms) )).
test(all_that_watch_a_pin_learn_of_it, [Ms,Ns] == [[edge(a, 1)],[edge(a, 1)]]) :-
    at_board([a=input(4)],
             ( watcher(pin_watch(a), 1, A), watcher(pin_watch(a), 1, B),
               drive(a, [1]), got(A, Ms), got(B, Ns) )).
test(latest_edge_is_a_fact, Facts == [edge(a, 0)]) :-
    at_board([a=input(4)],
             ( remote(alpha, pin_watch(a, [as(latest)])),
               watcher(pin_watch(a), 2, A), drive(a, [1,0]), got(A, _),
               remote(alpha, findall(F, sense(gpio-F), Facts)) )).
test(unwatched_pin_is_silent, Ms == [edge(b, 1)]) :-
    at_board([a=input(4), b=input(5)],
             ( watcher(( pin_watch(a), pin_watch(b), pin_unwatch(a) ), 1, A),
               drive(a, [1]), drive(b, [1]), got(A, Ms) )).
test(agent_that_has_left_gets_no_edges, M == user-go) :-
    capturing(with_hosts(
        [alpha,beta],
        ( link(alpha, beta),
          gpio_start(alpha, [a=input(4)], [factory(mock)]),
          create([ (main :- pin_watch(a), move(beta), here(H), leave(at(H)),
                    receive(M, 20), result(M)) ], A, [host(alpha)]),
          wait_until(remote(beta, sense(at(_))), 10),
          watcher(pin_watch(a), 1, B),
          drive(a, [1]),
          got(B, _),
          agent_send(A, go),
          agent_result(A, M, 20) )), _).

%   The edge of `b` comes when those of `a`, which do not last, would have come.

test(bounces_are_no_edges, Ms == [edge(b, 1),edge(a, 1)]) :-
    at_board([a=input(4, [debounce(0.2)]), b=input(5, [debounce(1)])],
             ( watcher(( pin_watch(a), pin_watch(b) ), 2, A),
               remote(alpha, pin_watch(b, [as(fact)])),
               drive(a, [1,0,1,0]), drive(b, [1]),
               wait_until(remote(alpha, sense(gpio-edge(b, 1))), 20),
               drive(a, [1,0,1]), got(A, Ms) )).
test(dropped_edges_are_counted, N == 4) :-
    at_board([a=input(4), b=input(5)],
             ( create([ (main :- pin_watch(a, [queue(2)]), self(Id),
                         leave(ready(Id)), receive(user-go, 20),
                         receive(gpio-_), receive(gpio-_),
                         receive(gpio-dropped(a, N0), 20), result(N0)) ],
                      A, [host(alpha)]),
               wait_until(remote(alpha, sense(ready(A))), 10),
               watcher(pin_watch(b), 1, B),
               drive(a, [1,0,1,0,1,0]), drive(b, [1]), got(B, _),
               agent_send(A, go),
               agent_result(A, N, 20) )).

:- end_tests(gpio_edges).

:- begin_tests(gpio_errors).

test(unknown_pin, Error == existence_error(pin, nix)) :-
    at_board([a=output(17)], error_of(pin(nix, _), Error)).
test(values, Errors == [ domain_error(pin_value, 2),
                         domain_error(pin_value, 0.5),
                         type_error(number, on),
                         domain_error(pin_value, 1.5),
                         domain_error(pin_value, -1) ]) :-
    at_board([a=output(17), f=pwm(18), i=input(4)],
             findall(Error,
                     ( member(Goal, [ pin(a, 2), pin(a, 0.5), pin(a, on),
                                      pin(f, 1.5), pin_drive(i, -1) ]),
                       error_of(Goal, Error) ),
                     Errors)).
test(kinds, Errors == [ permission_error(watch, pin, a),
                        permission_error(drive, pin, a),
                        existence_error(pin_watch, i) ]) :-
    at_board([a=output(17), i=input(4)],
             findall(Error,
                     ( member(Goal, [ pin_watch(a), pin_drive(a, 1),
                                      pin_unwatch(i) ]),
                       error_of(Goal, Error) ),
                     Errors)).
test(no_such_pin, Error == existence_error(gpio_pin, 99)) :-
    start_error([a=output(17), b=input(99)], [factory(mock)], Error).
test(no_such_thermometer, Error == existence_error(gpio_pin, '../x')) :-
    start_error([a=thermometer('../x')], [factory(mock)], Error).
test(pin_that_is_in_use, Error == permission_error(use, gpio_pin, 17)) :-
    start_error([a=output(17), b=input(17)], [factory(mock)], Error).
test(two_pins_of_one_name, Error == permission_error(open, pin, a)) :-
    start_error([a=output(17), a=output(18)], [factory(mock)], Error).
test(wrong_pins, Errors == [ domain_error(pin, a=led(3)),
                             domain_error(pin, a=output(x(1))),
                             domain_error(pin_option(output), pull(up)),
                             type_error(list, pins),
                             domain_error(gpio_option, fast(true)) ]) :-
    findall(Error,
            ( member(Pins-Options,
                     [ [a=led(3)]-[], [a=output(x(1))]-[],
                       [a=output(1, [pull(up)])]-[], pins-[],
                       []-[fast(true)] ]),
              start_error(Pins, Options, Error) ),
            Errors).
test(only_the_owner_opens_pins, Errors == [ permission_error(open, pin, b),
                                            permission_error(open, pin, a) ]) :-
    at_board([a=output(17)],
             findall(Error,
                     ( member(Goal, [pin_open(b, output(18)), pin_close(a)]),
                       error_of(Goal, Error) ),
                     Errors)).
test(opened_pins, Errors == [ permission_error(use, gpio_pin, 18), none,
                              none ]) :-
    at_board([a=output(18)], [factory(mock),open(true)],
             findall(Error,
                     ( member(Goal, [ pin_open(b, output(18)), pin_close(a),
                                      pin_open(b, output(18)) ]),
                       error_of(Goal, Error) ),
                     Errors)).
test(closed_pin, Ms == [edge(a, 1),closed(a)]) :-
    at_board([a=input(4)], [factory(mock),open(true)],
             ( watcher(pin_watch(a), 2, A), drive(a, [1]),
               remote(alpha, pin_close(a)), got(A, Ms) )).
test(machine_without_pins, Error == gpio_error(no_pins, alpha)) :-
    start_error([a=output(17)], [factory(native)], Error).

:- end_tests(gpio_errors).

%   Devices fail, and the helper goes on.

:- begin_tests(gpio_failures).

test(failure_of_each_request_is_its_error,
     Failed-Later == [F,F,F,F,F,F,F,F]-[none,none,none,none,none,none,none]) :-
    F = gpio_error(failed, alpha),
    with_tmp_dir(Dir, ( directory_file_path(Dir, broken, Broken),
                        failing_board(Dir, Broken, Failed, Later) )).

failing_board(Dir, Broken, Failed, Later) :-
    Requests = [ pin(a, 1), pin(a, _), pin(f, 0.5), pin(f, _), pin(i, _),
                 pin_drive(i, 1), pin_close(o) ],
    format(string(Code),
           "def failing(method):
    def call(*given):
        if os.path.exists('~w'):
            raise OSError(121, 'Remote I/O error')
        return method(*given)
    return call
for name in ['_get_state', '_set_state', '_set_function', 'drive_high']:
    for pin in [MockPin, MockPWMPin]:
        setattr(pin, name, failing(getattr(pin, name)))", [Broken]),
    with_patched(Dir, Code,
                 [a=output(17), f=pwm(18), i=input(4), o=output(22)],
                 [open(true)],
                 ( helper_pid(gpio(alpha), Pid),
                   write_file(Broken, ""),
                   errors([pin_open(b, output(23))|Requests], Failed),
                   delete_file(Broken),
                   errors(Requests, Later),
                   helper_pid(gpio(alpha), Pid) )).

errors(Goals, Errors) :-
    findall(Error, ( member(Goal, Goals), error_of(Goal, Error) ), Errors).

test(pin_that_fails_keeps_no_other_from_its_release, Text == "18") :-
    with_tmp_dir(Dir,
                 ( directory_file_path(Dir, released, File),
                   release(Dir, File, Text) )).

release(Dir, File, Text) :-
    format(string(Code),
           "def close(pin):
    if pin.number == 17:
        raise OSError(121, 'Remote I/O error')
    with open('~w', 'a') as stream:
        stream.write(str(pin.number))
MockPin.close = MockPWMPin.close = close", [File]),
    with_patched(Dir, Code, [a=output(17), b=output(18)], [],
                 gpio_stop(alpha)),
    read_file_to_string(File, Text, []).

test(unplugged_thermometer_is_silent_until_it_is_back,
     Error-Value == gpio_error(silent, alpha)-21.437) :-
    with_thermometer("21437\n", File,
                     ( delete_file(File), error_of(pin(air, _), Error),
                       write_file(File, "21437\n"), value(air, Value) )).
test(pin_that_a_restarted_helper_lacks_is_opened_when_it_is_back,
     Error-Value == existence_error(gpio_pin, '28-00000a1b2c3d')-21.437) :-
    with_thermometer("21437\n", File,
                     capturing(( delete_file(File), kill_helper,
                                 error_of(pin(air, _), Error),
                                 write_file(File, "21437\n"),
                                 value(air, Value) ), Messages)),
    assertion(memberchk(warning-typhon(gpio_pin_missing(alpha, "air", _)),
                        Messages)).
test(thermometer_that_hangs_stops_no_other,
     Error-Value == timeout_error(gpio(air), alpha)-21.437) :-
    with_tmp_dir(Dir, hanging(Dir, Error, Value)).

%   A pipe that no process writes to hangs.

hanging(Dir, Error, Value) :-
    thermometer(Dir, '28-00000a1b2c3d', "21437\n", File),
    thermometer(Dir, '28-00000a1b2c3e', "21437\n", _),
    delete_file(File),
    process_create(path(mkfifo), [File], []),
    at_board([ air=thermometer('28-00000a1b2c3d'),
               cellar=thermometer('28-00000a1b2c3e') ],
             [factory(mock),w1(Dir),timeout(3)],
             ( error_of(pin(air, _), Error), value(cellar, Value) )).

:- meta_predicate with_patched(+, +, +, +, 0).

%   with_patched(+Dir, +Code, +Pins, +Options, :Goal): Code changes the
%   simulated board before the bridge begins.

with_patched(Dir, Code, Pins, Options, Goal) :-
    directory_file_path(Dir, patched, File),
    write_file(File, "#!/usr/bin/python3
import os, runpy, sys
from gpiozero.pins.mock import MockPin, MockPWMPin
~w
sys.argv = sys.argv[2:]
runpy.run_path(sys.argv[0], run_name='__main__')
", [Code]),
    chmod(File, +x),
    at_board(Pins, [factory(mock),python(File)|Options], Goal).

:- end_tests(gpio_failures).

:- begin_tests(gpio_document).

test(thermostat, Differences == []) :-
    with_tmp_dir(Dir, document(Differences, Dir)).

document(Differences, Dir) :-
    Document = 'doc/boards.md',
    directory_file_path(Dir, 'thermostat.pl', File),
    shown_in_file(Document, "```prolog\n% thermostat.pl\n", File),
    Begin = "?- host_start(office)",
    string_concat("```text\n", Begin, Text),
    shown(Document, Text, Session),
    string_concat(Begin, Session, All),
    split_string(All, "\n", "", Lines),
    transcript_differences([1-Lines], Dir, Differences).

:- end_tests(gpio_document).

:- begin_tests(gpio_helper).

test(released_with_its_host, true) :-
    capturing(with_hosts([alpha],
                         ( gpio_start(alpha, [a=output(17)], [factory(mock)]),
                           helper_pid(gpio(alpha), Pid),
                           host_stop(alpha) )), _),
    wait_until(is_dead(Pid), 10).
test(stopped, Error = existence_error(procedure, _)) :-
    at_board([a=output(17)],
             ( gpio_stop(alpha), error_of(pin(a, _), Error) )).
test(killed_helper_opens_its_pins_again, Values-Ms == [0,0]-[edge(i, 1)]) :-
    at_board([a=output(17), i=input(4)],
             ( watcher(pin_watch(i), 1, A), set(a, 1), kill_helper,
               value(a, V0), value(i, I0), drive(i, [1]), got(A, Ms) )),
    Values = [V0,I0].
test(request_to_a_helper_that_dies, Error == helper_died(exit(7), gpio(alpha))) :-
    with_fake("if request['do'] == 'read': os._exit(7)", [a=output(17)],
              error_of(pin(a, _), Error)).
test(values_of_the_helper_are_checked, Errors == [ gpio_error(failed, alpha),
                                                   gpio_error(failed, alpha),
                                                   none ]) :-
    with_fake("reply['ok'] = 7 if request['do'] == 'read' else {}",
              [a=input(17), f=pwm(18), t=thermometer('28-000000000000')],
              findall(Error, ( member(Name, [a,f,t]),
                               error_of(pin(Name, _), Error) ), Errors)).

%   An edge of no pin, of an output, and of a wrong value are ignored.

test(events_of_the_helper_are_checked, Ms == [edge(i, 1)]) :-
    with_fake("if request['do'] == 'read':\n    \c
                   for fields in [{}, {'pin': 'zzunknown', 'value': 1}, \c
                                  {'pin': 'a', 'value': 1}, \c
                                  {'pin': 'i', 'value': 'x'}, \c
                                  {'pin': 'i', 'value': 2}, \c
                                  {'pin': ['i'], 'value': 1}, \c
                                  {'pin': 'i', 'value': 1}]:\n        \c
                       say(dict(fields, event='edge'))",
              [a=output(17), i=input(4)],
              ( watcher(pin_watch(i), 1, A),
                catch(remote(alpha, pin(i, _)), error(_, _), true),
                got(A, Ms) )).

:- meta_predicate with_fake(+, +, 0).

%   with_fake(+Code, +Pins, :Goal): the helper of alpha answers {} to all
%   requests, after Code.

with_fake(Code, Pins, Goal) :-
    with_tmp_dir(Dir,
                 ( directory_file_path(Dir, fake, File),
                   split_string(Code, "\n", "", Lines),
                   findall(Line, ( member(Line0, Lines),
                                   string_concat("    ", Line0, Line) ),
                           Indented),
                   atomic_list_concat(Indented, '\n', Body),
                   write_file(File, "#!/usr/bin/python3
import json, os, sys
def say(message):
    print(json.dumps(message), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    reply = {'ok': {}}
~w
    say(dict(reply, id=request.get('id')))
", [Body]),
                   chmod(File, +x),
                   at_board(Pins, [factory(mock),python(File)], Goal) )).

:- end_tests(gpio_helper).
