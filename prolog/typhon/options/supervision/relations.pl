:- module(typhon_relations,
          [ relations/2                 % ?Other, -Relations
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module('../../kernel/wire', [endpoint_address/1, endpoint_reply/2]).
:- use_module('../../kernel/host', [scheduler_call/1]).
:- use_module('../../kernel/agent', [agent_home_endpoint/2]).
:- use_module(monitors, [monitor_set/2]).
:- use_module(monitored_agents, [peers_ask/2]).

/** <module> Relations: which agents monitor and follow which

Each process reports the monitors of the agents whose home it is.

*Threading*: any thread that may wait.
*/

:- multifile typhon_endpoint:requested/4.

%   A process reports at most this many relations, to bound its answer.

most(5000).

%!  relations(?Other, -Relations:ordset) is det.
%
%   Relations with Other are those of this process, and of the processes that it
%   knows and that answer: monitors(Agent, Other), and follows(Agent, Other):
%   Agent is disposed of if Other ends otherwise than `done`.

relations(Other, Relations) :-
    endpoint_address(Me),
    relations_here(Other, Here),
    peers_ask(relations(Other), Results),
    findall(Relation,
            ( member(Peer-answer(Some), [Me-answer(Here)|Results]),
              is_list(Some),
              member(Relation, Some),
              is_relation(Relation, Other, Peer) ),
            Relations0),
    sort(Relations0, Relations).

is_relation(Relation, Other, Home) :-
    nonvar(Relation),
    ( Relation = monitors(Id, Other) ; Relation = follows(Id, Other) ),
    atom(Id),
    atom(Other),
    agent_home_endpoint(Id, Home),
    !.

relations_here(Other, Relations) :-
    most(Most),
    findall(Relation, limit(Most, relation(Other, Relation)), Relations).

relation(Other, Relation) :-
    monitor_set(Watcher, Other),
    relation_of(Watcher, Other, Id, Relation),
    agent_home_endpoint(Id, Home),
    endpoint_address(Home).

relation_of(ends(Id), Other, Id, follows(Id, Other)) :-
    !.
relation_of(Id, Other, Id, monitors(Id, Other)) :-
    atom(Id).

typhon_endpoint:requested(monitor, relations(Other), _, ReplyTo) :-
    scheduler_call(typhon_relations:send_relations(Other, ReplyTo)).

:- public send_relations/2.             % goal of a worker

send_relations(Other, ReplyTo) :-
    relations_here(Other, Relations),
    endpoint_reply(ReplyTo, Relations).
