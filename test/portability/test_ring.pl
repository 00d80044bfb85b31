:- module(test_ring, []).
:- use_module('../lib/common').
:- use_module('../lib/slowness', [patience/2]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists),
              [append/2, append/3, member/2, reverse/2, same_length/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_kill/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire), [random_hex/2]).
:- use_module(library(typhon/kernel/wire), [endpoint_peer/2]).

/** <module> Agents around a ring of processes

The host of this process and those of two others; one of these accepts no
records, so that every round uses both codecs. Each host reads one term of
every kind by itself; agents bring theirs from another host and compare.

TYPHON_RING=/path/one:/path/two may name other Prologs, two or more, the
second one of another word size: then the ring goes through all of them. See
test/portability/run.
*/

                /*******************************
                *            THE RING          *
                *******************************/

:- dynamic
    host/2,                             % Name, Address
    station/3.                          % Pid, In, Out

prologs(Prologs) :-
    getenv('TYPHON_RING', Value),
    !,
    atomic_list_concat(Prologs, :, Value).
prologs([Swipl, Swipl]) :-
    current_prolog_flag(executable, Swipl).

%   The processes share a cookie by their environment: the cookie file of the
%   suite may not exist on their machines.

start_ring :-
    random_hex(16, Cookie),
    setenv('TYPHON_COOKIE', Cookie),
    project_file('test/portability/terms.pl', Terms),
    host_start(alpha, [consult([Terms])]),
    host_property(alpha, address(Alpha)),
    assertz(host(alpha, Alpha)),
    prologs(Prologs),
    append(Stations, _, [[beta], [gamma,text], [delta], [epsilon]]),
    same_length(Prologs, Stations),
    !,
    maplist(start_station, Prologs, Stations),
    link_ring.

link_ring :-
    findall(Address, host(_, Address), [First|Hosts]),
    append(Hosts, [First], Nexts),
    maplist(link, [First|Hosts], Nexts).

start_station(Prolog, [Name|Modes]) :-
    project_file('.', Root),
    process_create(Prolog,
                   [ '-g', station, 'test/portability/station.pl', --, Name
                   | Modes
                   ],
                   [ stdin(pipe(In)), stdout(pipe(Out)), cwd(Root),
                     process(Pid)
                   ]),
    assertz(station(Pid, In, Out)),
    read_line_to_string(Out, Line),
    atom_string(Address, Line),
    assertz(host(Name, Address)).

stop_ring :-
    forall(retract(station(Pid, In, Out)), end_station(Pid, In, Out)),
    (   retract(host(alpha, _))
    ->  host_stop(alpha)
    ;   true
    ),
    retractall(host(_, _)),
    unsetenv('TYPHON_COOKIE').

%   A station ends with its input.

end_station(Pid, In, Out) :-
    close(In, [force(true)]),
    wait_for_end(Pid, 10, Status),
    (   Status == timeout
    ->  process_kill(Pid, kill),
        wait_for_end(Pid, 10, _)
    ;   true
    ),
    close(Out).

                /*******************************
                *            AGENTS            *
                *******************************/

program(Name, File) :-
    format(atom(Relative), 'test/portability/~w.pl', [Name]),
    project_file(Relative, File).

agent(Program, Host, Fact, Agent) :-
    program(Program, File),
    host(Host, Address),
    agent_create(File, Agent, [host(Address), facts([Fact])]).

%   One round, from host to host, that ends where it began.

route(forth, From, Route) :-
    findall(Name, host(Name, _), Names),
    append(Before, [From|After], Names),
    !,
    append([After, Before, [From]], Route).
route(back, From, Route) :-
    route(forth, From, Forth),
    once(append(Names, [From], Forth)),
    reverse([From|Names], Route).

laps(1, Route, Route) :-
    !.
laps(N, Route, Laps) :-
    N1 is N-1,
    laps(N1, Route, More),
    append(Route, More, Laps).

addresses(Names, Addresses) :-
    maplist(host, Names, Addresses).

joined(Agent, Outcome) :-
    patience(60, Seconds),
    agent_join(Agent, Outcome, Seconds).

taken(Host, Fact) :-
    host(Host, Address),
    remote(Address, take(Fact)).

carries(Direction, From, Laps, Outcome) :-
    route(Direction, From, Route),
    laps(Laps, Route, Names),
    addresses(Names, Hosts),
    agent(carrier, From, route(Hosts), Agent),
    joined(Agent, Outcome),
    (   Outcome == done
    ->  taken(From, travelled(Visited)),
        Visited == Hosts
    ;   true
    ).

                /*******************************
                *             TESTS            *
                *******************************/

:- begin_tests(ring_of_prologs, [ setup(start_ring), cleanup(stop_ring) ]).

test(state_and_variables_arrive_unchanged,
     [ forall(( member(Direction, [forth, back]), host(From, _) )),
       Outcome == done ]) :-
    carries(Direction, From, 2, Outcome).

test(codecs, Codecs == [fast, text]) :-
    maplist(codec, [beta, gamma], Codecs).

codec(Name, Codec) :-
    host(Name, Address),
    atomic_list_concat([_, Endpoint], @, Address),
    once(endpoint_peer(Endpoint, codec(Codec))).

test(hop_resumes_at_the_next_goal,
     [ forall(host(From, _)), Notes == Expected ]) :-
    route(forth, From, [B, C|_]),
    addresses([From, B, C], [HostA, HostB, HostC]),
    agent(winder, From, route(HostA, HostB, HostC), Agent),
    joined(Agent, Outcome),
    assertion(Outcome == done),
    taken(From, wound(Notes)),
    wound(HostA, HostB, HostC, Expected).

%   The steps of test/portability/winder.pl.

wound(A, B, C, Notes) :-
    I is -(2**70),
    Notes = [ B-condition, B-then, C-branch, A-failing, A-otherwise,
              B-soft(2), B-after(2), A-caught("caught", -0.0, I),
              A-uncaught, A-native, C-ignored, A-wound, B-bound_goal,
              C-later, A-7, B-6, C-5, A-4, B-3, C-2, A-1
            ].

test(messages_and_goals_are_visible_from_outside) :-
    route(forth, alpha, Route),
    addresses(Route, Hosts),
    agent(patient, alpha, route(Hosts), Agent),
    findall(Name-Term, here(term(Name, Term)), Pairs),
    forall(append(_, [Host|Rest], Hosts),
           station_of_patient(Agent, Host, Rest, Pairs)),
    joined(Agent, Outcome),
    assertion(Outcome == done).

station_of_patient(Agent, Host, Rest, Pairs) :-
    wait_until(( agent_property(Agent, host(Host)),
                 agent_property(Agent, state(waiting))
               ), 20),
    agent_property(Agent, goals(Goals)),
    assertion(Goals = [receive(_-Got), compare(Got), stations(Rest),
                       wait_with(_)]),
    Goals = [_, _, _, wait_with(Carried)],
    assertion(Carried =@= Pairs),
    agent_send(Agent, Pairs),
    wait_until(remote(Host, take(intact)), 20).

here(Goal) :-
    host(alpha, Address),
    remote(Address, findall(Goal, Goal, Goals)),
    member(Goal, Goals).

test(bindings_are_returned, [ forall(host(_, Address)) ]) :-
    remote(Address, findall(N-T, term(N, T), Pairs)),
    forall(member(N-T, Pairs),
           assertion(here(same(N, T)))).

test(many_agents, Outcomes == Done) :-
    findall(Agent,
            ( between(1, 4, _),
              host(From, _),
              route(forth, From, Route),
              laps(3, Route, Names),
              addresses(Names, Hosts),
              agent(carrier, From, route(Hosts), Agent)
            ),
            Agents),
    maplist(joined, Agents, Outcomes),
    findall(done, member(_, Agents), Done).

test(no_agent_remains) :-
    forall(host(_, Address),
           wait_until(remote(Address, host_load(0)), 5)).

:- end_tests(ring_of_prologs).
