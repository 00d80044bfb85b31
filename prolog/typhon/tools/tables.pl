:- module(typhon_tables,
          [ print_hosts/1,              % +Places
            print_agents/2,             % +Places, +Ids
            print_tree/1,               % +Places
            print_table/3               % +Columns, +Rows, +What
          ]).

/** <module> Tables of hosts, agents and supervision

*Threading*: any thread.  A table is a snapshot: hosts and agents that end while
it is made are left out.
*/

:- use_module(library(apply),
              [foldl/4, maplist/2, maplist/3, maplist/4, maplist/5]).
:- use_module(library(lists), [append/3, member/2, sum_list/2]).
:- use_module(library(pairs),
              [map_list_to_pairs/3, pairs_keys_values/3, pairs_values/2]).
:- use_module(library(settings), [setting/2]).
:- use_module('../kernel/agent', [agent_name/3]).
:- use_module('../kernel/base/text', [format_shown/2, formatted/3]).
:- use_module(event_text, [short_name/2]).
:- use_module(inventory,
              [ inventory/4, inventory_agents/2, inventory_hosts/4,
                inventory_order/2 ]).
:- autoload(supervision_tree, [supervision_tree/3]).

%   A longer table would not be readable.

longest_table(60).

%!  print_hosts(+Places) is det.
%
%   As hosts/0, but also for the processes at the addresses Places.

print_hosts(Places) :-
    inventory(0, Places, Seen, Silent),
    inventory_hosts(Places, Seen, Silent, All),
    in_order(All, Sorted),
    longest_table(Longest),
    first_few(Longest, Sorted, Shown, More),
    maplist(host_row, Shown, Rows),
    print_table([host-left, state-left, agents-right, arrived-right,
                 neighbours-left],
                Rows, host),
    print_more(More),
    print_silent(Silent).

host_row(host(Address, State, Load, Capacity, Arrived, Neighbours, _, _),
         [Address, State, Agents, Arrived, Text]) :-
    host_agents(Capacity, Load, Agents),
    host_neighbours(Neighbours, Text).

host_agents(Capacity, Load, Agents) :-
    integer(Capacity),
    !,
    format(atom(Agents), '~w of ~w', [Load, Capacity]).
host_agents(_, Load, Load).

%   Some neighbours are enough to recognise the network.

host_neighbours(Neighbours, Text) :-
    maplist(short_name, Neighbours, Names),
    first_few(6, Names, Shown, More),
    atomic_list_concat(Shown, ' ', Text0),
    (   More =:= 0
    ->  Text = Text0
    ;   format(atom(Text), '~w and ~d more', [Text0, More])
    ).

                /*******************************
                *            AGENTS            *
                *******************************/

%!  print_agents(+Places, +Ids) is det.
%
%   As agents/0, but also for the processes at the addresses Places.  Ids is
%   `full` for ids, or `short` for names where they are unique.

print_agents(Places, Ids) :-
    longest_table(Longest),
    Most is Longest+1,          % tells whether the last name is unique
    inventory(Most, Places, Seen, Silent),
    agents_seen(Seen, Agents, Count),
    first_few(Longest, Agents, Shown, _),
    maplist(agent_row(Ids, Agents), Shown, Rows),
    print_table([agent-left, host-left, program-left, state-left,
                 hops-right, mail-right],
                Rows, agent),
    length(Rows, Printed),
    More is Count-Printed,
    print_more(More),
    print_silent(Silent).

%   agents_seen(+Seen, -Agents, -Count): Agents are the first of Count agents,
%   in order.

agents_seen(Seen, Agents, Count) :-
    inventory_agents(Seen, Different),
    in_order(Different, Agents),
    findall(N, member(seen(_, _, N), Seen), Counts),
    findall(Id, ( member(seen(_, Some, _), Seen), member(Id, Some) ), All),
    sum_list(Counts, Total),
    length(All, Sent),
    length(Different, Left),
    Count is Total-(Sent-Left).

agent_row(Ids, All, agent(Id, glance(Address, Program, Doing, Hops, Mail)),
          [Name, Host, Program, Doing, Hops, Mail]) :-
    shown_id(Ids, All, Id, Name),
    short_name(Address, Host).

shown_id(short, All, Id, Name) :-
    agent_name(Id, Name, _),
    \+ ( member(agent(Other, _), All),
         Other \== Id,
         agent_name(Other, Name, _) ),
    !.
shown_id(_, _, Id, Id).

%!  print_tree(+Places) is det.
%
%   Print the agents that monitor others, with the agents below them indented,
%   also for the processes at the addresses Places.

print_tree(Places) :-
    supervision_tree(Places, Trees, Silent),
    findall(Row, ( member(Tree, Trees), tree_row(Tree, 0, Row) ), Rows),
    print_table([agent-left, is-left, host-left, program-left, state-left],
                Rows, 'agent that monitors other'),
    print_silent(Silent).

tree_row(node(Id, Relation, Glance, _), Depth, [Name,Is,Host,Program,Doing]) :-
    Indent is 2*Depth,
    format(atom(Name), '~*c~w', [Indent, 0'\s, Id]),
    ( Relation == top -> Is = '' ; Is = Relation ),
    (   Glance = glance(Address, Program, Doing, _, _)
    ->  short_name(Address, Host)
    ;   Host = '', Program = '', Doing = ''
    ).
tree_row(node(_, _, _, Below), Depth0, Row) :-
    Depth is Depth0+1,
    member(Node, Below),
    tree_row(Node, Depth, Row).

                /*******************************
                *             TABLE            *
                *******************************/

in_order(Rows, Sorted) :-
    map_list_to_pairs(row_key, Rows, Pairs),
    keysort(Pairs, SortedPairs),
    pairs_values(SortedPairs, Sorted).

row_key(Row, Key) :-
    arg(1, Row, Name),
    inventory_order(Name, Key).

print_more(More) :-
    (   More > 0
    ->  format('... and ~D more~n', [More])
    ;   true
    ).

print_silent(Silent) :-
    forall(member(Endpoint-Why, Silent), print_silence(Why, Endpoint)).

print_silence(gone, Endpoint) :-
    format_shown('There is no process at ~w any more~n', [Endpoint]).
print_silence(lost, Endpoint) :-
    format_shown('The connection to ~w was lost~n', [Endpoint]).
print_silence(late, Endpoint) :-
    setting(typhon_inventory:seconds, Seconds),
    format_shown('The process at ~w has not answered within ~w s~n',
                 [Endpoint, Seconds]).

%!  print_table(+Columns, +Rows, +What) is det.
%
%   Columns are pairs of a title and a side, `left` or `right`; without Rows a
%   line says that there is no What.

print_table(_, [], What) :-
    !,
    format('No ~ws~n', [What]).
print_table(Columns, Rows, _) :-
    pairs_keys_values(Columns, Titles, Sides),
    maplist(maplist(cell_text), [Titles|Rows], All),
    maplist(maplist(string_length), All, [First|WidthRows]),
    foldl(maplist(wider), WidthRows, First, Widths),
    maplist(print_row(Sides, Widths), All).

cell_text(Cell, Text) :-
    formatted('~w', [Cell], Text).

wider(Width, Widest0, Widest) :-
    Widest is max(Width, Widest0).

print_row(Sides, Widths, Cells) :-
    maplist(padded, Sides, Widths, Cells, Padded),
    atomic_list_concat(Padded, '  ', Line),
    without_trailing_blanks(Line, Text),
    format('~s~n', [Text]).

padded(left, Width, Cell, Padded) :-
    format(string(Padded), '~w~t~*|', [Cell, Width]).
padded(right, Width, Cell, Padded) :-
    format(string(Padded), '~t~w~*|', [Cell, Width]).

%   Leading blanks are kept, since they show the depth in a tree.

without_trailing_blanks(Line, Text) :-
    string_concat(x, Line, Marked),
    split_string(Marked, "", " ", [Stripped]),
    sub_string(Stripped, 1, _, 0, Text).

first_few(N, List, First, More) :-
    length(List, Length),
    (   Length =< N
    ->  First = List,
        More = 0
    ;   length(First, N),
        append(First, _, List),
        More is Length-N
    ).
