:- module(typhon_properties,
          [ agent_property/2,           % ?Agent, ?Property
            status_shown/2              % +Status, -State
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module('../base/options', [check_name/2]).
:- use_module('../program', [code_program/2]).
:- use_module('../host', [host/3, host_address/2, turn_of/3]).
:- use_module('../agent',
              [ agent/5, agent_home/2, agent_state/2, agent_status/3,
                fault_error/2, fault_shown/2, in_words/2, is_faulty/3,
                life_hops/2, life_payloads/2, mail_list/2, with_agent/2 ]).
:- use_module('../travel', [in_doubt/1, transfer_held/2]).
:- use_module(change, [held_parts/3]).
:- use_module(named, [agent_named/2]).
:- use_module(questions,
              [agent_ask/4, agent_ask_here/4, question_answered/2]).

/** <module> What can be seen of an agent

*Threading*: any thread.
*/

:- multifile
    typhon_names:known/2,
    typhon_questions:here/3.

%!  agent_property(?Agent, ?Property) is nondet.
%
%   Property is host(Address), program(Name), state(State), hops(N),
%   home(Address), goals(List), facts(Clauses), payloads(Names),
%   mailbox(Messages) or fault(Fault).  State is `running`, `sleeping`,
%   `waiting`, `resident`, `held` (see agent_step/1), `in_transit`, `in_doubt`
%   or faulty(Error), Error being `failed` if it has failed.  Then, and only
%   then, there is a fault:
%   fault(Error, Goal, Place, Host), the goal that failed or raised the error,
%   where it stands, as File:Line, or Name/Arity:N for the N-th clause of a
%   predicate, or `unknown`, and on which host it was.  What cannot travel
%   stands in goals and messages in words.  One that runs has busy(Seconds):
%   for so long, by the time of day, it has not stopped.  A host may be
%   given by its name, as in host(alpha).  If Agent is unbound, the agents of
%   this process are enumerated.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids) if Agent
%   is a name; of an id that is no more this fails
%   @error domain_error(agent_property, Property) if there is none like it

agent_property(Agent, Property0) :-
    check_name(agent_property, Property0),
    by_address(Property0, Property),
    known_as(Agent, Id, Ask),
    question(Property, Question),
    call(Ask, Id, Question, 10, answer(Properties)),
    one_of(Property, Properties).

%   One of all agents here may have left meanwhile: it is not followed.

known_as(Agent, Agent, agent_ask_here) :-
    var(Agent),
    !,
    agent(Agent, _, _, _, _).
known_as(Agent, Id, agent_ask) :-
    agent_named(Agent, Id).

%   Those there are follow from the clauses.

typhon_names:known(agent_property, mailbox(_)).
typhon_names:known(agent_property, Property) :-
    clause(property(Property, _), _).

%   A host may be given by its name.

by_address(host(Name), Property), named_host(Name, Address) =>
    Property = host(Address).
by_address(home(Name), Property), named_host(Name, Address) =>
    Property = home(Address).
by_address(Property0, Property) =>
    Property = Property0.

named_host(Name, Address) :-
    atom(Name),
    catch(host_address(Name, Address),
          error(existence_error(host, _), _),
          fail).

%   A mailbox may be long: it comes only if it is wanted.

question(Property, Question) :-
    var(Property),
    !,
    member(Question, [properties,mailbox]).
question(mailbox(_), mailbox) :-
    !.
question(_, properties).

%   There is one property of each name: people are not asked for more.

one_of(Property, Properties) :-
    (   var(Property)
    ->  member(Property, Properties)
    ;   memberchk(Property, Properties)
    ).

                /*******************************
                *             HERE             *
                *******************************/

typhon_questions:here(properties, Agent, Asker) :-
    with_agent(Agent, findall(P, property(P, Agent), Properties)),
    Properties \== [],
    question_answered(Asker, answer(Properties)).

typhon_questions:here(mailbox, Agent, Asker) :-
    with_agent(Agent, ( agent(Agent, _, _, _, _),
                        mail_list(Agent, Messages) )),
    question_answered(Asker, answer([mailbox(Messages)])).

property(host(Address), Agent) :-
    agent(Agent, Host, _, _, _),
    host(Host, Address, _).
property(program(Name), Agent) :-
    agent(Agent, _, _, Hash, _),
    code_program(Hash, program(Name, _, _, _)).
property(state(State), Agent) :-
    agent_status(Agent, Status, Goals0),
    (   goal_list(Goals0, Goals),
        is_faulty(Goals, Fault, _)
    ->  fault_error(Fault, Error),
        State = faulty(Error)
    ;   status_shown(Status, State)
    ).
property(busy(Seconds), Agent) :-
    agent_status(Agent, running, _),
    turn_of(Agent, _, Seconds).
property(hops(Hops), Agent) :-
    agent(Agent, _, _, _, Life),
    life_hops(Life, Hops).
property(home(Home), Agent) :-
    agent(Agent, _, _, _, _),
    agent_home(Agent, Home).
property(goals(Goals), Agent) :-
    agent_status(Agent, _, Goals0),
    goal_list(Goals0, Goals1),
    (   is_faulty(Goals1, _, Left)
    ->  in_words(Left, Goals)
    ;   Goals = Goals1
    ).
property(fault(Shown), Agent) :-
    agent_status(Agent, _, Goals0),
    goal_list(Goals0, Goals),
    is_faulty(Goals, Fault, _),
    fault_shown(Fault, Shown).
property(facts(Facts), Agent) :-
    agent(Agent, _, Module, _, _),
    agent_state(Module, state(_, Clauses)),
    findall(Clause, visible(Clauses, Clause), Facts).
property(payloads(Names), Agent) :-
    agent(Agent, _, _, _, Life),
    life_payloads(Life, Payloads),
    pairs_keys(Payloads, Names).

visible(Clauses, Clause) :-
    member(Clause, Clauses),
    \+ of_platform(Clause).

of_platform(Clause) :-
    functor(Clause, Name, _),
    sub_atom(Name, 0, _, _, $).

%!  status_shown(+Status, -State) is det.
%
%   State is how people call what an agent of that Status does.

status_shown(ready, running).
status_shown(running, running).
status_shown(obeying, running).
status_shown(arriving, in_transit).
status_shown(leaving(_, _), in_transit).
status_shown(sleeping(_), sleeping).
status_shown(waiting(_, _), waiting).
status_shown(resident, resident).
status_shown(held, held).
status_shown(resumed, running).
status_shown(faulty(Error), faulty(Error)).
status_shown(transit(Host, Sent), State) :-
    if_certain(transit(Host, Sent), in_transit, State).
status_shown(cloning(Host, Sent), State) :-
    if_certain(cloning(Host, Sent), waiting, State).

if_certain(Status, State0, State) :-
    (   in_doubt(Status)
    ->  State = in_doubt
    ;   State = State0
    ).

goal_list(Frozen, Goals) :-
    transfer_held(Frozen, Held),
    !,
    without_hole(Held, Goals).
goal_list(Held, Goals) :-
    held_parts(Held, _, Goals0),
    !,
    Goals = Goals0.
goal_list(hop(Held, _), Goals) :-       % leaving
    !,
    without_hole(Held, Goals).
goal_list(Goals, Goals).

without_hole(Hole-Goals0, Goals) :-
    (   Goals0 = [Goal|Goals1],
        Goal == Hole
    ->  Goals = Goals1
    ;   ignore(Hole = true),
        Goals = Goals0
    ).
