:- module(test_examples, []).

% Every example runs by itself and prints the expected lines.

:- use_module('../../app/packaging/parts', [left_out/2]).
:- use_module('../lib/common').
:- use_module('../lib/texts', [file_lines/2]).
:- use_module('../lib/fixtures').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [append/3, last/2, member/2, numlist/3, select/3]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

%   shows(Example, Lines): patterns of lines in the output, in any order

shows(hello,
      [ 'Hello from alpha@127.0.0.1:*', 'Hello from beta@127.0.0.1:*',
        'hello.*@alpha@127.0.0.1:*: done'
      ]).
shows(tour,
      [ 'hop 1: north@*', 'hop 2: east@*', 'hop 3: south@*' ]).
shows(clone,
      [ 'scout.*@base@* is at north@*', 'scout.*@base@* is at east@*',
        'scout.*@base@* is at south@*'
      ]).
shows(payload,
      [ 'The courier knows: 100 C are 212* F', 'On beta 20 C are 68* F' ]).
shows(fipa,
      [ 'inform for 7 euro' ]).
shows(messages,
      [ '5, then 42' ]).
shows(stigmergy,
      [ 'An ant found food 1', 'An ant found food 2', 'An ant found food 3',
        'An ant found nothing', 'An ant found nothing', 'In the nest: ?*?'
      ]).
shows(rewrite,
      [ 'alpha is new to me', 'beta is new to me',
        'I know alpha', 'I know beta'
      ]).
shows(supervisor,
      [ 'left.*@alpha@* ends, left.*@alpha@* takes its place',
        'The supervisor ends: done'
      ]).
shows(hierarchy,
      [ 'after few: [[]delta-0.*', 'after all: [[]delta-0.*',
        'after again: [[]delta-0.*'
      ]).
shows(voting,
      [ 'agreed(12,3,of(4))' ]).
shows(pheromone,
      [ 'road@*: 67 % from farm@*', 'wood@*: 100 % from farm@*',
        'farm@*: the fire is out'
      ]).

example(Example) :-
    program_in('examples/*.pl', Example).

program_in(Relative, Example) :-
    project_file(Relative, Pattern),
    expand_file_name(Pattern, Files),
    member(File, Files),
    file_base_name(File, Base),
    file_name_extension(Example, pl, Base).

%   Each pattern matches another line.

all_shown([], []).
all_shown([Pattern|Patterns], Lines) :-
    select(Line, Lines, Rest),
    wildcard_match(Pattern, Line),
    all_shown(Patterns, Rest).

example_lines(Example, Count) :-
    format(atom(Relative), 'examples/~w.pl', [Example]),
    project_file(Relative, File),
    file_lines(File, Lines),
    length(Lines, Count0),
    Count is Count0-1.

:- begin_tests(examples).

test(prints_the_expected_lines, [ forall(( example(Example), shows(Example, Patterns) )), nondet ]) :-
    format(atom(Relative), 'examples/~w.pl', [Example]),
    project_file(Relative, File),
    run_swipl([File], [timeout(30)], Status, Out, Err),
    assertion(Status == exit(0)),
    assertion(Err == ""),
    split_string(Out, "\n", "", Lines0),
    append(Lines, [""], Lines0),
    assertion(all_shown(Patterns, Lines)).

test(tested, Examples == Tested) :-
    setof(Example, example(Example), Examples),
    setof(Example,
          Patterns^( shows(Example, Patterns), \+ left_out(Example) ), Tested).

left_out(Example) :-
    format(atom(File), 'examples/~w.pl', [Example]),
    left_out(File, _).

test(short, Long == []) :-
    findall(Example-Lines,
            ( example(Example),
              example_lines(Example, Lines),
              Lines >= 40
            ),
            Long).

:- end_tests(examples).

%   Every program of examples/agents does what its first comment says, on three
%   hosts that are linked to each other. Logged are its log entries Host-What,
%   with the host on which it was; A, B and C are the addresses.

:- meta_predicate agent_logs(+, 2, -, -).

%   agent_logs(+Program, :Drive, -Addresses, -Logged): Drive(Agent, File) while
%   it is alive, File being the log.

agent_logs(Program, Drive, Addresses, Logged) :-
    with_tmp_dir(agent_logs_in(Program, Drive, Addresses, Logged)).

agent_logs_in(Program, Drive, Addresses, Logged, Dir) :-
    directory_file_path(Dir, 'events.pl', File),
    log_server_start([file(File)], Log),
    call_cleanup(
        with_hosts([a-[log(Log)], b-[log(Log)], c-[log(Log)]],
                   driven(Program, Drive, File, Addresses, Agent)),
        log_server_stop(Log)),
    logged(File, Agent, Logged).

driven(Program, Drive, File, [A,B,C], Agent) :-
    address(a, A),
    address(b, B),
    address(c, C),
    forall(member(X-Y, [a-b, a-c, b-c]), link(X, Y)),
    created(Program, Agent),
    call(Drive, Agent, File).

created(Program, Agent) :-
    format(atom(Relative), 'examples/agents/~w.pl', [Program]),
    project_file(Relative, File),
    agent_create(File, Agent, [host(a)]).

logged(File, Agent, Logged) :-
    log_events(File, Events),
    findall(Host-What,
            ( member(event(_, Host, Agent, What), Events),
              What \== created ),
            Logged).

until_done(Agent, _) :-
    joined(Agent, done).

keeps_notes(Agent, _) :-
    forall(member(Message, [ remember(milk), recall, go(b), remember(tea),
                             recall, stop ]),
           agent_send(Agent, Message)),
    agent_join(Agent, Outcome, 20),
    assertion(Outcome == disposed).

%   The other agent is the load.

watches(Agent, File) :-
    wait_until(loads(File, Agent, [1]), 20),
    created(keeper, Other),
    wait_until(loads(File, Agent, [1,2]), 20),
    agent_dispose(Other),
    wait_until(loads(File, Agent, [1,2,1]), 20),
    agent_dispose(Agent).

loads(File, Agent, Loads) :-
    logged(File, Agent, Logged),
    findall(Load, member(_-load(Load), Logged), Loads).

:- begin_tests(example_agents).

test(hello, Logged == [ A-hello_from(A), B-hello_from(B), C-hello_from(C),
                        A-ended(done) ]) :-
    agent_logs(hello, until_done, [A,B,C], Logged).

test(census, Logged == [A-seen(B, 1), A-seen(C, 1), A-ended(done)]) :-
    agent_logs(census, until_done, [A,B,C], Logged).

test(rounds, [Numbers, Last] == [OneToTen, ended(done)]) :-
    agent_logs(rounds, until_done, [A|_], Logged),
    findall(N, member(Host-hop(N, Host), Logged), Numbers),
    findall(Host, member(Host-hop(_, _), Logged), Hosts),
    assertion(moved(A, Hosts)),
    numlist(1, 10, OneToTen),
    last(Logged, _-Last).

test(keeper, Logged == [ A-note(milk), B-note(milk), B-note(tea),
                         B-ended(disposed) ]) :-
    agent_logs(keeper, keeps_notes, [A,B,_], Logged).

test(watchman, Logged == [ A-load(1), A-load(2), A-load(1),
                           A-ended(disposed) ]) :-
    agent_logs(watchman, watches, [A|_], Logged).

test(tested, Programs == [census, hello, keeper, rounds, watchman]) :-
    setof(Program, program_in('examples/agents/*.pl', Program), Programs).

%   Each hop is to another host.

moved(_, []).
moved(Here, [Host|Hosts]) :-
    Host \== Here,
    moved(Host, Hosts).

:- end_tests(example_agents).
