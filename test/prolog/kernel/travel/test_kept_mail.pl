:- module(test_kept_mail, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/travel), [mail_admit/3]).

/** <module> Mail that cannot be sent on, and is kept

An option keeps it; here the suite does so.

*Threading*: one test at a time; the hook runs in any thread that may wait.
*/

:- dynamic
    keeping/0,
    kept/4.                             % Formal, Id, Mail, Thread

:- multifile typhon_mail:mail_kept/3.

typhon_mail:mail_kept(Formal, Id, Mail) :-
    test_kept_mail:keeping,
    test_kept_mail:keep(Formal, Id, Mail).

%   A thread that holds the mutex of the agent, or reads a connection, must not
%   call the hook: another thread takes that mutex meanwhile.

keep(Formal, Id, Mail) :-
    thread_create(typhon_agent:with_agent(Id, true), Thread),
    thread_join(Thread, true),
    assertz(kept(Formal, Id, Mail, Thread)).

:- meta_predicate while_keeping(0).

while_keeping(Goal) :-
    retractall(kept(_, _, _, _)),
    setup_call_cleanup(assertz(keeping), Goal, retractall(keeping)).

messages(Id, Messages) :-
    findall(M, ( kept(_, Id, Mail, _), member(mail(_, _, M), Mail) ),
            Messages).

formals(Id, Formals) :-
    findall(F, kept(F, Id, _, _), Formals0),
    sort(Formals0, Formals).

%   stranger(+Host, -Id): the id of an agent of Host that does not exist.

stranger(Host, Id) :-
    atom_concat('none.b7b4qcym.1@', Host, Id).

%   absent(-Id): an agent whose home cannot be reached.

absent(Id) :-
    free_port(Port),
    format(atom(Host), 'nowhere@127.0.0.1:~d', [Port]),
    stranger(Host, Id).

:- begin_tests(kept_mail).

test(mail_for_an_unreachable_home_is_kept,
     Formals-Messages == [host_unreachable(Home)]-[one,two]) :-
    absent(Id),
    atomic_list_concat([_,_,Home], @, Id),
    with_hosts([alpha],
               while_keeping(( agent_send(Id, one), agent_send(Id, two),
                               formals(Id, Formals),
                               messages(Id, Messages) ))).
test(mail_for_an_agent_that_is_known_nowhere_is_kept,
     Formals-Messages == [existence_error(agent, Id)]-[one]) :-
    with_hosts([alpha],
               while_keeping(( address(alpha, Alpha),
                               stranger(Alpha, Id),
                               agent_send(Id, one),
                               formals(Id, Formals),
                               messages(Id, Messages) ))).
test(mail_with_a_hint_is_kept, Messages == [one]) :-
    absent(Id),
    atomic_list_concat([_,Host,Home], @, Id),
    atomic_list_concat([Host,Home], @, Address),
    with_hosts([alpha],
               while_keeping(( agent_send(at(Id, Address), one),
                               messages(Id, Messages) ))).
test(mail_for_an_ended_agent_is_an_error,
     Formals-Formal == []-existence_error(agent, Id)) :-
    with_hosts([alpha],
               while_keeping(( create([main], Id, [host(alpha)]),
                               joined(Id, done),
                               catch(agent_send(Id, one), error(Formal, _),
                                     true),
                               formals(Id, Formals) ))).
test(mail_that_is_not_kept_is_an_error,
     error(host_unreachable(_))) :-
    absent(Id),
    with_hosts([alpha], agent_send(Id, one)).
test(mail_that_is_forwarded_is_kept, Messages == [one]) :-
    with_hosts([alpha],
               with_peers([beta],
                          while_keeping(
                              ( address(alpha, Alpha),
                                stranger(Alpha, Id),
                                peer_do(beta, agent_send(Id, one)),
                                wait_until(kept(_, Id, _, _), 20),
                                messages(Id, Messages) )))).
test(mail_that_was_kept_arrives_once, Result == [one,two]) :-
    with_hosts([alpha],
               ( create([ (main :- receive(_-A), receive(_-B),
                                   result([A,B])) ], Id, [host(alpha)]),
                 forall(member(L-M, [l1-one, l1-one, l2-two, l2-two]),
                        mail_admit(L, Id, [mail(none, user, M)])),
                 agent_result(Id, Result, 20) )).

:- end_tests(kept_mail).

:- needs([journal]).

:- begin_tests(kept_mail_of_a_journal).

:- meta_predicate with_journal(+, 0).

with_journal(Dir, Goal) :-
    setup_call_cleanup(host_start(alpha, [journal(Dir)]),
                       once(Goal), host_stop(alpha)).

test(mail_of_an_agent_is_kept, Messages == [one]) :-
    no_leaks(with_tmp_dir(Dir,
        with_journal(Dir,
            while_keeping(
                ( address(alpha, Alpha),
                  stranger(Alpha, Id),
                  create([ (main :- send(Id, one)) ], A, [host(alpha)]),
                  joined(A, done),
                  wait_until(kept(_, Id, _, _), 20),
                  messages(Id, Messages) ))))).
test(mail_that_was_kept_arrives_once_over_a_restart, Result == [one,two]) :-
    no_leaks(with_tmp_dir(Dir,
        ( with_journal(Dir,
              ( create([ (main :- receive(_-A), receive(_-B),
                                  result([A,B])) ], Id, [host(alpha)]),
                mail_admit(l1, Id, [mail(none, user, one)]),
                mail_admit(l1, Id, [mail(none, user, one)]) )),
          with_journal(Dir,
              ( mail_admit(l1, Id, [mail(none, user, one)]),
                mail_admit(l2, Id, [mail(none, user, two)]),
                agent_result(Id, Result, 20) )) ))).

:- end_tests(kept_mail_of_a_journal).
