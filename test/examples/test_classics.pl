:- module(test_classics, []).

% The ten classical programs of doc/classics.md give the same results as
% solutions without agents, on other networks than those of the document.

:- use_module('../lib/common').
:- use_module('../lib/networks').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists),
              [ last/2, member/2, nth1/3, numlist/3, permutation/2,
                sum_list/2 ]).
:- use_module(library(plunit)).
:- use_module(library(random), [random_permutation/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(solution_sequences), [distinct/2]).
:- use_module(library(typhon)).
:- use_module('../lib/fixtures', [capturing/2]).

program(Name, File) :-
    atom_concat('examples/classics/', Name, Relative),
    project_file(Relative, File).

%   on(+Topology, +Options, -Hosts, :Goal, -Logged): in a network without a log
%   file: Logged are the printed entries.

:- meta_predicate on(+, +, -, 0, -), virtually(+, -, 0, -).

on(Topology, Options, Hosts, Goal, Logged) :-
    no_leaks(capturing(with_network(Topology, [seed(1)|Options], _, Hosts,
                                    Goal), Messages)),
    logged(Messages, Logged).

logged(Messages, Logged) :-
    findall(What, member(informational-typhon(log(_, _, What)), Messages),
            Logged).

virtually(Topology, Hosts, Goal, Logged) :-
    on(Topology, [clock(virtual), hop_time(uniform(1, 3))], Hosts, Goal,
       Logged).

create(Name, Host, Options, Agent) :-
    program(Name, Program),
    agent_create(Program, Agent, [host(Host)|Options]).

ends(Agent) :-
    agent_join(Agent, Outcome, 10_000),
    assertion(Outcome == done).

%   The agent runs to its end on the first of Hosts.

run(Name, Facts, [Host|_]) :-
    create(Name, Host, [facts(Facts)], Agent),
    ends(Agent).

                /*******************************
                *        WHAT THEY DO          *
                *******************************/

%   gives(+Name, +Facts, -Result, +Hosts): Result of an agent on the first of
%   Hosts.

gives(Name, Facts, Result, [Host|_]) :-
    create(Name, Host, [facts(Facts)], Agent),
    agent_result(Agent, Result, 10_000).

put_number(Host, N) :-
    remote(Host, leave(number(N))).

word(agent, who).
word(hop, what).
word(place, where).

asked(Host, Word, Expected) :-
    create(dictionary, Host, [name(later)], Dictionary),
    agent_create(clauses([ (:- agent(reader, [])),
                           (main :-
                                send(Dictionary, look_up(Word)),
                                receive(Dictionary-Answer),
                                Answer == Expected) ]),
                 Reader, [host(Host)]),
    ends(Reader),
    agent_dispose(Dictionary).

%   The time in which all agents and messages in flight arrive.

pass(Host, Seconds) :-
    agent_create(clauses([(:- agent(clock, [])), (main :- sleep(Seconds))]),
                 Clock, [host(Host)]),
    ends(Clock).

plays(Players, Logged) :-
    no_leaks(capturing(play(Players), Messages)),
    logged(Messages, Logged).

play(Players) :-
    host_start(hall, [clock(virtual)]),
    forall(member(Host-Player, Players), seat(Host, Player)),
    run(game, [], [hall]),
    forall(member(Host-_, [hall-none|Players]), host_stop(Host)).

seat(Host, Player) :-
    program(Player, Place),
    atom_concat(Place, '.pl', File),
    host_start(Host, [clock(virtual), consult(File)]),
    link(hall, Host).

%   The shortest way to come through all Places and back to the first.

shortest([First|Places], Km) :-
    aggregate_all(min(Length),
                  ( permutation(Places, Tour),
                    foldl(leg, Tour, First-0, Last-Km0),
                    leg(First, Last-Km0, _-Length) ),
                  Km).

leg(X/Y, X0/Y0-Km0, X/Y-Km) :-
    Km is Km0+sqrt((X-X0)**2+(Y-Y0)**2).

put_town(Host, Place) :-
    remote(Host, leave(at(Place))).

sorts(Numbers, Hosts) :-
    Hosts = [First|_],
    maplist(sorter(First), Numbers, Agents),
    maplist(ends, Agents),
    maplist(number_there, Hosts, Found),
    msort(Numbers, Sorted),
    assertion(Found == Sorted).

sorter(Host, N, Agent) :-
    create(sorter, Host, [facts([mine(N)])], Agent).

number_there(Host, N) :-
    remote(Host, sense(number(N))).

%   The number of agents that have visited these hosts.

arrivals(Hosts, Sum) :-
    aggregate_all(sum(Count),
                  ( member(Host, Hosts),
                    host_property(Host, hop_time(in, Stats)),
                    arg(1, Stats, Count) ),
                  Sum).

%   The towns of roads.pl, and the shortest paths between all of them.

on_the_roads(Goal) :-
    program('roads.pl', File),
    setup_call_cleanup(
        ( roads:use_module(library(typhon)),
          load_files(roads:File, [silent(true)]),
          roads:roads(Network) ),
        once(Goal),
        network_stop(Network)).

town(Town) :-
    distinct(Town, ( roads:road(Town, _, _) ; roads:road(_, Town, _) )).

finds_shortest(From, To) :-
    finds(From, To, Found),
    aggregate_all(min(Km, Way), way(From, To, [From], Km, Way),
                  min(Least, _)),
    assertion(Found = way(Least, [From|_])).

finds(From, To, Way) :-
    program(map, Map),
    create(pathfinder, From,
           [payloads([Map]), facts([start(From), goal(To)])], Agent),
    agent_result(Agent, Way, 10_000).

way(To, To, Path, 0, Path) :-
    !.
way(From, To, Path, Km, Way) :-
    ( roads:road(From, Next, Road) ; roads:road(Next, From, Road) ),
    \+ memberchk(Next, Path),
    way(Next, To, [Next|Path], Km0, Way),
    Km is Km0+Road.

                /*******************************
                *             TESTS            *
                *******************************/

:- begin_tests(classics).

test(hello_is_logged_on_each_host, Logged == Expected) :-
    findall(hello_from(Host),
            ( member(N, [2, 3, 4]), format(atom(Host), 'n~d@virtual:0', [N]) ),
            Expected),
    virtually(mesh(4), Hosts, run(hello, [], Hosts), Logged).

test(sum_is_that_of_the_numbers, Found == Sum) :-
    numlist(11, 16, Numbers0),
    random_permutation(Numbers0, Numbers),
    sum_list(Numbers, Sum),
    virtually(mesh(7), [Home|Hosts],
        ( maplist(put_number, Hosts, Numbers),
          gives(sum, [], Found, [Home]) ), _).

%   Words defined in one life of the dictionary are found in another.

test(dictionary_keeps_words_on_shelves) :-
    virtually(mesh(5), [Home|Shelves],
        ( create(dictionary, Home, [], First),
          forall(word(Word, Meaning), agent_send(First, define(Word, Meaning))),
          agent_send(First, define(hop, again)),
          pass(Home, 100),
          agent_dispose(First),
          findall(Word-Meaning,
                  ( member(Host, Shelves),
                    remote(Host, findall(W-M, sense(entry(W, M)), Entries)),
                    member(Word-Meaning, Entries) ),
                  Found),
          msort(Found, Sorted),
          assertion(Sorted == [agent-who, hop-again, place-where]),
          asked(Home, hop, means(hop, again)),
          asked(Home, cat, unknown(cat)) ), _).

test(thinker_wins_the_game, nondet) :-
    plays([anna-novice, bert-thinker], [won(o, _)]).

test(first_of_two_novices_wins, nondet) :-
    plays([anna-novice, bert-novice], [won(x, _)]).

test(salesman_finds_the_shortest_tour) :-
    Places = [0/0, 7/1, 3/5, 1/6, 4/2],
    shortest(Places, Km),
    virtually(mesh(5), Hosts,
        ( maplist(put_town, Hosts, Places),
          gives(salesman, [], tour(Found, Tour), Hosts) ), _),
    assertion(abs(Found-Km) < 1e-9),
    assertion(length(Tour, 6)).

%   Every host has the news once, with its distance from the source.

test(flood_reaches_each_host_once) :-
    on(grid(3, 4), [clock(virtual), hop_time(uniform(1, 1))], Hosts,
        ( Hosts = [Home|_],
          run(flood, [news(it)], Hosts),
          pass(Home, 100),
          forall(nth1(N, Hosts, Host),
                 ( remote(Host, findall(Hops, sense(hops(it, Hops)), Found)),
                   Distance is (N-1) // 4 + (N-1) mod 4,
                   assertion(Found == [Distance]) )) ), _).

test(explorer_sees_every_host, Sorted == Hosts) :-
    virtually(random(12, 0.2), Hosts1, gives(explorer, [], Seen, Hosts1), _),
    findall(Host, ( between(1, 12, N),
                    format(atom(Host), 'n~d@virtual:0', [N]) ), Hosts0),
    msort(Hosts0, Hosts),
    msort(Seen, Sorted).

test(explorer_makes_two_hops_for_each_host, true(Hops =:= 2*8)) :-
    virtually(tree(9), Hosts,
        ( run(explorer, [], Hosts),
          arrivals(Hosts, Hops) ), _).

test(tree_has_the_keys_in_order, Logged == [Sorted]) :-
    Keys = [8, 4, 12, 2, 5, 10, 14, 1, 15],
    msort(Keys, Sorted),
    virtually(tree(15), [Root|Hosts],
        ( create(tree, Root, [], Tree),
          forall(member(Key, Keys), agent_send(Tree, insert(Key))),
          agent_create(clauses([ (:- agent(reader, [])),
                                 (main :-
                                      send(Tree, keys),
                                      receive(Tree-keys(Found)),
                                      log(Found),
                                      send(Tree, member(5)),
                                      receive(Tree-found(5, Host)),
                                      move(Host),
                                      sense(key(5)),
                                      send(Tree, member(99)),
                                      receive(Tree-no(99))) ]),
                       Reader, [host(Root)]),
          last(Hosts, Last),
          agent_move(Reader, Last),
          ends(Reader) ), Logged).

test(sorters_sort) :-
    numlist(1, 9, Numbers0),
    random_permutation(Numbers0, Numbers),
    virtually(line(9), Hosts, sorts(Numbers, Hosts), _).

test(sorters_sort_on_sockets) :-
    on(line(4), [processes(2), hosts([concurrency(1)])],
       Hosts, sorts([3, 1, 4, 2], Hosts), _).

test(pathfinder_finds_all_shortest_paths) :-
    no_leaks(on_the_roads(
        forall(( town(From), town(To), From \== To ),
               finds_shortest(From, To)))).

test(pathfinder_checks_only_possibly_shorter_paths, true(Hops =< 4)) :-
    no_leaks(on_the_roads(( finds(harbour, castle, _),
                            findall(Town, town(Town), Towns),
                            arrivals(Towns, Hops) ))).

test(page_shows_the_current_programs, Others == []) :-
    project_file('doc/classics.md', Page),
    read_file_to_string(Page, Text, [encoding(utf8)]),
    project_file('examples/classics/*.pl', Pattern),
    expand_file_name(Pattern, Files),
    findall(File,
            ( member(File, Files),
              read_file_to_string(File, Program, [encoding(utf8)]),
              format(string(Block), "```prolog~n~s```~n", [Program]),
              \+ sub_string(Text, _, _, _, Block) ),
            Others).

:- end_tests(classics).
