:- module(typhon_relations,
          [ relations/1                 % -Relations
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module('../../kernel/wire', [endpoint_address/1, endpoint_reply/2]).
:- use_module('../../kernel/host', [scheduler_call/1]).
:- use_module('../../kernel/agent', [agent_home_endpoint/2]).
:- use_module(monitors, [monitor_set/2]).
:- use_module(watched, [others_ask/2]).

/** <module> Which agents monitor and follow which

For people who look at a network.  Each process reports the monitors of the
agents whose home it is.

*Threading*: any thread that may wait.
*/

:- multifile typhon_endpoint:requested/4.

%   So many of a process are reported.

most(5000).

%!  relations(-Relations:ordset) is det.
%
%   Of the processes that are known here and answer: monitors(Agent, Other), and
%   follows(Agent, Other), which is disposed of if Other ends badly.

relations(Relations) :-
    here(Here),
    others_ask(relations, Results),
    findall(Relation,
            (   member(Relation, Here)
            ;   member(_-answer(There), Results),
                is_list(There),
                member(Relation, There),
                is_relation(Relation)
            ),
            Relations0),
    sort(Relations0, Relations).

is_relation(Relation) :-
    nonvar(Relation),
    ( Relation = monitors(A, B) ; Relation = follows(A, B) ),
    atom(A),
    atom(B),
    !.

here(Relations) :-
    most(Most),
    findall(Relation, limit(Most, relation(Relation)), Relations).

relation(Relation) :-
    monitor_set(Watcher, Other),
    said(Watcher, Other, Relation, Agent),
    agent_home_endpoint(Agent, Home),
    endpoint_address(Home).

said(ends(Id), Other, follows(Id, Other), Id) :-
    !.
said(Id, Other, monitors(Id, Other), Id) :-
    atom(Id).

typhon_endpoint:requested(monitor, relations, _, ReplyTo) :-
    scheduler_call(typhon_relations:told(ReplyTo)).

:- public told/1.                       % goal of a worker

told(ReplyTo) :-
    here(Relations),
    endpoint_reply(ReplyTo, Relations).
