:- module(typhon_creating,
          [ create/3                    % +Program, -Agent, +Options
          ]).
:- use_module(library(error), [permission_error/3]).
:- use_module('../program', [vocabulary/1]).
:- use_module('../host', [context/3, parts_call/3]).
:- use_module('../agent', [agent_variant/2]).
:- use_module('../lifecycle', [agent_create_by/4]).

/** <module> What an agent says to create another

*Threading*: the thread that runs the agent; waits for the answer of another
process.
*/

:- vocabulary(typhon_creating).

%!  create(+Program, -Agent, +Options) is det.
%
%   As agent_create/3; the new agent begins on this host unless host(Host) says
%   where, and has the owner of this one.  Program may also be `self`, the
%   program of this agent: its state is then what facts(Clauses) says.  Where
%   programs are checked Program is `self`, clauses(Terms) or agents(Path), and a
%   new agent counts as a clone.
%
%   @error as agent_create/3

create(Program, Agent, Options) :-
    context(Host, Id, Module),
    parts_call(acts, Host, [Id, say(Program-Options)]),
    parts_call(acts, Host, [Id, clone]),
    (   agent_variant(Module, _),
        \+ may_name(Program)
    ->  permission_error(call, sandboxed, create(Program, Agent, Options))
    ;   agent_create_by(Id, Program, Agent, Options)
    ).

%   may_name(+Program) is semidet: no file of this machine, but of agents/.

may_name(Program) :-
    ground(Program),
    Program = agents(Path),
    !,
    format(atom(Below), '~w', [Path]),
    \+ is_absolute_file_name(Below),
    \+ sub_atom(Below, _, _, _, '..').
may_name(Program) :-
    ( Program == self ; subsumes_term(clauses(_), Program) ),
    !.
