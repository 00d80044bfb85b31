:- module(test_access, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(plunit)).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire), [endpoint_peer/2]).

/** <module> Rules for peers, and the audit

*Threading*: one test at a time.
*/

tried(Goal, Result) :-
    catch(( Goal -> Result = true ; Result = false ), error(Result, _), true).

:- begin_tests(access).

test(rules_decide_and_refusals_are_audited,
     [Create,Remote,Dispose,Look]-Noted =
         [ move_refused(_, peer), permission_error(remote, host, _),
           permission_error(orders, agent, _), true ]
         - [refused(y,peer),refused(remote),refused(orders)]) :-
    with_rules([messages,watch], There-_,
        ( waiting_agent(A),
          tried(agent_create(clauses([(:- agent(y, [])), (main :- true)]), _,
                             [host(There)]), Create),
          tried(remote(There, true), Remote),
          tried(agent_dispose(A), Dispose),
          tried(agent_property(A, state(_)), Look) ), Noted).

%   A peer disposes of an agent before there are rules, under rules, and after
%   their removal.

test(rules_and_audit_of_a_running_host_change,
     [Before,Ruled,After]-Noted =
         [true, permission_error(orders, agent, _), true]
         - [refused(orders), order(_, dispose)]) :-
    with_rules(none, _-File,
        ( disposed(Before),
          peer_do(p, ( host_change(p, audit(File)),
                       host_change(p, peer([cookie-[agents]])) )),
          disposed(Ruled),
          peer_do(p, host_change(p, peer([cookie-all]))),
          disposed(After) ), Noted).

%   A peer watches a host, by its name, without the right and with it.

test(events_need_the_right_to_watch,
     [Without,With]-Noted = [permission_error(watch, host, _), true]
                            -[refused(watch)]) :-
    with_rules([messages], There-_,
        ( tried(watches(There), Without),
          peer_do(p, host_change(p, peer([cookie-[watch]]))),
          tried(watches(There), With) ), Noted).
test(unknown_rules_are_an_error, error(domain_error(peer_rule, x))) :-
    host_start(g, [peer([x])]).
test(unknown_rules_are_an_error_of_a_change,
     error(domain_error(peer_rule, x))) :-
    with_hosts([g-[peer([cookie-all])]], host_change(g, peer([x]))).

test(records_only_of_peers_that_may_run_goals, Codecs == [fast,text,text]) :-
    maplist(codec_with, [ [], [peer([cookie-[agents,messages]])],
                          [remote(false)] ], Codecs).

:- end_tests(access).

codec_with(Options, Codec) :-
    no_leaks(with_peers(
        [p-[host(Options)]],
        with_host_here(( peer_host(p, There),
          agent_create(clauses([(:- agent(y, [])), main]), A, [host(here)]),
          agent_join(A, done, 5),
          tried(agent_create(clauses([(:- agent(y, [])), main]), _,
                             [host(There)]), _),
          once(endpoint_peer(_, codec(Codec))) )))).

%   with_rules(+Rights, -Place, :Goal, -Noted): Goal is called beside a process
%   p with a host that gives these Rights, and has an audit, or has neither.
%   Place is Host-File, with the file of the audit.

:- meta_predicate with_rules(+, -, 0, -).

with_rules(Rights, There-File, Goal, Noted) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, audit, File),
          ( Rights == none -> Options = []
          ; Options = [peer([cookie-Rights]), audit(File)] ),
          no_leaks(with_peers(
              [p-[host(Options)]],
              with_host_here(( peer_host(p, There), Goal,
                               audited(File, Noted) )))) )).

watches(Host) :-
    watch([Host], [_]>>true, Watch),
    unwatch(Watch).

disposed(Result) :-
    waiting_agent(A),
    tried(agent_dispose(A), Result).

waiting_agent(A) :-
    peer_do(p, agent_create(clauses([ (:- agent(x, [])),
                                      on_message(_, _) ]), A)).

audited(File, Whats) :-
    read_file_to_terms(File, Entries, []),
    findall(What, member(audit(_, _, _, cookie, What), Entries), Whats).

with_host_here(Goal) :-
    setup_call_cleanup(host_start(here), once(Goal), host_stop(here)).
