:- module(auction_operator,
          [ auction_start/3,            % +Mechanism, +Hosts, +Options
            auction_post/3,             % +Mechanism, +Task, +Host
            auction_open/3,             % +Mechanism, +Hosts, -Tasks
            auction_counts/3,           % +Mechanism, +Hosts, -Counts
            auction_account/2           % +Mechanism, +Hosts
          ]).
:- use_module('../../prolog/typhon',
              [agent_create/3, agent_property/2, agent_send/2, remote/2]).
:- use_module('../../prolog/typhon/kernel/base/options', [check_options/2]).
:- use_module('../../prolog/typhon/kernel/program/paths', []).
:- use_module('../lib/settings', [setting_facts/3]).
:- use_module(tasks, [check_task/1]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(error),
              [existence_error/2, must_be/2, type_error/2]).
:- use_module(library(lists),
              [append/3, max_list/2, member/2, memberchk/2]).
:- use_module(library(option), [option/2]).
:- use_module(library(ordsets), [ord_subtract/3, ord_union/3]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module(library(ugraphs), [neighbours/3, vertices_edges_to_ugraph/3]).

/** <module> Auctions of tasks, for users and programs

Puts on hosts the nodes of a mechanism of thesis section 7.5, `murdoch` or
`anta`, and posts tasks to be auctioned. Robots are those of
allocation_operator, so are tasks, task(Name, Teams, Details). Hosts are
addresses, so these predicates work from any process with the cookie, also if
another process started the hosts.

*Threading*: any thread; no state.
*/

:- multifile
    agent_settings:takes/4,
    typhon_options:declared/4.

%!  auction_start(+Mechanism, +Hosts, +Options) is det.
%
%   Each of Hosts that has none gets a node of Mechanism; nodes know those
%   of Hosts, and send messages to neighbours only. Options:
%
%     - settings(+Pairs)
%       Name-Value, replaces a default of auctions/participant.pl.
%     - diameter(+Links)
%       Diameter of the network; default its current diameter. It
%       is the setting `level`, and with the longest time of a hop it makes
%       the settings `window` and `answer`, host seconds to wait for bids and
%       for answers: a round trip across the network, plus the time to send to
%       all neighbours if nodes send one message after the other, plus slack.
%     - slack(+Seconds)
%       Host seconds that the computer needs to pass on some thousand
%       messages; default half a real second.
%
%   Not for concurrent calls.
%
%   @error type_error(mechanism, X), domain_error(auction_option, Option),
%   domain_error(setting, X)
%   @error existence_error(host, Host), host_unreachable(Host)

auction_start(Mechanism, Hosts, Options) :-
    program(Mechanism, _),
    must_be(list(atom), Hosts),
    check_options(auction_option, Options),
    settings(Hosts, Options, Settings),
    maplist(node_at(Mechanism, Settings), Hosts, Nodes),
    pairs_keys_values(Peers, Hosts, Nodes),
    forall(member(Node, Nodes), agent_send(Node, peers(Peers))).

program(Mechanism, Program) :-
    (   memberchk(Mechanism-Program,
                  [ murdoch-agents(allocation/murdoch),
                    anta-agents(allocation/anta) ])
    ->  true
    ;   type_error(mechanism, Mechanism)
    ).

node_at(Mechanism, _, Host, Node) :-
    remote(Host, sense(node(Mechanism, Node0))),
    !,
    Node = Node0.
node_at(Mechanism, Settings, Host, Node) :-
    program(Mechanism, Program),
    hop_time(Host, Times),
    append(Times, Settings, Facts),
    agent_create(Program, Node,
                 [host(Host), static(true), facts(Facts)]),
    remote(Host, leave(node(Mechanism, Node))).

                /*******************************
                *           SETTINGS           *
                *******************************/

typhon_options:declared(auction_option, settings(X), list, X).
typhon_options:declared(auction_option, diameter(X), positive_integer, X).
typhon_options:declared(auction_option, slack(X), number, X).

agent_settings:takes(auction_start, [agents(allocation/murdoch)], [], refused).

settings(Hosts, Options, Settings) :-
    setting_facts(auction_start, Options, Given),
    edges(Hosts, Edges),
    (   option(diameter(Diameter), Options)
    ->  true
    ;   diameter(Hosts, Edges, Diameter)
    ),
    slack(Hosts, Options, Slack),
    longest_hop(Hosts, Hop),
    in_turn(Given, Hosts, Edges, Turns),
    Window is 2*Diameter*Hop*Turns + Slack,
    findall(setting(Name, Value),
            ( member(Name-Value,
                     [level-Diameter, window-Window, answer-Window]),
              \+ memberchk(setting(Name, _), Given) ),
            More),
    append(Given, More, Settings).

%   in_turn(+Settings, +Hosts, +Edges, -Turns): Turns is the time, in hops,
%   that a node with the mean number of neighbours needs to send to all of
%   them; more than 1 only if nodes send one message after the other.

in_turn(Given, Hosts, Edges, Turns) :-
    (   memberchk(setting(sending, one_by_one(Share)), Given)
    ->  length(Edges, Links),
        length(Hosts, Count),
        Turns is max(1, Share*Links/Count)
    ;   Turns = 1
    ).

slack(_, Options, Slack) :-
    option(slack(Slack), Options),
    !.
slack([Host|_], _, Slack) :-
    host_name(Host, Name),
    remote(Host, typhon_time:clock(Name, _, Rate)),
    !,
    Slack is Rate/2.
slack(_, _, 0.5).

longest_hop(Hosts, Longest) :-
    findall(Max,
            ( member(Host, Hosts),
              hop_time(Host, [setting(_, uniform(_, Max))]) ),
            Times),
    max_list([0|Times], Longest).

hop_time(Host, Times) :-
    host_name(Host, Name),
    (   remote(Host, typhon_hosts:host_option(Name, hop_time(Time)))
    ->  Times = [setting(hop_time, Time)]
    ;   Times = []
    ).

host_name(Host, Name) :-
    (   sub_atom(Host, Before, _, _, @)
    ->  sub_atom(Host, 0, Before, _, Name)
    ;   Name = Host
    ).

%   Edges contains each link twice, once for each of its ends.

edges(Hosts, Edges) :-
    findall(Host-Other,
            ( member(Host, Hosts),
              remote(Host, neighbours(Others)),
              member(Other, Others), memberchk(Other, Hosts) ),
            Edges).

%   Diameter is the greatest distance of two hosts in the same component.

diameter(Hosts, Edges, Diameter) :-
    vertices_edges_to_ugraph(Hosts, Edges, Graph),
    findall(Depth,
            ( member(Host, Hosts), depth([Host], [Host], Graph, 0, Depth) ),
            Depths),
    max_list([1|Depths], Diameter).

%   depth(+Border, +Seen, +Graph, +Depth0, -Depth): breadth first.

depth(Border, Seen, Graph, Depth0, Depth) :-
    foldl(beyond(Graph), Border, [], Next0),
    ord_subtract(Next0, Seen, Next),
    (   Next == []
    ->  Depth = Depth0
    ;   ord_union(Seen, Next, Seen1),
        Depth1 is Depth0 + 1,
        depth(Next, Seen1, Graph, Depth1, Depth)
    ).

beyond(Graph, Host, Next0, Next) :-
    neighbours(Host, Graph, Others),
    ord_union(Next0, Others, Next).

                /*******************************
                *             TASKS            *
                *******************************/

%!  auction_post(+Mechanism, +Task, +Host) is det.
%
%   The node at Host auctions Task until it is completed or its deadline has
%   passed.
%
%   @error type_error(task, Task), existence_error(node, Host),
%   host_unreachable(Host)

auction_post(Mechanism, Task, Host) :-
    program(Mechanism, _),
    check_task(Task),
    node(Mechanism, Host, Node),
    agent_send(Node, post(Task)).

node(Mechanism, Host, Node) :-
    (   remote(Host, sense(node(Mechanism, Node0)))
    ->  Node = Node0
    ;   existence_error(node, Host)
    ).

%!  auction_open(+Mechanism, +Hosts, -Tasks:list) is det.
%
%   Tasks are the names of the tasks that the nodes at Hosts still auction or
%   have executed.
%
%   @error existence_error(node, Host), host_unreachable(Host)

auction_open(Mechanism, Hosts, Tasks) :-
    findall(Name,
            ( member(Host, Hosts),
              node(Mechanism, Host, Node),
              agent_property(Node, facts(Facts)),
              member(job(_, task(Name, _, _), _, _, _, _), Facts) ),
            Tasks).

                /*******************************
                *            COUNTS            *
                *******************************/

%!  auction_counts(+Mechanism, +Hosts, -Counts:list(pair)) is det.
%
%   Counts are Kind-Count, ordered by kind: how many messages of a kind the
%   nodes at Hosts have sent since auction_account/2, each message over one
%   link.  Hosts that have ended are left out.
%
%   @error timeout_error(order, Node): the node runs but does not answer

auction_counts(Mechanism, Hosts, Counts) :-
    findall(Kind-Count, count_at(Mechanism, Hosts, Kind, Count), All),
    findall(Kind, member(Kind-_, All), Kinds0),
    sort(Kinds0, Kinds),
    findall(Kind-Sum,
            ( member(Kind, Kinds),
              aggregate_all(sum(Count), member(Kind-Count, All), Sum) ),
            Counts).

count_at(Mechanism, Hosts, Kind, Count) :-
    member(Host, Hosts),
    catch(( node(Mechanism, Host, Node),
            agent_property(Node, facts(Facts)) ),
          error(Formal, Context),
          ( gone(Formal) -> fail ; throw(error(Formal, Context)) )),
    member(sent(Kind, Count), Facts).

gone(host_unreachable(_)).
gone(existence_error(host, _)).
gone(existence_error(node, _)).

%!  auction_account(+Mechanism, +Hosts) is det.
%
%   The nodes at Hosts log their counts, as communications(Kind, Count), and
%   reset them to 0.  Does not wait for the nodes.
%
%   @error existence_error(node, Host), host_unreachable(Host)

auction_account(Mechanism, Hosts) :-
    forall(member(Host, Hosts),
           ( node(Mechanism, Host, Node), agent_send(Node, account) )).
