:- module(typhon_spacetime,
          [ spacetime/2                 % +Events, -World
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists), [last/2, member/2, reverse/2]).
:- use_module(library(pairs), [group_pairs_by_key/2, pairs_values/2]).
:- use_module('../../prolog/typhon/tools/event_text', [own_event/1]).

/** <module> Positions of agents over time

Converts the events of a log, see typhon_events, to lines in space and time:

    world(Span, Hosts, Agents, Stays, Hops, Letters, Marks)

  - Span is From-To, the times of the first and the last event; Hosts and
    Agents are in the order of their first events
  - stay(Agent, Host, From, To)
  - hop(Agent, FromHost, From, ToHost, To, How): How is `seen`, or `guessed`
    if the log does not have the time of the move
  - letter(FromAgent, From, ToAgent, To): the first message that A sends to B
    is the first that B receives from A
  - mark(Kind, Agent, Host, Time): Kind is `begins`, `ends`, `fails`, `logs`,
    or clone(Clone)

*Threading*: pure.
*/

%!  spacetime(+Events, -World) is semidet.
%
%   Fails if there are no events of agents.

spacetime(Events0, world(First-Last, Hosts, Agents, Stays, Hops, Letters,
                         Marks)) :-
    findall(Time-event(Time, Host, Agent, What),
            ( member(event(Time, Host, Agent, What), Events0),
              Agent \== none ),
            Keyed),
    keysort(Keyed, Sorted),
    pairs_values(Sorted, Events),
    Events = [event(First, _, _, _)|_],
    last(Events, event(Last, _, _, _)),
    in_order(Host, member(event(_, Host, _, _), Events), Hosts),
    in_order(Agent, member(event(_, _, Agent, _), Events), Agents),
    findall(Agent-(Time-Host-What), member(event(Time, Host, Agent, What),
                                           Events),
            Own),
    keysort(Own, Grouped),
    group_pairs_by_key(Grouped, Lives),
    findall(Line, line_of(Lives, Last, Line), Lines),
    findall(S, ( member(S, Lines), S = stay(_, _, _, _) ), Stays),
    findall(H, ( member(H, Lines), H = hop(_, _, _, _, _, _) ), Hops),
    letters(Events, Letters),
    findall(Mark, mark(Events, Mark), Marks).

:- meta_predicate in_order(?, 0, -).

in_order(Item, Goal, Items) :-
    findall(Item, Goal, All),
    foldl(new, All, [], Reversed),
    reverse(Reversed, Items).

new(Item, Items, Items) :-
    memberchk(Item, Items),
    !.
new(Item, Items, [Item|Items]).

                /*******************************
                *             LINES            *
                *******************************/

line_of(Lives, Last, Line) :-
    member(Agent-Own, Lives),
    lines(Own, nowhere, Agent, Last, Lines),
    member(Line, Lines).

%   lines(+Own, +Where, ...): Where is `nowhere`, here(Host, Since, Latest),
%   with the time of the latest event there, left(Host, Time), or `over`.

lines([], Where, Agent, Last, Lines) :-
    (   Where = here(Host, Since, _)
    ->  Lines = [stay(Agent, Host, Since, Last)]
    ;   Lines = []
    ).
lines([Time-Host-What|Own], Where0, Agent, Last, Lines) :-
    line(What, Time, Host, Agent, Where0, Where, Lines, Rest),
    lines(Own, Where, Agent, Last, Rest).

line(_, _, _, _, over, over, Lines, Lines) :-
    !.
line(What, Time, Host, Agent, Where0, Where, Lines, Rest) :-
    \+ own_event(What),
    !,
    be_here(Where0, Time, Host, Agent, Where, Lines, Rest).
line(arrived(From, Seconds), Time, Host, Agent, Where,
     here(Host, Time, Time), Lines, Rest) :-
    !,
    set_out(Where, From, Seconds, Time, Agent, FromHost, Start, Lines, More),
    More = [hop(Agent, FromHost, Start, Host, Time, seen)|Rest].
line(left(_), Time, Host, Agent, Where0, left(Host, Time), Lines, Rest) :-
    !,
    be_here(Where0, Time, Host, Agent, here(_, Since, _), Lines, Rest0),
    Rest0 = [stay(Agent, Host, Since, Time)|Rest].
line(What, Time, Host, Agent, Where0, over, Lines, Rest) :-
    last_of(What),
    !,
    be_here(Where0, Time, Host, Agent, here(_, Since, _), Lines, Rest0),
    Rest0 = [stay(Agent, Host, Since, Time)|Rest].
line(_, Time, Host, Agent, Where0, Where, Lines, Rest) :-
    be_here(Where0, Time, Host, Agent, Where, Lines, Rest).

last_of(ended(_)).
last_of(faulty(_)).

%   set_out(+Where, ...): host and time of departure of an agent that arrives
%   now.

set_out(left(Host, Start), _, _, _, _, Host, Start, Rest, Rest) :-
    !.
set_out(here(Host, Since, _), _, Seconds, Time, Agent, Host, Start,
        [stay(Agent, Host, Since, Start)|Rest], Rest) :-
    !,
    Start is max(Since, Time-Seconds).
set_out(_, From, Seconds, Time, _, From, Start, Rest, Rest) :-
    Start is Time-Seconds.

%   be_here(+Where0, ...): the agent has an event on Host.

be_here(here(Host, Since, _), Time, Host, _, here(Host, Since, Time),
        Rest, Rest) :-
    !.
be_here(here(Other, Since, Latest), Time, Host, Agent,
        here(Host, Time, Time),
        [ stay(Agent, Other, Since, Latest),
          hop(Agent, Other, Latest, Host, Time, guessed) | Rest ], Rest) :-
    !.
be_here(left(Host, Start), Time, Host, _, here(Host, Start, Time),
        Rest, Rest) :-                  % its move failed
    !.
be_here(left(Other, Start), Time, Host, Agent, here(Host, Time, Time),
        [hop(Agent, Other, Start, Host, Time, guessed)|Rest], Rest) :-
    !.
be_here(_, Time, Host, _, here(Host, Time, Time), Rest, Rest).

                /*******************************
                *       LETTERS, MARKS         *
                *******************************/

letters(Events, Letters) :-
    findall((From-To)-Time,
            ( member(event(Time, _, From, What), Events), sent(What, To) ),
            Sent),
    findall((From-To)-Time,
            ( member(event(Time, _, To, What), Events), received(What, From) ),
            Received),
    keysort(Sent, Sent1),
    keysort(Received, Received1),
    pair(Sent1, Received1, Letters).

sent(sent(To), To).
sent(sent(To, _), To).

received(received(From), From).
received(received(From, _), From).

%   The k-th message sent is the k-th received between the same two agents.

pair([Ends-From|Sent], [Ends-To|Received], Letters) :-
    !,
    (   To < From-0.1                   % its sending was not logged
    ->  pair([Ends-From|Sent], Received, Letters)
    ;   Ends = A-B,
        Letters = [letter(A, From, B, To)|More],
        pair(Sent, Received, More)
    ).
pair([Ends-From|Sent], [Other-To|Received], Letters) :-
    !,
    (   Ends @< Other
    ->  pair(Sent, [Other-To|Received], Letters)
    ;   pair([Ends-From|Sent], Received, Letters)
    ).
pair(_, _, []).

mark(Events, mark(Kind, Agent, Host, Time)) :-
    member(event(Time, Host, Agent, What), Events),
    kind(What, Kind).

kind(created, begins) :- !.
kind(ended(Outcome), Kind) :-
    !,
    (   memberchk(Outcome, [done, disposed])
    ->  Kind = ends
    ;   Kind = fails
    ).
kind(faulty(_), fails) :- !.
kind(cloned(Clone), clone(Clone)) :-
    own_event(cloned(Clone)),
    !.
kind(What, logs) :-
    \+ own_event(What).
