:- module(test_app, []).

% The command line, in separate processes, as from a shell.

:- use_module('../../app/packaging/parts', [installed/1]).
:- use_module('../lib/common').
:- use_module('../lib/texts', [write_file/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, subset/2]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(sgml), [load_structure/3]).

:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil), [read_file_to_string/3, read_line_to_string/2]).

typhon(Args, Status, Out, Err) :-
    typhon_args(Args, SwiplArgs),
    run_swipl(SwiplArgs, [timeout(60)], Status, Out, Err).

%   On a busy machine processes answer late.

typhon_args(Args, ['-g',Heard,App|Args]) :-
    Heard = 'settings:set_setting(typhon_inventory:seconds,30)',
    project_file('app/typhon.pl', App).

%   The output of a successful command, in lines.

typhon_lines(Args, Lines) :-
    typhon(Args, Status, Out, Err),
    assertion(Status-Err == exit(0)-""),
    split_string(Out, "\n", "", Lines0),
    append(Lines, [_], Lines0),
    !.

%   An expected error: one line, no stack, status 1.

typhon_error(Args, Text) :-
    typhon_error(Args, Text, "").

typhon_error(Args, Text, Hint) :-
    typhon(Args, Status, Out, Err),
    assertion(Status-Out == exit(1)-""),
    split_string(Err, "\n", "\n", Lines),
    assertion(Lines = [_]),
    assertion(sub_string(Err, _, _, _, Text)),
    assertion(sub_string(Err, _, _, _, Hint)).

:- meta_predicate with_typhon(+, -, -, 0).

%   Goal runs while `typhon Args` does; Line is the first it printed.

with_typhon(Args, Pid, Line, Goal) :-
    typhon_args(Args, SwiplArgs),
    with_swipl(SwiplArgs, Pid, _, Out,
               ( read_line_to_string(Out, Line0),
                 assertion(string(Line0)),
                 atom_string(Line, Line0),
                 call(Goal)
               )).

has_line(Lines, Pattern) :-
    member(Line, Lines),
    wildcard_match(Pattern, Line),
    !.

write_file(Dir, Name, Text, File) :-
    directory_file_path(Dir, Name, File),
    write_file(File, Text).

:- begin_tests(app_help).

test(overview) :-
    typhon_lines(['--help'], Lines),
    forall(member(Command, [host, network, check, create, agents, hosts, tree, send,
                            move, dispose, join, remote, stop, log,
                            story, picture, diagnose]),
           ( atom_concat(Command, ' *', Pattern0),
             atom_concat('  ', Pattern0, Pattern),
             assertion(has_line(Lines, Pattern))
           )).
test(help_is_apart_from_the_arguments) :-
    typhon_lines(['--help'], Lines),
    forall(member(Line, Lines),
           assertion(\+ sub_string(Line, _, _, _, "NAMEmake"))),
    assertion(nextto("  keys init | host NAME | author NAME | revoke NAME",
                     "                          make an authority, make or \c
                      revoke keys for hosts and authors", Lines)).
test(without_arguments, Lines1 == Lines2) :-
    typhon_lines([], Lines1),
    typhon_lines(['--help'], Lines2).
test(closed_output_pipe, Text == "") :-
    project_file('app/typhon.pl', App),
    with_tmp_dir(stopped_reading(App, Text)).
test(command, forall(member(Command-Pattern,
                            [ host-'*--port=PORT*', network-'*--processes=N*',
                              create-'*--join=SECONDS*',
                              agents-'*--host=ADDRESS*',
                              hosts-'*--host=ADDRESS*',
                              network-'    grid(ROWS,COLUMNS)*a grid*',
                              move-'*--timeout=SECONDS*',
                              send-'*--host=ADDRESS*', log-'*--serve*',
                              picture-'*--from=TIME*',
                              diagnose-'Usage:*'
                            ]))) :-
    typhon_lines([Command, '--help'], Lines),
    assertion(has_line(Lines, Pattern)).

stopped_reading(App, Text, Dir) :-
    directory_file_path(Dir, err, Err),
    current_prolog_flag(executable, Swipl),
    format(atom(Script), '~w ~w --help 2>~w | exec <&-', [Swipl, App, Err]),
    shell(Script),
    read_file_to_string(Err, Text, []).

:- end_tests(app_help).

%   wrong(Name, Args, Text, Hint): the error of a command.

wrong(unknown_command, [hots], "no command hots (did you mean host or hosts?)",
      "").
wrong(too_few_arguments, [host], "host takes NAME", "").
wrong(unknown_option, [host, alpha, '--prot', 7],
      "host has no option --prot (did you mean port?)", "").
wrong(unknown_option, [network, 'ring(2)', '--hop-tme=x'],
      "(did you mean hop_time?)", "").
wrong(unknown_option, [host, alpha, '-p', 3], "host has no option -p", "").
wrong(wrong_type, [host, alpha, '--port', many], "many",
      "an integer of at least 0").
wrong(no_value, [host, alpha, '--port'], "--port needs a value", "").
wrong(missing_option, [create, 'agents(x)'], "--host", "").
wrong(not_a_term, [network, 'grid(2,'], "grid(2,", "").
wrong(not_a_term, [create, x, '--host', a, '--fact', 'p('],
      "not a Prolog term: p(", "").
wrong(not_a_topology, [network, 'blob(2)'], "blob(2)",
      "network --help lists the shapes").
wrong(no_such_file, [host, alpha, '--consult', '/no/such.pl'], "/no/such.pl",
      "").
wrong(no_process_at_the_address, [hosts, '--host', Address], Advice, "") :-
    free_port(Port),
    format(atom(Address), 'alpha@127.0.0.1:~d', [Port]),
    atom_concat('diagnose ', Address, Advice).
wrong(command_without_arguments, [agents, x], "agents takes options only", "").
wrong(options_may_precede_the_command, Args, Text, "") :-
    member(Args-Text, [ ['--host', alpha, agents]-"There is no host alpha",
                        ['--host=alpha', agents]-"There is no host alpha",
                        ['--no-read-only', page]-"page needs --host" ]).
wrong(text_without_quotes, [send, 'bob@alpha@127.0.0.1:9'|Words], Proposed,
      "") :-
    member(Words-Proposed, [ ['Hello']-"\"'Hello'\"", ['it is']-"\"'it is'\"",
                             [it, is]-"\"'it is'\"" ]).
wrong(not_an_id, [dispose, bob], "with --host ADDRESS a name is enough", "").

:- begin_tests(app_errors).

test(command_is_wrong, [forall(wrong(_, Args, Text, Hint))]) :-
    typhon_error(Args, Text, Hint).

:- end_tests(app_errors).

:- begin_tests(app_host).

test(stops_cleanly, [ forall(member(Signal, [term, int])),
                      Status == exit(0) ]) :-
    with_typhon([host, alpha], Pid, Address,
                ( assertion(wildcard_match('alpha@127.0.0.1:*', Address)),
                  typhon_lines([agents, '--host', Address], ["No agents"]),
                  process_kill(Pid, Signal),
                  wait_for_end(Pid, 10, Status)
                )).
test(port) :-
    free_port(Port),
    with_typhon([host, alpha, '--port', Port], _, Address, true),
    assertion(format(atom(Address), 'alpha@127.0.0.1:~d', [Port])).
test(serves) :-
    with_tmp_dir(serves).

serves(Dir) :-
    write_file(Dir, 'place.pl', 'colour(red).\n', Place),
    write_file(Dir, 'painter.pl',
               ':- agent(painter, []).\n\c
                main :- colour(C), leave(seen(C)).\n\c
                on_message(_, paint(C)) :- leave(painted(C)).\n',
               Program),
    with_typhon([host, alpha, '--consult', Place], _, Address,
                paint(Address, Program)).

paint(Address, Program) :-
    typhon_lines([create, Program, '--host', Address, '--name', bob],
                 [Agent]),
    assertion(has_line([Agent], 'bob.*@alpha@*')),
    wait_until(is_resident(Address), 20),
    typhon_lines([send, Agent, 'paint(blue)'], []),
    typhon_lines([hosts, '--host', Address], Hosts),
    assertion(has_line(Hosts, '*alpha@*1*')).

is_resident(Address) :-
    typhon([agents, '--host', Address], exit(0), Out, _),
    split_string(Out, "\n", "", Agents),
    has_line(Agents, '*bob.*resident*').

test(tree) :-
    with_tmp_dir(tree).

tree(Dir) :-
    write_file(Dir, 'worker.pl',
               ':- agent(worker, []).\nmain :- receive(_-stop).\n', Program),
    format(atom(Child), 'child(ann, \'~w\', [])', [Program]),
    with_typhon([host, alpha], _, Address,
                ( typhon_lines([tree, '--host', Address],
                               ["No agent that monitors others"]),
                  typhon_lines([create, 'agents(supervisor)', '--host', Address,
                                '--fact', Child], [_]),
                  wait_until(has_child(Address), 20) )).

has_child(Address) :-
    typhon([tree, '--host', Address], exit(0), Out, _),
    split_string(Out, "\n", "", [_,Top,Child|_]),
    wildcard_match("supervisor.*", Top),
    wildcard_match("  ann.* child * worker *", Child).

test(join) :-
    with_tmp_dir(join).

join(Dir) :-
    write_file(Dir, 'ends.pl',
               ':- agent(ends, [state([n/1])]).\nmain :- n(1).\n',
               Program),
    with_typhon([host, alpha], _, Address,
                ( typhon_lines([create, Program, '--host', Address,
                                '--fact', 'n(1)', '--join', 10],
                               [_, Outcome]),
                  typhon([create, Program, '--host', Address,
                          '--join', 10], Status, _, _)
                )),
    assertion(Outcome == "done"),
    assertion(Status == exit(1)).

%   By an id, or by a name if the network is given.

test(orders) :-
    with_tmp_dir(orders).

orders(Dir) :-
    write_file(Dir, 'tourist.pl',
               ':- agent(tourist, []).\non_message(_, stop) :- dispose.\n',
               Program),
    with_typhon([network, 'ring(3)', '--processes', 2], Pid, N1,
                ( orders(N1, Program),
                  process_kill(Pid, int),
                  wait_for_end(Pid, 20, Status)
                )),
    assertion(Status == exit(0)).

orders(N1, Program) :-
    typhon_lines([create, Program, '--host', N1, '--name', bob], [Bob]),
    typhon_lines([create, Program, '--host', N1, '--name', ann], [_]),
    typhon_lines([move, bob, n3, '--host', N1], []),
    typhon_lines([agents, '--host', N1], Agents),
    assertion(has_line(Agents, 'bob.*n3 *tourist *resident *1 *0')),
    typhon_lines([dispose, Bob], []),
    typhon([join, Bob, '--timeout', 5], exit(1), "disposed\n", ""),
    typhon_error([move, ann, n7, '--host', N1], "no host n7"),
    typhon_error([dispose, bob, '--host', N1], "no agent bob"),
    typhon_error([dispose, annn, '--host', N1], "(did you mean ann."),
    typhon_lines([remote, N1, 'neighbours([A,B]), write(hi), nl, _X = 1'],
                 ["hi", Line1, Line2]),
    assertion(has_line([Line1], 'A = *n2@*')),
    assertion(has_line([Line2], 'B = *n3@*')),
    typhon([remote, N1, fail], exit(1), "", "").

test(stop) :-
    with_typhon([host, alpha], Pid, Alpha,
                ( typhon_lines([stop, Alpha], []),
                  wait_for_end(Pid, 10, Status),
                  typhon_error([stop, Alpha], Alpha)
                )),
    assertion(Status == exit(0)).

%   The process of a program continues after its host has been stopped.

test(stop_a_host_of_a_program) :-
    project_file('prolog/typhon.pl', Typhon),
    Goal = 'host_start(alpha), host_property(alpha, address(A)), writeln(A), \c
            flush_output, read(_)',
    with_swipl(['-g', Goal, '-t', halt, Typhon], _, _, Out,
               ( read_line_to_string(Out, Line),
                 atom_string(Alpha, Line),
                 typhon_lines([stop, Alpha], []),
                 typhon_error([hosts, '--host', Alpha], Alpha) )).

test(check) :-
    with_tmp_dir(check).

check(Dir) :-
    write_file(Dir, 'good.pl', ':- agent(good, []).\nmain.\n', Good),
    write_file(Dir, 'bad.pl',
               ':- agent(bad, []).\nmain :- \\+ move(x).\n', Bad),
    typhon([check, Good], exit(0), "", _),
    typhon([check, Good, Bad], exit(1), "", Err),
    assertion(sub_string(Err, _, _, _, "bad.pl:2")),
    typhon_error([check, '/no/such/program'], "agents(census)"),
    typhon([log, '/no/such/log'], exit(1), "", LogErr),
    assertion(\+ sub_string(LogErr, _, _, _, "census")).

test(link) :-
    with_typhon([host, alpha], _, Alpha,
        with_typhon([host, beta, '--link', Alpha], _, _,
                    ( typhon_lines([hosts, '--host', Alpha], Hosts),
                      assertion(has_line(Hosts, '*alpha@*beta*'))
                    ))).

test(mqtt, condition(( installed(bridges), has_paho ))) :-
    with_typhon([host, alpha, '--mqtt', 'mqtt://127.0.0.1:1'], _, Alpha,
                typhon_lines([remote, Alpha, 'publish(a,b)'], [])).

has_paho :-
    typhon([diagnose, mqtt, 'mqtt://127.0.0.1:1'], _, Out, _),
    split_string(Out, "\n", "", Lines),
    \+ has_line(Lines, '*FAIL*paho*').

:- end_tests(app_host).

:- begin_tests(app_network).

test(runs_until_stopped, Status == exit(0)) :-
    with_typhon([network, 'ring(4)', '--processes', 2], Pid, Address,
                ( typhon_lines([hosts, '--host', Address], Hosts),
                  process_kill(Pid, int),
                  wait_for_end(Pid, 20, Status)
                )),
    assertion(length(Hosts, 5)).

:- end_tests(app_network).

:- begin_tests(app_log).

test(serve_and_print) :-
    with_tmp_dir(serve_and_print).

serve_and_print(Dir) :-
    directory_file_path(Dir, events, File),
    with_typhon([log, File, '--serve'], Pid, Log,
                ( with_typhon([host, alpha, '--log', Log], _, Address,
                              log_something(Dir, Address)),
                  process_kill(Pid, int),
                  wait_for_end(Pid, 10, Status)
                )),
    assertion(Status == exit(0)),
    typhon_lines([log, File], Lines),
    assertion(has_line(Lines, '*alpha@*chatty*hello(world)*')).

log_something(Dir, Address) :-
    write_file(Dir, 'chatty.pl',
               ':- agent(chatty, []).\nmain :- log(hello(world)).\n',
               Program),
    typhon_lines([create, Program, '--host', Address, '--join', 10],
                 [_, "done"]).

%   A log of three hosts: one agent hops, logs, and sends its clone a message.

log_of(Dir, File) :-
    directory_file_path(Dir, 'some.log', File),
    setup_call_cleanup(
        open(File, write, Out),
        forall(logged(Event), ( writeq(Out, Event), writeln(Out, '.') )),
        close(Out)).

logged(event(0.0, 'n1@h:1', 'a.x.1@n1@h:1', created)).
logged(event(1.0, 'n1@h:1', 'a.x.1@n1@h:1', left('n10@h:1'))).
logged(event(1.5, 'n10@h:1', 'a.x.1@n1@h:1', arrived('n1@h:1', 0.5))).
logged(event(2.0, 'n10@h:1', 'a.x.2@n10@h:1', created)).
logged(event(2.0, 'n10@h:1', 'a.x.1@n1@h:1', cloned('a.x.2@n10@h:1'))).
logged(event(3.0, 'n10@h:1', 'a.x.1@n1@h:1', arrived(some, where))).
logged(event(4.0, 'n10@h:1', 'a.x.1@n1@h:1', sent('a.x.2@n10@h:1'))).
logged(event(4.5, 'n10@h:1', 'a.x.2@n10@h:1', received('a.x.1@n1@h:1'))).
logged(event(5.0, 'n2@h:1', 'a.x.2@n10@h:1', 'a & b < c')).
logged(event(6.0, 'n10@h:1', 'a.x.1@n1@h:1', ended(failed))).

test(story) :-
    with_tmp_dir(story).

story(Dir) :-
    log_of(Dir, File),
    typhon_lines([story, File, 'a.x.2'], Lines),
    assertion(Lines = ["a.x.2@n10@h:1"|_]),
    assertion(has_line(Lines, '*2.0000  n10 *begins')),
    assertion(has_line(Lines, '*n10 *is a clone of a.x.1')),
    assertion(has_line(Lines, '*n10 *takes a message from a.x.1')),
    typhon_lines([story, File, a], All),
    assertion(has_line(All, '*n10 *comes from n1, in 0.5 s')),
    assertion(has_line(All, '*n10 *logs arrived(some,where)')),
    assertion(has_line(All, '*n10 *ends, failed')),
    typhon_error([story, File, b], "agents in it: a.x.1, a.x.2").

test(outputs_do_not_overwrite_a_log) :-
    with_tmp_dir(Dir,
        ( log_of(Dir, Log),
          write_file(Dir, 'run.html', "text", Other),
          read_file_to_string(Log, Before, []),
          forall(member(Args, [ [page, Other, '--export', Log],
                                [page, Log, '--export', Log],
                                [picture, Log, Log] ]),
                 ( Args = [page|_], \+ installed(replay)
                 -> true
                 ;  typhon_error(Args, "is not overwritten")
                 )),
          read_file_to_string(Log, After, []),
          assertion(Before == After) )).
test(page_without_events_is_not_written, condition(installed(replay))) :-
    with_tmp_dir(Dir,
        ( write_file(Dir, 'empty.pl', "", Empty),
          directory_file_path(Dir, 'new.html', Html),
          typhon_error([page, Empty, '--export', Html], "has no events"),
          assertion(\+ exists_file(Html)) )).
test(picture) :-
    with_tmp_dir(picture).

picture(Dir) :-
    log_of(Dir, File),
    directory_file_path(Dir, 'some.svg', Svg),
    typhon_lines([picture, File, Svg], []),
    load_structure(Svg, [element(_, _, Parts)], [dialect(xmlns)]),
    findall(T, ( sub_term(element(_:text, _, [T]), Parts) ), Texts),
    assertion(subset([n1, n2, n10, 'a.x.1', 'a.x.2', fails, message], Texts)),
    assertion(append(_, [n1, n2, n10|_], Texts)),
    typhon_lines([picture, File, Svg, '--from', 2, '--to', 3], []),
    typhon_error([picture, File, Svg, '--from', 70], "no events").

test(version_is_that_of_the_pack) :-
    project_file('pack.pl', Pack),
    read_file_to_string(Pack, Text, []),
    typhon_lines(['--version'], [Version]),
    format(string(Fact), "version('~s').", [Version]),
    assertion(sub_string(Text, _, _, _, Fact)).

:- end_tests(app_log).

%   diagnosed(+Args, -Status, +Patterns): the output has lines of Patterns.

diagnosed(Args, Status, Patterns) :-
    typhon([diagnose|Args], Status, Out, _),
    have_lines(Out, Patterns).

have_lines(Out, Patterns) :-
    split_string(Out, "\n", "\n", Lines),
    forall(member(Pattern, Patterns), assertion(has_line(Lines, Pattern))).

:- begin_tests(app_diagnose).

test(works) :-
    with_typhon([host, alpha], _, Address,
        diagnosed([Address], exit(0), ['*ok*authentication*codec*'])).
test(no_process_at_the_address, Status == exit(1)) :-
    free_port(Port),
    format(atom(Address), 'alpha@127.0.0.1:~d', [Port]),
    diagnosed([Address], Status, ['*ok*cookie*', '*FAIL*connection*']).
test(other_host_at_the_address, Status == exit(1)) :-
    with_typhon([host, alpha], _, Address,
        ( atom_concat(alpha, Endpoint, Address),
          atom_concat(beta, Endpoint, There),
          diagnosed([There], Status, [ '*ok*authentication*',
                                       '*FAIL*host*no host beta*alpha*' ]) )).
test(other_cookie, Status == exit(1)) :-
    with_typhon([host, alpha], _, Address,
        ( typhon_args([diagnose, Address], Args),
          run_swipl(Args, [environment(['TYPHON_COOKIE'=other])], Status, Out,
                    _),
          have_lines(Out, ['*FAIL*authentication*']) )).
test(python, [condition(installed(bridges)), Status == exit(0)]) :-
    diagnosed([python], Status, ['*ok*function*hello agents*']).
test(bridge_without_a_peer,
     [ condition(installed(bridges)),
       forall(member(Args-Pattern, [ [mqtt, 'mqtt://127.0.0.1:1']
                                     -'*FAIL*{broker,paho}*',
                                     [gpio]-'*FAIL*{has no pins,no gpiozero}*',
                                     [ros, 'ws://127.0.0.1:1/']-'*FAIL*ros*'
                                   ])),
       Status == exit(1) ]) :-
    diagnosed(Args, Status, [Pattern]).

:- end_tests(app_diagnose).
