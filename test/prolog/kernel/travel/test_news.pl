:- module(test_news, []).
:- use_module('../../../lib/common', [wait_until/2, with_settings/2]).
:- use_module('../../../lib/endpoints', [with_listener/3]).
:- use_module('../../../lib/peers').
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/travel/news),
              [news_carried/1, news_hurry/0, news_send/3]).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).

/** <module> News of agents for an unreachable home

*Threading*: the main thread; a worker posts the news.
*/

%   kept_news(+All, -Kept): Kept are the news that are kept after All were
%   given, in order, and the home could not be reached.

kept_news(All, Kept) :-
    with_silent_home(Home,
                     ( forall(member(News, All), news_send(Home, x, News)),
                       kept(Home, Kept) )).

%   kept_under_way(+First, +Then, -Kept): Then is given while First is being
%   posted.

kept_under_way(First, Then, Kept) :-
    with_silent_home(Home,
                     ( news_send(Home, x, First),
                       wait_until(\+ typhon_news:news(Home, x, _), 10),
                       news_send(Home, x, Then),
                       kept(Home, Kept) )).

%   with_silent_home(-Home, :Goal): a host is running, and Home is a port at
%   which a silent process listens.

:- meta_predicate with_silent_home(-, 0).

with_silent_home(Home, Goal) :-
    with_settings([typhon_connection_manager:connect_time=0.2],
        with_listener(5, Home,
            setup_call_cleanup(host_start(alpha), Goal, host_stop(alpha)))).

%   The worker that has posted news waits for an alarm.

kept(Home, Kept) :-
    wait_until(( typhon_scheduler:alarm(_, Home, news(_)),
                 findall(News, typhon_news:news(Home, x, News), Kept),
                 Kept \== [] ), 20).

at(Hops, located(x, 'beta@127.0.0.1:1', Hops)).

end(Hops, ended(x, done, Hops)).

%   A worker of b posts news when the process ends, and is held until the end
%   has begun.

last_news :-
    peer_host(b, B),
    peer_agent(a, [ (:- agent(guest, [])),
                    (main :- move(B)),
                    on_message(_, _) ], [], Id),
    wait_until(peer_do(b, agent_property(Id, state(resident))), 10),
    wait_until(peer_do(b, \+ typhon_news:courier(_)), 10),
    slow_courier,
    peer_do(b, host_stop(b)),
    peer_do(a, agent_join(Id, disposed, 10)).

slow_courier :-
    wrapped(b, typhon_runtime:released(_), Ends,
            ( test_common:wait_until(\+ typhon_news:news(_, _, _), 5),
              Ends )),
    wrapped(b, typhon_news:posted(How, _, _), Posted,
            ( (   How == endpoint_post
              ->  test_common:wait_until(
                      \+ typhon_session:session(_, _), 5)
              ;   true
              ),
              Posted )).

%   Wrapped predicates cannot be written in an answer.

wrapped(Peer, Head, Wrapped, Body) :-
    peer_do(Peer, \+ \+ wrap_predicate(Head, test_news, Wrapped, Body)).

%   sent_with_pause(+Pause, +Acts, -Posts): Posts are the numbers of news in
%   each post that follows from Acts, if moves are posted after a pause of
%   Pause seconds.

:- dynamic
    post/1,
    fails/1.                            % Formal: of the next post

sent_with_pause(Pause, Acts, Posts) :-
    with_settings([typhon_news:news_pause=Pause],
                  setup_call_cleanup(
                      ( wrap_predicate(typhon_news:posted(_, _, All), test_news,
                                       _, test_news:posted(All)),
                        host_start(alpha) ),
                      ( maplist(act, Acts),
                        wait_until(\+ news_carried('127.0.0.1:1'), 20) ),
                      ( host_stop(alpha),
                        unwrap_predicate(typhon_news:posted/3, test_news) ))),
    findall(Post, retract(post(Post)), Posts).

posted(_) :-
    retract(fails(Formal)),
    throw(error(Formal, _)).
posted(All) :-
    length(All, Count),
    assertz(post(Count)).

act(tell(Id, News)) :-
    news_send('127.0.0.1:1', Id, News).
act(fails(Formal)) :-
    assertz(fails(Formal)).
act(hurry) :-
    news_hurry.
act(waits) :-                           % for more, or is gone already
    Home = '127.0.0.1:1',
    wait_until(( typhon_news:pauses(Home) ; \+ typhon_news:news(Home, _, _) ),
               20).

:- begin_tests(news).

%   keeps(-How, -First, -Then, -Kept): of news, at(Hops) or end(Hops), that
%   are given in this order, or while First is being posted (`under_way`).

keeps(in_order, at(1), at(2), at(2)).
keeps(in_order, at(2), at(1), at(2)).
keeps(in_order, at(2), end(2), end(2)).
keeps(in_order, end(2), at(2), end(2)).
keeps(under_way, at(2), end(2), end(2)).
keeps(under_way, end(2), at(2), end(2)).
keeps(under_way, end(1), at(2), at(2)). % the end of a discarded copy

test(newest_news_are_kept, [ forall(keeps(How, First0, Then0, Kept0)),
                             Kept == [Expected] ]) :-
    maplist(news_of, [First0,Then0,Kept0], [First,Then,Expected]),
    (   How == in_order
    ->  kept_news([First,Then], Kept)
    ;   kept_under_way(First, Then, Kept)
    ).

news_of(at(Hops), News) :- at(Hops, News).
news_of(end(Hops), News) :- end(Hops, News).

test(news_are_batched_after_a_pause, Posts == [10]) :-
    findall(tell(I, News), ( between(1, 10, I), at(I, News) ), Acts),
    sent_with_pause(0.3, Acts, Posts).
test(news_of_a_location_waits_for_more, Posts == [2]) :-
    sent_with_pause(100, [ tell(a, located(a, b, 1)), waits,
                           tell(c, located(c, d, 1)), hurry ], Posts).
test(end_is_sent_at_once_with_all_waiting_news, Posts == [2]) :-
    at(1, News), end(1, End),
    sent_with_pause(60, [tell(x, News), tell(y, End)], Posts).
test(waiting_news_are_sent_on_demand, Posts == [1]) :-
    at(1, News),
    sent_with_pause(60, [tell(x, News), hurry], Posts).
test(error_of_a_commit_does_not_end_the_courier,
     [ forall(member(Formal, [ journal_unreachable(there, why),
                               journal_damaged(there, why),
                               journal_unwritten(there, why),
                               resource_error(journal_space),
                               permission_error(open, journal, there) ])),
       Posts == [1] ]) :-
    at(1, News),
    sent_with_pause(0, [fails(Formal), tell(x, News)], Posts).
test(pending_news_are_sent_when_the_process_ends) :-
    with_peers([a, b], last_news).

:- end_tests(news).
