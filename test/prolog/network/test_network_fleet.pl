:- module(test_network_fleet, []).

% Networks whose hosts belong to a fleet.

:- use_module('../../lib/common').

:- needs([fleet]).

:- use_module('../../lib/fixtures').
:- use_module('../../lib/networks').
:- use_module('../../lib/redis', [redis_address/2, with_redis/3]).
:- use_module('../../lib/texts', [message_text/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).

password('a secret word').

:- meta_predicate
    in_fleet(0),
    in_fleet(+, 0).

in_fleet(Goal) :-
    in_fleet(60, Goal).

in_fleet(Lease, Goal) :-
    password(Password),
    no_leaks(with_redis(['--requirepass', Password], Redis,
                        joined(Redis, Password, Lease, Goal))).

:- meta_predicate joined(+, +, +, 0).

joined(Redis, Password, Lease, Goal) :-
    redis_address(Redis, Address),
    setup_call_cleanup(
        fleet_join(lab, [redis(Address), password(Password), lease(Lease)]),
        once(Goal),
        fleet_leave(lab)).

up(Hosts) :-
    fleet_hosts(lab, Found, [state(up)]),
    msort(Found, Hosts).

all_up(Hosts) :-
    msort(Hosts, Sorted),
    up(Sorted).

secret_is_hidden(Pids) :-
    password(Password),
    forall(( member(Pid, Pids), member(Name, [cmdline, environ]) ),
           ( format(atom(File), '/proc/~w/~w', [Pid, Name]),
             read_file_to_string(File, Text, [encoding(octet)]),
             assertion(\+ sub_string(Text, _, _, _, Password)) )).

:- begin_tests(network_fleet).

test(hosts_of_children_belong_to_the_fleet) :-
    in_fleet(( with_network(ring(4), [fleet(lab), processes(2)], Network, Hosts,
                   ( all_up(Hosts),
                     network_property(Network, processes(Pids)),
                     secret_is_hidden(Pids) )),
               wait_until(up([]), 20) )).
test(hosts_of_this_process_belong_to_the_fleet) :-
    in_fleet(with_network(ring(2), [fleet(lab)], _, Hosts, all_up(Hosts))).
test(processes_on_other_machines_join) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, rsh, Program),
          shell_script(Program, "shift; exec sh -c \"$*\""),
          with_settings([typhon_children:ssh=Program],
              in_fleet(with_network(ring(2),
                                    [ fleet(lab),
                                      start(ssh(['me@127.0.0.1'])) ],
                                    _, Hosts, all_up(Hosts)))) )).
test(killed_process_is_a_member_again) :-
    in_fleet(capturing(
        with_network(ring(2), [fleet(lab), processes(2), restart(true)], Network,
                     Hosts,
            ( network_property(Network, processes([_, Pid])),
              process_kill(Pid, kill),
              wait_until(again(Network, Pid), 60),
              wait_until(all_up(Hosts), 20) )),
        _)).
test(agent_outlives_its_process_by_a_journal_in_the_engine, N == 7) :-
    in_fleet(1, capturing(
        with_network(ring(2), [ fleet(lab), processes(2), restart(true),
                                journal(redis('lab/net')) ],
                     Network, [_,Host],
            ( agent_create(clauses([ (:- agent(keeper, [state([n/1])])),
                                     n(7),
                                     (main :- receive(_-go), n(N), result(N)) ]),
                           Agent, [host(Host)]),
              network_property(Network, processes([_, Pid])),
              process_kill(Pid, kill),
              wait_until(again(Network, Pid), 60),
              agent_send(Agent, go),
              agent_result(Agent, N, 60) )),
        _)).
test(loaded_network_belongs_to_the_fleet) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, saved, File),
          in_fleet(( with_network(ring(2), [fleet(lab), processes(2)], Network,
                                  network_save(Network, File)),
                     with_loaded_network(File, Loaded,
                         ( network_property(Loaded, hosts(Hosts)),
                           wait_until(all_up(Hosts), 20) )) )) )).
test(unknown_fleet_is_an_error_before_anything_starts) :-
    in_fleet(( catch(network_start(ring(2), _, [fleet(lba), processes(2)]),
                     Error, true),
               Error = error(Formal, _),
               assertion(Formal == existence_error(fleet, lba)),
               message_text(Error, Text),
               assertion(sub_string(Text, _, _, _, "did you mean lab?")) )).

:- end_tests(network_fleet).

again(Network, Pid) :-
    network_property(Network, processes(Pids)),
    nth1(2, Pids, Now),
    Now \== Pid.
