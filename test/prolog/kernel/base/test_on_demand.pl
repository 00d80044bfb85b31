:- module(test_on_demand, []).

/** <module> Options are loaded on first use

Each test has a process of its own.

*Threading*: one thread in each, unless the name of the test says otherwise.
*/

:- use_module('../../../lib/common', [project_file/2, run_swipl/5]).
:- use_module(library(plunit)).

%   seen(+Goal, -Out): the output of a process with library(typhon) that calls
%   Goal, in which loaded(Modules) is defined.

seen(Goal, Out) :-
    project_file('prolog/typhon.pl', Typhon),
    atom_concat(Goal, ', flush_output', Flushed),
    run_swipl(['-g', Flushed, '-t', halt, Typhon], [timeout(60)], Status, Out,
              Err),
    (   Status == exit(0)
    ->  true
    ;   throw(error(system_error(Err), _))
    ).

:- begin_tests(on_demand).

test(plain_host_loads_no_option, Out == "[]") :-
    seen('host_start(a), agent_create(clauses([(:- agent(x, [])), main]), A), \c
          agent_join(A, done, 5), \c
          findall(M, ( member(M, [ typhon_networks, typhon_store, \c
                                   typhon_guard, typhon_virtual, \c
                                   typhon_quotas, typhon_trail, \c
                                   typhon_access, typhon_watch_senders, \c
                                   typhon_tables, typhon_page_server, \c
                                   typhon_tracing, typhon_stepping, \c
                                   typhon_spying, typhon_units_of_work, \c
                                   typhon_channel, typhon_hop_ids, \c
                                   typhon_journaled_tuples, \c
                                   typhon_host_log, typhon_concurrency, \c
                                   typhon_external_recipients, typhon_remote, \c
                                   typhon_payloads, typhon_fault, \c
                                   typhon_single ]), \c
                       module_property(M, file(_)) ), Ms), \c
          print(Ms)', Out).

%   SWI-Prolog 10 itself loads the index of its library with library(socket).

test(plain_host_loads_no_large_library, Out == "[],0") :-
    seen('host_start(a), \c
          ( current_prolog_flag(version, V), V < 100000, \c
            predicate_property(\'$autoload\':library_index(_, _, _), \c
                               number_of_clauses(N)) -> true ; N = 0 ), \c
          findall(M, ( member(M, [ process, predicate_options, readutil ]), \c
                       module_property(M, file(_)) ), Ms), \c
          print((Ms,N))', Out).
test(option_of_a_host_loads_its_code, Out == "guarded") :-
    seen('host_start(a, [policy(guarded), cell(none)]), \c
          module_property(typhon_guard, file(_)), \c
          module_property(typhon_quotas, file(_)), write(guarded)', Out).
test(change_of_options_loads_the_code, Out == "guarded") :-
    seen('host_start(a, [cell(none)]), host_change(a, policy(guarded)), \c
          module_property(typhon_guard, file(_)), write(guarded)', Out).
test(limit_on_running_agents_loads_the_code, Out == "1") :-
    seen('host_start(a), host_change(a, concurrency(1)), \c
          module_property(typhon_concurrency, file(_)), \c
          Clauses = [ (:- agent(x, [])), \c
                      (main :- thread_self(Me), flag(now, N, N+1), \c
                               flag(most, M, max(M, N+1)), \c
                               thread_get_message(Me, x, [timeout(0.01)]) \c
                               -> true ; flag(now, N, N-1)) ], \c
          findall(A, ( between(1, 20, _), \c
                       agent_create(clauses(Clauses), A) ), As), \c
          forall(member(A, As), agent_join(A, done, 20)), \c
          get_flag(most, Most), print(Most)', Out).
test(loading_does_not_count_for_the_quota_of_an_agent,
     Out == "type_error(receiver,fipa(x))") :-
    seen('host_start(a, [quota([inferences(5000)])]), \c
          agent_create(clauses([ (:- agent(x, [])), \c
                                 (main :- send(fipa(x), hello)) ]), A, \c
                       [host(a)]), \c
          agent_join(A, raised(error(E, _)), 20), print(E)', Out).
test(mistyped_options_are_compared_with_unloaded_ones,
     true(sub_string(Out, _, _, _, "did you mean policy?"))) :-
    seen('catch(host_start(a, [polici(x)]), E, true), \c
          \'$messages\':translate_message(E, Lines, []), \c
          print_message_lines(user_output, \'\', Lines)', Out).
test(values_of_unloaded_options_are_checked, Out == "type_error(text,1)") :-
    seen('catch(host_start(a, [policy(1)]), error(E, _), print(E))', Out).
test(settings_can_be_set_before_loading, Out == "7,7") :-
    seen('set_setting(typhon_watch_senders:events, 7), \c
          setting(typhon_watch_senders:events, A), host_start(a), \c
          watch(a, [_]>>true, W), unwatch(W), \c
          findall(B, setting(typhon_watch_senders:events, B), Bs), \c
          atomic_list_concat([A|Bs], (\',\'), All), write(All)', Out).
test(watch_by_a_peer_loads_its_code, Out == "started") :-
    seen('host_start(a), host_property(a, address(Address)), \c
          format(atom(There), "host_start(b), watch(~q, [E]>>true, W), \c
                               unwatch(W), write(started), host_stop(b)", \c
                 [Address]), \c
          current_prolog_flag(executable, Swipl), \c
          module_property(typhon, file(Typhon)), \c
          process_create(Swipl, [\'-g\', There, \'-t\', halt, Typhon], \c
                         [stdout(pipe(In))]), \c
          read_string(In, _, Said), write(Said), \c
          module_property(typhon_watch_senders, file(_))', Out).
test(waiting_thread_is_answered_however_the_load_ends, Out == "[e,e,b,f,t]") :-
    seen('Ends = [ thread_exit(x), (thread_self(M), thread_signal(M, abort)), \c
                   throw(b), fail, true ], \c
          findall(R, ( member(G, Ends), \c
                       thread_create(( catch(typhon_own_thread:uncounted(G), \c
                                             B, true) \c
                                       -> ( var(B) -> W = t \c
                                          ; B = error(_, _) -> W = e ; W = B ), \c
                                          thread_exit(W) \c
                                       ;  thread_exit(f) ), T), \c
                       thread_join(T, exited(R)) ), Rs), print(Rs)', Out).
test(many_threads_load_a_part_at_once, Out == "[true]") :-
    seen('host_start(a), \c
          findall(T, ( between(1, 8, _), \c
                       thread_create(( watch(a, [_]>>true, W), \c
                                       unwatch(W) ), T) ), Ts), \c
          findall(S, ( member(T, Ts), thread_join(T, S) ), Ss), \c
          sort(Ss, Set), print(Set)', Out).
test(library_alone_neither_reads_nor_compiles_programs, Out == "[]") :-
    seen('host_start(a), \c
          findall(F, ( source_file(F), sub_atom(F, _, _, _, \c
                       \'/typhon/language\') ), Fs), print(Fs)', Out).
test(connection_loads_the_compiler, Out == "loaded") :-
    seen('network_start(line(2), N, [processes(2)]), \c
          network_property(N, hosts([A|_])), \c
          remote(A, thread_wait(module_property(typhon_chunk_compiler, \c
                                                exports(_)), \c
                                [timeout(30), retry_every(0.05)])), \c
          network_stop(N), write(loaded)', Out).
test(first_agents_of_many_threads, Out == "[0,1,2,3,4,5,6,7]") :-
    seen('host_start(a), \c
          numlist(0, 7, Ns), \c
          findall(T, ( member(N, Ns), \c
                       thread_create(( \c
                           agent_create(clauses([ (:- agent(x, [])), \c
                               (main :- sleep(0), result(N)) ]), A), \c
                           agent_result(A, R, 30), \c
                           thread_exit(R) ), T) ), Ts), \c
          findall(R, ( member(T, Ts), thread_join(T, exited(R)) ), Rs), \c
          print(Rs)', Out).
test(first_agent_after_interrupted_ones, Out == "1") :-
    seen('host_start(a), \c
          P = clauses([(:- agent(x, [])), (main :- sleep(0), result(1))]), \c
          forall(member(I, [1,10,30,100,200,400,800]), \c
                 call_with_inference_limit(agent_create(P, _), I, _)), \c
          agent_create(P, B), agent_result(B, R, 30), print(R)', Out).
test(compiling_the_first_program_does_not_count_for_its_quota, Out == "1") :-
    seen('host_start(a, [quota([inferences(2000)])]), \c
          agent_create(clauses([ (:- agent(x, [])), \c
                                 (main :- sleep(0), result(1)) ]), A), \c
          agent_result(A, R, 30), print(R)', Out).

%   Files of the library are loaded by many threads, and waits for a thread that
%   loads one must not keep a mutex that this thread may want.

test(nothing_is_loaded_while_a_mutex_is_held, [nondet, Held == []]) :-
    project_file('test/lib/first_uses.pl', File),
    project_file(prolog, Library),
    atom_concat('library=', Library, Path),
    run_swipl(['-p', Path, '-g', 'first_uses(Held),print(held(Held))',
               '-t', halt, File],
              [timeout(120)], Status, Out, _),
    assertion(Status == exit(0)),
    sub_string(Out, Before, _, _, "held("),
    sub_string(Out, Before, _, 0, Text),
    term_string(held(Held), Text).

test(process_that_ends_loads_code,
     [forall(member(Before, [true, host_start(a)])), Out == "loaded"]) :-
    part_loaded(Loaded),
    format(atom(Goal), '~q, at_halt(( ~w, flush_output ))', [Before, Loaded]),
    seen(Goal, Out).
test(thread_with_little_stack_loads_code, Out == "loaded") :-
    part_loaded(Loaded),
    format(atom(Goal), 'thread_create(( ~w ), T, [stack_limit(100000)]), \c
                        thread_join(T, true)', [Loaded]),
    seen(Goal, Out).

part_loaded('typhon_on_demand:on_demand_load(fault, report), \c
             module_property(typhon_fault, file(_)), write(loaded)').

test(library_predicates_are_searched_for_again, Out == "true,false") :-
    seen('current_prolog_flag(autoload, A), \c
          current_prolog_flag(optimise, O), \c
          format("~w,~w", [A, O])', Out).

:- end_tests(on_demand).
