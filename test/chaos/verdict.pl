:- module(chaos_verdict,
          [ verdict/3,                  % +Scenario, +Evidence, -Findings
            finding_kind/3              % ?Kind, ?Severity, ?Meaning
          ]).

/** <module> Comparison of the invariants with the result of a run

A finding is finding(Kind, What).  If no process was killed nothing is
excused; otherwise a loss is excused if the process that held the item, or its
destination, was killed afterwards, see doc/agents.md. Duplicates are never
excused.

*Threading*: for one thread at a time, see chaos_facts.
*/

:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module(facts).
:- use_module(goods, [message_finding/2, token_finding/2]).

%!  finding_kind(?Kind, ?Severity, ?Meaning) is nondet.
%
%   Severity is `wrong`, `excused` (only where processes were killed), or
%   `told`: reported, since nothing else was promised.

finding_kind(lost,          wrong,   'agents lost').
finding_kind(doubled,       wrong,   'agents doubled').
finding_kind(count,         wrong,   'wrong counts').
finding_kind(outcome,       wrong,   'wrong outcomes').
finding_kind(undead,        wrong,   'agents that went on when disposed of').
finding_kind(stuck,         wrong,   'agents not at rest at the end').
finding_kind(message_lost,  wrong,   'messages lost').
finding_kind(message_twice, wrong,   'messages doubled').
finding_kind(order_still,   wrong,   'out of order, between agents that stand').
finding_kind(token_lost,    wrong,   'tokens lost').
finding_kind(token_twice,   wrong,   'tokens doubled').
finding_kind(hung,          wrong,   'calls that hung').
finding_kind(crashed,       wrong,   'processes that ended by themselves').
finding_kind(denied,        wrong,   'agents said not to exist').
finding_kind(refused,       wrong,   'errors without a cause').
finding_kind(left,          wrong,   'threads and queues left').
finding_kind(died,          excused, 'agents that died with a process').
finding_kind(again,         excused, 'steps done again after a death').
finding_kind(message_died,  excused, 'messages that died with a process').
finding_kind(token_died,    excused, 'tokens that died with a process').
finding_kind(in_doubt,      excused, 'agents in doubt, to dead processes').
finding_kind(late,          told,    'agents disposed of in doubt that went on').
finding_kind(order_moving,  told,    'out of order, where one moves').
finding_kind(error,         told,    'errors while there were faults').

%!  verdict(+Scenario, +Evidence, -Findings) is det.

verdict(Scenario, Evidence, Findings) :-
    facts_load(Evidence),
    call_cleanup(
        findall(Finding, finding(Scenario, Evidence, Finding), Findings0),
        facts_clear),
    sort(Findings0, Findings).

finding(Scenario, _, Finding) :-
    agent_finding(Scenario, Finding).
finding(_, Evidence, Finding) :-
    message_finding(Evidence.mail, Finding).
finding(_, Evidence, Finding) :-
    token_finding(Evidence.tuples, Finding).
finding(Scenario, Evidence, Finding) :-
    member(Call, Evidence.calls),
    call_finding(Call, Scenario, Finding).
finding(_, Evidence, finding(left, Name:Thing)) :-
    member(Name-Things, Evidence.left),
    member(Thing, Things).

                /*******************************
                *            AGENTS            *
                *******************************/

agent_finding(_, finding(Kind, copies(Key, Id, Names))) :-
    created(Key, _, Id, _, _),
    findall(Name, standing(Id, Name, _, _, _), Names),
    length(Names, Count),
    copies(Count, Key, Kind).
agent_finding(_, finding(stuck, at(Key, State))) :-
    standing_as(Key, State, _, _),
    State \== resident,
    \+ ( State == in_doubt, depends_on_the_dead(Key) ).
agent_finding(_, finding(in_doubt, Key)) :-
    standing_as(Key, in_doubt, _, _),
    depends_on_the_dead(Key).
agent_finding(_, Finding) :-
    created(Key, _, _, _, _),
    findall(Tick-at(Life, Event),
            event(Key, Tick, Event, _, Life), Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    tick_finding(Groups, Key, Finding).
agent_finding(_, finding(count, What)) :-
    standing_as(Key, _, Hops, Facts),
    wrong_count(Key, Hops, Facts, What).
agent_finding(_, finding(count, Key:Event)) :-
    event(Key, _, Event, _, _),
    ( Event = wrong(_) ; Event = astray(_, _) ).
agent_finding(_, finding(outcome, Key-Outcome)) :-
    created(Key, _, Id, _, _),
    outcome(Id, Outcome),
    \+ right_outcome(Key, Outcome).
agent_finding(_, finding(Kind, Key:Event)) :-
    disposed(Key, Time),
    once(( event(Key, _, Event, Later, _), Later > Time )),
    (   created(Key, _, Id, _, _),
        event(Id, _, ended_in_doubt, _, _)
    ->  Kind = late
    ;   Kind = undead
    ).
agent_finding(_, finding(Kind, unwanted_clone(Key, Why, Seen))) :-
    event(Parent, _, no_clone(N, Why), Told, _),
    clone_key(Parent, N, Key),
    findall(Time-at(Life, Event), event(Key, _, Event, Time, Life), Seen0),
    msort(Seen0, Seen),
    Seen \== [],
    unwanted(Told, Seen, Kind).
agent_finding(Scenario, finding(Kind, Key:stays(Why))) :-
    event(Key, _, stays(Why), _, _),
    (   Scenario == calm
    ->  Kind = refused
    ;   Kind = error
    ).

standing_as(Key, State, Hops, Facts) :-
    created(Key, _, Id, _, _),
    standing(Id, _, State, Hops, Facts).

%   copies(+Count, +Key, -Kind): the violation of a wrong count.

copies(0, Key, Kind) :-
    \+ has_ended(Key),
    (   excused(Key)
    ->  Kind = died
    ;   Kind = lost
    ).
copies(1, Key, undead) :-
    has_ended(Key),
    \+ ( standing_as(Key, in_doubt, _, _),
         depends_on_the_dead(Key) ).
copies(Count, _, doubled) :-
    Count > 1.

has_ended(Key) :-
    disposed(Key, _),
    !.
has_ended(Key) :-
    event(Key, _, end, _, _),
    !.
has_ended(Key) :-
    created(Key, victim, Id, _, _),
    outcome(Id, disposed).

%   unwanted(+Told, +Seen, -Kind): its parent was notified that there is no
%   clone, which is correct if the clone died before.

unwanted(Told, Seen, died) :-
    forall(member(_-at(Name-Number, _), Seen),
           ( life(Name, Number, _, Dead),
             number(Dead),
             Dead =< Told )),
    !.
unwanted(_, _, doubled).

%   An agent that is moved by an order does not announce it, nor does a clone,
%   or an agent that is to be disposed of.

excused(Key) :-
    last_trace(Key, Event, Time, Name-Number),
    (   life(Name, Number, _, Dead),
        number(Dead)
    ;   Event = go(Host),
        home_of(Host, Other),
        death_of(Other, Dead),
        Dead >= Time
    ;   created(Key, Kind, _, _, _),
        memberchk(Kind, [sleeper,clone,victim]),
        death_of(_, Dead),
        Dead >= Time-1
    ;   created(Key, victim, _, Home, _),
        \+ alive(Home)                  % its home had news of its end, if any
    ),
    !.

last_trace(Key, Event, Time, Life) :-
    aggregate_all(max(T, E-L), event(Key, _, E, T, L),
                  max(Time, Event-Life)),
    !.
last_trace(Key, none, Time, Life) :-
    created(Key, _, _, Life, Time).

%   The hosts of a process have its name and a number.

home_of(Host, Name) :-
    life(Name, 1, _, _),
    sub_atom(Host, 0, _, _, Name),
    !.

%   The destination, or the processes that knew the agent's host, are gone for
%   good.

depends_on_the_dead(Key) :-
    gone(Name),
    (   last_trace(Key, go(Host), _, _),
        home_of(Host, Name)
    ;   sent_on(Key, Host),
        home_of(Host, Name)
    ;   created(Key, _, _, Name-_, _)
    ;   created(Key, _, _, Home-_, _),      % restarted, it queries all
        life(Home, _, _, Died),
        Died \== inf
    ;   created(Key, Kind, _, _, _),      % these do not announce hops
        memberchk(Kind, [sleeper,cloner])
    ),
    !.

%   The copy that is on a host was sent to Host; it may have hopped further,
%   and its last steps died with the process that was about to send it back.

sent_on(Key, Host) :-
    created(Key, _, Id, _, _),
    standing(Id, Holder, _, _, _),
    aggregate_all(max(T, E), event(Key, _, E, T, Holder-_), max(_, go(Host))).

gone(Name) :-
    life(Name, 1, _, _),
    \+ life(Name, _, _, inf).

%   Ticks are 1, 2, 3 and so on, each once.

tick_finding(Groups, Key, finding(Kind, twice(Key, Tick, Events))) :-
    member(Tick-Events, Groups),
    Events = [_,_|_],
    (   findall(Life, ( member(at(Life, _), Events), alive(Life) ), Lives),
        \+ Lives = [_,_|_],
        dead_among(Events)
    ->  Kind = again
    ;   Kind = doubled
    ).
tick_finding(Groups, Key, finding(count, gap(Key, Tick, Next))) :-
    append(_, [Tick-_,Next-_|_], Groups),
    Next =\= Tick+1.

dead_among(Events) :-
    member(at(Life, _), Events),
    \+ alive(Life),
    !.

%   For a clone that was born elsewhere getting there was the first hop.

wrong_count(Key, _, Facts, ticks(Key, Tick, Noted)) :-
    memberchk(tick(Tick), Facts),
    aggregate_all(max(T, L), event(Key, T, _, _, L), max(Noted, Life)),
    Tick =\= Noted,
    \+ ( Tick < Noted, \+ alive(Life) ).
wrong_count(Key, Hops, Facts, hops(Key, Steps, Hops)) :-
    created(Key, Kind, _, _, _),
    Kind \== sleeper,
    memberchk(steps(Steps), Facts),
    Steps =\= Hops,
    \+ ( Kind == clone, Hops =:= Steps+1 ).

right_outcome(Key, _) :-
    copies(0, Key, died),               % that cannot be known
    !.
right_outcome(Key, _) :-
    created(Key, _, _, Life, _),
    \+ alive(Life),                     % its home has forgotten
    !.
right_outcome(Key, timeout) :-
    excused(Key),                       % it died with the news of its end
    !.
right_outcome(Key, Outcome) :-
    ended_as(Key, Outcome).

ended_as(Key, Outcome) :-
    disposed(Key, _),
    !,
    Outcome == disposed.
ended_as(Key, disposed) :-
    created(Key, victim, _, _, _),      % the caller of the order got no answer
    !.
ended_as(Key, Outcome) :-
    event(Key, _, end, _, _),
    !,
    created(Key, Kind, _, _, _),
    (   Kind == clone
    ->  Outcome == disposed
    ;   Outcome == done
    ).
ended_as(_, timeout).                   % the agent has not ended

                /*******************************
                *             CALLS            *
                *******************************/

call_finding(call(What, Name, Result), Scenario, finding(Kind, Found)) :-
    Found = call(What, Name, Result),
    call_kind(Result, What, Scenario, Kind).

call_kind(hung, _, _, Kind) :-
    !,
    Kind = hung.
call_kind(crashed(_), _, _, Kind) :-
    !,
    Kind = crashed.
call_kind(died, _, _, _) :-
    !,
    fail.
call_kind(outcome(_), join(_, Key), _, Kind) :-
    !,
    \+ copies(0, Key, died),
    Kind = outcome.
call_kind(_, What, _, Kind) :-
    looks(What),
    !,
    Kind = refused.
call_kind(Result, _, _, Kind) :-
    no_such_agent(Result),
    !,
    (   death_of(_, _)
    ->  Kind = error
    ;   Kind = denied
    ).
call_kind(_, _, calm, Kind) :-
    !,
    Kind = refused.
call_kind(_, _, _, error).

%   Calls of the suite itself at the end, to healthy processes.

looks(halt).
looks(census(_)).
looks(tuples(_)).
looks(outcomes(_, _)).
looks(timer_size(_)).
looks(close_hosts(_)).

no_such_agent(no).
no_such_agent(raised(existence_error(agent, _))).
