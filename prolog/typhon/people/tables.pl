:- module(typhon_tables,
          [ hosts/0,
            agents/0
          ]).

/** <module> Hosts and agents as tables for people

*Threading*: any thread.  A table is a snapshot: what goes away while it is
made is left out.
*/

:- use_module(library(apply), [foldl/4, maplist/2, maplist/3, maplist/4]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/3]).
:- use_module('../host', [host_property/2]).
:- use_module('../lifecycle', [agent_property/2]).

%   So many lines are still read by a person.

longest_table(60).

                /*******************************
                *             HOSTS            *
                *******************************/

%!  hosts is det.
%
%   Print a table of the hosts of this process: their address, what they
%   do, how many agents they have of how many they admit, how many came in,
%   and their neighbours.

hosts :-
    findall(Host, host_property(Host, state(_)), Hosts0),
    sort(Hosts0, Hosts),
    findall(Row, (member(Host, Hosts), host_row(Host, Row)), Rows),
    print_table([host-left, state-left, agents-right, 'arrived'-right,
                 neighbours-left],
                Rows, host).

host_row(Host, [Address, State, Agents, Arrived, Neighbours]) :-
    findall(Property, host_property(Host, Property), Properties),
    option(address(Address), Properties, Host),
    option(state(State0), Properties, ''),
    plain(State0, State),
    host_agents(Properties, Agents),
    host_arrived(Properties, Arrived),
    host_neighbours(Properties, Neighbours).

host_agents(Properties, Agents) :-
    option(load(Load), Properties, 0),
    option(capacity(Capacity), Properties, inf),
    (   Capacity == inf
    ->  Agents = Load
    ;   format(atom(Agents), '~w of ~w', [Load, Capacity])
    ).

host_arrived(Properties, Count) :-
    (   member(hop_time(in, stats(Count0, _, _, _)), Properties)
    ->  Count = Count0
    ;   Count = 0
    ).

%   Enough of them to recognise the network.

host_neighbours(Properties, Text) :-
    option(neighbours(Neighbours), Properties, []),
    maplist(short_name, Neighbours, Names),
    first_few(6, Names, Shown, More),
    atomic_list_concat(Shown, ' ', Text0),
    (   More =:= 0
    ->  Text = Text0
    ;   format(atom(Text), '~w and ~d more', [Text0, More])
    ).

short_name(Address, Name) :-
    sub_atom(Address, Before, _, _, @),
    !,
    sub_atom(Address, 0, Before, _, Name).
short_name(Name, Name).

                /*******************************
                *            AGENTS            *
                *******************************/

%!  agents is det.
%
%   Print a table of the agents known to this process: id, where it is,
%   what it does and how far it has come.

agents :-
    findall(Agent, agent_property(Agent, state(_)), Agents0),
    sort(Agents0, Agents),
    longest_table(Longest),
    first_few(Longest, Agents, Shown, More),
    findall(Row, (member(Agent, Shown), agent_row(Agent, Row)), Rows),
    print_table([agent-left, host-left, program-left, state-left,
                 hops-right],
                Rows, agent),
    (   More =:= 0
    ->  true
    ;   format('... and ~D more~n', [More])
    ).

agent_row(Agent, [Agent, Host, Program, State, Hops]) :-
    agent_property(Agent, state(State0)),
    !,
    plain(State0, State),
    findall(Property, agent_property(Agent, Property), Properties),
    option(host(Host0), Properties, ''),
    short_name(Host0, Host),
    option(program(Program), Properties, ''),
    option(hops(Hops), Properties, '').

%   An error as a state would fill the line: faulty says it.

plain(State, Text) :-
    compound(State),
    !,
    functor(State, Text, _).
plain(State, State).

                /*******************************
                *             TABLE            *
                *******************************/

print_table(_, [], What) :-
    !,
    format('No ~ws~n', [What]).
print_table(Columns, Rows, _) :-
    findall(Title, member(Title-_, Columns), Titles),
    findall(Side, member(_-Side, Columns), Sides),
    All = [Titles|Rows],
    maplist(maplist(width), All, WidthRows),
    foldl(maplist(wider), WidthRows, [0,0,0,0,0], Widths),
    maplist(print_row(Sides, Widths), All).

width(Cell, Width) :-
    format(string(Text), '~w', [Cell]),
    string_length(Text, Width).

wider(Width, Widest0, Widest) :-
    Widest is max(Width, Widest0).

print_row(Sides, Widths, Cells) :-
    maplist(padded, Sides, Widths, Cells, Padded),
    atomic_list_concat(Padded, '  ', Line0),
    split_string(Line0, "", " ", [Line]),
    format('~s~n', [Line]).

padded(Side, Width, Cell, Padded) :-
    width(Cell, Used),
    Fill is Width-Used,
    (   Side == left
    ->  format(atom(Padded), '~w~*c', [Cell, Fill, 0'\s])
    ;   format(atom(Padded), '~*c~w', [Fill, 0'\s, Cell])
    ).

first_few(N, List, First, More) :-
    length(List, Length),
    (   Length =< N
    ->  First = List,
        More = 0
    ;   length(First, N),
        append(First, _, List),
        More is Length-N
    ).
