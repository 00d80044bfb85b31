:- module(typhon_properties,
          [ property_of_agent/2,        % ?Agent, ?Property
            place_of_agent/2,           % +Agent, -Host
            show_status/2               % +Status, -State
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module('../../kernel/base/options', [check_name/2]).
:- use_module('../../kernel/program', [code_names/2, code_program/2]).
:- use_module('../../kernel/host', [host/3, host_address/2, turn_of/3]).
:- use_module('../../kernel/agent',
              [ agent/5, agent_home/2, agent_state/2, agent_status/3,
                fault_error/2, fault_shown/2, is_faulty/3,
                life_hops/2, life_payloads/2, mail_list/2, with_agent/2 ]).
:- use_module('../../language/faults', [printable_fallback/2]).
:- use_module('../../kernel/travel', [ agent_known_at/2, agent_outcome/2, in_doubt/1,
                transfer_held/2, whereabouts/2 ]).
:- use_module('../../kernel/lifecycle',
              [ agent_ask/4, agent_ask_here/4, agent_named/2, held_parts/3,
                question_answered/2 ]).

/** <module> Properties of agents

*Threading*: any thread.
*/

:- multifile
    typhon_names:known/2,
    typhon_questions:here/3.

%!  property_of_agent(?Agent, ?Property) is nondet.
%
%   As agent_property/2.

property_of_agent(Agent, Property0) :-
    check_name(agent_property, Property0),
    by_address(Property0, Property),
    known_as(Agent, Id, Ask),
    question(Property, Question),
    call(Ask, Id, Question, 10, answer(Properties)),
    one_of(Property, Properties).

%!  place_of_agent(+Agent, -Host) is det.
%
%   As agent_where/2.

place_of_agent(Agent, Host) :-
    agent_named(Agent, Id),
    (   catch(property_of_agent(Id, host(Host0)), error(Formal, Context),
              no_answer(Formal, Context))
    ->  true
    ;   agent_known_at(Id, Host0)
    ->  true
    ;   \+ agent_outcome(Id, _),
        whereabouts(Id, Host0)
    ->  true
    ;   existence_error(agent, Agent)
    ),
    Host = Host0.

no_answer(Formal, Context) :-
    (   memberchk(Formal, [ host_unreachable(_), connection_lost(_),
                            timeout_error(order, _) ])
    ->  fail
    ;   throw(error(Formal, Context))
    ).

%   The enumeration asks only this process: agents that leave meanwhile are left
%   out.

known_as(Agent, Agent, agent_ask_here) :-
    var(Agent),
    !,
    agent(Agent, _, _, _, _).
known_as(Agent, Id, agent_ask) :-
    agent_named(Agent, Id).

%   mailbox(_) has no clause of property/2, unlike the other properties.

typhon_names:known(agent_property, mailbox(_)).
typhon_names:known(agent_property, Property) :-
    clause(property(Property, _), _).

%   Users may give the name of a host in place of its address.

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

%   A mailbox may be long, so it is sent only on request.

question(Property, Question) :-
    var(Property),
    !,
    member(Question, [properties,mailbox]).
question(mailbox(_), mailbox) :-
    !.
question(_, properties).

%   A property has one value, so no choice point is left.

one_of(Property, Properties) :-
    (   var(Property)
    ->  member(Property, Properties)
    ;   memberchk(Property, Properties)
    ).

                /*******************************
                *          THIS PROCESS        *
                *******************************/

typhon_questions:here(properties, Agent, Asker) :-
    with_agent(Agent, findall(P, property(P, Agent), Properties)),
    Properties \== [],
    question_answered(Asker, answer(Properties)).

typhon_questions:here(mailbox, Agent, Asker) :-
    with_agent(Agent, ( agent(Agent, _, _, _, _),
                        mail_list(Agent, Messages) )),
    question_answered(Asker, answer([mailbox(Messages)])).

typhon_questions:here(program, Agent, Asker) :-
    agent(Agent, _, _, Hash, _),
    code_program(Hash, Program),
    !,
    code_names(Hash, Names),
    question_answered(Asker, answer(Program-Names)).

:- '$clausable'(property/2).

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
    ;   show_status(Status, State)
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
    ->  printable_fallback(Left, Goals)
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

%!  show_status(+Status, -State) is det.
%
%   As status_shown/2.

show_status(ready, running).
show_status(running, running).
show_status(obeying, running).
show_status(arriving, in_transit).
show_status(leaving(_, _), in_transit).
show_status(sleeping(_), sleeping).
show_status(waiting(_, _), waiting).
show_status(resident, resident).
show_status(held, held).
show_status(resumed, running).
show_status(faulty(Error), faulty(Error)).
show_status(transit(Host, Sent), State) :-
    if_certain(transit(Host, Sent), in_transit, State).
show_status(cloning(Host, Sent), State) :-
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
goal_list(Goals, Goals).

without_hole(Hole-Goals0, Goals) :-
    (   Goals0 = [Goal|Goals1],
        Goal == Hole
    ->  Goals = Goals1
    ;   ignore(Hole = true),
        Goals = Goals0
    ).
