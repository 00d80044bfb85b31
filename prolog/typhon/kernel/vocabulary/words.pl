:- module(typhon_words,
          [ self/1,                     % -Id
            here/1,                     % -Host
            home/1,                     % -Host
            parent/1,                   % -Id
            hops/1,                     % -Count
            now/1,                      % -Time
            neighbours/1,               % -Hosts
            neighbour/2,                % ?Host, -Cost
            host_load/1,                % -Count
            send/2,                     % +Agent, +Message
            leave/1,                    % +Fact
            leave_new/1,                % +Fact
            sense/1,                    % ?Fact
            take/1,                     % ?Fact
            log/1,                      % +What
            result/1,                   % +Term
            enter/1,                    % +Result
            message_failed/2,           % +From, +Message
            move/1,                     % +Host
            move/2,                     % +Host, +Options
            clone/1,                    % -Role
            clone/2,                    % +Host, -Role
            receive/1,                  % ?Message
            receive/2,                  % ?Message, +Timeout
            dispose/0
          ]).
:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/on_demand',
              [on_demand_call/3, on_demand_load/2, on_demand_missing/2]).
:- use_module('../base/own_thread', [uncounted/1]).
:- use_module('../base/reports', [report/4]).
:- use_module('../program',
              [control_of_system/1, control_use/2, vocabulary/1]).
:- use_module('../wire', [mobile_term/1]).
:- use_module('../host',
              [ context/3, context_agent/1, context_host/1, context_now/2,
                event/4, host/3, host_address/2, host_closed/1,
                host_link_cost/3, host_load/2, host_neighbours/2,
                host_time/2, amended/5, parts_call/3,
                tuple_leave/3, tuple_leave_new/3, tuple_sense/2,
                tuple_take/2 ]).
:- use_module('../agent',
              [ agent/5, agent_home/2, agent_variant/2, life_hops/2,
                life_parent/2, result_put/2 ]).
:- use_module('../travel', [post/3]).

/** <module> The vocabulary of agents

Agents find these predicates through the place of their host.  The control
predicates at the end only raise an error when an agent calls them where it
cannot stop; everywhere else the machine handles them.

*Threading*: any thread that runs the agent; see typhon_turns.
*/

:- vocabulary(typhon_words).

:- multifile
    enters/3,                   % Module, Id, Result: it is stored and signed
    logged/3,                   % Host, Agent, What: the log of Host has it
    posts_external/4.           % Host, To, From, Message: send it to To, which
                                % is no agent

%!  self(-Id) is det.
%
%   The id of this agent.

self(Id) :-
    context_agent(Id).

%!  here(-Host) is det.
%
%   The address of the host of this agent.

here(Address) :-
    context_host(Host),
    host(Host, Address, _).

%!  home(-Host) is det.
%
%   The address of the host where this agent was born.

home(Address) :-
    context_agent(Id),
    agent_home(Id, Address).

%!  parent(-Id) is semidet.
%
%   The agent of which this one is a clone; fails if it is no clone.

parent(Parent) :-
    life(Life),
    life_parent(Life, Parent),
    Parent \== none.

%!  hops(-Count) is det.
%
%   The number of moves of this agent.

hops(Count) :-
    life(Life),
    life_hops(Life, Count).

%!  now(-Time:float) is det.
%
%   The time on the clock of the host.

now(Time) :-
    context_host(Host),
    host_time(Host, Time).

life(Life) :-
    context_agent(Id),
    agent(Id, _, _, _, Life).

%!  neighbours(-Hosts:list(atom)) is det.
%
%   The addresses of linked hosts.

neighbours(Hosts) :-
    context_host(Host),
    host_neighbours(Host, Hosts).

%!  neighbour(?Host, -Cost:number) is nondet.
%
%   The cost of the link to Host, 1 unless it was set.

neighbour(Host, Cost) :-
    context_host(Here),
    linked(Host, Here, Address),
    host_link_cost(Here, Address, Cost).

linked(Host, Here, Host) :-
    var(Host),
    !,
    host_neighbours(Here, Hosts),
    member(Host, Hosts).
linked(Host, _, Address) :-
    host_address(Host, Address).

%!  host_load(-Count:integer) is det.
%
%   The number of agents on this host.

host_load(Count) :-
    context_host(Host),
    host_load(Host, Count).

%!  send(+Agent, +Message) is det.
%
%   As agent_send/2; the sender is this agent.  A message to an ended agent, or
%   one whose mailbox is full, is dropped with a warning, not an error; without the warning while the host of
%   this agent stops.  `user`, the sender of messages from outside, has no
%   mailbox: messages to it are printed.
%
%   A compound term, such as fipa(Name, Addresses), is a recipient beyond a
%   bridge of this host.

send(at(Agent, _), Message), \+ compound(Agent) =>
    send(Agent, Message).
send(External, Message), compound(External) =>
    context(Host, Id, Module),
    (   agent_variant(Module, _)        % the bridge acts for the host
    ->  permission_error(call, sandboxed, send(External, Message))
    ;   true
    ),
    (   on_demand_missing(recipient, external)
    ->  uncounted(on_demand_load(recipient, external))  % outside the turn
    ;   true                                    % of the agent, and its quotas
    ),
    posts_external(Host, External, Id, Message),
    event(messages, Host, Id, sent(External, Message)).
send(Agent, Message), Agent == user =>
    context(Host, Id, _),
    parts_call(acts, Host, [Id, send(Message)]),
    event(messages, Host, Id, sent(user, Message)),
    print_message(informational, typhon(told(Id, Message))).
send(Agent, Message) =>
    must_be(atom, Agent),
    context(Host, Id, _),
    parts_call(acts, Host, [Id, send(Message)]),
    event(messages, Host, Id, sent(Agent, Message)),
    catch(post(Agent, Id, Message),
          error(Formal, Context),
          not_sent(Formal, Context, Host, Agent, Id, Message)).

%   On a host that stops, agents at rest end first, which running agents cannot
%   know: messages to ended agents are dropped without a warning.

not_sent(existence_error(agent, Agent), _, Host, Agent, _, _) :-
    host_closed(Host),
    !.
not_sent(Formal, _, _, Agent, Id, Message) :-
    ( Formal = existence_error(agent, Agent)
    ; Formal = resource_error(mailbox)
    ),
    !,
    report(warning, lost_messages, Agent,
           typhon(undeliverable(Formal, Agent, Id, Message))).
not_sent(Formal, Context, _, _, _, _) :-
    throw(error(Formal, Context)).

%!  leave(+Fact) is det.
%
%   Put a fact in the tuple space of the host.

leave(Fact) :-
    may_leave(Fact, Host, Place, By),
    tuple_leave(Place, Fact, By),
    report_fact(Host, leave(Fact)).

%!  leave_new(+Fact) is semidet.
%
%   As leave/1, but fails if there is a fact that unifies.  Of several agents
%   that do so with one fact, one succeeds.

leave_new(Fact) :-
    may_leave(Fact, Host, Place, By),
    tuple_leave_new(Place, Fact, By),
    report_fact(Host, leave(Fact)).

may_leave(Fact, Host, Place, By) :-
    place(Host, Place),
    context_now(_, Agent),
    parts_call(acts, Host, [Agent, leave(Fact)]),
    mobile_term(Fact),
    amended(tuple, Host, Agent, none, By).

%!  sense(?Fact) is nondet.
%
%   Read a fact in the tuple space of the host.

sense(Fact) :-
    place(_, Place),
    tuple_sense(Place, Fact).

%!  take(?Fact) is semidet.
%
%   Remove a fact from the tuple space of the host.  Of several agents that
%   take one fact, one succeeds.

take(Fact) :-
    place(Host, Place),
    tuple_take(Place, Fact),
    report_fact(Host, take(Fact)).

report_fact(Host, What) :-
    context_now(_, Agent),
    event(facts, Host, Agent, What).

place(Host, Place) :-
    context_host(Host),
    host(Host, _, Place).

may_say(Host, Term) :-
    context_now(_, Agent),
    parts_call(acts, Host, [Agent, say(Term)]).

%!  log(+What) is det.
%
%   Send an event to the log server of the host; print it if there is none.

log(What) :-
    context_host(Host),
    context_now(Host, Agent),
    parts_call(acts, Host, [Agent, log(What)]),
    event(said, Host, Agent, log(What)),
    (   logged(Host, Agent, What)
    ->  true
    ;   print_message(informational, typhon(log(Host, Agent, What)))
    ).

%!  enter(+Result) is det.
%
%   Add Result to the trail of this agent, signed by its host: later hosts
%   cannot remove or change it undetected, see agent_trail/2.  They can read
%   it, unless it is sealed, see seal/3.
%
%   @error type_error(mobile_term, Culprit)
%   @error existence_error(keys, here)

enter(Result) :-
    context_host(Host),
    may_say(Host, Result),
    mobile_term(Result),
    context_agent(Id),
    agent(Id, _, Module, _, _),
    (   enters(Module, Id, Result)
    ->  true
    ;   existence_error(keys, here)
    ).

%!  result(+Term) is det.
%
%   The result of this agent is Term, which replaces an earlier one.
%   agent_result/3 returns it when the agent has ended.
%
%   @error type_error(mobile_term, Culprit)
%   @error resource_error(result_bytes)

result(Term) :-
    context(Host, _, Module),
    may_say(Host, Term),
    mobile_term(Term),
    result_put(Module, Term).

%!  message_failed(+From, +Message) is det.
%
%   Print a warning that on_message/2 has failed, at most one in a second, and
%   the number of the others.  The agent goes on.  If the
%   program has a clause for the message, the warning has the location of the
%   goal that failed.

message_failed(From, Message) :-
    context(Host, Id, _),
    may_say(Host, From-Message),
    (   on_demand_call(fault, report,
                       typhon_fault:agent_handled(Id,
                                                  on_message(From, Message),
                                                  Fault))
    ->  Warning = message_undone(Id, From, Message, Fault)
    ;   Warning = message_failed(Id, From, Message)
    ),
    report(warning, messages_not_understood, Id, typhon(Warning)).

                /*******************************
                *            CONTROL           *
                *******************************/

%!  move(+Host) is det.
%!  move(+Host, +Options) is det.
%
%   Move to Host and go on there with the next goal; go on at once if the agent
%   is there already.  Host may be any(Tags), Tags a tag or a list of tags, where
%   an option knows hosts by tags.  Choice points left of move/1 are discarded, as
%   those left of all predicates below.  Option:
%
%     - wait(+Seconds): if Host cannot be reached wait for it, where an option
%       keeps agents for hosts that are away, for Seconds of host time, a number
%       or `inf`; else as move/1
%
%   @error domain_error(move_option, Option)
%   @error move_refused(Host, Reason): capacity, token or unknown_host
%   @error host_unreachable(Host)
%   @error type_error(mobile_term, Culprit)

%!  clone(-Role) is det.
%!  clone(+Host, -Role) is det.
%
%   Clone this agent, here or on Host.  This agent goes on with Role =
%   parent(CloneId), the clone with Role = clone(ParentId).

%!  sleep(+Seconds) is det.
%
%   Go on after Seconds of host time, at once if Seconds is negative, never if it
%   is `inf`.  This is not the sleep/1 of the system: an agent that sleeps
%   occupies no thread.

%!  receive(?Message) is det.
%!  receive(?Message, +Timeout) is semidet.
%
%   Take the oldest message From-Term that unifies with Message, or wait for
%   one, for at most Timeout seconds of host time.  Other messages stay in the
%   mailbox.

%!  dispose is det.
%
%   End this agent.

%   Each control predicate that Prolog does not have raises this error.

term_expansion(misplaced_controls, Clauses) :-
    findall((Head :- misplaced(Name/Arity)),
            ( control_use(Head, called(_)),
              \+ control_of_system(Head),
              functor(Head, Name, Arity) ),
            Clauses).

misplaced_controls.

misplaced(PI) :-
    throw(error(permission_error(call, control_predicate, PI),
                context(PI, 'an agent cannot stop inside a goal that \c
                             Prolog runs to its end'))).
