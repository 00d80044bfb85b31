:- module(test_looking, []).

% Inspecting agents: listing, tracing, stepping and spying, as at the top
% level.

:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures', [with_hosts/2]).
:- use_module('../../../lib/networks').
:- use_module('../../../lib/texts').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, last/2, member/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(yall)).
:- use_module(library(typhon)).
:- use_module(library(typhon/tools/source_view/variable_names),
              [goals_places/3]).

%   two(:Goal): with hosts alpha and beta, in virtual time.

:- meta_predicate two(0), prints(0, -), in_network(1).

two(Goal) :-
    with_hosts([alpha-[clock(virtual)], beta-[clock(virtual)]], Goal).

in_network(Goal) :-
    with_network(edges([1-2]), [processes(2)], _, [Here, There],
                 call(Goal, Here-There)).

%   In virtual time others run while a caller waits.

later :-
    agent_create(clauses([ (:- agent(waiter, [])), (main :- sleep(1)) ]), A),
    agent_join(A, done, 10).

%   prints(:Goal, -Said): the messages that are printed meanwhile, in order.

:- dynamic said/1.
:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

prints(Goal, Said) :-
    retractall(said(_)),
    setup_call_cleanup(
        asserta((user:message_hook(typhon(M), _, _) :- test_looking:note(M)),
                Ref),
        Goal,
        erase(Ref)),
    findall(S, retract(said(S)), Said).

note(traced(_, Host, What)) :-
    atomic_list_concat([Name|_], @, Host),
    assertz(said(Name-What)).
note(stepped(_, What)) :-
    assertz(said(What)).
note(spied(_, _, Goal)) :-
    assertz(said(spied(Goal))).
note(told(_, Message)) :-
    assertz(said(Message)).
note(spy(_, _, _)).
note(nospy(_, _, _)).
note(spied_none(_, PI, Meant)) :-
    assertz(said(none(PI, Meant))).

traveller(
    [ (:- agent(traveller, [state([seen/1])])),
      (main :- receive(_-go(Host)), tour(Host), send(user, home)),
      (tour(Host) :-
           move(Host), digit(X), X > 1, assertz(seen(X)),
           ( sleeps -> true ; home(Home), move(Home) )),
      digit(1), digit(2),
      (sleeps :- sleep(5), fail)
    ]).

traveller_on(Host, Agent) :-
    traveller(Program),
    agent_create(clauses(Program), Agent, [host(Host)]).

%   goes(-Goal, -Program): does Goal when it gets a message.

goes(Goal, [(:- agent(a, [])), (main :- receive(_), Goal)]).

goals(Said, Goals) :-
    findall(Goal, member(held(_, Goal), Said), Goals).

with_named_program(File, Goal) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'tourist.pl', File),
          write_file(File, ":- agent(tourist, []).~n~n\c
                            main :- receive(_-go(Hosts)), tour(Hosts),~n\c
                                    home(Home), move(Home).~n~n\c
                            tour([]).~n\c
                            tour([Host|Hosts]) :- move(Host), tour(Hosts).~n",
                     []),
          once(Goal) )).

:- meta_predicate with_named_program(-, 0).

:- begin_tests(listing).

listing_of(Agent, Text) :-
    with_output_to(string(Text), agent_listing(Agent)).

shows(Text, Part) :-
    sub_string(Text, _, _, _, Part),
    !.

marked(Text, Line) :-
    split_string(Text, "\n", "", Lines),
    member(Marked, Lines),
    string_concat("=>  ", Line, Marked).

test(listing_marks_the_waiting_goal) :-
    two(( traveller_on(alpha, A),
          later,
          listing_of(A, Text) )),
    shows(Text, ":- agent(traveller, [state([seen/1])])."),
    findall(L, marked(Text, L), ["receive(_-go(A)),"]),
    shows(Text, "% goals left\n:- receive(_-go(A)),\n   tour(A),"),
    \+ shows(Text, "% facts").

test(goal_in_a_condition) :-
    two(( traveller_on(alpha, A),
          prints(( agent_step(A), agent_send(A, go(beta)) ), _),
          agent_notrace(A),
          later,
          listing_of(A, Text) )),
    findall(L, marked(Text, L), ["sleep(5),"]),
    shows(Text, "% facts\n\nseen(2).").

test(agent_in_another_process) :-
    in_network(elsewhere(Text)),
    shows(Text, "on n2@"),
    shows(Text, "main :-\n=>  receive(_).").

elsewhere(Text, _-Host) :-
    goes(true, Program),
    agent_create(clauses(Program), A, [host(Host)]),
    waits(A),
    listing_of(A, Text).

%   A program that was read from a file has names of variables.

test(names_of_variables) :-
    two(named_on(alpha, rests, Text)),
    forall(named_part(Part), assertion(shows(Text, Part))).
test(names_of_variables_in_another_process) :-
    in_network(named_elsewhere(Text)),
    forall(named_part(Part), assertion(shows(Text, Part))).

named_part("=>  receive(_-go(Hosts)),\n    tour(Hosts),\n    home(Home),").
named_part("tour([Host|Hosts]) :-\n    move(Host),\n    tour(Hosts).").
named_part("% goals left\n:- receive(_-go(Hosts)),\n   tour(Hosts),\n\c
           \u0020  home(Home),\n   move(Home).").

named_elsewhere(Text, _-Host) :-
    named_on(Host, waits, Text).

rests(_) :-
    later.

waits(Agent) :-
    wait_until(agent_property(Agent, state(waiting)), 5).

:- meta_predicate named_on(+, 1, -).

named_on(Host, Waits, Text) :-
    with_named_program(File,
                       ( agent_create(File, A, [host(Host)]),
                         call(Waits, A),
                         listing_of(A, Text) )).

test(names_of_variables_of_a_caller) :-
    two(with_named_program(File,
            ( agent_create(File, A, [host(alpha)]),
              prints(( agent_step(A), agent_send(A, go([beta])),
                       agent_step(A), agent_step(A), agent_step(A) ), _),
              later,
              listing_of(A, Text) ))),
    assertion(shows(Text, "% goals left\n:- move(beta),\n   tour([]),\n\c
                           \u0020  home(Home),\n   move(Home).")).
test(names_of_variables_of_a_goal_that_is_next,
     Goal = receive(_-go('$VAR'('Hosts')))) :-
    two(with_named_program(File,
            ( agent_create(File, A, [host(alpha)]),
              prints(( agent_step(A), agent_step(A) ), Said),
              agent_notrace(A) ))),
    last(Said, held(_, Goal)).

test(no_such_agent, error(existence_error(agent, 'a.v.99@alpha@virtual:0'))) :-
    two(agent_listing('a.v.99@alpha@virtual:0')).

clauses([ (a :- b, move(x), c, d),
          (e :- c, d),
          (f :- ( g, sleep(1), h -> c ; d ), i),
          (k :- catch(( sleep(1), l ), _, m)),
          (n :- move(y)),
          (o :- p, move(z)) ]).

%   stands(-Goals, -Places): the goals that are left, and the calls in the
%   clauses where an agent may be that has them.

stands([_, c, d, rest], [1-2]).
stands([c, d, rest], [1-3, 2-1]).
stands([( sleep_until(3.0), h -> c ; d ), i], [3-1]).
stands([( c, d, h -> c ; d ), i], [1-3, 2-1]).
stands([( z, h -> c ; d ), i], [3-1]).
stands([catch(( sleep_until(3.0), l ), _, m)], [4-1]).
stands([x, y], []).
stands([], []).

test(goals_have_places, [forall(stands(Goals, Places)), true(Ps == Places)]) :-
    clauses(Clauses),
    goals_places(Clauses, Goals, Ps).
test(last_goal, Places == [5-1, 6-2]) :-
    clauses(Clauses),
    goals_places(Clauses, [_], Places0),
    findall(N-I, ( member(N-I, Places0), memberchk(N, [5, 6]) ), Places).

:- end_tests(listing).

:- begin_tests(tracing).

%   traced(-Name, -Program, -Kinds, -Said): what is printed of an agent.

traced(hops_and_messages, Program, [hops, messages],
       [ alpha-received(user, go(beta)), alpha-left(Beta),
         beta-arrived(Alpha, _), beta-left(Alpha), alpha-arrived(Beta, _),
         alpha-sent(user, home), home, alpha-ended(done) ]) :-
    traveller(Program).
traced(clones, Program, [hops],
       [ alpha-created, alpha-cloned(_), alpha-ended(done),
         alpha-ended(done) ]) :-
    goes(clone(_), Program).
traced(tuples, Program, [facts],
       [alpha-leave(f(1)), alpha-take(f(1)), alpha-ended(done)]) :-
    goes(( leave(f(1)), take(f(_)) ), Program).
traced(refused_move, Program, [hops],
       [alpha-left(Full), alpha-stayed(Full), alpha-ended(done)]) :-
    goes(catch(move(full), _, true), Program).

:- meta_predicate trip(+, 1, -).

%   trip(+Program, :Goal, -Said): Goal is called with the agent before it goes.

trip(Program, Goal, Said) :-
    two(prints(( host_start(full, [clock(virtual), capacity(0)]),
                 agent_create(clauses(Program), A, [host(alpha)]),
                 call(Goal, A),
                 agent_send(A, go(beta)),
                 agent_join(A, done, 20),
                 later,
                 host_stop(full) ), Said)).

traces(Kinds, Agent) :-
    agent_trace(Agent, Kinds).

test(acts_are_printed,
     [forall(traced(_, Program, Kinds, Expected)), true(Said = Expected)]) :-
    trip(Program, traces(Kinds), Said).
test(goals) :-
    traveller(Program),
    trip(Program, traces([goals]), Said),
    findall(G, member(beta-goal(G), Said), Goals),
    Goals = [ digit(_), 1>1, 2>1, assertz(seen(2)), sleeps, sleep(5), fail,
              home(_), move(_) ].
test(no_reports_after_untrace, Said == [home]) :-
    traveller(Program),
    trip(Program, [A]>>( agent_trace(A, [hops, goals]), agent_notrace(A) ),
         Said).

test(agent_in_other_processes) :-
    in_network(elsewhere(Said)),
    findall(What, member(n1-What, Said), At1),
    findall(What, member(n2-What, Said), At2),
    At1 = [ received(user, go(_)), left(_), arrived(_, _), sent(user, home),
            ended(done) ],
    At2 = [arrived(_, _), left(_)].

elsewhere(Said, Here-There) :-
    Program = [ (:- agent(a, [])),
                (main :- receive(_-go(To)), move(To), home(Home), move(Home),
                         send(user, home)) ],
    prints(( agent_create(clauses(Program), A, [host(Here)]),
             agent_trace(A, [hops, messages]),
             agent_send(A, go(There)),
             agent_join(A, done, 10),
             wait_until(( said(n1-ended(done)), said(n2-left(_)) ), 5) ),
           Said).

test(kinds_are_a_list_of_kinds,
     [ forall(member(Kinds-Error, [ [jumps]-domain_error(trace_kind, jumps),
                                    hops-type_error(list, hops) ])),
       error(Error) ]) :-
    two(( traveller_on(alpha, A), agent_trace(A, Kinds) )).
test(process_without_hosts_gets_no_reports,
     [ forall(member(Goal, [agent_trace(x, [hops]), agent_notrace(x)])),
       error(existence_error(endpoint, running)) ]) :-
    Goal.
test(no_reports_after_the_tracer_ends, error(existence_error(agent, _))) :-
    two(( traveller_on(alpha, A), agent_dispose(A),
          agent_trace(A, [hops]) )).

:- end_tests(tracing).

:- begin_tests(stepping).

steps(0, _) :-
    !.
steps(N, Agent) :-
    agent_step(Agent),
    N1 is N-1,
    steps(N1, Agent).

%   stepped(+Program, +N, -Agent, -Said): what is printed when the agent makes N
%   steps after it got its message; the hosts stop while it is held.

:- meta_predicate stepped(+, +, -, 0, -).

stepped(Program, N, A, Goal, Said) :-
    two(prints(( agent_create(clauses(Program), A, [host(alpha)]),
                 steps(1, A), agent_send(A, go(beta)), steps(N, A),
                 call(Goal) ), Said)).

test(agent_is_stepped_goal_by_goal) :-
    traveller(Program),
    stepped(Program, 8, A,
            ( agent_property(A, state(State)),
              agent_property(A, goals([Next|_])),
              agent_notrace(A),
              agent_join(A, done, 20) ), Said),
    State-Next == held-sleeps,
    goals(Said, Goals),
    append(_, [ tour(beta), move(beta), digit(_), 1>1, 2>1, assertz(seen(2)),
                sleeps ], Goals),
    !.
test(stepped_agent_rests) :-
    two(prints(( traveller_on(alpha, A), steps(3, A) ), Said)),
    last(Said, rests(waiting)).
test(stepped_agent_ends) :-
    goes(here(_), Program),
    stepped(Program, 3, _, true, Said),
    last(Said, ended(done)).
test(held_agents_can_be_ended) :-
    traveller(Program),
    stepped(Program, 1, A,
            ( agent_property(A, state(held)),
              agent_dispose(A),
              agent_join(A, disposed, 1) ), _).
test(agent_that_ends_itself_is_not_held, Outcome == disposed) :-
    goes(( self(Self), agent_dispose(Self), receive(_) ), Program),
    stepped([(:- use_module(library(typhon)))|Program], 4, A,
            agent_join(A, Outcome, 1), _).
test(error_during_a_step) :-
    goes(( catch(member(X, [1,0]), _, true), X =:= 0, atom_length(_, _) ),
         Program),
    stepped(Program, 6, A,
            ( agent_property(A, state(State)),
              agent_property(A, fault(fault(_, Goal, Place, _))) ), Said),
    State = faulty(error(instantiation_error, _)),
    Goal-Place = atom_length(_, _)-(main/0:1),
    last(Said, rests(faulty)).
test(in_another_process) :-
    in_network(elsewhere(Said)),
    goals(Said, Goals),
    last(Goals, here(_)).

elsewhere(Said, Here-There) :-
    prints(( agent_create(clauses([ (:- agent(a, [])),
                                    (main :- receive(_-go(To)), move(To),
                                             here(_), sleep(100)) ]),
                          A, [host(Here)]),
             agent_step(A),
             agent_send(A, go(There)),
             wait_until(( agent_step(A),
                          said(held(There, here(_))) ), 10) ), Said).

test(no_such_agent, error(existence_error(agent, _))) :-
    two(agent_step('a.v.99@alpha@virtual:0')).
test(clones_are_not_held) :-
    stepped([ (:- agent(a, [])), (main :- receive(_), clone(W), told(W)),
              told(parent(_)), (told(clone(_)) :- send(user, x)) ], 4, _,
            true, Said),
    memberchk(x, Said).

:- end_tests(stepping).

:- begin_tests(spying).

:- meta_predicate spied_in(0, 0, 0).

spied_in(Set, Goal, Clear) :-
    setup_call_cleanup(Set, two(Goal), Clear).

goes_there_and_back :-
    traveller_on(alpha, A),
    agent_send(A, go(beta)),
    agent_join(A, done, 10).

test(mistyped_predicate) :-
    prints(spied_in(true,
                    ( traveller_on(alpha, _),
                      spy(traveller:tuor/1),
                      nospy(traveller:tuor/1),
                      spy(traveller:tour),
                      nospy(traveller:tour) ),
                    true), Said),
    Said == [none(tuor/1, ' (did you mean tour/1?)')].

test(held_at_a_spy_point) :-
    prints(spied_in(spy(traveller:tour/1),
                    ( traveller_on(alpha, A),
                      agent_send(A, go(beta)),
                      \+ agent_join(A, done, 10),
                      agent_property(A, state(State)),
                      agent_notrace(A),
                      agent_join(A, done, 20) ),
                    nospy(traveller:tour/1)), Said),
    State == held,
    Said == [spied(tour(beta)), home].

test(nospy_ends_spying) :-
    prints(spied_in(( spy(traveller:tour/1), nospy(traveller:tour/1) ),
                    goes_there_and_back,
                    true), Said),
    Said == [home].

test(calls_are_printed) :-
    prints(spied_in(trace(traveller:tour/1),
                    goes_there_and_back,
                    trace(traveller:tour/1, -all)), Said),
    Said == [alpha-goal(tour(beta)), home].

:- dynamic port/1.

test(ports_of_native_predicates) :-
    retractall(port(_)),
    setup_call_cleanup(
        asserta((user:message_hook(frame(_:digit(_), trace(Port, _)), _, _) :-
                     assertz(test_looking:port(Port))), Ref),
        prints(spied_in(trace(traveller:digit/1, [call, exit]),
                        goes_there_and_back,
                        trace(traveller:digit/1, -all)), _),
        erase(Ref)),
    findall(P, retract(test_looking:port(P)), [call, exit, exit]).

test(qualified_predicates_are_prologs) :-
    setup_call_cleanup(
        spy(lists:append/3),
        '$get_predicate_attribute'(lists:append(_, _, _), spy, 1),
        ( nospy(lists:append/3), nodebug )).

:- end_tests(spying).

:- begin_tests(full_log).

%   logged(+Kinds, -Events, -Text): the log of a traveller there and back.

logged(Kinds, Events, Text) :-
    logged(Kinds, [_]>>true, Events, Text).

:- meta_predicate logged(+, 1, -, -).

logged(Kinds, Goal, Events, Text) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'log.pl', File),
          ( Kinds == [] -> Log = log(File) ; Log = log(File, Kinds) ),
          with_network(edges([1-2]), [clock(virtual), seed(1), Log], _,
                       [H1, H2],
                       ( traveller_on(H1, A),
                         prints(( call(Goal, A),
                                  agent_send(A, go(H2)),
                                  agent_join(A, done, 20) ), _) )),
          log_events(File, Events),
          read_file_to_string(File, Text, []) )).

test(kinds_of_events_are_logged,
     [ forall(member(Kinds-Expected,
                     [ []-[n1-created, n1-ended(done)],
                       [hops, messages]-
                       [ n1-created, n1-received(user), n1-left(N2),
                         n2-arrived(N1, _), n2-left(N1), n1-arrived(N2, _),
                         n1-sent(user), n1-ended(done) ] ])),
       true(Whats = Expected) ]) :-
    logged(Kinds, Events, _),
    findall(Name-What,
            ( member(event(_, Host, _, What), Events),
              atomic_list_concat([Name|_], @, Host) ),
            Whats).

test(hop_times_are_logged) :-
    logged([hops], Events, _),
    findall(S, member(event(_, _, _, arrived(_, S)), Events), [0.0, 0.0]).

test(virtual_runs_repeat, Text1 == Text2) :-
    logged([hops, messages], _, Text1),
    logged([hops, messages], _, Text2).

test(unknown_kind, error(type_error(event_kind, jumps))) :-
    network_start(edges([1-2]), _, [log(nowhere, [jumps])]).

test(host_option, error(type_error(event_kind, jumps))) :-
    host_start(alpha, [log('log@127.0.0.1:1', [jumps])]).

test(a_traced_agent_is_in_the_log) :-
    logged([], [A]>>agent_trace(A, [goals]), Events, _),
    findall(G, member(event(_, _, _, goal(G)), Events), [_|_]).

:- end_tests(full_log).
