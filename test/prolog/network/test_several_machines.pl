:- module(test_several_machines, []).

% Networks over machines that app/machines.py makes, and what it leaves behind.
% Where the system does not permit them the suite is skipped, with a message.

:- use_module('../../lib/common').

:- needs(['openssh-client', 'openssh-server', python3]).

:- use_module('../../lib/beside_machines', [beside/5, machines_permitted/0]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_kill/2]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_line_to_string/2]).

%   said(+Options, +Goal, -Term): Goal of lib/several_machines says Term.

said(Options, Goal, Term) :-
    project_file('test/lib/several_machines.pl', File),
    format(atom(Text), '~q', [Goal]),
    current_prolog_flag(executable, Swipl),
    beside(Options, [Swipl, '-f', none, '-g', Text, '-t', halt, File], _, Out,
           read(Out, Term)).

host_command(Cookie, Command) :-
    project_file('test/lib/several_machines.pl', File),
    format(atom(Command),
           'TYPHON_COOKIE_FILE=- TYPHON_COOKIE=~w swipl -f none \c
-g "host_at(far, \'10.213.78.1\')" \c
-t halt ~w', [Cookie, File]).

shared(Cookie, Other, Said) :-
    host_command(Other, Command),
    setenv('TYPHON_COOKIE', Cookie),
    call_cleanup(said(['--delay', 5, 1], visit(Command), Said),
                 unsetenv('TYPHON_COOKIE')).

                /*******************************
                *            LEFT              *
                *******************************/

%   processes_below(+Pid, -Pids): its children, and theirs. Some end meanwhile:
%   daemons have one for each connection.

processes_below(Pid, [Pid|Pids]) :-
    format(atom(File), '/proc/~w/task/~w/children', [Pid, Pid]),
    catch(read_file_to_string(File, Text, []), error(_, _), Text = ""),
    split_string(Text, " ", " ", Words),
    findall(Below, ( member(Word, Words), number_string(Child, Word),
                     processes_below(Child, Some), member(Below, Some) ),
            Pids).

:- begin_tests(several_machines,
               [condition(machines_permitted)]).

test(agent_goes_round_three_machines_and_this_one,
     Said == network([H, H, A, A, B, B, C, C], done, 8)) :-
    H = '10.213.78.254', A = '10.213.78.1', B = '10.213.78.2',
    C = '10.213.78.3',
    said(['--delay', '1,2,3', '--loss', '0,0.5', 3],
         network_over([local, A, B, C]), Said).
test(hosts_with_a_shared_cookie, Said = visited(done, Far, Far)) :-
    shared(one, one, Said).
test(hosts_with_different_cookies,
     true(subsumes_term(error(permission_error(authenticate, host, _)),
                        Said))) :-
    shared(one, other, Said).
test(packets_take_the_delays_of_both_ends) :-
    beside(['--delay', '0,400', 2],
           [ sh, '-c', 'date +%s%N; ssh 10.213.78.2 true; date +%s%N' ], _, Out,
           findall(T, ( between(1, 2, _), read_line_to_string(Out, Line),
                        number_string(T, Line) ), [T1, T2])),
    % at least four round trips
    assertion(T2 - T1 > 3 200 000 000).
test(machines_have_names_of_their_own,
     Names == ["here", "machine1", "machine2"]) :-
    beside([2], [ sh, '-c', 'hostname; for n in 1 2; do \c
                  ssh 10.213.78.$n hostname; done' ], _, Out,
           findall(Name, ( between(1, 3, _), read_line_to_string(Out, Name) ),
                   Names)).
test(status_is_that_of_the_command, Status == exit(7)) :-
    beside([1], [sh, '-c', 'exit 7'], Pid, _, wait_for_end(Pid, 60, Status)).
test(nothing_is_left, [forall(member(Signal, [kill, term]))]) :-
    beside([2], [sh, '-c', 'echo up; sleep 600'], Pid, Out,
           ( read_line_to_string(Out, "up"),
             processes_below(Pid, Pids),
             assertion(( length(Pids, N), N >= 5 )),
             process_kill(Pid, Signal),
             wait_until(maplist(is_dead, Pids), 20) )).
test(nothing_is_left_when_the_caller_is_killed) :-
    python(Python),
    project_file('app/machines.py', Program),
    setup_call_cleanup(
        process_create(path(sh),
                       [ '-c', '"$0" "$1" 1 sh -c "echo up; sleep 600"; true',
                         Python, Program ],
                       [stdin(null), stdout(pipe(Out)), process(Pid)]),
        ( read_line_to_string(Out, "up"),
          processes_below(Pid, Pids) ),
        ( process_kill(Pid, kill),
          close(Out),
          wait_for_end(Pid, 20, _) )),
    wait_until(maplist(is_dead, Pids), 20).
:- end_tests(several_machines).

                /*******************************
                *        NOT PERMITTED         *
                *******************************/

:- begin_tests(no_machines).

test(each_end_loses_its_share) :-
    python(Python),
    project_file(app, App),
    process_create(Python,
                   [ '-Bc', 'import random, sys; sys.path.append(sys.argv[1]); \c
from machines import Machine, arrives; random.seed(1); \c
ends = [Machine("", 0, 0, loss) for loss in (.1, .2)]; \c
sys.exit(not 7000 < sum(arrives(*ends) for _ in range(10000)) < 7400)', App ],
                   [process(Pid)]),
    wait_for_end(Pid, 60, exit(0)).
test(message_says_what_to_do, nondet) :-
    python(Python),
    project_file('app/machines.py', Program),
    process_create(path(setpriv),
                   [ '--bounding-set=-sys_admin', Python, Program, 1, true ],
                   [stderr(pipe(Err)), process(Pid)]),
    read_line_to_string(Err, Line),
    close(Err),
    wait_for_end(Pid, 60, exit(69)),
    sub_string(Line, _, _, _, "be root").
:- end_tests(no_machines).
