:- module(chaos_evidence,
          [ settle/3,                   % +Seconds, +Expected, -Rest
            evidence/2                  % +Dir, -Evidence
          ]).

/** <module> The state at the end of a run

Waits until the agents rest, and collects the data for the verdict.

*Threading*: for the main thread.
*/

:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [append/2, member/2]).
:- use_module(cluster).
:- use_module(work).

call_seconds(60).

%!  settle(+Seconds, +Expected, -Rest) is det.
%
%   Wait until at most as many agents are restless, and as many messages
%   outstanding, as Expected; or until nothing has changed for a while; but not
%   longer than Seconds.  The number of messages of dead processes is unknown.
%
%   @arg Expected, Rest are rest(Agents, Messages)

quiet_seconds(12).  % longer than the pause between two posts of news

settle(Seconds, Expected, Rest) :-
    get_time(Now),
    End is Now+Seconds,
    settle(Now, End, none, Expected, Rest).

settle(Since0, End, Before, Expected, Rest) :-
    picture(Picture),
    get_time(Now),
    (   Picture == Before
    ->  Since = Since0
    ;   Since = Now
    ),
    (   settled(Since, Now, End, Picture, Expected)
    ->  Picture = picture(Rest, _)
    ;   Soon is Now+0.5,
        cluster_wait(Soon),
        settle(Since, End, Picture, Expected, Rest)
    ).

settled(_, Now, End, _, _) :-
    Now >= End.
settled(Since, Now, _, _, _) :-
    quiet_seconds(Quiet),
    Now-Since >= Quiet.
settled(Since, Now, _, picture(rest(A, M), _), rest(A0, M0)) :-
    Now > Since,                        % unchanged since then
    nobody_died,
    A =< A0,
    M =< M0.

nobody_died :-
    cluster_lives(Lives),
    forall(member(life(_, _, _, End), Lives), End == inf).

%   picture(rest(Agents, Messages), Ticks)

picture(picture(rest(Restless, Missing), Ticks)) :-
    agents(Agents),
    work_mail(Mail),
    length(Mail, Posted),
    aggregate_all(count, ( member(agent(_, _, State, _, _), Agents),
                           State \== resident ), Restless),
    sum_of(tick(N)-N, Agents, Ticks),
    sum_of(said(_, K)-K, Agents, Said),
    sum_of(heard(H)-H, Agents, Heard),
    Missing is Said+Posted-Heard.

sum_of(Pattern, Agents, Sum) :-
    aggregate_all(sum(N),
                  ( member(agent(_, _, _, _, Facts), Agents),
                    member(Fact, Facts),
                    copy_term(Pattern, Fact-N) ),
                  Sum).

agents(Agents) :-
    call_seconds(Seconds),
    cluster_call_all(census(_), Seconds, Results),
    findall(agent(Name, Id, State, Hops, Facts),
            ( member(Name-yes(census(List)), Results),
              member(agent(Id, State, Hops, Facts), List) ),
            Agents).

%!  evidence(+Dir, -Evidence) is det.
%
%   Evidence is a dict: lives, agents (as created), standing (agent(Name, Id,
%   State, Hops, Facts) for each on a host), tuples, events (e(Key, Tick,
%   Event, Time, Life)), mail, disposed, outcomes (Id-Outcome as its home
%   reports), calls, left (Name-Things), timers (kB), proxies. Afterwards there
%   are no hosts any more.

evidence(Dir, _{ lives:Lives, agents:Agents, standing:Standing,
                 tuples:Tuples, events:Events, mail:Mail,
                 disposed:Disposed, outcomes:Outcomes, calls:Calls,
                 left:Left, timers:Timers, proxies:Proxies }) :-
    call_seconds(Seconds),
    cluster_lives(Lives),
    work_agents(Agents),
    agents(Standing),
    answers(tuples(Found), Found, Lists),
    append(Lists, Tuples),
    events(Dir, Events),
    outcomes(Agents, Events, Outcomes),
    answers(timer_size(Size), Size, Timers),
    cluster_proxy([counts], Proxies),
    cluster_call_all(close_hosts(_), Seconds, Closed),
    findall(Name-Things,
            ( member(Name-yes(close_hosts(Things)), Closed), Things \== [] ),
            Left),
    work_answers,
    work_mail(Mail),
    work_disposed(Disposed),
    work_calls(Calls).

answers(Goal, Template, List) :-
    call_seconds(Seconds),
    cluster_call_all(Goal, Seconds, Results),
    findall(Template, member(_-yes(Goal), Results), List).

%   The homes of agents that should have ended are queried.

outcomes(Agents, Events, Outcomes) :-
    findall(Name-Id, ending(Agents, Events, Name, Id), Pairs),
    cluster_running(Names),
    call_seconds(Seconds),
    findall(Name-Tag,
            ( member(Name, Names),
              findall(Id, member(Name-Id, Pairs), Ids),
              cluster_ask(Name, outcomes(Ids, _), Seconds, Tag) ),
            Tags),
    findall(Outcome,
            ( member(_-Tag, Tags),
              cluster_result(Tag, yes(outcomes(_, List))),
              member(Outcome, List) ),
            Outcomes).

ending(Agents, _, Name, Id) :-
    member(agent(_, Kind, Id, Name-_, _), Agents),
    memberchk(Kind, [sprinter,victim]).
ending(_, Events, Name, Id) :-
    member(e(_, _, clone(_, Id), _, _), Events),
    once(( cluster_names(Names),
           member(Name, Names),
           cluster_hosts(Name, Hosts),
           member(Host, Hosts),
           atom_concat(@, Host, Home),
           sub_atom(Id, _, _, 0, Home) )).

%   An incomplete line of a killed process or of an interrupted writer is
%   skipped, but not the lines after it.

events(Dir, Events) :-
    cluster_lives(Lives),
    findall(Event,
            ( member(life(Name, Number, _, _), Lives),
              format(atom(File), '~w/~w.~d.ledger', [Dir, Name, Number]),
              event_in(File, Name-Number, Event) ),
            Events0),
    msort(Events0, Events).

event_in(File, Life, e(Key, Tick, Event, Time, Life)) :-
    exists_file(File),
    setup_call_cleanup(
        open(File, read, In),
        ( repeat,
          catch(read_term(In, Term, []), error(syntax_error(_), _),
                Term = broken),
          (   Term == end_of_file
          ->  !,
              fail
          ;   Term = e(Key, Tick, Event, Time)
          )
        ),
        close(In)).
