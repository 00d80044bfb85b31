:- module(test_app_fleet, []).

% The command `fleet`, in separate processes, as service managers and users call
% it.

:- use_module('../lib/common').
:- use_module('../lib/redis').
:- use_module('../lib/texts', [write_file/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, same_length/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil), [read_line_to_string/2]).

:- needs([fleet]).

typhon(Args, Status, Out, Err) :-
    project_file('app/typhon.pl', App),
    run_swipl([App|Args], [timeout(60)], Status, Out, Err).

lines(Args, Lines) :-
    typhon(Args, Status, Out, Err),
    assertion(Status-Err == exit(0)-""),
    split_string(Out, "\n", "", Lines0),
    append(Lines, [_], Lines0),
    !.

refused(Args, Part) :-
    typhon(Args, Status, Out, Err),
    assertion(Status-Out == exit(1)-""),
    assertion(once(sub_string(Err, _, _, _, Part))).

engine(Redis, [fleet, '--fleet', lab, '--redis', At]) :-
    redis_address(Redis, Host:Port),
    atomic_list_concat([Host, Port], :, At).

asks(Redis, Words, Args) :-
    engine(Redis, Engine),
    append(Engine, Words, Args).

:- meta_predicate with_host(+, +, +, -, -, 0).

%   with_host(+Redis, +Name, +Options, -Address, -Pid, :Goal): the command `host`.

with_host(Redis, Name, Options, Address, Pid, Goal) :-
    project_file('app/typhon.pl', App),
    engine(Redis, [_|Engine]),
    append([App, host, Name|Engine], Options, Args),
    with_swipl(Args, Pid, _, Out,
               ( read_line_to_string(Out, Line),
                 assertion(string(Line)),
                 atom_string(Address, Line),
                 call(Goal) )).

has(Lines, Pattern) :-
    (   member(Line, Lines),
        wildcard_match(Pattern, Line)
    ->  true
    ;   assertion(Lines == has(Pattern))
    ).

%   resting(+Address, +More, -Id): an agent that waits for a message.

resting(Address, More, Id) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'rests.pl', File),
          write_file(File, ":- agent(rests, []).\nmain :- receive(_).\n"),
          lines([create, File, '--host', Address|More], [Line]) )),
    atom_string(Id, Line).

state(Redis, Name, State) :-
    asks(Redis, [hosts], Args),
    typhon(Args, exit(0), Out, _),
    split_string(Out, "\n", "", Lines),
    format(atom(Pattern), '~w@*  ~w *', [Name, State]),
    member(Line, Lines),
    wildcard_match(Pattern, Line),
    !.

listed_and_filtered(Redis) :-
    with_host(Redis, alpha, ['--tags', 'red,round'], A, _,
        with_host(Redis, beta, ['--tags', red], B, Pid,
            ( resting(A, [], _),
              asks(Redis, [hosts], All),
              listed(All, [ 'host *state *since *agents *parked *tags',
                            'alpha@* up *-*:*  1 * 0 *red round',
                            'beta@* up *-*:*  0 * 0 *red' ]),
              asks(Redis, [hosts, '--tag', 'round,red'], Round),
              lines(Round, [_,Line]),
              has([Line], 'alpha@*'),
              asks(Redis, [hosts, '--away'], Away),
              listed(Away, ['No hosts']),
              wait_until(test_app_fleet:is_here(A), 30),
              alive(A),
              process_kill(Pid, kill),
              wait_until(test_app_fleet:state(Redis, beta, away), 30),
              lines(Away, [_,Gone]),
              has([Gone], 'beta@* away *-*:*'),
              refused([fleet, here, B], "cannot be reached") ))).

%   listed(+Args, +Patterns): the lines are these in the end: a lease may lapse on
%   a busy machine.

listed(Args, Patterns) :-
    wait_until(test_app_fleet:lists(Args, Patterns), 30).

lists(Args, Patterns) :-
    lines(Args, Lines),
    same_length(Patterns, Lines),
    forall(member(Pattern, Patterns),
           ( member(Line, Lines), wildcard_match(Pattern, Line) )).

alive(Address) :-
    lines([fleet, alive, Address, '--timeout', 60], []).

drained(Redis) :-
    with_host(Redis, alpha, ['--tags', red], A, _,
        with_host(Redis, beta, ['--tags', red], B, _,
            ( resting(A, [], Moves),
              resting(A, ['--static'], Stays),
              wait_until(test_app_fleet:is_here(B), 30),
              lines([fleet, drain, A], Lines),
              atom_string(Stays, Line),
              assertion(Lines == [Line]),
              asks(Redis, [where, Moves], Where),
              lines(Where, [There]),
              atom_string(B, Text),
              assertion(There == Text),
              wait_until(test_app_fleet:left(A), 20),
              wait_until(test_app_fleet:is_here(B), 30),
              alive(A),
              refused([fleet, drain, B], "away") ))).

left(Address) :-
    typhon([fleet, here, Address], exit(1), "", Err),
    once(sub_string(Err, _, _, _, "was drained")).

parked(Redis) :-
    with_host(Redis, alpha, [], A, _,
        with_host(Redis, beta, [], B, Pid,
            ( process_kill(Pid, kill),
              wait_until(test_app_fleet:state(Redis, beta, away), 30),
              parks(A, B, Id),
              asks(Redis, [park, list], List),
              wait_until(test_app_fleet:is_listed(List, Id), 30),
              asks(Redis, [hosts, '--away'], Away),
              lines(Away, [_,Gone]),
              has([Gone], 'beta@* away *-*:*  0 * 1'),
              asks(Redis, [park, send, Id], Send),
              refused(Send, "cannot be reached"),
              asks(Redis, [park, drop, Id], Drop),
              lines(Drop, []),
              lines([join, Id, '--timeout', 30], ["done"]),
              lines(List, ["No parked agents"]),
              refused(Drop, "parked") ))).

parks(A, B, Id) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'goes.pl', File),
          format(string(Text),
                 ":- agent(goes, []).~nmain :- catch(move('~w', [wait(600)]), \c
                      error(host_unreachable(_), _), true).~n", [B]),
          write_file(File, Text),
          lines([create, File, '--host', A], [Line]) )),
    atom_string(Id, Line).

is_listed(List, Id) :-
    lines(List, [_,Line]),
    atom_concat(Id, ' *@* *-*:* *-*:*', Pattern),
    wildcard_match(Pattern, Line).

%   Readiness needs the engine; liveness does not.

engine_is_gone(Redis) :-
    with_host(Redis, alpha, [], A, _,
        ( redis_signal(Redis, kill),
          refused([fleet, here, A], "cannot reach the engine of the fleet lab"),
          alive(A),
          asks(Redis, [hosts], Args),
          refused(Args, "cannot be reached"),
          redis_restart(Redis),
          wait_until(test_app_fleet:is_here(A), 30) )).

is_here(Address) :-
    typhon([fleet, here, Address], exit(0), _, _).

stopped_process_is_not_alive(Redis) :-
    with_host(Redis, alpha, [], A, Pid,
        ( stop_process(Pid),
          call_cleanup(typhon([fleet, alive, A, '--timeout', 1], Status, _, _),
                       process_kill(Pid, cont)),
          assertion(Status == exit(1)) )).

:- begin_tests(app_fleet).

test(hosts_are_listed_by_state_and_tag) :-
    with_redis(Redis, listed_and_filtered(Redis)).
test(drained_host_is_not_here_and_lists_what_stays) :-
    with_redis(Redis, drained(Redis)).
test(agents_that_wait_are_listed_and_go_on) :-
    with_redis(Redis, parked(Redis)).
test(liveness_does_not_need_the_engine) :-
    with_redis(Redis, engine_is_gone(Redis)).
test(stopped_process_is_not_alive) :-
    with_redis(Redis, stopped_process_is_not_alive(Redis)).
test(mistakes,
     [forall(member(Args-Part,
         [ [hots, '--fleet', lab]-"no command hots (did you mean hosts?)",
           [hosts]-"fleet needs --fleet",
           [hosts, '--fleet', lab]-"fleet needs --redis",
           [hosts, '--flet', lab]-"did you mean fleet?",
           [hosts, '--fleet', lab, '--redis', x]-"HOST:PORT expected",
           [where, '--fleet', lab, '--redis', 'a:1']-"fleet takes hosts",
           [hosts, '--fleet', lab, '--redis', '127.0.0.1:1']-
               "cannot be reached" ]))]) :-
    refused([fleet|Args], Part).
test(host_without_a_fleet_is_not_here) :-
    project_file('app/typhon.pl', App),
    with_swipl([App, host, alpha], _, _, Out,
               ( read_line_to_string(Out, Line),
                 atom_string(Address, Line),
                 refused([fleet, here, Address], "fleet") )).
test(help_names_what_there_is) :-
    lines([fleet, '--help'], Lines),
    forall(member(What, [hosts, where, 'park list', drain, here, alive]),
           ( atomic_list_concat(['    ', What, '*'], Pattern),
             has(Lines, Pattern) )).

:- end_tests(app_fleet).
