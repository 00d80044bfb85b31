:- module(typhon_inbox,
          [ inbox_put/4,                % +How, +Source, +Whom, +What
            gap_forget/3                % +Service, +Key, +Agent
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module('../host',
              [ event/4, events_hear/3, events_unhear/3, host/3,
                tuple_leave/2, tuple_sense/2, tuple_take/2 ]).
:- use_module('../agent', [agent/5, agent_mail/2, mail_count/2, with_agent/2]).

/** <module> Where it arrives, and what there is no room for

What comes for an agent is put in its mailbox, as long as fewer than so many
messages wait there.  The others are counted, and when half of the room is
free again, or what comes next has room, the agent first gets
Service-dropped(Key, Count).  So it is with facts; there the fact
Service-dropped(Key, Count) has the count of all that were dropped.

*Threading*: inbox_put/4 is for the thread that reads what comes.  Whoever
runs an agent hears that it takes a message, while there are gaps.
*/

:- multifile typhon_events:told/4.

:- dynamic
    gap/6.                      % Agent, Service, Key, Host, Max, Count

%!  inbox_put(+How, +Source, +Whom, +What) is semidet.
%
%   How is how(As, Max), Source is Service-Key, Whom Host-Agent and What
%   Message-Same, as of subscribers_tell/5.  Fails if Agent is not on Host.

inbox_put(how(message, Max), Service-Key, Host-Agent, Message-_) =>
    told_gap(Agent, Service, Key, Before),
    with_agent(Agent, put(Agent, Host, Max, Service, Before, Message, Done)),
    done(Done, gap(Agent, Service, Key, Host, Max)).
inbox_put(how(fact, Max), Service-Key, Host-_, Message-_) =>
    host(Host, _, Place),
    (   facts(Place, Service, Max, Count),
        Count < Max
    ->  leave(Host, Place, Service-Message)
    ;   dropped_fact(Host, Place, Service, Key)
    ).
inbox_put(how(latest, Max), Service-Key, Host-Agent, Message-Same) =>
    host(Host, _, Place),
    (   tuple_sense(Place, Service-Same)
    ->  leave(Host, Place, Service-Message),
        ignore(tuple_take(Place, Service-Same))
    ;   inbox_put(how(fact, Max), Service-Key, Host-Agent, Message-Same)
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

told_gap(Agent, Service, Key, Before) :-
    (   gap(Agent, Service, Key, _, _, Count)
    ->  Before = [Service-dropped(Key, Count)]
    ;   Before = []
    ).

put(Agent, Host, Max, Service, Before, Message, Done) :-
    agent(Agent, Host, _, _, _),
    !,
    mail_count(Agent, Count),
    (   Count < Max
    ->  mail(Before, Agent, Service-Message),
        Done = put(Before)
    ;   Done = full
    ).

mail([], Agent, Message) :-
    agent_mail(Agent, [Message]).
mail([Before], Agent, Message) :-
    agent_mail(Agent, [Before,Message]).

done(put([]), _).
done(put([_]), gap(Agent, Service, Key, _, _)) :-
    gap_forget(Service, Key, Agent).
done(full, gap(Agent, Service, Key, Host, Max)) :-
    with_mutex(typhon_inbox, count(Agent, Service, Key, Host, Max)).

%   Only the thread that reads counts, but others tell.

count(Agent, Service, Key, Host, Max) :-
    (   retract(gap(Agent, Service, Key, Host, Max, Count0))
    ->  Count is Count0+1
    ;   Count = 1,
        (   gap(_, _, _, Host, _, _)
        ->  true
        ;   events_hear([messages], Host, inbox)
        )
    ),
    assertz(gap(Agent, Service, Key, Host, Max, Count)).

%!  gap_forget(+Service, +Key, +Agent) is det.
%
%   Nothing is missing, or nobody wants to know.

gap_forget(Service, Key, Agent) :-
    (   gap(Agent, Service, Key, _, _, _)
    ->  with_mutex(typhon_inbox, forget(Agent, Service, Key))
    ;   true
    ).

forget(Agent, Service, Key) :-
    (   retract(gap(Agent, Service, Key, Host, _, _)),
        \+ gap(_, _, _, Host, _, _)
    ->  events_unhear([messages], Host, inbox)
    ;   true
    ).

typhon_events:told(inbox, _, Agent, received(_, _)) :-
    gap(Agent, Service, Key, _, Max, _),
    with_agent(Agent, mail_count(Agent, Waiting)),
    Waiting =< Max//2,
    with_mutex(typhon_inbox,
               ( gap(Agent, Service, Key, _, _, Count),
                 forget(Agent, Service, Key) )),
    with_agent(Agent, ignore(agent_mail(Agent,
                                        [Service-dropped(Key, Count)]))).

                /*******************************
                *             FACTS            *
                *******************************/

leave(Host, Place, Fact) :-
    tuple_leave(Place, Fact),
    event(facts, Host, none, leave(Fact)).

%   All facts, if these are few, else those of Service.

facts(Place, Service, Max, Count) :-
    predicate_property(Place:'$tuple'(_), number_of_clauses(All)),
    (   All < Max
    ->  Count = All
    ;   aggregate_all(count, tuple_sense(Place, Service-_), Count)
    ).

dropped_fact(Host, Place, Service, Key) :-
    (   tuple_take(Place, Service-dropped(Key, Count0))
    ->  Count is Count0+1
    ;   Count = 1
    ),
    leave(Host, Place, Service-dropped(Key, Count)).
