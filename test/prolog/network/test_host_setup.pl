:- module(test_host_setup, []).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/3]).
:- use_module('../../lib/networks').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(typhon)).

/** <module> Places of the hosts of a network

*Threading*: one test at a time.
*/

%   with_files(-Shop, -Bank, :Goal): Shop and Bank are files for places.

:- meta_predicate with_files(-, -, 0).

with_files(Shop, Bank, Goal) :-
    with_tmp_dir(Dir,
        ( maplist(directory_file_path(Dir), ['shop.pl','bank.pl'], [Shop,Bank]),
          write_file(Shop, "sells(bread). sells(milk).~n", []),
          write_file(Bank, "lends(1000).~n", []),
          once(Goal) )).

%   offers(+Host, +Template, +Goal, -List)

offers(Host, Template, Goal, List) :-
    remote(Host, findall(Template, catch(Goal, error(_, _), fail), List)).

:- begin_tests(places).

%   placed(?Shop, ?Bank, -Options, -Offers): what n1 sells and lends, and n2.

placed(Shop, _, [places(Shop)], [[bread,milk],[],[bread,milk],[]]).
placed(Shop, Bank, [places([n1-Shop, 2-[Bank]])],
       [[bread,milk],[],[],[1000]]).
placed(Shop, Bank, [hosts([consult(Shop)]), places(n2-Bank)],
       [[bread,milk],[],[bread,milk],[1000]]).

test(files_of_hosts,
     [forall(placed(Shop, Bank, Options, Expected)), Offers == Expected]) :-
    with_files(Shop, Bank,
        with_network(line(2), [clock(virtual)|Options], _,
                     findall(L, ( member(Host, [n1,n2]),
                                  member(Offer, [sells(X), lends(X)]),
                                  offers(Host, X, Offer, L) ), Offers))).
test(goal_in_each_place, Hs == [n1,n2,n3]) :-
    with_network(line(3), [places(( here(H), leave(me(H)) )), clock(virtual)],
                 Network,
                 ( network_property(Network, hosts(Hosts)),
                   findall(Name,
                           ( member(Host, Hosts),
                             remote(Host, sense(me(Me))), Me == Host,
                             atomic_list_concat([Name,_], @, Me) ),
                           Hs) )).
test(goals_run_after_links_are_made, Count == 2) :-
    with_network(line(3),
                 [ places(( neighbours(L), length(L, N), leave(n(N)) )),
                   clock(virtual) ], _,
                 remote(n2, sense(n(Count)))).
test(agents_find_asserted_facts, O == done) :-
    with_network(line(2), [places(n2-[assertz(price(7))]), clock(virtual)],
                 _,
                 ( agent_create(clauses([ (:- agent(buyer)),
                                          (main :- neighbours([H]), move(H),
                                                   price(7)) ]), A,
                                [host(n1)]),
                   agent_join(A, O, 10) )).
test(goals_run_in_order, L == [1,2,3]) :-
    with_network(line(1),
                 [ places([leave(p(1)), n1-[leave(p(2))], leave(p(3))]),
                   clock(virtual) ], _,
                 offers(n1, X, sense(p(X)), L)).
test(places_in_several_processes, All == [[bread,milk]-[a],[]-[b]]) :-
    with_files(Shop, _,
        with_network(edges([a-b]),
                     [ processes(2),
                       places([ a-Shop,
                                ( here(H), atomic_list_concat([N,_], @, H),
                                  assertz(called(N)) ) ]) ],
                     Network,
                     ( network_property(Network, hosts([A,B])),
                       offers(A, X, sells(X), L1),
                       offers(A, X, called(X), C1),
                       offers(B, X, sells(X), L2),
                       offers(B, X, called(X), C2) ))),
    All = [L1-C1,L2-C2].
test(hosts_that_refuse_remote_goals) :-
    with_network(line(2),
                 [hosts([remote(false)]), places(leave(p)), clock(virtual)],
                 _, true).

%   Either all hosts start or none.

test(refused_places,
     [ forall(member(Places-Options-Formal,
                     [ call(dispose)-[clock(virtual)]-permission_error(_, _, _),
                       [n1-leave(p), take(p)]-[clock(virtual)]-
                       place_goal_failed(n2, take(p)),
                       n2-(_ is foo+1)-[clock(virtual)]-
                       type_error(evaluable, foo/0),
                       2-(_ is foo+1)-[processes(2)]-
                       type_error(evaluable, foo/0),
                       n3-leave(p)-[]-existence_error(host, n3),
                       n2-nothing-[clock(virtual)]-
                       existence_error(source_sink, _),
                       [7]-[]-type_error(callable, 7) ])),
       error(Formal) ]) :-
    no_leaks(network_start(line(2), _, [places(Places)|Options])).

:- end_tests(places).

:- begin_tests(saved_program).

%   The processes run the installed Prolog: that of the saved state would run
%   the goal again, and then print a message and end.

program("
:- multifile user:file_search_path/2.
user:file_search_path(library, '~w').
:- use_module(library(typhon)).
main :-
    getenv('TYPHON_TEST_AGAIN', _),
    !,
    halt(3).
main :-
    setenv('TYPHON_TEST_AGAIN', 1),
    network_start(ring(3), Network, [processes(2)]),
    network_stop(Network),
    halt.
").

test(saved_state_starts_networks, Status == exit(0)) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'program.pl', File),
          directory_file_path(Dir, saved, Saved),
          project_file(prolog, Library),
          program(Format),
          write_file(File, Format, [Library]),
          format(atom(Save),
                 'qsave_program(~q,\c
                                [goal(main),stand_alone(true),foreign(save)])',
                 [Saved]),
          ended(path(swipl), ['-g', Save, '-t', halt, File], exit(0)),
          ended(Saved, [], Status) )).

ended(Program, Args, Status) :-
    process_create(Program, Args,
                   [stdin(null), stdout(null), stderr(null), process(Pid)]),
    process_wait(Pid, Status).

:- end_tests(saved_program).
