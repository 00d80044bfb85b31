:- module(test_host_log, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/host_log)).

:- multifile typhon_hosting:begins/1.

:- dynamic begun/1.

typhon_hosting:begins(Host) :-          % after that of the log
    assertz(begun(Host)).

/** <module> A missing log server

*/

%   ended(+Count): so many agents have started, written a log entry and ended.

ended(Count) :-
    forall(between(1, Count, _),
           ( create([(main :- log(hi))], Agent, [host(alpha)]),
             joined(Agent, done) )).

warnings_of(Messages, Warnings) :-
    findall(What, member(warning-typhon(What), Messages), Warnings).

at(Port, Endpoint) :-
    atom_concat('127.0.0.1:', Port, Endpoint).

comes_back(Port, Dir) :-
    directory_file_path(Dir, 'events.pl', File),
    host_start(beta, [port(Port)]),
    log_server_start([file(File), name(log)], Log),
    ended(2),
    log_server_stop(Log),
    host_stop(beta),
    log_events(File, Events),
    aggregate_all(count, member(event(_, _, _, hi), Events), Count),
    assertion(Count == 2).

:- begin_tests(host_log).

test(reported_once_and_again_after_recovery,
     true(Count >= 6)) :-
    free_port(Port),
    at(Port, Endpoint),
    atom_concat('log@', Endpoint, Log),
    with_hosts([alpha-[log(Log)]],
               capturing(( ended(3),
                           with_tmp_dir(test_host_log:comes_back(Port)) ),
                         Messages)),
    warnings_of(Messages, [log_unheard(Endpoint), log_heard(Endpoint, Count)]).
test(each_host_that_starts_is_logged, Count == 2) :-
    free_port(Port),
    at(Port, Endpoint),
    atom_concat('log@', Endpoint, Log),
    Once = with_hosts([alpha-[log(Log)]], ended(1)),
    capturing(( Once, Once ), Messages),
    warnings_of(Messages, Warnings),
    aggregate_all(count, member(log_unheard(Endpoint), Warnings), Count).
test(other_options_learn_that_a_host_with_a_log_begins) :-
    free_port(Port),
    at(Port, Endpoint),
    atom_concat('log@', Endpoint, Log),
    with_hosts([delta-[log(Log)]], assertion(begun(delta))).

:- end_tests(host_log).
