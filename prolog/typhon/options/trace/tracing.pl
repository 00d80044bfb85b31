:- module(typhon_tracing,
          [ agent_trace/2,              % +Agent, +What
            agent_notrace/1,            % +Agent
            goal_shown/3,               % +Id, +Goal, -Shown
            held_on/2,                  % +Id, +Held
            traced_goals/1,             % +Life
            traced_stepwise/1,          % +Life
            traced_step/1,              % +Id
            traced_held/1               % +Id
          ]).
:- use_module(library(apply), [exclude/3, maplist/2]).
:- use_module(library(error),
              [domain_error/2, existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../../kernel/base/bounds', [bounded/3]).
:- use_module('../../kernel/program', [code_names/2, code_program/2]).
:- use_module('../../kernel/wire',
              [endpoint_address/1, endpoint_reply/2, endpoint_request/4]).
:- use_module('../../kernel/host', [events_subscribe/3, host/3, schedule/2]).
:- use_module('../../kernel/agent',
              [ agent/5, agent_put/3, agent_put_life/2, agent_status/3, agent_unorder/2,
                life_extras/2, set_extras_of_life/3, with_agent/2 ]).
:- use_module('../../kernel/lifecycle',
              [agent_named/2, order_give/3, question_answered/2]).
:- use_module('../../tools/source_view', [goal_named/4]).

/** <module> Tracers of agents

The tracers of an agent are extras of its life, so they move with it:
trace(To, Kinds), where To is the address of the process that prints events of
Kinds, and `step` if the agent is held before each goal.  The order
watched(Change) changes them, where Change is trace(To, Kinds), `step` or
none(To).

*Threading*: any thread sends orders; the thread in which an event arrives
prints it.  Only the thread that runs the agent, or holds its mutex, changes its
tracers.
*/

:- multifile
    typhon_agents:carries/3,
    typhon_endpoint:requested/4,
    typhon_events:handle_event/4,
    typhon_agents:not_cloned/1,
    typhon_names:known/2,
    typhon_orders:carried_out/3,
    typhon_orders:noted/1.

%!  agent_trace(+Agent, +What) is det.
%!  agent_notrace(+Agent) is det.
%
%   See the interface of the layer, typhon_trace.

agent_trace(Agent, What) :-
    must_be(list, What),
    maplist(must_be_kind, What),
    own_endpoint(To),
    agent_named(Agent, Id),
    expect_events(Id),
    order_give(Id, watched(trace(To, What)), _).

%   Other processes send events of agents that were traced here, only. An agent
%   that is no longer traced may still have events under way.

:- dynamic expected/1.                  % Id

:- setting(traced, positive_integer, 1000,
           "Agents whose traces are printed, the latest").

expect_events(Id) :-
    (   expected(Id)
    ->  true
    ;   bounded(expected(_), typhon_tracing:traced, assertz(expected(Id)))
    ).

must_be_kind(Kind) :-
    must_be(atom, Kind),
    (   trace_kind(Kind)
    ->  true
    ;   domain_error(trace_kind, Kind)
    ).

trace_kind(hops).
trace_kind(messages).
trace_kind(facts).
trace_kind(goals).

typhon_names:known(trace_kind, Kind) :-
    trace_kind(Kind).

agent_notrace(Agent) :-
    own_endpoint(To),
    order_give(Agent, watched(none(To)), _).

own_endpoint(To) :-
    (   endpoint_address(To)
    ->  true
    ;   existence_error(endpoint, running)
    ).

                /*******************************
                *            TRACERS           *
                *******************************/

%   A traced agent has arrived in this process.  Its tracers may come from an
%   untrusted peer, so they are checked.

typhon_agents:carries(trace, Id, trace(To, Kinds0)) :-
    atom(To),
    is_list(Kinds0),
    findall(Kind, ( trace_kind(Kind), memberchk(Kind, Kinds0) ), Kinds),
    events_subscribe([life, bad_ends|Kinds], Id, trace(To)).
typhon_agents:carries(step, _, step).     % checked by typhon_stepping

%   A clone is not stepped: no caller knows its id, so no caller would let it
%   continue.

typhon_agents:not_cloned(Extra) :-
    Extra == step.

%!  traced_goals(+Life) is semidet.
%!  traced_stepwise(+Life) is semidet.
%
%   Goals of an agent with this Life are traced, or the agent is stepped; the
%   agent is stepped.

traced_goals(Life) :-
    life_extras(Life, Extras),
    Extras \== [],
    member(Extra, Extras),
    (   Extra == step
    ;   nonvar(Extra),
        Extra = trace(_, Kinds),
        memberchk(goals, Kinds)
    ),
    !.

traced_stepwise(Life) :-
    life_extras(Life, Extras),
    memberchk(step, Extras).

%!  traced_step(+Id) is det.
%
%   From now on hold Id before each goal.  The calling thread runs Id.

traced_step(Id) :-
    with_agent(Id, change(step, Id)).

typhon_orders:carried_out(watched(Change), Id, ok) :-
    with_agent(Id, change(Change, Id)).

change(Change, Id) :-
    agent(Id, _, _, _, Life0),
    !,
    life_extras(Life0, Extras0),
    changed(Change, Extras0, Extras),
    set_extras_of_life(Extras, Life0, Life),
    agent_put_life(Id, Life),
    release(Extras, Id).

changed(trace(To, Kinds), Extras0, [trace(To, Kinds)|Extras]) :-
    exclude(is_of(To), Extras0, Extras).
changed(step, Extras0, [step|Extras]) :-
    exclude(==(step), Extras0, Extras).
changed(none(To), Extras0, Extras) :-
    exclude(is_of(To), Extras0, Extras1),
    exclude(==(step), Extras1, Extras).

is_of(To, trace(To, _)).

%   A held agent that is no longer stepped continues.

release(Extras, Id) :-
    (   \+ memberchk(step, Extras),
        agent_status(Id, held, Held)
    ->  held_on(Id, Held)
    ;   true
    ).

%!  held_on(+Id, +Held) is det.
%
%   Let Id, which is held, go on from Held.

held_on(Id, Held) :-
    agent_put(Id, resumed, Held),
    agent(Id, Host, _, _, _),
    !,
    schedule(Host, Id).

%!  traced_held(+Id) is det.
%
%   Orders usually wait for an effect of the agent.  If Id is held, its orders
%   to change tracers are carried out now, and requests that have followed Id
%   get the answer `again`.

traced_held(Id) :-
    with_agent(Id, ( agent_status(Id, held, _),
                     take_order(Id, Asker, Answer) )),
    !,
    question_answered(Asker, answer(Answer)),
    traced_held(Id).
traced_held(_).

take_order(Id, Asker, ok) :-
    agent_unorder(Id, asked(watched(Change), Asker)),
    change(Change, Id).
take_order(Id, Asker, again) :-
    agent_unorder(Id, asked(question(_), Asker)).

typhon_orders:noted(Id) :-
    traced_held(Id).

                /*******************************
                *           REPORTS            *
                *******************************/

typhon_events:handle_event(trace(To), Host, Agent, What0) :-
    host(Host, Address, _),
    ( What0 = goal(Goal) -> goal_shown(Agent, Goal, Shown), What = goal(Shown)
    ; What = What0
    ),
    (   endpoint_address(To)
    ->  show(Address, Agent, What)
    ;   endpoint_request(To, trace, traced(Address, Agent, What), ignore_answer)
    ).

%!  goal_shown(+Id, +Goal, -Shown) is det.
%
%   Shown is Goal with '$VAR'(Name) for variables, if the clause of the program
%   of Id from which Goal comes is known.

goal_shown(Id, Goal, Shown) :-
    agent(Id, _, _, Hash, _),
    code_program(Hash, program(_, _, _, Clauses)),
    !,
    code_names(Hash, Lists),
    goal_named(Clauses, Lists, Goal, Shown).
goal_shown(_, Goal, Goal).

%   The answer does not matter: a process that is gone prints no events.

ignore_answer(_).

typhon_endpoint:requested(trace, traced(Host, Agent, What), _, ReplyTo) :-
    (   expected(Agent)
    ->  show(Host, Agent, What)
    ;   true
    ),
    endpoint_reply(ReplyTo, ok).

show(Host, Agent, What) :-
    print_message(help, typhon(traced(Agent, Host, What))).
