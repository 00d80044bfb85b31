:- module(test_python, []).

/** <module> Functions of a Python file as predicates of a place

Calls of agents, their results, faults, and messages that Python sends by
itself.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/networks').
:- needs([python3]).
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [last/2, member/2, numlist/3, sum_list/2]).
:- use_module(library(typhon)).

functions(File) :-
    project_file('test/lib/python_functions.py', File).

%   with_python(+Options, :Goal), or with_python(+Hosts, +Options, :Goal): alpha
%   has the functions.

:- meta_predicate with_python(+, 0), with_python(+, +, 0).

with_python(Options, Goal) :-
    with_python([alpha], Options, Goal).

with_python(Hosts, Options, Goal) :-
    functions(File),
    with_hosts(Hosts,
               ( python_start(alpha, File, Options),
                 call(Goal) )).

error_of(Goal, Formal) :-
    catch(( remote(alpha, Goal), Formal = none ), error(Formal0, _), true),
    Formal = Formal0,
    !.
error_of(_, none).

pid(Pid) :-
    typhon_helper_requests:helper_pid(python(alpha), Pid).

%   file(+Dir, +Name, +Lines, -File)

file(Dir, Name, Lines, File) :-
    directory_file_path(Dir, Name, File),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        forall(member(Line, Lines), format(Out, '~w~n', [Line])),
        close(Out)).

%   Conversions of values share one host.

shared_python :-
    functions(File),
    host_start(alpha),
    python_start(alpha, File, [timeout(120)]).

:- begin_tests(python_values, [setup(shared_python),
                               cleanup(host_stop(alpha))]).

with_python([], Goal) :-
    call(Goal).

test(values_return_unchanged) :-
    Values = [ 1, -7, 1267650600228229401496703205376, 0.5, "text", "", "\u00e4\n\"",
               "\U0001F600",
               [], [1,["a"]], _{a:1, b:_{c:[]}}, null, true, false ],
    with_python([], forall(member(V, Values),
                           ( remote(alpha, echo(V, R)),
                             assertion(R =@= V) ))).
test(kinds, Kinds == ["int", "float", "str", "str", "list", "dict",
                      "NoneType", "bool"]) :-
    with_python([], maplist(kind, [1, 1.0, "s", atom, [], _{}, null, true],
                            Kinds)).
test(values_without_a_json_form,
     Results =@= [ [1,"a"], [1], "\000\\xff\", [0,1,2], _{'1':"one"}]) :-
    with_python([], maplist(odd, [tuple, set, bytes, range, key], Results0)),
    maplist(untagged, Results0, Results).
test(unconvertible_results) :-
    with_python([],
                ( error_of(odd(nan, _), NaN),
                  error_of(odd(object, _), Object),
                  error_of(deep(2000, _), Deep),
                  remote(alpha, echo(1, 1)) )),
    assertion(NaN = python_error('ValueError', _)),
    assertion(Object = python_error('TypeError', _)),
    assertion(Deep = python_error('RecursionError', _)).

%   A list is never truncated silently.

test(long_lists, [Length, Error] = [1000002, python_error('OverflowError', _)]) :-
    with_python([], ( remote(alpha, ( long(1000002, List),
                                      length(List, Length) )),
                      error_of(odd(endless, _), Error) )).
test(unconvertible_arguments,
     [ X, Y, Z, V ] == [ type_error(json_value, f(x)),
                         type_error(json_value, 1r3),
                         type_error(json_value, g), instantiation_error ]) :-
    with_python([],
                ( error_of(echo(f(x), _), X),
                  error_of(echo([_{a:1r3}], _), Y),
                  error_of(echo([a|g], _), Z0),
                  error_of(echo([_], _), V) )),
    ( Z0 = type_error(json_value, [a|g]) -> Z = type_error(json_value, g)
    ; Z = Z0 ).
test(a_megabyte, Length == 1000000) :-
    with_python([], ( remote(alpha, big(1000000, Text)),
                      remote(alpha, echo(Text, Text)) )),
    string_length(Text, Length).
test(result_is_unified, fail) :-
    with_python([], remote(alpha, echo(1, 2))).

kind(Value, Kind) :-
    remote(alpha, kind(Value, Kind)).
odd(Which, Result) :-
    remote(alpha, odd(Which, Result)).

untagged(Dict, Untagged) :-
    is_dict(Dict),
    !,
    dict_pairs(Dict, _, Pairs0),
    findall(Key-V, ( member(K-V, Pairs0), atom_string(Key, K) ), Pairs),
    dict_pairs(Untagged, _, Pairs).
untagged(Value, Value).

:- end_tests(python_values).

:- begin_tests(python_functions).

test(agent_calls_a_function, Outcome-Result == done-6) :-
    with_python([], ( create([ (main :- area(2, 3, R), get_dict(area, R, A),
                            leave(got(A))) ],
                             Agent),
                      joined(Agent, Outcome),
                      remote(alpha, sense(got(Result))) )).
test(defaults, As == [4, 6, 6]) :-
    with_python([], ( remote(alpha, area(2, A1)),
                      remote(alpha, area(2, 3, A2)),
                      remote(alpha, area(2, 3, cm, A3)) )),
    maplist(area_of, [A1,A2,A3], As).
test(only_public_functions_of_the_file_are_callable, Known == []) :-
    with_python([],
                findall(PI, ( member(PI, ['_hidden'/1, dumps/2, named/1,
                                          named/2, 'MET'/1, sleep/2]),
                              known(PI) ), Known)).
test(functions_are_unknown_on_other_hosts, E == none) :-
    with_python([alpha, beta], [],
               ( host_property(beta, place(Place)),
                 ( predicate_property(Place:echo(_, _), defined) -> E = known
                 ; E = none ) )).
test(several_files_share_a_process, [A,B] == [1,2]) :-
    with_tmp_dir(two_files(A, B)).
test(name_in_the_vocabulary_is_refused,
     E-Left == permission_error(define, vocabulary,
                                send/2)-none) :-
    with_tmp_dir(clash(['def send(x): return x'], [], E, Left)).
test(name_of_a_system_predicate_is_refused,
     E == permission_error(define, vocabulary, print/2)) :-
    with_tmp_dir(clash(['def print(x): return x'], [], E, _)).
test(name_defined_in_the_place_is_refused,
     E == permission_error(deliver, procedure, mine/1)) :-
    with_tmp_dir(clash(['def mine(): return 1'], [mine(0)], E, _)).
test(syntax_error, Class-Left == 'SyntaxError'-none) :-
    with_tmp_dir(clash(['def f(:'], [], python_error(Class, _), Left)).
test(error_at_load, E == python_error('KeyError', "'x'")) :-
    with_tmp_dir(clash(['{}["x"]'], [], E, _)).
test(no_such_file, error(existence_error(source_sink, _), _)) :-
    with_hosts([alpha], python_start(alpha, '/no/such.py', [])).
test(no_python, error(existence_error(python, '/no/python'), _)) :-
    functions(File),
    with_hosts([alpha], python_start(alpha, File, [python('/no/python')])).
test(no_such_host, error(existence_error(host, nowhere), _)) :-
    python_start(nowhere, x, []).
test(bad_option, error(domain_error(python_option, colour(red)), _)) :-
    functions(File),
    with_hosts([alpha], python_start(alpha, File, [colour(red)])).
test(started_twice, error(permission_error(start, python, alpha), _)) :-
    functions(File),
    with_python([], python_start(alpha, File, [])).
test(stopped, [E,Again] == [unknown, 1]) :-
    functions(File),
    with_python([],
                ( python_stop(alpha),
                  error_of(echo(1, _), E0),
                  python_start(alpha, File, []),
                  remote(alpha, echo(1, Again)) )),
    ( E0 = existence_error(procedure, _) -> E = unknown ; E = E0 ).
test(stopped_twice, error(existence_error(python, alpha), _)) :-
    with_python([], ( python_stop(alpha), python_stop(alpha) )).
test(starts_with_a_remote_host, R == [5]) :-
    functions(File),
    with_network(line(2), [processes(2)], _, Hosts,
        ( last(Hosts, Far),
          python_start(Far, File, []),
          remote(Far, echo([5], R)),
          python_stop(Far) )).

area_of(Dict, Dict.area).

known(Name/Arity) :-
    host_property(alpha, place(Place)),
    functor(Head, Name, Arity),
    predicate_property(Place:Head, defined).

two_files(A, B, Dir) :-
    file(Dir, 'one.py', ['def one(): return 1'], One),
    file(Dir, 'two.py', ['import one', 'def two(): return one.one() + 1'],
         Two),
    with_hosts([alpha],
               ( python_start(alpha, [One, Two], []),
                 remote(alpha, ( one(A), two(B) )) )).

clash(Lines, Facts, E, Left, Dir) :-
    file(Dir, 'clash.py', Lines, File),
    findall(Line, ( member(F, Facts), format(atom(Line), '~q.', [F]) ), Own),
    file(Dir, 'own.pl', Own, Prolog),
    with_hosts([alpha-[consult(Prolog)]],
               ( catch(python_start(alpha, File, []), error(E, _), true),
                 ( pid(_) -> Left = process ; Left = none ) )).

:- end_tests(python_functions).

:- begin_tests(python_faults).

test(exceptions,
     [A,B] == [ python_error('ValueError', "so"),
                python_error('OSError', "no disk") ]) :-
    with_python([], ( error_of(fail(value, so, _), A),
                      error_of(fail(os, "no disk", _), B) )).
test(agent_gets_the_exception, Facts == [python_error('ValueError', "so")]) :-
    with_python([],
                ( create([ (main :- catch(fail(value, so, _), error(E, _),
                                          true),
                            leave(e(E))) ], Agent),
                  joined(Agent, done),
                  remote(alpha, findall(E, sense(e(E)), Facts)) )).
test(exit, E-R == python_error('SystemExit', "7")-1) :-
    with_python([], ( error_of(leave_politely(_), E),
                      remote(alpha, echo(1, R)) )).
test(timeout, E == timeout_error(python(nap), alpha)) :-
    with_python([timeout(0.2), threads(1)],
                capturing(( wait_until(( error_of(nap(3, _), E),
                                         E \= helper_died(stuck, _) ), 30),
                            wait_until(again, 30) ), _)).
test(printed_output_is_no_answer, R == "done") :-
    with_python([], remote(alpha, noise(R))).
test(crash) :-
    with_python([],
                capturing(( thread_self(Me),
                            thread_create(( error_of(nap(20, _), F),
                                            thread_send_message(Me, f(F)) ),
                                          Thread),
                            wait_until(waits, 10),
                            error_of(leave_process(3, _), E),
                            thread_get_message(Me, f(F), [timeout(10)]),
                            thread_join(Thread),
                            wait_until(catch(remote(alpha, echo(2, 2)),
                                             error(_, _), fail), 10)
                          ), Messages)),
    assertion(E == helper_died(exit(3), python(alpha))),
    assertion(F == helper_died(exit(3), python(alpha))),
    assertion(memberchk(warning-typhon(helper_ended(python(alpha), exit(3))),
                        Messages)).
test(repeated_crash, R == 5) :-
    with_python([],
                capturing(( forall(between(1, 3, _),
                                   ( error_of(leave_process(1, _), _),
                                     wait_until(again, 10) )),
                            remote(alpha, echo(5, R)) ), _)).
test(calls_during_a_restart_wait_for_the_functions, R == 2) :-
    with_tmp_dir(slow_to_load(R)).
test(stuck) :-
    with_python([timeout(0.2)],
                capturing(( pid(Pid),
                            stop_process(Pid),
                            error_of(echo(1, _), E),
                            wait_until(again, 30) ), _)),
    assertion(E == helper_died(stuck, python(alpha))).
test(stopped_during_a_call, E == closed) :-
    with_python([alpha], [],
               ( thread_self(Me),
                 thread_create(( error_of(nap(20, _), F),
                                 thread_send_message(Me, f(F)) ), Thread),
                 remote(alpha, echo(1, 1)),
                 wait_until(waits, 10),
                 python_stop(alpha),
                 thread_get_message(Me, f(F), [timeout(10)]),
                 thread_join(Thread) )),
    ( F = existence_error(helper, _) -> E = closed ; E = F ).
test(host_stops_during_a_call, Outcome == disposed) :-
    with_python([alpha, beta], [timeout(30)],
               ( create([ (main :- nap(30, _)) ], Agent, [host(alpha)]),
                 wait_until(waits, 10),
                 host_stop(alpha),
                 joined(Agent, Outcome) )).

slow_to_load(R, Dir) :-
    file(Dir, 'slow.py',
         ["import os, time", "time.sleep(0.5)",
          "def give_up(): os._exit(1)", "def twice(n): return 2*n"], File),
    with_hosts([alpha],
               ( python_start(alpha, File, []),
                 capturing(( error_of(give_up(_), _),
                             remote(alpha, twice(1, R)) ), _) )).

again :-
    catch(remote(alpha, echo(2, 2)), error(_, _), fail).

waits :-
    remote(alpha, sense(python-"waits")).

:- end_tests(python_faults).

:- begin_tests(concurrent_python_calls).

test(many_calls_at_a_time, Outcomes == [done,done,done,done]) :-
    with_python([threads(4)],
                ( findall(A, ( between(1, 4, _),
                               create([ (main :- meet(true)) ], A) ), As),
                  maplist(joined, As, Outcomes) )).
test(waiting_call_does_not_block_others, Waiting == 10) :-
    with_python([timeout(20), threads(20)],
                ( findall(A, ( between(1, 10, _),
                               create([ (main :- held(_)) ], A) ), As),
                  wait_until(remote(alpha, ( findall(x, sense(python-"waits"),
                                                     Calls),
                                             length(Calls, 10) )), 10),
                  create([ (main :- echo(1, 1)) ], Quick),
                  joined(Quick, done),
                  aggregate_all(count, ( member(A, As),
                                         agent_property(A, state(_)) ),
                                Waiting),
                  remote(alpha, let_go(_)),
                  maplist(joined, As, Outcomes) )),
    forall(member(O, Outcomes), assertion(O == done)).
test(answers_are_not_mixed_up) :-
    with_python([threads(8)],
                ( numlist(1, 20, Ns),
                  maplist(asker, Ns, As),
                  maplist(joined, As, Outcomes) )),
    forall(member(O, Outcomes), assertion(O == done)).
test(state_is_kept, Sum == 6) :-
    with_python([threads(1)], ( maplist(count, [A,B,C]),
                                sum_list([A,B,C], Sum) )).

asker(N, Agent) :-
    create([ (main :- forall(between(1, 25, I),
                             ( V is N*1000+I, echo(V, V) ))) ], Agent).

count(N) :-
    remote(alpha, count(N)).

:- end_tests(concurrent_python_calls).

:- begin_tests(messages_of_python).

test(messages, Numbers == [0,1,2]) :-
    with_python([],
                ( create([ (main :- post(3, Me), self(Id),
                                    atom_string(Id, Me),
                                    receive(python-A), receive(python-B),
                                    receive(python-C),
                                    maplist(get_dict(n), [A,B,C], Ns),
                                    result(Ns)) ], Agent),
                  joined(Agent, done),
                  agent_result(Agent, Numbers, 5) )).
test(message_to_another_agent, R == "hello") :-
    with_python([],
                ( create([ (main :- receive(python-T), result(T)) ], A),
                  remote(alpha, post_to(A, hello, null)),
                  joined(A, done),
                  agent_result(A, R, 5) )).
test(message_to_no_agent, R == 1) :-
    with_python([], ( remote(alpha, post_to(missing, hello, null)),
                      remote(alpha, echo(1, R)) )).
test(moved_agent_is_not_followed, Mail == []) :-
    with_python([alpha, beta], [],
               ( create([ (main :- move(beta), receive(_-go)) ], A,
                        [host(alpha)]),
                 address(beta, Beta),
                 wait_until(agent_property(A, host(Beta)), 10),
                 wait_until(agent_property(A, state(waiting)), 10),
                 remote(alpha, post_to(A, hello, null)),
                 agent_property(A, mailbox(Mail)) )).
test(dropped_messages_of_an_agent_that_left_are_forgotten, Gaps == 0) :-
    with_python([alpha, beta], [queue(2)],
               ( create([ (main :- post(9, _), receive(_-go), move(beta),
                                   receive(_-never)) ], A,
                        [host(alpha)]),
                 wait_until(( state_size(typhon_inbox, Count), Count > 0 ), 10),
                 agent_send(A, go),
                 address(beta, Beta),
                 wait_until(agent_property(A, host(Beta)), 10),
                 state_size(typhon_inbox, Gaps) )).
test(too_many_messages, [Got,Dropped] == [10,90]) :-
    with_python([queue(10)],
                ( create([ (main :- post(100, _), receive(_-go), take(0)),
                           (take(N) :- receive(python-M),
                            (   M = dropped(posts, D)
                            ->  result([N,D])
                            ;   N1 is N+1, take(N1)
                            )) ], A),
                  wait_until(mail(A, 10), 10),
                  remote(alpha, echo(1, 1)),
                  agent_send(A, go),
                  joined(A, done),
                  agent_result(A, [Got,Dropped], 5) )).
test(facts, Facts == [1, "b"]) :-
    with_python([],
                ( remote(alpha, leave_fact(1, null)),
                  remote(alpha, leave_fact(b, null)),
                  remote(alpha, findall(F, sense(python-F), Facts)) )).

mail(Agent, Count) :-
    agent_property(Agent, mailbox(Mail)),
    length(Mail, Count).

:- end_tests(messages_of_python).

:- begin_tests(python_payloads).

%   The host is in another process, which has not loaded Python yet.

test(payload_is_carried_and_delivered, R == [42, 12]) :-
    with_tmp_dir(Dir,
        ( twice(Dir, File),
          with_network(line(2), [processes(2)], _, [Near,Far],
              ( host_change(Far, python(true)),
                create([ (main :- r(F), move(F), deliver(twice), twice(21, X),
                          result(X)) ], A,
                       [host(Near), payloads([File]), facts([r(Far)])]),
                joined(A, done),
                agent_result(A, X, 5),
                remote(Far, twice(6, Y)) )),
          R = [X,Y] )).
test(payload_is_refused_where_not_allowed,
     E == permission_error(deliver, python,
                           twice)) :-
    with_tmp_dir(refused(E)).
test(undelivered, E == existence_error) :-
    with_tmp_dir(undelivered(E)).
test(stopped, E == existence_error(python, alpha)) :-
    with_tmp_dir(stopped(E)).
test(bad_code, Class == 'SyntaxError') :-
    with_tmp_dir(bad_code(Class)).
test(no_such_file, error(existence_error(source_sink, _), _)) :-
    with_hosts([alpha], create([ (main :- true) ], _,
                               [payloads(['/no/such.py'])])).
test(payload_works_after_a_crash, R == 42) :-
    with_tmp_dir(after_crash(R)).

twice(Dir, File) :-
    file(Dir, 'twice.py', ['def twice(x): return 2*x'], File).

refused(E, Dir) :-
    twice(Dir, File),
    with_hosts([alpha],
               ( create([ (main :- catch(deliver(twice), error(F, _), true),
                           result(F)) ], A, [payloads([File])]),
                 joined(A, done),
                 agent_result(A, E, 5) )).

undelivered(E, Dir) :-
    twice(Dir, File),
    with_hosts([alpha-[python(true)]],
               ( create([ (main :- deliver(twice), twice(1, 2),
                           undeliver(twice)) ], A, [payloads([File])]),
                 joined(A, done),
                 error_of(twice(1, _), Formal),
                 functor(Formal, E, _) )).

stopped(E, Dir) :-
    twice(Dir, File),
    with_hosts([alpha-[python(true)]],
               ( create([ (main :- deliver(twice)) ], A, [payloads([File])]),
                 joined(A, done),
                 python_stop(alpha),
                 error_of(twice(1, _), E) )).

bad_code(Class, Dir) :-
    file(Dir, 'bad.py', ['def ('], File),
    with_hosts([alpha-[python(true)]],
               ( create([ (main :- catch(deliver(bad), error(F, _), true),
                           result(F)) ], A, [payloads([File])]),
                 joined(A, done),
                 agent_result(A, python_error(Class, _), 5) )).

after_crash(R, Dir) :-
    twice(Dir, File),
    functions(Functions),
    with_hosts([alpha-[python(true)]],
               ( python_start(alpha, Functions, []),
                 create([ (main :- deliver(twice)) ], A, [payloads([File])]),
                 joined(A, done),
                 capturing(( error_of(leave_process(3, _), _),
                             wait_until(catch(remote(alpha, twice(21, R)),
                                              error(_, _), fail), 10) ), _)
               )).

:- end_tests(python_payloads).
