:- module(typhon_program_words,
          [ create/3,                   % +Program, -Agent, +Options
            attach/1,                   % +Payload
            detach/1,                   % +Name
            deliver/1,                  % +Name
            undeliver/1                 % +Name
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [must_be/2, permission_error/3]).
:- use_module(library(option), [option/3]).
:- use_module('../base/on_demand', [on_demand_call/3]).
:- use_module('../program',
              [payload_load/2, payload_python/3, path_below/1, vocabulary/1]).
:- use_module('../host',
              [ context/3, context_agent/1, context_host/1, host/3,
                parts_call/3, place_deliver/3, place_undeliver/2 ]).
:- use_module('../agent', [agent_variant/2]).
:- use_module('../lifecycle', [agent_create_by/4]).

/** <module> The vocabulary of agents: creating agents, and payloads

*Threading*: the thread that runs the agent; create/3 waits for the answer of
another process.
*/

:- vocabulary(typhon_program_words).

:- multifile
    python_delivered/3,         % Host, Name, Source: a payload, where allowed
    python_undelivered/2.       % Host, Name

%!  create(+Program, -Agent, +Options) is det.
%
%   As agent_create/3.  The new agent begins on this host unless host(Host)
%   names another, and has the owner of this agent.  Program may also be
%   `self`, the program of this agent, with the state facts(Clauses).  Where
%   programs are checked Program is `self`, clauses(Terms) or agents(Path),
%   payloads are clauses or payloads(Path), and a new agent counts as a clone.
%
%   @error as agent_create/3

create(Program, Agent, Options) :-
    context(Host, Id, Module),
    parts_call(acts, Host, [Id, say(Program-Options)]),
    parts_call(acts, Host, [Id, clone]),
    (   agent_variant(Module, _),
        \+ ( may_name(Program), may_attach(Options) )
    ->  permission_error(call, sandboxed, create(Program, Agent, Options))
    ;   agent_create_by(Id, Program, Agent, Options)
    ).

%   may_name(+Program) is semidet: Program is no file outside of agents/.

may_name(Program) :-
    nonvar(Program),
    names(Program).

names(self).
names(clauses(_)).
names(agents(Path)) :- path_below(Path).

%   may_attach(+Options) is semidet: payloads are no files outside of payloads/.

may_attach(Options) :-
    is_list(Options),
    option(payloads(Specs), Options, []),
    is_list(Specs),
    maplist(nonvar, Specs),
    maplist(attaches, Specs).

attaches(payload(_, _, _)).
attaches(clauses(_)).
attaches(payloads(Path)) :- path_below(Path).

                /*******************************
                *           PAYLOADS           *
                *******************************/

%!  attach(+Payload) is det.
%
%   Add the clauses of a payload file to this agent.  Where programs are checked
%   Payload is payloads(Path).
%
%   @error permission_error(attach, procedure, PI)

attach(Spec) :-
    context(Host, Id, Module),
    (   agent_variant(Module, _),
        \+ ( nonvar(Spec), Spec = payloads(Path), path_below(Path) )
    ->  permission_error(call, sandboxed, attach(Spec))
    ;   true
    ),
    payload_load(Spec, Payload),
    parts_call(acts, Host, [Id, attach]),
    by_payloads(agent_attach(Id, Payload)).

%!  detach(+Name) is det.
%
%   Remove the clauses of the payload Name from this agent.
%
%   @error existence_error(payload, Name)

detach(Name) :-
    must_be(atom, Name),
    context_agent(Id),
    by_payloads(agent_detach(Id, Name)).

by_payloads(Goal) :-
    on_demand_call(payload, any, typhon_payloads:Goal).

%!  deliver(+Name) is det.
%
%   Install an attached payload in the place of the host, where all agents and
%   services can call it.
%
%   @error existence_error(payload, Name)
%   @error permission_error(deliver, procedure, PI)
%   @error permission_error(deliver, python, Name) if the payload is Python,
%          and the host was not started with python(true)

deliver(Name) :-
    must_be(atom, Name),
    context_agent(Id),
    by_payloads(agent_payload(Id, Name, Payload)),
    context_host(Host),
    (   payload_python(Payload, Name, Source)
    ->  deliver_python(Host, Name, Source)
    ;   host(Host, _, Place),
        place_deliver(Place, Payload, _)
    ).

deliver_python(Host, Name, Source) :-
    (   python_delivered(Host, Name, Source)
    ->  true
    ;   permission_error(deliver, python, Name)
    ).

%!  undeliver(+Name) is det.
%
%   Remove a delivered payload from the place of the host.
%
%   @error existence_error(payload, Name)

undeliver(Name) :-
    must_be(atom, Name),
    context_host(Host),
    host(Host, _, Place),
    place_undeliver(Place, Name),
    ignore(python_undelivered(Host, Name)).
