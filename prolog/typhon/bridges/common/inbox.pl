:- module(typhon_inbox,
          [ inbox_put/4,                % +How, +Source, +Whom, +What
            gap_forget/3,               % +Service, +Key, +Agent
            inbox_key/2                 % +Key, -Text
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module('../../kernel/host',
              [ event/4, events_subscribe/3, events_unsubscribe/1, host/3,
                tuple_leave/2, tuple_sense/2, tuple_take/2 ]).
:- use_module('../../kernel/agent',
              [agent/5, agent_mail/2, mail_count/2, with_agent/2]).

/** <module> Incoming messages of services, and dropped ones

A message for an agent goes to its mailbox if fewer than Max messages wait
there.  Otherwise it is dropped and counted: there is a gap.  When half of the
mailbox is free again, or the next message fits, the agent first gets
Service-dropped(Key, Count).  Facts are treated in the same way, but the fact
Service-dropped(Key, Count) has the count of all dropped facts.

*Threading*: the thread that reads incoming messages calls inbox_put/4.  While a
host has gaps, the threads that run its agents report each message that an agent
takes, and the agents that leave, end or become faulty.
*/

:- multifile
    dropped/3,                  % Service, Host, Message: for an agent whose
                                % queue is full; must not wait
    typhon_events:handle_event/4.

:- dynamic
    gap/7.                      % Agent, Service, Text, Host, Max, Count, Key

%!  inbox_put(+How, +Source, +Whom, +What) is semidet.
%
%   Deliver a message or fact.  How is how(As, Max), Source is Service-Key, Whom
%   is Host-Agent and What is Message-Same, see subscribers_notify/5.  Fails if
%   Agent is not on Host.

inbox_put(how(message, Max), Service-Key, Host-Agent, Message-_) =>
    Gap = gap(Agent, Service, Key, Host, Max),
    gap_taken(Gap, Count),
    prepend_dropped(Count, Service, Key, Messages, [Service-Message]),
    with_agent(Agent, put(Agent, Host, Max, Messages, Done)),
    done(Done, Gap, Count),
    (   Done == full
    ->  ignore(dropped(Service, Host, Message))
    ;   true
    ).
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

prepend_dropped(0, _, _, Messages, Messages) :-
    !.
prepend_dropped(Count, Service, Key, [Service-dropped(Key, Count)|Messages],
                Messages).

put(Agent, Host, Max, Messages, Done) :-
    agent(Agent, Host, _, _, _),
    !,
    mail_count(Agent, Waiting),
    (   Waiting < Max
    ->  agent_mail(Agent, Messages),
        Done = put
    ;   Done = full
    ).

done(put, Gap, Count) :-
    (   Count =:= 0
    ->  true
    ;   with_mutex(typhon_inbox, stop_listening(Gap))
    ).
done(full, Gap, Count0) :-
    Count is Count0+1,
    with_mutex(typhon_inbox, add(Gap, Count)),
    Gap = gap(Agent, Service, Key, Host, _),
    (   agent(Agent, Host, _, _, _)
    ->  true
    ;   gap_forget(Service, Key, Agent) % it left before the subscription
    ).

                /*******************************
                *             GAPS             *
                *******************************/

%   gap_taken(+Gap, -Count): remove the gap and return its count.  The caller
%   must report the gap or restore it.

gap_taken(gap(Agent, Service, Key, Host, Max), Count) :-
    (   gap(Agent, Service, _, _, _, _, _),
        inbox_key(Key, Text),
        with_mutex(typhon_inbox,
                   retract(gap(Agent, Service, Text, Host, Max, Count0, _)))
    ->  Count = Count0
    ;   Count = 0
    ).

add(gap(Agent, Service, Key, Host, Max), Count) :-
    (   gap(_, _, _, Host, _, _, _)
    ->  true
    ;   events_subscribe([messages,life,bad_ends,hops], Host, inbox(Host))
    ),
    inbox_key(Key, Text),
    assertz(gap(Agent, Service, Text, Host, Max, Count, Key)).

stop_listening(gap(_, _, _, Host, _)) :-
    (   gap(_, _, _, Host, _, _, _)
    ->  true
    ;   events_unsubscribe(inbox(Host))
    ).

%!  inbox_key(+Key, -Text:atom) is det.
%
%   Text is Key as an atom, for tables that threads share: an index on compound
%   terms is not safe there, see typhon_agents.

inbox_key(Key, Key) :-
    atom(Key),
    !.
inbox_key(Key, Text) :-
    format(atom(Text), '~q', [Key]).

%!  gap_forget(+Service, +Key, +Agent) is det.
%
%   Agent is no longer subscribed: drop its gap.

gap_forget(Service, Key, Agent) :-
    Gap = gap(Agent, Service, Key, _, _),
    gap_taken(Gap, Count),
    (   Count =:= 0
    ->  true
    ;   with_mutex(typhon_inbox, stop_listening(Gap))
    ).

typhon_events:handle_event(inbox(_), Host, Agent, received(_, _)) :-
    gap(Agent, Service, _, Host, Max, _, Key),
    with_agent(Agent, mail_count(Agent, Waiting)),
    Waiting =< Max//2,
    Gap = gap(Agent, Service, Key, Host, Max),
    gap_taken(Gap, Count),
    Count > 0,
    with_mutex(typhon_inbox, stop_listening(Gap)),
    with_agent(Agent, ignore(agent_mail(Agent,
                                        [Service-dropped(Key, Count)]))).
typhon_events:handle_event(inbox(_), Host, Agent, What) :-
    ends_stay(What),
    forall(gap(Agent, Service, _, Host, _, _, Key),
           gap_forget(Service, Key, Agent)).

ends_stay(left(_)).
ends_stay(ended(_)).
ends_stay(faulty(_)).

leave(Host, Place, Fact) :-
    tuple_leave(Place, Fact),
    event(facts, Host, none, leave(Fact)).

%   facts(+Place, +Service, +Max, -Count): Count is the number of facts of
%   Service. Where the tuple space has few facts, the number of all facts
%   serves, which is found at once.

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
