:- module(test_tables, []).

% The output of agents/0 and hosts/0 in a process that has started a network,
% or joined one.

:- use_module('../../lib/common').
:- use_module('../../lib/networks').
:- use_module('../../lib/fixtures').
:- use_module(library(apply), [exclude/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(typhon)).

:- meta_predicate table(0, -).

table(Goal, Lines) :-
    with_output_to(string(Text), Goal),
    split_string(Text, "\n", "\n", Lines).

%   shows(+Lines, +Words): a line with just these words, whatever the space.

shows(Lines, Words) :-
    member(Line, Lines),
    split_string(Line, " ", " ", Parts0),
    exclude(==(""), Parts0, Parts),
    Parts == Words,
    !.

matches(Lines, Pattern) :-
    member(Line, Lines),
    wildcard_match(Pattern, Line),
    !.

:- begin_tests(tables).

test(empty_tables, Tables == [["No hosts"], ["No agents"]]) :-
    table(hosts, Hosts),
    table(agents, Agents),
    Tables = [Hosts, Agents].

test(agent_under_way_within_the_process) :-
    with_hosts([ alpha-[clock(virtual), hop_time(uniform(5, 5))],
                 beta-[clock(virtual)] ],
               ( create([(main :- move(beta))], A, [name(goes), host(alpha)]),
                 agent_join(A, timeout, 2),
                 table(agents, Lines) )),
    assertion(shows(Lines, ["goes", "alpha", "test", "in_transit", "to",
                            "beta", "0", "0"])).

test(activity_of_an_agent) :-
    with_hosts([alpha-[clock(virtual)], beta-[clock(virtual)]],
        ( create([(main :- receive(_-go(_)))], W1, [name(waits), host(beta)]),
          create([(main :- sleep(7))], S, [name(sleeps), host(alpha)]),
          create([on_message(_, _)], _, [name(stays), host(alpha)]),
          capturing(( create([(main :- foo(_) is _)], F,
                             [name(errs), host(alpha)]),
                      agent_join(F, _, 0.5) ), _),
          forall(member(A, [W1, W1, S]), agent_send(A, hello)),
          agent_join(S, timeout, 2),
          table(agents, Lines),
          assertion(shows(Lines, ["agent", "host", "program", "state", "hops",
                                  "mail"])),
          assertion(shows(Lines, ["waits", "beta", "test", "waiting", "for",
                                  "_-go(_)", "0", "2"])),
          assertion(shows(Lines, ["sleeps", "alpha", "test", "sleeping,", "5.0",
                                  "s", "left", "0", "1"])),
          assertion(shows(Lines, ["stays", "alpha", "test", "resident", "0",
                                  "0"])),
          assertion(matches(Lines, "errs*faulty: instantiation_error*")) )).
test(columns_are_aligned,
     Lines == [ "agent        host   program  state     hops  mail",
                "a            alpha  test     resident     0     0",
                "long_one     alpha  test     resident     0     0",
                "longer_name  alpha  test     resident     0     0" ]) :-
    with_hosts([alpha-[clock(virtual)]],
               ( forall(member(Name, [long_one, a, longer_name]),
                        create([on_message(_, _)], _,
                               [name(Name), host(alpha)])),
                 table(agents, Lines) )).

test(unique_names_are_shortened) :-
    with_hosts([alpha-[clock(virtual)]],
        ( forall(member(Name, [bob, carl, carl]),
                 create([on_message(_, _)], _, [name(Name)])),
          table(agents, [_|Lines]),
          assertion(matches(Lines, "bob  *alpha *")),
          findall(Line, ( member(Line, Lines),
                          wildcard_match("carl.v.*@alpha@* alpha *", Line) ),
                  Carls),
          assertion(length(Carls, 2)) )).
test(sorted_in_natural_order) :-
    with_network(ring(11), [clock(virtual)], _,
        table(hosts, Lines)),
    findall(Name, ( member(Line, Lines), split_string(Line, "@", "", [Name,_|_]) ),
            Names),
    findall(N, ( between(1, 11, I), format(string(N), "n~d", [I]) ), Expected),
    assertion(Names == Expected).

test(long_list_of_agents_is_shortened) :-
    with_hosts([alpha-[clock(virtual)]],
        ( forall(between(1, 70, I),
                 ( atom_concat(w, I, Name),
                   create([on_message(_, _)], _, [name(Name)]) )),
          table(agents, Lines),
          length(Lines, Length),
          assertion(Length =:= 62),
          assertion(matches(Lines, "... and 10 more")),
          nth1(61, Lines, Last),
          assertion(wildcard_match("w60 *", Last)) )).

%   A process that has only joined the network lists all of it, too. A hanging
%   process delays the list no longer than the setting says, and is named.

test(whole_network) :-
    with_network(ring(3), [processes(3)], Network, [H1,H2,_],
        ( network_property(Network, processes([_, P2, P3])),
          create([on_message(_, _)], A, [host(H2), name(far)]),
          agent_send(A, hello),
          wait_until(sees(agents, "far *n2 *resident *"), 5),
          wait_until(joined_sees(H1), 20),
          with_settings([typhon_inventory:seconds=1],
                        hangs(P2, P3)) )).

%   A process that listens at two ports is one.

test(two_ports) :-
    free_port(P1),
    free_port(P2),
    with_hosts([alpha-[port(P1)], beta-[port(P2)]],
               ( address(alpha, Alpha),
                 two_ports_seen(Alpha, Lines) )),
    assertion(length(Lines, 3)).

two_ports_seen(Alpha, Lines) :-
    address(beta, Beta),
    project_file('prolog/typhon.pl', Typhon),
    format(atom(Goal),
           'use_module(~q), host_start(gamma), link(gamma, ~q), \c
            link(gamma, ~q), hosts, halt', [Typhon, Alpha, Beta]),
    run_swipl(['-f', none, '-g', Goal], [], exit(0), Out, ""),
    split_string(Out, "\n", "\n", [_|Lines]).

sees(Table, Pattern) :-
    table(Table, Lines),
    matches(Lines, Pattern).

joined_sees(H1) :-
    remote(H1, with_output_to(string(Text), call(typhon:hosts))),
    split_string(Text, "\n", "", Lines),
    forall(member(Name, ["n1", "n2", "n3"]),
           ( string_concat(Name, "@* running *", Pattern),
             matches(Lines, Pattern) )).

hangs(P2, P3) :-
    process_kill(P2, stop),
    wait_until(( get_time(T0),
                 table(hosts, Hosts),
                 get_time(T1),
                 matches(Hosts, "n2@* silent*"),
                 matches(Hosts, "n3@* running *") ), 30),
    table(agents, Agents),
    process_kill(P2, cont),
    Seconds is T1-T0,
    assertion(soon(Seconds, 15)),
    assertion(matches(Hosts, "The process at *has not answered within 1 s")),
    assertion(matches(Agents, "*has not answered within 1 s")),
    capturing(( process_kill(P3, kill),
                wait_until(sees(hosts, "n3@* gone*"), 10) ), _),
    assertion(sees(agents, "There is no process at * any more")).

:- end_tests(tables).
