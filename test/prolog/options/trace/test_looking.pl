:- module(test_looking, []).

% Inspecting agents: listing, tracing, stepping and spying, as at the top
% level.

:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/tools/source_view/variable_names),
              [goals_places/3]).

%   two(:Goal): with hosts alpha and beta, in virtual time.

:- meta_predicate two(0), prints(0, -), in_network(+, 1).

two(Goal) :-
    no_leaks(setup_call_cleanup(
                 ( host_start(alpha, [clock(virtual)]),
                   host_start(beta, [clock(virtual)]) ),
                 once(Goal),
                 ( host_stop(alpha), host_stop(beta) ))).

in_network(Options, Goal) :-
    no_leaks(setup_call_cleanup(
                 network_start(edges([1-2]), Network, Options),
                 once(call(Goal, Network)),
                 network_stop(Network))).

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

goals(Said, Goals) :-
    findall(Goal, member(held(_, Goal), Said), Goals).

:- meta_predicate with_named_program(-, 0).

with_named_program(File, Goal) :-
    with_tmp_dir(test_looking:named_program(File, Goal)).

named_program(File, Goal, Dir) :-
    directory_file_path(Dir, 'tourist.pl', File),
    write_file(File, ":- agent(tourist, []).~n~n\c
                      main :- receive(_-go(Hosts)), tour(Hosts),~n\c
                              home(Home), move(Home).~n~n\c
                      tour([]).~n\c
                      tour([Host|Hosts]) :- move(Host), tour(Hosts).~n", []),
    once(Goal).

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
    in_network([processes(2)], elsewhere(Text)),
    shows(Text, "on n2@"),
    shows(Text, "main :-\n=>  receive(_).").

elsewhere(Text, Network) :-
    network_property(Network, hosts([_, Host])),
    agent_create(clauses([ (:- agent(a, [])), (main :- receive(_), true) ]),
                 A, [host(Host)]),
    wait_until(agent_property(A, state(waiting)), 5),
    listing_of(A, Text).

%   A program that was read from a file has names of variables.

test(names_of_variables) :-
    two(named_on(alpha, rests, Text)),
    forall(named_part(Part), assertion(shows(Text, Part))).
test(names_of_variables_in_another_process) :-
    in_network([processes(2)], named_elsewhere(Text)),
    forall(named_part(Part), assertion(shows(Text, Part))).

named_part("=>  receive(_-go(Hosts)),\n    tour(Hosts),\n    home(Home),").
named_part("tour([Host|Hosts]) :-\n    move(Host),\n    tour(Hosts).").
named_part("% goals left\n:- receive(_-go(Hosts)),\n   tour(Hosts),\n\c
           \u0020  home(Home),\n   move(Home).").

named_elsewhere(Text, Network) :-
    network_property(Network, hosts([_, Host])),
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

stands(Goals, Places) :-
    clauses(Clauses),
    goals_places(Clauses, Goals, Places).

test(goals_match_at_the_unbound_goal) :-
    stands([_, c, d, rest], [1-2]).
test(identical_goals) :-
    stands([c, d, rest], [1-3, 2-1]).
test(last_goal, Places == [5-1, 6-2]) :-
    stands([_], Places0),
    findall(N-I, ( member(N-I, Places0), memberchk(N, [5, 6]) ), Places).
test(goal_within_a_condition) :-
    stands([( sleep_until(3.0), h -> c ; d ), i], [3-1]).
test(goal_called_by_a_condition) :-
    stands([( c, d, h -> c ; d ), i], [1-3, 2-1]).
test(same_goal_outside_the_condition) :-
    stands([( z, h -> c ; d ), i], [3-1]).
test(caught_goal) :-
    stands([catch(( sleep_until(3.0), l ), _, m)], [4-1]).
test(no_matching_goal) :-
    stands([x, y], []).
test(no_goals_left) :-
    stands([], []).

:- end_tests(listing).

:- begin_tests(tracing).

test(hops_and_messages) :-
    two(prints(( traveller_on(alpha, A),
                 agent_trace(A, [hops, messages]),
                 agent_send(A, go(beta)),
                 agent_join(A, done, 20) ), Said)),
    Said = [ alpha-received(user, go(beta)), alpha-left(Beta),
             beta-arrived(Alpha, _), beta-left(Alpha),
             alpha-arrived(Beta, _), alpha-sent(user, home), home,
             alpha-ended(done) ].

test(goals) :-
    two(prints(( traveller_on(alpha, A),
                 agent_trace(A, [goals]),
                 agent_send(A, go(beta)),
                 agent_join(A, done, 20) ), Said)),
    findall(G, member(beta-goal(G), Said), Goals),
    Goals = [ digit(_), 1>1, 2>1, assertz(seen(2)), sleeps, sleep(5), fail,
              home(_), move(_) ].

test(no_reports_after_untrace) :-
    two(prints(( traveller_on(alpha, A),
                 agent_trace(A, [hops, goals]),
                 agent_notrace(A),
                 agent_send(A, go(beta)),
                 agent_join(A, done, 20) ), Said)),
    findall(What, member(_-What, Said), []).

test(clones_are_traced) :-
    two(prints(( agent_create(clauses([ (:- agent(a, [])),
                                        (main :- receive(_), clone(_)) ]),
                              A, [host(alpha)]),
                 agent_trace(A, [hops]),
                 agent_send(A, go),
                 later ), Said)),
    Said = [ alpha-created, alpha-cloned(_), alpha-ended(done),
             alpha-ended(done) ].

test(tuples_are_traced) :-
    two(prints(( agent_create(clauses([ (:- agent(a, [])),
                                        (main :- receive(_), leave(f(1)),
                                                 take(f(_))) ]),
                              A, [host(alpha)]),
                 agent_trace(A, [facts]),
                 agent_send(A, go),
                 agent_join(A, done, 5) ), Said)),
    Said = [ alpha-leave(f(1)), alpha-take(f(1)), alpha-ended(done) ].

test(refused_move) :-
    no_leaks(setup_call_cleanup(
        ( host_start(alpha, [clock(virtual)]),
          host_start(full, [clock(virtual), capacity(0)]) ),
        prints(( agent_create(clauses([ (:- agent(a, [])),
                                        (main :- receive(_),
                                             catch(move(full), _, true)) ]),
                              A, [host(alpha)]),
                 agent_trace(A, [hops]),
                 agent_send(A, go),
                 agent_join(A, done, 5) ), Said),
        ( host_stop(alpha), host_stop(full) ))),
    Said = [ alpha-left(Full), alpha-stayed(Full), alpha-ended(done) ].

test(agent_in_other_processes) :-
    in_network([processes(2)], elsewhere(Said)),
    findall(What, member(n1-What, Said), At1),
    findall(What, member(n2-What, Said), At2),
    At1 = [ received(user, go(_)), left(_), arrived(_, _), sent(user, home),
            ended(done) ],
    At2 = [arrived(_, _), left(_)].

elsewhere(Said, Network) :-
    network_property(Network, hosts([Here, There])),
    clauses(Program),
    prints(( agent_create(clauses(Program), A, [host(Here)]),
             agent_trace(A, [hops, messages]),
             agent_send(A, go(There)),
             agent_join(A, done, 10),
             wait_until(( said(n1-ended(done)), said(n2-left(_)) ), 5) ),
           Said).

clauses([ (:- agent(a, [])),
          (main :- receive(_-go(There)), move(There), home(Home),
                   move(Home), send(user, home)) ]).

test(unknown_kind, error(domain_error(trace_kind, jumps))) :-
    two(( traveller_on(alpha, A), agent_trace(A, [jumps]) )).

test(kinds_must_be_a_list, error(type_error(list, hops))) :-
    two(( traveller_on(alpha, A), agent_trace(A, hops) )).

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

test(agent_is_stepped_goal_by_goal) :-
    two(prints(( traveller_on(alpha, A),
                 steps(1, A),
                 agent_send(A, go(beta)),
                 steps(8, A),
                 agent_property(A, state(State)),
                 agent_property(A, goals([Next|_])),
                 agent_notrace(A),
                 agent_join(A, done, 20) ), Said)),
    State-Next == held-sleeps,
    goals(Said, Goals),
    append_last(Goals, [ tour(beta), move(beta), digit(_), 1>1, 2>1,
                         assertz(seen(2)), sleeps ]).

append_last(List, End) :-
    append(_, End0, List),
    length(End, N),
    length(End0, N),
    !,
    End0 = End.

test(stepped_agent_rests) :-
    two(prints(( traveller_on(alpha, A), steps(3, A) ), Said)),
    last_of(Said, rests(waiting)).

last_of(List, Last) :-
    append(_, [Last0], List),
    !,
    Last0 = Last.

test(stepped_agent_ends) :-
    two(prints(( agent_create(clauses([ (:- agent(a, [])),
                                        (main :- receive(_), here(_)) ]),
                              A, [host(alpha)]),
                 steps(1, A), agent_send(A, x), steps(3, A) ), Said)),
    last_of(Said, ended(done)).

test(held_agents_can_be_ended) :-
    two(( prints(( traveller_on(alpha, A),
                   agent_step(A), agent_send(A, go(beta)), agent_step(A) ), _),
          agent_property(A, state(held)),
          agent_dispose(A),
          agent_join(A, disposed, 1) )).

test(hosts_with_held_agents_stop) :-
    two(prints(( traveller_on(alpha, A),
                 agent_step(A), agent_send(A, go(beta)), agent_step(A) ), _)).

test(error_during_a_step) :-
    two(prints(( agent_create(clauses([ (:- agent(a, [])),
                                        (main :- receive(_),
                                             catch(member(X, [1,0]), _, true),
                                             X =:= 0, atom_length(_, _)) ]),
                              A, [host(alpha)]),
                 steps(1, A), agent_send(A, x), steps(6, A),
                 agent_property(A, state(State)),
                 agent_property(A, fault(fault(_, Goal, Place, _))) ),
               Said)),
    State = faulty(error(instantiation_error, _)),
    Goal-Place = atom_length(_, _)-(main/0:1),
    last_of(Said, rests(faulty)).

test(in_another_process) :-
    in_network([processes(2)], elsewhere(Said)),
    goals(Said, Goals),
    last_of(Goals, here(_)).

elsewhere(Said, Network) :-
    network_property(Network, hosts([Here, There])),
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
    two(( prints(( agent_create(clauses([ (:- agent(a, [])),
                                          (main :- receive(_), clone(W),
                                                   told(W)),
                                          told(parent(_)),
                                          (told(clone(_)) :- send(user, x)) ]),
                                A, [host(alpha)]),
                   steps(1, A), agent_send(A, go), steps(4, A) ), Said),
          memberchk(x, Said) )).

:- end_tests(stepping).

:- begin_tests(spying).

:- meta_predicate spied_in(0, 0, 0).

spied_in(Set, Goal, Clear) :-
    setup_call_cleanup(Set, two(Goal), Clear).

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
                    ( traveller_on(alpha, A),
                      agent_send(A, go(beta)),
                      agent_join(A, done, 10) ),
                    true), Said),
    Said == [home].

test(calls_are_printed) :-
    prints(spied_in(trace(traveller:tour/1),
                    ( traveller_on(alpha, A),
                      agent_send(A, go(beta)),
                      agent_join(A, done, 10) ),
                    trace(traveller:tour/1, -all)), Said),
    Said == [alpha-goal(tour(beta)), home].

:- dynamic port/1.

test(ports_of_native_predicates) :-
    retractall(port(_)),
    setup_call_cleanup(
        asserta((user:message_hook(frame(_:digit(_), trace(Port, _)), _, _) :-
                     assertz(test_looking:port(Port))), Ref),
        prints(spied_in(trace(traveller:digit/1, [call, exit]),
                        ( traveller_on(alpha, A),
                          agent_send(A, go(beta)),
                          agent_join(A, done, 10) ),
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
    no_leaks(with_tmp_dir(logged(Kinds, Events, Text))).

logged(Kinds, Events, Text, Dir) :-
    directory_file_path(Dir, 'log.pl', File),
    log_option(Kinds, File, Log),
    setup_call_cleanup(
        network_start(edges([1-2]), Network, [clock(virtual), seed(1), Log]),
        once(live(Network)),
        network_stop(Network)),
    log_events(File, Events),
    read_file_to_string(File, Text, []).

log_option([], File, log(File)).
log_option([Kind|Kinds], File, log(File, [Kind|Kinds])).

live(Network) :-
    network_property(Network, hosts([H1, H2])),
    traveller_on(H1, A),
    prints(( agent_send(A, go(H2)),
             agent_join(A, done, 20) ), _).

whats(Events, Whats) :-
    findall(Name-What,
            ( member(event(_, Host, _, What), Events),
              atomic_list_concat([Name|_], @, Host) ),
            Whats).

test(log_of_lives_only) :-
    logged([], Events, _),
    whats(Events, [n1-created, n1-ended(done)]).

test(hops_and_messages) :-
    logged([hops, messages], Events, _),
    whats(Events,
          [ n1-created, n1-received(user), n1-left(N2), n2-arrived(N1, _),
            n2-left(N1), n1-arrived(N2, _), n1-sent(user), n1-ended(done) ]).

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
    no_leaks(with_tmp_dir(traced_and_logged(Events))),
    findall(G, member(event(_, _, _, goal(G)), Events), [_|_]).

traced_and_logged(Events, Dir) :-
    directory_file_path(Dir, 'log.pl', File),
    setup_call_cleanup(
        network_start(edges([1-2]), Network, [clock(virtual), log(File)]),
        once(( network_property(Network, hosts([H1, H2])),
               traveller_on(H1, A),
               prints(( agent_trace(A, [goals]),
                        agent_send(A, go(H2)),
                        agent_join(A, done, 20) ), _) )),
        network_stop(Network)),
    log_events(File, Events).

:- end_tests(full_log).
