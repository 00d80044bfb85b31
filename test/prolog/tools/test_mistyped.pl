:- module(test_mistyped, []).
:- use_module(library(plunit)).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/2, message_text/2]).
:- use_module('../../lib/networks').
:- use_module('../../lib/fixtures').
:- use_module(library(apply)).
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(yall)).
:- use_module(library(typhon)).
:- use_module(library(typhon/nxt)).
:- use_module(library(typhon/options/migration/strategy), []).
:- use_module('../../../agents/allocation/operator').
:- use_module('../../../agents/allocation/auctions').
:- use_module('../../../agents/allocation/sequence').
:- use_module('../../../agents/learning/operator').
:- use_module('../../../agents/population/operator').
:- use_module('../../../agents/sieve/operator').
:- use_module('../../../agents/sync/operator').

/** <module> Messages for mistyped names

*/

%   error_text(:Goal, -Text): Goal raises an error, whose text is Text.

:- meta_predicate error_text(0, -).

error_text(Goal, Text) :-
    catch(( call(Goal), Error = none ), error(Formal, Context),
          Error = error(Formal, Context)),
    assertion(Error \== none),
    message_text(Error, Text).

raises(Goal, Parts) :-
    error_text(Goal, Text),
    forall(member(Part, Parts),
           assertion(sub_string(Text, _, _, _, Part))).

%   says(Name, Goal, Parts): the text of the error of Goal has Parts.

says(option_of_another_form, host_start(a, [hop_time(3)]),
     ["(write hop_time(uniform("]).
says(quota, host_start(a, [quota([hop(3)])]), ["(did you mean hops?)"]).
says(policy, host_start(a, [policy(guardd)]),
     ["trusted, guarded or a file of rules"]).
says(all_options_are_listed, nxt_run(b, a, 50, [limit(90)]),
     ["; there are brake, degrees, regulated, state, sync"]).
says(wrong_value_names_the_option, host_start(a, [capacity(many)]),
     ["in capacity(many)"]).
says(option_with_an_equals_sign, host_start(a, [port=9700]),
     ["host option port=9700", "port"]).
says(setting_of_a_mechanism,
     sequence_start(s, [], [], [settings([dleta-1])], _),
     ["there are delta, theta, maximum, window, strategy, patience"]).
says(topology, network_start(rnig(4), _, []),
     ["no topology rnig(4) (did you mean ring(N)?)", "grid(Rows,Cols)"]).
says(arguments_of_a_topology, network_start(grid(3), _, []),
     ["(did you mean grid(Rows,Cols)?)"]).
says(arguments_of_a_topology, network_start(ring(a), _, []), ["in ring(a)"]).
says(clock, network_start(ring(2), _, [clock(fast)]), ["clock(virtual)"]).
says(clock, host_start(a, [clock(fast)]), ["virtual"]).
says(vocabulary, user:Goal, ["Unknown procedure", Outside]) :-
    member(Goal-Outside, [ move(beta)-"agent_move(Agent, Host)",
                           send(a, b)-"agent_send(Agent, Message)",
                           leave(x)-"remote(Host, leave(_))" ]).
says(dynamic_model, network_start(ring(4), _, [dynamic(dynamc_1)]),
     ["(did you mean dynamic_1"]).
says(single_process_of_virtual_time,
     network_start(ring(2), _, [clock(virtual), processes(2)]),
     ["one process", "processes(2)"]).
says(search_path, agent_check(agent(census)), ["(did you mean agents(_)?)"]).
says(strategy,
     typhon_strategy:next_host(consientious, [], a, memory(1, []), _, _),
     ["(did you mean conscientious?)"]).

:- begin_tests(options).

test(error_suggests_a_fix, [forall(says(_, Goal, Parts))]) :-
    raises(Goal, Parts).

%   Unknown names, and their suggestions.

unknown(host_start(a, [capacty(1)]), host_option, capacity).
unknown(host_start(a, [tokens([]), consut(f)]), host_option, consult).
unknown(agent_create(clauses([]), _, [hots(a)]), agent_option, host).
unknown(agent_create(clauses([]), _, [lifetme(3)]), agent_option, lifetime).
unknown(network_start(ring(2), _, [proceses(2)]), network_option, processes).
unknown(network_start(ring(2), _, [hosts([capacty(2)])]), host_option,
        capacity).
unknown(network_start(ring(2), _, [processes(2), hosts([capacty(2)])]),
        host_option, capacity).
unknown(network_start(ring(2), _,
                      [machines([machine(m, [swipel(x)])])]),
        machine_option, swipl).
unknown(log_server_start([fil(x)], _), log_server_option, file).
unknown(nxt_connect(b, '/dev/null', [baudrat(1)]), nxt_option, baudrate).
unknown(nxt_run(b, a, 50, [regulatd(true)]), nxt_motor_option, regulated).
unknown(sequence_start(s, [], [], [agnts(2)], _), sequence_option, agents).
unknown(learning_start([], p, [], [agnts(2)], _), learning_option, agents).
unknown(population_start(s, [], [], [stats([])], _), population_option,
        starts).
unknown(sieve_start([], a, [setings([])]), sieve_option, settings).
unknown(robot_start(nowhere, [], [cots(x)]), robot_option, cost).
unknown(task_allocate(task(t, [1-[a]], []), nowhere, [nmae(x)], _),
        task_option, name).
unknown(auction_start(anta, [], [slck(1)]), auction_option, slack).
unknown(sequence_begin(s, [], nowhere, [], [dedline(1)], _),
        sequence_allocation_option, deadline).

test(unknown_option_is_an_error, [forall(unknown(Goal, Domain, _)),
                                  error(domain_error(Domain, _))]) :-
    no_leaks(Goal).
test(similar_option_is_suggested, [forall(unknown(Goal, _, Meant))]) :-
    format(string(Proposed), '(did you mean ~w?); there are ', [Meant]),
    raises(Goal, [Proposed]).
test(either_type_is_accepted) :-
    with_hosts([a-[capacity(inf)], b-[capacity(3), concurrency(inf)]], true).
test(single_letter_gets_no_suggestion) :-
    error_text(agent_create(clauses([]), _, [x(1)]), Text),
    assertion(\+ sub_string(Text, _, _, _, "did you mean")).

:- end_tests(options).

:- begin_tests(names).

test(numbers_have_the_noun_that_they_need,
     Texts == ['1 host', '0 hosts', '2 processes', '1 process', '1,200 hops']) :-
    findall(Text, ( member(Count-Noun, [ 1-host, 0-host, 2-process, 1-process,
                                         1200-hop ]),
                    typhon_names:counted(Count, Noun, Text) ), Texts).

test(property, [forall(member(Goal-Meant,
                              [ agent_property(_, sate(_))-"state(_)",
                                agent_property(bob, hosts(_))-"host(_)",
                                host_property(_, adress(_))-"address(_)",
                                network_property(_, host(_))-"hosts(_)" ]))]) :-
    error_text(Goal, Text),
    assertion(sub_string(Text, _, _, _, Meant)).
test(unknown_property_is_an_error,
     error(domain_error(agent_property, sate(_)))) :-
    agent_property(_, sate(_)).
test(every_property_can_be_queried) :-
    with_hosts([alpha],
               ( create([(on_message(_, _))], A, [host(alpha)]),
                 wait_state(A, resident),
                 forall(agent_property(A, P),
                        ( functor(P, Name, N), functor(General, Name, N),
                          assertion(agent_property(A, General)) )),
                 forall(host_property(alpha, P),
                        ( functor(P, Name, N), functor(General, Name, N),
                          assertion(host_property(alpha, General)) )) )).
test(host) :-
    with_hosts([alpha],
               ( raises(host_stop(alhpa), ["(did you mean alpha?)"]),
                 raises(link(alpha, alhpa), ["(did you mean alpha?)"]),
                 raises(agent_create(clauses([(:- agent(a)), main]), _,
                                     [host(alhpa)]),
                        [ "There is no host alhpa here (did you mean alpha?)"
                        ]) )).
test(network) :-
    with_network(ring(2), [clock(virtual)], N,
        ( atom_concat(N, x, Mistyped),
          raises(network_stop(Mistyped), ["(did you mean ", N]) )).
test(existing_host_is_reported) :-
    with_hosts([alpha],
               raises(host_start(alpha),
                      ["There is a host alpha here already"])).
test(agent_that_has_ended) :-
    with_hosts([alpha],
               ( create([main], A, [host(alpha)]),
                 joined(A, done),
                 raises(agent_send(A, x), [" has ended: done"]) )).
test(destination_host) :-
    with_hosts([alpha],
               ( capturing(( create([(main :- move(alhpa))], A,
                                    [host(alpha)]),
                             agent_join(A, raised(Error), 5) ), _),
                 raises(throw(Error), ["(did you mean alpha?)"]) )).
test(kinds_of_trace_and_change) :-
    with_hosts([alpha],
               ( create([(on_message(_, _))], A, [host(alpha)]),
                 raises(agent_trace(A, [hop]), ["(did you mean hops?)"]),
                 raises(agent_change(A, fact([])),
                        ["(did you mean facts(Clauses)?)"]) )).

:- end_tests(names).

:- begin_tests(names_of_existing_agents).

%   A name is given for an output argument.

given(agent_create(clauses([(:- agent(a)), main]), bob)).
given(agent_clone(eve, bob)).
given(agent_load('point.txt', bob)).
given(network_start(ring(3), net, [])).
given(network_load('net.txt', net, [])).
given(log_server_start([file('/dev/null')], log)).
given(watch(alpha, [_]>>true, watch)).

test(refused_agent_is_not_created, [ forall(given(Goal)),
                                     error(uninstantiation_error(_)) ]) :-
    with_hosts([alpha],
               call_cleanup(Goal, assertion(\+ agent_property(_, _)))).

:- end_tests(names_of_existing_agents).

:- begin_tests(programs).

in_directory(Goal) :-
    with_tmp_dir(in_directory(Goal)).

in_directory(Goal, Dir) :-
    working_directory(Old, Dir),
    call_cleanup(( forall(file(Name, Text), put(Name, Text)),
                   catch(link_file('/nowhere', 'agents/broken.pl', symbolic),
                         error(_, _), true),
                   call(Goal)
                 ), working_directory(_, Old)).

file('agents/tourist.pl', ':- agent(tourist, []).\nmain.\n').
file('agents/survey/census.pl', '% a census\n:- agent(census).\nmain.\n').
file('agents/survey/cencus_part.pl', 'part.\n').
file('agents/7.pl', ':- agent(seven).\nmain.\n').
file('agents/bad.pl', ':- agent(bad, [.\n').
file('payloads/thermo.pl', ':- payload(thermo, [provides([t/1])]).\nt(1).\n').

put(Name, Text) :-
    file_directory_name(Name, Folder),
    make_directory_path(Folder),
    write_file(Name, Text).

test(agents) :-
    in_directory(raises(agent_check(agents(tourst)),
                        ["There is no file agents(tourst) \c
                          (did you mean tourist?)"])).
test(files) :-
    in_directory(( raises(agent_check('agents/turist'),
                          ["There is no file 'agents/turist' \c
                            (did you mean agents/tourist?)"]),
                   working_directory(_, agents),
                   raises(agent_check(tourst),
                          ["There is no file tourst (did you mean tourist?)"]),
                   raises(agent_check('tourst.pl'),
                          ["There is no file 'tourst.pl' \c
                            (did you mean tourist.pl?)"]),
                   error_text(agent_check('no/such/file'), Text),
                   assertion(sub_string(Text, _, _, _, "does not exist")) )).
test(program_in_a_folder) :-
    in_directory(raises(agent_check(agents(survey/cenus)),
                        ["(did you mean survey/census?)"])).
test(program_by_its_last_part) :-
    in_directory(raises(agent_check(agents(census)),
                        ["(did you mean survey/census?)"])).
test(payloads) :-
    in_directory(
        with_hosts([alpha],
                   raises(agent_create(agents(tourist), _,
                                       [payloads([payloads(thrmo)])]),
                          ["(did you mean thermo?)"]))).
test(only_programs_are_suggested) :-
    in_directory(( typhon_names:names(agents, Names),
                   assertion(memberchk(tourist, Names)),
                   assertion(memberchk('survey/census', Names)),
                   assertion(\+ memberchk('survey/cencus_part', Names)) )).

:- end_tests(programs).
