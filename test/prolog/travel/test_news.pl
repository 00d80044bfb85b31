:- module(test_news, []).
:- use_module('../../lib/common', [free_port/1, wait_until/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/travel/news), [news_tell/3]).

/** <module> News of agents for a home that cannot be reached

*Threading*: the main thread; the courier is a worker.
*/

%   told(+All, -Kept): of All, told one after the other, Kept are kept.

told(All, Kept) :-
    free_port(Port),
    format(atom(Home), '127.0.0.1:~d', [Port]),
    setup_call_cleanup(
        host_start(alpha),
        ( forall(member(News, All), news_tell(Home, x, News)),
          wait_until(( findall(News, typhon_news:news(Home, x, News), Kept),
                       Kept \== [] ), 10) ),
        host_stop(alpha)).

at(Hops, located(x, 'beta@127.0.0.1:1', Hops)).

end(Hops, ended(x, done, Hops)).

:- begin_tests(news).

test(the_newest, Kept == [News2]) :-
    at(1, News1), at(2, News2),
    told([News1, News2], Kept).
test(whatever_is_told_last, Kept == [News2]) :-
    at(1, News1), at(2, News2),
    told([News2, News1], Kept).
test(an_end, Kept == [End]) :-
    at(2, News), end(2, End),
    told([News, End], Kept).
test(an_end_that_is_told_first, Kept == [End]) :-
    at(2, News), end(2, End),
    told([End, News], Kept).

:- end_tests(news).
