:- module(typhon_news,
          [ news_tell/3                 % +Home, +Id, +News
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(endpoint, [endpoint_post/3]).
:- use_module(scheduler, [alarm_set/3, scheduler_call/1]).

/** <module> News for the homes of agents

Where an agent is and how it ended, told to the process in which it was
born.  Of each agent only the newest news are kept until they are sent, and
each home has one courier, who takes along all there are: a home that does
not answer costs one attempt at a time, whatever the number of agents and
of their hops.

*Threading*: any thread tells; a courier is a call of a worker, or an alarm
that waits for the next.
*/

:- setting(news_seconds, number, 300,
           "News for a home that cannot be reached are kept so long").

:- multifile typhon_scheduler:fire/2.

:- dynamic
    news/3,                     % Home, Id, News: the newest, not yet sent
    courier/1.                  % Home: somebody sees to its news

%   So many are sent at a time, and the longest pause between attempts.

load(500).
longest_pause(10).              % seconds

%!  news_tell(+Home, +Id, +News) is det.
%
%   Let Home, an endpoint, have News of Id, some time soon.

news_tell(Home, Id, News) :-
    with_mutex(typhon_news, note(Home, Id, News, Courier)),
    (   Courier == wanted
    ->  scheduler_call(typhon_news:carry(Home, try(0, 0.5)))
    ;   true
    ).

note(Home, Id, News, Courier) :-
    retractall(news(Home, Id, _)),
    assertz(news(Home, Id, News)),
    (   courier(Home)
    ->  Courier = there
    ;   assertz(courier(Home)),
        Courier = wanted
    ).

%   carry(+Home, +Try): until nothing is left.  Try is try(Since, Pause): it
%   has not worked since then, 0 if it has, and the pause after this one.

carry(Home, Try) :-
    load(Most),
    with_mutex(typhon_news, take(Most, Home, All)),
    (   All == []
    ->  true
    ;   catch(( endpoint_post(Home, whereabouts, All), Sent = true ),
              error(unreachable(_), _),
              Sent = false),
        sent(Sent, Home, All, Try)
    ).

take(0, _, []) :-
    !.
take(Most, Home, [News|All]) :-
    retract(news(Home, _, News)),
    !,
    Most1 is Most-1,
    take(Most1, Home, All).
take(Most, Home, []) :-
    load(Most),                 % nothing left: the courier goes
    !,
    retractall(courier(Home)).
take(_, _, []).

sent(true, Home, _, _) :-
    carry(Home, try(0, 0.5)).
sent(false, Home, All, try(Since0, Pause)) :-
    get_time(Now),
    (   Since0 =:= 0
    ->  Since = Now
    ;   Since = Since0
    ),
    setting(news_seconds, Max),
    (   Now-Since > Max
    ->  give_up(Home)
    ;   with_mutex(typhon_news, forall(member(News, All), back(Home, News))),
        longest_pause(Longest),
        Pause1 is min(Longest, 2*Pause),
        Stamp is Now+Pause,
        alarm_set(Stamp, Home, news(try(Since, Pause1)))
    ).

%   What came meanwhile is newer.

back(Home, News) :-
    arg(1, News, Id),
    (   news(Home, Id, _)
    ->  true
    ;   assertz(news(Home, Id, News))
    ).

give_up(Home) :-
    with_mutex(typhon_news,
               ( retractall(news(Home, _, _)),
                 retractall(courier(Home)) )),
    print_message(silent, typhon(home_unreachable(Home))).

typhon_scheduler:fire(Home, news(Try)) :-
    !,
    scheduler_call(typhon_news:carry(Home, Try)).
