:- module(typhon_tracing,
          [ agent_trace/2,              % +Agent, +What
            agent_notrace/1,            % +Agent
            goal_shown/3                % +Id, +Goal, -Shown
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error),
              [domain_error/2, existence_error/2, must_be/2]).
:- use_module('../program', [code_names/2, code_program/2, goal_named/4]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_reply/2, endpoint_request/4]).
:- use_module('../host', [host/3]).
:- use_module('../agent', [agent/5, trace_kind/1]).
:- use_module(order_client, [order_give/3]).

/** <module> Agents of which people want to hear

The tracers of an agent are a part of its life, see typhon_traces, so they
follow it wherever it goes.  Events are sent to the process that asked,
and printed there.

*Threading*: any thread asks; events are printed in the thread that they come
in.
*/

:- multifile
    typhon_endpoint:requested/4,
    typhon_events:told/4.

%!  agent_trace(+Agent, +What) is det.
%!  agent_notrace(+Agent) is det.
%
%   Print what happens to Agent from now on, wherever it is and goes, and
%   write it in the log of the host where it happens, if that has one.  What
%   is a list out of `hops`, `messages`, `facts`, which is what it leaves in
%   and takes from the tuple spaces of hosts, and `goals`, which are those
%   that the machine comes to, not those within what Prolog runs to its end
%   by itself.  Clones are traced, too.
%
%   agent_notrace/1 ends this, and lets an agent go on that is held, see
%   agent_step/1.
%
%   @error existence_error(agent, Agent)
%   @error domain_error(trace_kind, Kind)

agent_trace(Agent, What) :-
    must_be(list, What),
    maplist(must_be_kind, What),
    me(To),
    order_give(Agent, watched(trace(To, What)), _).

must_be_kind(Kind) :-
    must_be(atom, Kind),
    (   trace_kind(Kind)
    ->  true
    ;   domain_error(trace_kind, Kind)
    ).

agent_notrace(Agent) :-
    me(To),
    order_give(Agent, watched(none(To)), _).

me(To) :-
    (   endpoint_address(To)
    ->  true
    ;   existence_error(endpoint, running)
    ).

                /*******************************
                *             TELL             *
                *******************************/

typhon_events:told(trace(To), Host, Agent, What0) :-
    host(Host, Address, _),
    ( What0 = goal(Goal) -> goal_shown(Agent, Goal, Shown), What = goal(Shown)
    ; What = What0
    ),
    (   endpoint_address(To)
    ->  show(Address, Agent, What)
    ;   endpoint_request(To, trace, traced(Address, Agent, What), heard)
    ).

%!  goal_shown(+Id, +Goal, -Shown) is det.
%
%   Shown is Goal with '$VAR'(Name) in place of variables, as far as it is known
%   from which clause of the program of Id it comes.

goal_shown(Id, Goal, Shown) :-
    agent(Id, _, _, Hash, _),
    code_program(Hash, program(_, _, _, Clauses)),
    !,
    code_names(Hash, Lists),
    goal_named(Clauses, Lists, Goal, Shown).
goal_shown(_, Goal, Goal).

%   Whose people do not listen any more need not be told.

heard(_).

typhon_endpoint:requested(trace, traced(Host, Agent, What), _, ReplyTo) :-
    show(Host, Agent, What),
    endpoint_reply(ReplyTo, ok).

show(Host, Agent, What) :-
    print_message(help, typhon(traced(Agent, Host, What))).
