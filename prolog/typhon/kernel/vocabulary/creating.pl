:- module(typhon_creating,
          [ create/3                    % +Program, -Agent, +Options
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(option), [option/3]).
:- use_module('../program', [path_below/1, vocabulary/1]).
:- use_module('../host', [context/3, parts_call/3]).
:- use_module('../agent', [agent_variant/2]).
:- use_module('../lifecycle', [agent_create_by/4]).

/** <module> The predicate by which an agent creates another

*Threading*: the thread that runs the agent; waits for the answer of another
process.
*/

:- vocabulary(typhon_creating).

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
