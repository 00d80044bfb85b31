:- module(typhon_supervision_tree,
          [ supervision_tree/3          % +Places, -Trees, -Silent
          ]).
:- use_module(library(assoc),
              [ assoc_to_keys/2, empty_assoc/1, get_assoc/3, list_to_assoc/2,
                put_assoc/4 ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs),
              [group_pairs_by_key/2, map_list_to_pairs/3, pairs_values/2]).
:- use_module('../options/supervision', [agent_relations/1]).
:- use_module(inventory, [inventory/4, inventory_agents/2, inventory_order/2]).

/** <module> Trees of supervisors, their children and monitored agents

A child of an agent follows it, see monitor/2.  The tree has the children of an
agent, and other agents that it monitors, below it.  Two agents that monitor
each other, such as a supervisor and its standby, would be below each other;
then the agent with more agents below it is at the top.

*Threading*: any thread that may wait.
*/

%   So many agents of each process have a summary; others have only their id.

most(5000).

%!  supervision_tree(+Places, -Trees:list, -Silent:list) is det.
%
%   Trees are terms node(Id, Relation, Glance, Below): Relation is `top`,
%   `child` or `monitored`, Glance is that of agent_summary/2, or `none`, and
%   Below are the nodes below the agent.  Places and Silent are those of
%   inventory/4.  Agents without relations are left out.

supervision_tree(Places, Trees, Silent) :-
    most(Most),
    inventory(Most, Places, Seen, Silent),
    inventory_agents(Seen, Agents),
    agent_relations(Relations),
    forest(Relations, Agents, Trees).

forest(Relations, Agents, Trees) :-
    findall(Id-Glance, member(agent(Id, Glance), Agents), Glances0),
    list_to_assoc(Glances0, Glances),
    below(Relations, Below, Related),
    tops(Below, Related, Tops),
    empty_assoc(None),
    tree_nodes(Tops, top, Below-Glances, None, _, Trees).

%   below(+Relations, -Below, -Related): Below is an assoc from an agent to the
%   pairs Relation-Id of the agents below it.  Related is an assoc of the agents
%   that are below another.

below(Relations, Below, Related) :-
    findall(Relation-true, member(Relation, Relations), Pairs),
    list_to_assoc(Pairs, Known),
    findall(Id-true,
            ( member(follows(Id, Parent), Relations),
              child(Id, Parent, Known) ),
            Children0),
    sort(Children0, Children1),
    list_to_assoc(Children1, Children),
    findall(Parent-(Relation-Id),
            edge(Relations, Known, Children, Parent, Relation, Id),
            Edges0),
    sort(Edges0, Edges),
    group_pairs_by_key(Edges, Groups),
    list_to_assoc(Groups, Below),
    findall(Id-true, member(_-(_-Id), Edges), Related0),
    sort(Related0, Related1),
    list_to_assoc(Related1, Related).

edge(Relations, Known, _, Parent, child, Id) :-
    member(follows(Id, Parent), Relations),
    child(Id, Parent, Known).
edge(Relations, _, Children, Parent, monitored, Id) :-
    member(monitors(Parent, Id), Relations),
    Parent \== Id,
    \+ get_assoc(Id, Children, true).

%   If two agents follow each other, the one that monitors is the parent.

child(Id, Parent, Known) :-
    \+ ( get_assoc(monitors(Id, Parent), Known, true),
         \+ get_assoc(monitors(Parent, Id), Known, true) ).

%   tops(+Below, +Related, -Tops): Tops are the agents with others below them:
%   first those that are below no other, then those with most agents below them.

tops(Below, Related, Tops) :-
    assoc_to_keys(Below, Parents),
    map_list_to_pairs(top_key(Below, Related), Parents, Pairs0),
    keysort(Pairs0, Pairs),
    pairs_values(Pairs, Tops).

top_key(Below, Related, Id, key(Is, Fewer, Order)) :-
    ( get_assoc(Id, Related, true) -> Is = 1 ; Is = 0 ),
    get_assoc(Id, Below, List),
    length(List, Count),
    Fewer is -Count,
    inventory_order(Id, Order).

%   tree_nodes(+Ids, +Relation, +Known, +Placed0, -Placed, -Nodes): Placed are
%   the agents that have a node already, so that each agent gets only one.

tree_nodes([], _, _, Placed, Placed, []).
tree_nodes([Id|Ids], Relation, Known, Placed0, Placed, Nodes) :-
    (   get_assoc(Id, Placed0, true)
    ->  Nodes = Nodes1,
        Placed1 = Placed0
    ;   node(Id, Relation, Known, Placed0, Placed1, Node),
        Nodes = [Node|Nodes1]
    ),
    tree_nodes(Ids, Relation, Known, Placed1, Placed, Nodes1).

node(Id, Relation, Known, Placed0, Placed, node(Id, Relation, Glance, Below)) :-
    Known = Lists-Glances,
    ( get_assoc(Id, Glances, Glance0) -> Glance = Glance0 ; Glance = none ),
    put_assoc(Id, Placed0, true, Placed1),
    (   get_assoc(Id, Lists, List)
    ->  of_relation(child, List, Children),
        of_relation(monitored, List, Others),
        tree_nodes(Children, child, Known, Placed1, Placed2, Below1),
        tree_nodes(Others, monitored, Known, Placed2, Placed, Below2),
        append(Below1, Below2, Below)
    ;   Below = [],
        Placed = Placed1
    ).

of_relation(Relation, List, Ids) :-
    findall(Order-Id,
            ( member(Relation-Id, List), inventory_order(Id, Order) ),
            Pairs0),
    keysort(Pairs0, Pairs),
    pairs_values(Pairs, Ids).
