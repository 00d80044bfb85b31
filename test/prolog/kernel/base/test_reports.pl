:- module(test_reports, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/slowness', [patience/2]).
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(random), [random_between/3]).
:- use_module(library(thread), [concurrent_maplist/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/reports)).

/** <module> Warnings that can be caused as often as an agent or a peer wants

*Threading*: one test at a time, but for threads that report together.
*/

:- begin_tests(reports).

test(first_of_a_kind_is_printed_and_the_others_are_counted, Seen == [1,1,9]) :-
    capturing(( forall(between(1, 10, _), report(warning, k, g, m(k))),
                forall(between(1, 1, _), report(warning, l, g, m(l))),
                reports_end ), Messages),
    findall(N, shown(N, _, Messages), Seen).
test(no_report_is_lost, Sum == 4000) :-
    capturing(( concurrent_maplist(reports(1000), [1,2,3,4]), reports_end ),
              Messages),
    aggregate_all(sum(N), shown(N, _, Messages), Sum).
test(kinds_and_groups_are_bounded, true(( Sum == 3100, Groups == 17 ))) :-
    get_time(T0),
    capturing(( forall(between(1, 1000, K),
                       forall(member(G, [K,x,y]),
                              report(warning, kind(K), G, m(K)))),
                forall(between(1, 100, G), report(warning, kind(1), G, m(1))),
                reports_end ), Messages),
    get_time(T1),
    aggregate_all(count, member(_-typhon(more(_, _)), Messages), Kinds),
    assertion(Kinds =< 65*(1+T1-T0)),
    aggregate_all(max(N), ( member(_-typhon(more(_, Gs)), Messages),
                            length(Gs, N) ), Groups),
    aggregate_all(sum(N), shown(N, _, Messages), Sum).
test(level_of_a_summary_is_the_worst, Level == error) :-
    capturing(( forall(member(L, [informational,informational,error]),
                       report(L, k, g, m(k))),
                reports_end ), Messages),
    once(member(Level-typhon(more(_, _)), Messages)).
test(name_of_a_group_is_data, [nondet, Lines == true]) :-
    Bad = 'a\e[31m\nWarning: ~w ~@',
    capturing(( report(warning, k, Bad, m(k)), report(warning, k, Bad, m(k)),
                reports_end ), Messages),
    once(member(_-typhon(more(K, Groups)), Messages)),
    message_text(typhon(more(K, Groups)), Text),
    (   sub_string(Text, _, _, _, "\e")
    ->  Lines = Text
    ;   Lines = true
    ).

:- end_tests(reports).

shown(1, M, Messages) :-
    member(_-m(M), Messages).
shown(N, K, Messages) :-
    member(_-typhon(more(K, Groups)), Messages),
    member(N-_, Groups).

reports(Count, Group) :-
    forall(between(1, Count, _),
           ( random_between(1, 5, K),
             report(warning, k(K), Group, m(K)) )).

%   An agent sends to no agent, and to one that does not understand, as fast as
%   its quotas let it.

:- begin_tests(floods_of_warnings).

test(agent_causes_one_message_for_each_second, Sum-Few == 6000-true) :-
    get_time(T0),
    patience(5, Seconds),
    capturing(with_hosts([ g-[ policy(guarded), cell(none),
                               quota([seconds(Seconds)]) ] ],
                         flood), Messages),
    get_time(T1),
    findall(M, flood_message(M, Messages), Ms),
    aggregate_all(sum(N), ( member(M, Ms), count_of(M, N) ), Sum),
    length(Ms, Count),
    ( Count =< 2*(3+T1-T0) -> Few = true ; Few = Count ).

:- end_tests(floods_of_warnings).

flood :-
    create([ (on_message(_, last) :- dispose) ], Deaf, [host(g)]),
    create([ (main :- s(D),
                      forall(between(1, 3000, _),
                             ( send(nobody, x), send(D, x) )),
                      send(D, last)) ], Agent, [host(g), facts([s(Deaf)])]),
    agent_join(Agent, done, 60),
    agent_join(Deaf, _, 60).

flood_message(M, Messages) :-
    member(_-typhon(M), Messages),
    count_of(M, _).

count_of(undeliverable(_, _, _, _), 1).
count_of(undeliverable(_, _, _, _, More), N) :- N is More+1.
count_of(message_failed(_, _, _), 1).
count_of(message_undone(_, _, _, _), 1).
count_of(more(lost_messages, Groups), N) :- sum_of(Groups, N).
count_of(more(messages_not_understood, Groups), N) :- sum_of(Groups, N).

sum_of(Groups, Sum) :-
    aggregate_all(sum(N), member(N-_, Groups), Sum).

%   What a peer sends wrongly, as often as it wants.

:- begin_tests(floods_of_peers).

test(each_kind_is_one_message_and_a_count,
     [forall(wrong(Kind, Goal)), Counts == [1,more(49)]]) :-
    with_hosts([g], capturing(( forall(between(1, 50, _), once(Goal)),
                                reports_end ), Messages)),
    findall(Count, ( member(_-Message, Messages),
                     wrong_count(Message, Kind, Count) ), Counts).

:- end_tests(floods_of_peers).

%   wrong(-Kind, -Goal): Goal handles what was sent, and Kind is reported.

wrong(malformed_agents,
      typhon_arrival:arrived(g, image(x), known, none, 'p@1.2.3.4:1', _)).
wrong(undeclared_terms,
      typhon_request:allowed(session(k, fast, w, o, p, i), request, bogus, x,
                             '1.2.3.4:1', _)).
wrong(undeclared_terms,
      typhon_request:post_in(session(k, fast, w, o, p, i), bogus, x,
                             '1.2.3.4:1')).
wrong(errors_of_hooks,
      typhon_session:call_hook(throw(error(system_error(x), _)))).
wrong(unsent_requests,
      typhon_connection_manager:not_sent(representation_error(frame), _,
                                         '1.2.3.4:1', ground)).
wrong(foreign_processes,
      typhon_connection:missed('1.2.3.4:1',
                               permission_error(authenticate, peer, other))).

wrong_count(typhon(more(Kind, [Count-_])), Kind, more(Count)).
wrong_count(typhon(raised(error(_, _))), _, 1).
wrong_count(typhon(endpoint, What), _, 1) :-
    functor(What, Name, _),
    memberchk(Name, [undeclared,hook,foreign]).
