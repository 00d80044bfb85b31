:- module(test_host_setup, []).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/3]).
:- use_module('../../lib/networks').
:- use_module(library(plunit)).
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
    with_tmp_dir(write_files(Shop, Bank, Goal)).

write_files(Shop, Bank, Goal, Dir) :-
    file(Dir, 'shop.pl', "sells(bread). sells(milk).", Shop),
    file(Dir, 'bank.pl', "lends(1000).", Bank),
    call(Goal).

file(Dir, Name, Text, File) :-
    directory_file_path(Dir, Name, File),
    setup_call_cleanup(open(File, write, Out),
                       writeln(Out, Text),
                       close(Out)).

%   offers(+Host, +Template, +Goal, -List)

offers(Host, Template, Goal, List) :-
    remote(Host, findall(Template, catch(Goal, error(_, _), fail), List)).

:- begin_tests(places).

test(one_file_for_all_hosts, All == [[bread,milk],[bread,milk]]) :-
    with_files(Shop, _,
        with_network(line(2), [places(Shop), clock(virtual)], _,
                     ( offers(n1, X, sells(X), L1),
                       offers(n2, X, sells(X), L2) ))),
    All = [L1,L2].
test(files_of_one_host, All == [[bread,milk],[],[],[1000]]) :-
    with_files(Shop, Bank,
        with_network(line(2),
                     [places([n1-Shop, 2-[Bank]]), clock(virtual)], _,
                     ( offers(n1, X, sells(X), L1),
                       offers(n1, X, lends(X), L2),
                       offers(n2, X, sells(X), L3),
                       offers(n2, X, lends(X), L4) ))),
    All = [L1,L2,L3,L4].
test(files_of_one_host_and_of_all, L1-L2 == [bread,milk]-[1000]) :-
    with_files(Shop, Bank,
        with_network(line(2),
                     [ hosts([consult(Shop)]), places(n2-Bank),
                       clock(virtual) ], _,
                     ( offers(n2, X, sells(X), L1),
                       offers(n2, X, lends(X), L2) ))).
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
test(goal_without_arguments, error(permission_error(_, _, _))) :-
    network_start(line(1), _, [places(call(dispose)), clock(virtual)]).
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

test(failing_goal, error(place_goal_failed(n2, take(p)))) :-
    no_leaks(network_start(line(2), _,
                           [places([n1-leave(p), take(p)]),
                            clock(virtual)])).
test(raising_goal, error(type_error(evaluable, foo/0))) :-
    no_leaks(network_start(line(2), _,
                           [places(n2-(_ is foo+1)), clock(virtual)])).
test(raising_goal_in_another_process,
     error(type_error(evaluable, foo/0))) :-
    no_leaks(network_start(line(2), _,
                           [places(2-(_ is foo+1)), processes(2)])).
test(no_such_host, error(existence_error(host, n3))) :-
    network_start(line(2), _, [places(n3-leave(p))]).
test(no_such_file, error(existence_error(source_sink, _))) :-
    no_leaks(network_start(line(2), _,
                           [places(n2-nothing), clock(virtual)])).
test(not_callable, error(type_error(callable, 7))) :-
    network_start(line(2), _, [places([7])]).

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
    with_tmp_dir(status_of_saved(Status)).

status_of_saved(Status, Dir) :-
    directory_file_path(Dir, 'program.pl', File),
    directory_file_path(Dir, saved, Saved),
    project_file(prolog, Library),
    program(Format),
    write_file(File, Format, [Library]),
    format(atom(Save),
           'qsave_program(~q,[goal(main),stand_alone(true),foreign(save)])',
           [Saved]),
    ended(path(swipl), ['-g', Save, '-t', halt, File], exit(0)),
    ended(Saved, [], Status).

ended(Program, Args, Status) :-
    process_create(Program, Args,
                   [stdin(null), stdout(null), stderr(null), process(Pid)]),
    process_wait(Pid, Status).

:- end_tests(saved_program).
