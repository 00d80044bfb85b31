:- module(typhon_news,
          [ news_send/3,                % +Home, +Id, +News
            news_carried/1,             % +Home
            news_hurry/0
          ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../base/durable', [durable_on/0, durable_post/3]).
:- use_module('../base/reports', [report/4]).
:- use_module('../wire', [endpoint_post/3, endpoint_post_by/4]).
:- use_module(sender_authorization, [with_proof/5]).
:- use_module('../host', [alarm_in/3, scheduler_call/1]).

/** <module> News for the homes of agents

News reports to the home of an agent where the agent is and how it ended.  Only
the newest news of each agent is kept until it is sent.  Each home has one
courier, a task that sends all news there is: a home that does not answer costs
one attempt at a time, whatever the number of agents and of their hops.  News of
a location waits a moment for more news, to share a frame: until the home has
it, the processes that the agent left forward its messages.

*Threading*: any thread adds news; a courier is a call of a worker, or an alarm
that waits for the next attempt.
*/

:- setting(news_seconds, number, 300,
           "Seconds that news for an unreachable home is kept").
:- setting(news_pause, number, 0.005,
           "Seconds that news of a location waits for more news").

:- multifile
    typhon_durable:undelivered/4,
    typhon_runtime:ending/1,
    typhon_scheduler:fire/2.

:- dynamic
    news/3,                     % Home, Id, News: the newest, not yet sent
    in_hand/2,                  % Home, All: news that its courier is sending
    courier/1,                  % Home: a thread sends its news, or will
    pauses/1.                   % Home: its courier waits for more news

%   The weight of the news in one frame, at most.  News with results may be
%   long.

most_weight(500).
weight(ended(_, _, _, _), 50) :- !.
weight(_, 1).
longest_pause(10).              % seconds between attempts

%!  news_send(+Home, +Id, +News) is det.
%
%   Send News of Id to Home, an endpoint, soon.

news_send(Home, _, News) :-
    durable_on,
    news_lasts(News),
    !,
    posted(durable_post, Home, [News]).
news_send(Home, Id, News) :-
    with_mutex(typhon_news, note(Home, Id, News, Courier)),
    start_courier(Courier, Home).

start_courier(now, Home) :-
    scheduler_call(carry(Home, try(0, 0.5))).
start_courier(soon, Home) :-
    setting(news_pause, Seconds),
    alarm_in(Seconds, Home, news_paused).
start_courier(there, _).
start_courier(none, _).

%!  news_carried(+Home) is semidet.
%
%   A thread is sending news to Home, or will do so.

news_carried(Home) :-
    courier(Home),
    !.

%!  news_hurry is det.
%
%   Send the news that waits for more news now, because no alarm goes off while
%   turns are paused.

news_hurry :-
    forall(pauses(Home), typhon_scheduler:fire(Home, news_paused)).

%   Only news of a location need not last: the agent will report again.

news_lasts(News) :-
    \+ News = located(_, _, _).

note(Home, Id, News, Courier) :-
    keep(Home, Id, News),
    courier_of(Home, News, Courier).

%   courier_of(+Home, +News, -Courier): when the courier starts: `now`, `soon`,
%   after a pause, or it is `there` already.

courier_of(Home, News, Courier) :-
    courier(Home),
    !,
    (   news_lasts(News),
        retract(pauses(Home))
    ->  Courier = now
    ;   Courier = there
    ).
courier_of(Home, News, Courier) :-
    assertz(courier(Home)),
    when_due(News, Home, Courier).

when_due(News, _, now) :-
    news_lasts(News),
    !.
when_due(_, Home, soon) :-
    assertz(pauses(Home)).

%   after(+Home, -Courier): the courier has sent its news.  Courier says when it
%   starts next, as in courier_of/3, or is `none`.

after(Home, Courier) :-
    retractall(in_hand(Home, _)),
    (   news(Home, _, News),
        news_lasts(News)
    ->  Courier = now
    ;   news(Home, _, News)
    ->  when_due(News, Home, Courier)
    ;   retractall(courier(Home)),
        Courier = none
    ).

keep(Home, Id, News) :-
    news(Home, Id, Known),
    \+ newer(News, Known),
    !.
keep(Home, Id, News) :-
    retractall(news(Home, Id, _)),
    assertz(news(Home, Id, News)).

%   Ages show which news is newer.  The order of sending does not, nor the time
%   at which it was added while the courier was sending: the end notice may
%   overtake the arrival notice.

newer(News, Known) :-
    age(News, Age),
    age(Known, Age0),
    Age @> Age0.

age(located(_, _, Hops), age(Hops, 0, 0, 0)).
age(faulty(_, _, Stamp, _, Hops), age(Hops, 1, Stamp, 0)).
age(resumed(_, Stamp, Hops), age(Hops, 1, Stamp, 1)).
age(ended(_, _, Hops, _), age(Hops, 2, 0, 0)).
age(ended(_, _, Hops), age(Hops, 2, 0, 0)).  % fewer hops: a copy that was
                                             % given up in doubt

%   The process is about to end: send what can be sent before one deadline for
%   all homes, and give up the rest.  News that a courier is sending is sent
%   again, in case it is too slow; so the home may get it twice.

typhon_runtime:ending(before) :-
    setting(typhon_endpoint:flush_time, Seconds),
    deadline(Seconds, Deadline),
    forall(courier(Home),
           ( flush(Home, Deadline),
             give_up(Home) )).

flush(Home, Deadline) :-
    with_mutex(typhon_news, take_all(Home, All)),
    All \== [],
    catch(posted(endpoint_post_by(Deadline), Home, All), error(_, _), fail),
    !,
    flush(Home, Deadline).
flush(_, _).

take_all(Home, All) :-
    retract(in_hand(Home, All)),
    !.
take_all(Home, All) :-
    take(Home, All).

%   carry(+Home, +Try): send until nothing is left.  Try is try(Since, Pause):
%   attempts have failed since then, or 0, and the pause after this one.

carry(Home, Try) :-
    with_mutex(typhon_news, take_in_hand(Home, All)),
    (   All == []
    ->  true
    ;   catch(( posted(endpoint_post, Home, All), Answer = ok ),
              error(Answer, _),
              true),
        sent(Answer, Home, All, Try)
    ).

%   posted(:Post, +Home, +All): news too long for one frame is sent in two.  If
%   an end notice is too long, it is sent without results.

posted(Post, Home, All) :-
    shown_news(Home, All, Shown),
    catch(call(Post, Home, whereabouts, Shown),
          error(resource_error(frame_bytes), _),
          posted_in_parts(All, Post, Home)).

shown_news(Home, All, Shown) :-
    findall(Id, ( member(News, All), arg(1, News, Id) ), Ids),
    with_proof(Home, Ids, [], All, Shown).

posted_in_parts([ended(Id, Outcome, Hops, _)], Post, Home) :-
    !,
    report(warning, lost_results, Id, typhon(results_lost(Id))),
    posted(Post, Home, [ended(Id, Outcome, Hops)]).
posted_in_parts([News], _, _) :-
    !,
    arg(1, News, Id),
    report(warning, lost_news, Id, typhon(news_too_long(Id))).
posted_in_parts(All, Post, Home) :-
    length(All, Count),
    Half is Count//2,
    length(First, Half),
    append(First, Rest, All),
    posted(Post, Home, First),
    posted(Post, Home, Rest).

typhon_durable:undelivered(whereabouts, shown(_, All), Home, Formal) :-
    !,
    typhon_durable:undelivered(whereabouts, All, Home, Formal).
typhon_durable:undelivered(whereabouts, All, Home, resource_error(_)) :-
    posted_in_parts(All, durable_post, Home).

take(Home, All) :-
    most_weight(Most),
    take(Most, Home, All).

take(Most, Home, [News|All]) :-
    Most > 0,
    retract(news(Home, _, News)),
    !,
    weight(News, Weight),
    Most1 is Most-Weight,
    take(Most1, Home, All).
take(_, _, []).

take_in_hand(Home, All) :-
    take(Home, All),
    retractall(in_hand(Home, _)),
    (   All == []
    ->  retractall(courier(Home))
    ;   assertz(in_hand(Home, All))
    ).

%   A courier ends with the process, or gives up after news_seconds: it tries
%   again after any other error, such as that of a journal.

sent(ok, Home, _, _) :-
    !,
    with_mutex(typhon_news, after(Home, Courier)),
    start_courier(Courier, Home).
sent(unreachable(_), Home, All, try(Since0, Pause)) :-
    !,
    monotonic_time(Now),
    since(Since0, Now, Since),
    setting(news_seconds, Max),
    (   Now-Since > Max
    ->  give_up(Home)
    ;   once_more(Home, All, try(Since, Pause))
    ).
sent(existence_error(_, _), Home, _, _) :-
    !,
    give_up(Home).                      % this process ends
sent(_, Home, All, Try) :-
    once_more(Home, All, Try).

once_more(Home, All, try(Since, Pause)) :-
    with_mutex(typhon_news, forall(member(News, All), put_back(Home, News))),
    longest_pause(Longest),
    Pause1 is min(Longest, 2*Pause),
    alarm_in(Pause, Home, news(try(Since, Pause1))).

since(0, Now, Now) :-
    !.
since(Since, _, Since).

put_back(Home, News) :-
    arg(1, News, Id),
    keep(Home, Id, News).

give_up(Home) :-
    with_mutex(typhon_news,
               ( retractall(news(Home, _, _)),
                 retractall(in_hand(Home, _)),
                 retractall(pauses(Home)),
                 retractall(courier(Home)) )),
    print_message(silent, typhon(home_unreachable(Home))).

typhon_scheduler:fire(Home, news(Try)) :-
    !,
    scheduler_call(carry(Home, Try)).
typhon_scheduler:fire(Home, news_paused) :-
    !,
    (   with_mutex(typhon_news, retract(pauses(Home)))
    ->  scheduler_call(carry(Home, try(0, 0.5)))
    ;   true                            % more urgent news came meanwhile
    ).
