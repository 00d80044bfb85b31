:- module(test_guard, []).
:- use_module('../../../lib/allowed_goals').
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module(library(yall)).
:- use_module(library(typhon)).

/** <module> Untrusted agents on a host that guards

Each attack is tried in three ways: written in the program, constructed at run
time and run by the machine, and constructed and run by Prolog.

*Threading*: one test at a time.
*/

%   attack(-Goal): a goal that no untrusted agent may call.

attack(halt).
attack(halt(1)).
attack(abort).
attack(close(user_output)).
attack(close(user_error, [force(true)])).
attack(set_output(x)).
attack(see(x)).
attack(open('/tmp/x', write, _)).
attack(write(x)).
attack(writeln(x)).
attack(nl).
attack(print(x)).
attack(read(_)).
attack(read_term(user_input, _, [])).
attack(read_term_from_atom('a', _, [])).
attack(consult(user)).
attack(load_files(library(lists), [])).
attack(use_module(library(process))).
attack(use_foreign_library(foreign(process))).
attack(open_shared_object(x, _)).
attack(shell(true)).
attack(process_create(path(true), [], [])).
attack(delete_file('/tmp/typhon_no_such')).
attack(exists_file('/etc/passwd')).
attack(getenv('HOME', _)).
attack(setenv(x, y)).
attack(working_directory(_, _)).
attack(thread_create(true, _)).
attack(thread_self(_)).
attack(thread_exit(true)).
attack(thread_signal(main, halt)).
attack(thread_send_message(main, x)).
attack(thread_get_message(_)).
attack(thread_join(main, _)).
attack(mutex_lock(typhon_code)).
attack(with_mutex(typhon_code, true)).
attack(message_queue_create(_)).
attack(set_prolog_flag(double_quotes, atom)).
attack(set_prolog_flag(stack_limit, 1)).
attack(current_prolog_flag(pid, _)).
attack(create_prolog_flag(x, 1, [])).
attack(set_stream(user_output, alias(x))).
attack(op(700, xfx, =>>)).
attack(nb_setval(typhon_turns, none)).
attack(b_setval(typhon_turns, none)).
attack(nb_getval(typhon_turns, _)).
attack(nb_current(_, _)).
attack(flag(x, _, 1)).
attack(set_flag(x, 1)).
attack(recorda(x, y)).
attack(asserta(user:portray(_))).
attack(assertz((user:portray(_) :- true))).
attack(assertz((portray(_) :- halt))).
attack(assertz((p(X) :- user:X))).
attack(assertz('$mobile'(_, _, _, _, _, _))).
attack(assertz('mobile main'([], [], _))).
attack(assertz((term_expansion(_, _) :- shell(x)))).
attack(assertz((goal_expansion(_, _) :- shell(x)))).
attack(assertz((attr_unify_hook(_, _) :- halt))).
attack(retract(typhon_agents:agent(_, _, _, _, _))).
attack(retract((user:portray(_) :- _))).
attack(retractall(system:foo(_))).
attack(retractall('$tuple'(_))).
attack(abolish(foo/1)).
attack(dynamic(foo/1)).
attack(clause(typhon_words:send(_, _), _)).
attack(predicate_property(_, _)).
attack(current_predicate(_)).
attack(current_module(_)).
attack(module(user)).
attack(set_module(user)).
attack(add_import_module(user, system, end)).
attack(import_module(_, _)).
attack(@(true, user)).
attack(user:true).
attack(system:halt).
attack(typhon_place:place_destroy(x)).
attack(call(user:true)).
attack(findall(_, user:true, _)).
attack(setof(_, _^halt, _)).
attack(setof(_, _^user:true, _)).
attack(forall(true, halt)).
attack(\+ halt).
attack(catch(true, _, halt) ; halt).
attack(catch(halt, _, true)).
attack(catch_with_backtrace(true, _, true)).
attack(catch(throw(x), _, halt)).
attack(setup_call_cleanup(true, true, halt)).
attack(call_cleanup(true, halt)).
attack(throw('$aborted')).
attack(throw(unwind(halt(0)))).
attack(throw(inference_limit_exceeded(_))).
attack((length(L, 20000), throw(L))).
attack(call_with_inference_limit(true, 1, _)).
attack(call_with_time_limit(1, true)).
attack(prolog_cut_to(1)).
attack('$cut'(1)).
attack('$at'(x, halt)).
attack('$fault'(x)).
attack('$set_source_module'(user)).
attack('$destroy_module'(user)).
attack(prolog_current_frame(_)).
attack(prolog_skip_level(_, 1)).
attack(put_attr(_, user, x)).
attack(freeze(_, halt)).
attack(when(ground(_), halt)).
attack(dif(_, _)).
attack(del_attrs(_)).
attack(tnot(x)).
attack(abolish_all_tables).
attack(garbage_collect).
attack(garbage_collect_atoms).
attack(trim_stacks).
attack(trace).
attack(spy(foo)).
attack(protocol(x)).
attack(print_message(error, format("~@", [halt]))).
attack(message_to_string(format("~@", [halt]), _)).
attack(assertion(fail)).
attack(debug(typhon(_))).
attack(format("~w", [x])).
attack(format(user_error, "~w", [x])).
attack(format(string(_), "~@", [halt])).
attack(format(string(_), "~p", [x])).
attack(format(string(_), "~*c", [100000000, 0'x])).
attack(format(string(_), "~9999999|", [])).
attack(format(atom(_), "~w", [x])).
attack(with_output_to(string(_), halt)).
attack(term_to_atom(_, '{|html||x|}')).
attack(term_string(_, "{|html||x|}")).
attack(normalize_space(user_error, x)).
attack(sformat(_, "x", [])).
attack(phrase(halt, [])).
attack(phrase({halt}, [])).
attack(phrase(user:x, [])).
attack(maplist(halt, [])).
attack(maplist([X]>>shell(X), [true])).
attack(maplist(user:foo, [1])).
attack(foldl([X,Y,Y]>>(call(user:X)), [true], a, _)).
attack(aggregate_all(count, shell(_), _)).
attack(aggregate_all(count, user:true, _)).
attack(aggregate_all(bag(x), _^shell(x), _)).
attack(maplist(aggregate_all(bag(x)), [_^shell(x)], _)).
attack(aggregate_all(count, x, _^shell(x), _)).
attack(group_by(x, x, _^shell(x), _)).
attack(call(call, halt)).
attack(call(call(call), shell, x)).
attack(call(',', true, halt)).
attack(call((',')/2, true)).
attack(apply(halt, [])).
attack(not(halt)).
attack(once(ignore((true, halt)))).
attack((true -> halt ; true)).
attack((fail *-> true ; halt)).
attack(set_random(seed(1))).
attack(deliver(x)).
attack(undeliver(x)).
attack(attach('/etc/passwd')).
attack(attach(library(lists))).
attack(attach(payloads('../../x'))).
attack(tcp_socket(_)).
attack(host_stop(g)).
attack(host_start(other)).
attack(remote(g, halt)).
attack(agent_dispose(x)).
attack(agent_create(x, _)).
attack(variant_sha1(x, _)).
attack(sleep(1, 2, 3) ; consult(x)).

refused(Goal) :-
    \+ \+ lets_in_no(Goal),
    \+ \+ raises_in(call(G), G, Goal),
    \+ \+ raises_in(findall(x, G, _), G, Goal),
    \+ \+ raises_in(maplist([A]>>A, [G]), G, Goal).

%   A goal written in the program: its agent is refused, or stopped at the
%   goal.

lets_in_no(Goal) :-
    catch(( create([(main :- Goal)], A, [host(g)]),
            joined_guarded(A, raised(error(Formal, _))) ),
          error(Formal, _), true),
    of_policy(Formal).

raises_in(Call, G, Goal) :-
    create([(main :- goal(G), Call), goal(Goal)], A, [host(g)]),
    joined_guarded(A, Outcome),
    Outcome = raised(error(Formal, _)),
    of_policy(Formal).

joined_guarded(A, Outcome) :-
    agent_join(A, Outcome, 60).

of_policy(move_refused(_, policy(_))).
of_policy(permission_error(call, sandboxed, _)).
of_policy(permission_error(_, _, _)).
of_policy(existence_error(procedure, _)).

%   below_variables(-Goal): Goal, which untrusted agents may call, has an
%   argument with a forbidden goal below a variable. Some libraries call such a
%   goal, whatever their specification says.

below_variables(Goal) :-
    allowed_goal(_, runs(Spec)),
    member(Other, [x, _, count, bag(x), [1,2]]),
    member(Below, [_^Harm, _^_^Harm, x^Harm]),
    Harm = flag(typhon_guard_escaped, _, 1),
    Spec =.. [Name|Modes],
    maplist(given(Other, Below), Modes, Args),
    Goal =.. [Name|Args].

given(_, Below, Mode, Arg), memberchk(Mode, [0, ^]) =>
    Arg = Below.
given(_, _, Mode, Arg), integer(Mode) =>
    Arg = true.
given(Other, _, _, Arg) =>
    Arg = Other.

made_up(Goals, Own) :-
    findall(goal(G), member(G, Goals), Facts),
    append([(main :- goal(G), catch(G, _, true), fail), main|Own], Facts,
           Clauses),
    outcome(Clauses, done).

as_written(Goal) :-
    catch(outcome([(main :- catch(Goal, _, true))], _),
          error(move_refused(_, policy(_)), _), true).

outcome(Clauses, Outcome) :-
    create(Clauses, A, [host(g)]),
    joined_guarded(A, Outcome).

:- begin_tests(guard).

test(each_attack_is_refused, Through == []) :-
    with_hosts([g-[policy(guarded), cell(none)]],
               capturing(findall(G, limit(1, ( attack(G), \+ refused(G) )),
                                 Through), _)).

test(constructed_goals_are_checked, Escaped-Count == 0-many) :-
    flag(typhon_guard_escaped, _, 0),
    with_hosts([g-[policy(guarded), cell(none)]],
               ( findall(Goal, below_variables(Goal), Goals),
                 made_up(Goals, []),
                 made_up(Goals, [(_^_ :- true)]),
                 forall(member(Goal, Goals), as_written(Goal)) )),
    flag(typhon_guard_escaped, Escaped, 0),
    ( Goals = [_,_,_|_] -> Count = many ; Count = few ).

%   Permitted goals run.

test(ordinary_programs_run, R-Facts == [2-a,4-b]-[ok]) :-
    with_hosts([g-[policy(guarded), cell(none)], t],
               ( create([ (main :- assertz(s(ok)), numlist(1, 4, Ns),
                                   include([X]>>(0 is X mod 2), Ns, Even),
                                   pairs_keys_values(Ps, Even, [a,b]),
                                   each(go, [t,g]), findall(F, s(F), Fs),
                                   result(Ps-Fs)),
                          each(_, []),
                          (each(G, [X|Xs]) :- call(G, X), each(G, Xs)),
                          (go(H) :- sleep(0.001), move(H)) ], A, [host(g)]),
                 agent_result(A, R-Facts, 5) )).
test(move_inside_a_constructed_goal, H == H0) :-
    with_hosts([g-[policy(guarded), cell(none)], t],
               ( address(g, H0),
                 create([ (main :- G = (move(t), move(g)), call(G), here(H),
                                   result(H)) ], A, [host(t)]),
                 agent_result(A, H, 5) )).
test(carried_clauses_are_checked_on_arrival,
     R = error(move_refused(_, policy(halt)), _)) :-
    with_hosts([g-[policy(guarded), cell(none)], t],
               ( create([ (main :- assertz((s(_) :- halt)),
                                   catch(move(g), E, true), result(E)) ],
                        A, [host(t)]),
                 agent_result(A, R, 5) )).
test(pending_goals_are_checked_on_arrival,
     R = error(move_refused(_, policy(shell(x))), _)) :-
    with_hosts([g-[policy(guarded), cell(none)], t],
               ( create([ (main :- G = (move(g), shell(x)),
                                   catch(call(G), E, true), result(E)) ],
                        A, [host(t)]),
                 agent_result(A, R, 5) )).
test(only_services_of_the_place_are_callable, Rs == [open(1),hidden]) :-
    with_tmp_dir(places(Rs)).
test(service_calls_are_limited,
     Rs = done-raised(error(resource_error(calls(open/1)), _))) :-
    with_tmp_dir(often(Rs)).
%   The agent's own predicate of that name precedes the service.

test(services_cannot_be_changed_or_read, Rs == [[],[],[],[x],[x]]-[1,2]) :-
    with_tmp_dir(changes_of_services(Rs)).
test(rules_in_a_file, Os == [done,refused]) :-
    with_tmp_dir(by_rules(Os)).
test(check_reports_refusals_beforehand, Ms = [_]) :-
    capturing(\+ agent_check(clauses([(:- agent(x, [])), (main :- halt)]),
                             [policy(guarded)]),
              Ms0),
    findall(W, member(error-typhon(not_let_in(W, _)), Ms0), Ms).
test(check_of_admissible_programs) :-
    capturing(agent_check(clauses([(:- agent(x, [])), (main :- self(_))]),
                          [policy(guarded)]),
              _).
test(changed_policy_applies_from_now_on,
     O = error(move_refused(_, policy(halt)), _)) :-
    with_hosts([g-[cell(none)]],
               ( host_change(g, policy(guarded)),
                 catch(create([(main :- halt)], _, [host(g)]), O, true) )).
test(no_such_policy, error(existence_error(_, _))) :-
    host_start(g, [policy('/no/such/file')]).

:- end_tests(guard).

place_file(Dir, File) :-
    directory_file_path(Dir, 'place.pl', File),
    write_file(File, ":- service(open/1).~n:- dynamic open/1.~n~w",
                     ["open(1).\nopen(2).\nhidden(1).\n"]).

places(Rs, Dir) :-
    place_file(Dir, File),
    with_hosts([g-[policy(guarded), cell(none), consult(File)]],
               ( create([ (main :- once(open(X)),
                                   catch(( hidden(_), Y = seen ), _,
                                         Y = hidden),
                                   result([open(X),Y])) ], A, [host(g)]),
                 agent_result(A, Rs, 5) )).

%   Twice in a second, each time with two answers.

often(Often-Outcome, Dir) :-
    place_file(Dir, File),
    with_hosts([g-[ policy(guarded), cell(none), consult(File),
                    quota([owner(calls(open/1, 2))]) ]],
               ( created([ (main :- forall(open(_), true),
                                    forall(open(_), true)) ], A),
                 agent_join(A, Often, 5),
                 created([ (main :- repeat, catch(open(_), _, true), fail) ], B),
                 capturing(agent_join(B, Outcome, 5), _) )).

created(Clauses, A) :-
    create(Clauses, A, [host(g)]).

changes_of_services(Rs-Left, Dir) :-
    place_file(Dir, File),
    with_hosts([g-[policy(guarded), cell(none), consult(File)]],
               ( create([ (main :- once(open(_)), Gs = [ retract(open(1)),
                                       clause(open(_), _),
                                       retract(hidden(_)),
                                       retractall(open(_)),
                                       assertz(open(9)) ],
                                   findall(R, ( member(G, Gs),
                                                findall(x, catch(G, _, fail),
                                                        R) ), Rs),
                                   result(Rs)) ], A, [host(g)]),
                 agent_result(A, Rs, 5),
                 findall(X, remote(g, open(X)), Firsts),
                 remote(g, findall(X, open(X), Left)),
                 Firsts == [1] )).

by_rules([O1,O2], Dir) :-
    directory_file_path(Dir, rules, File),
    write_file(File, "allow(current_op/3).~nrefuse(send/2).~n", []),
    with_hosts([g-[policy(File), cell(none)]],
               ( outcome([(main :- once(current_op(_, _, mod)))], O1),
                 catch(outcome([(main :- send(user, x))], O2),
                       error(move_refused(_, policy(send(_, _))), _),
                       O2 = refused) )).

                /*******************************
                *            QUOTAS            *
                *******************************/

%   hog(?What, -Clauses): an agent that uses more of the resource What than
%   allowed.

hog(seconds, [ (main :- lp), (lp :- lp) ]).
hog(seconds, [ (main :- repeat, fail) ]).
hog(seconds, [ (main :- catch(lp, _, true), main), (lp :- lp) ]).
hog(seconds, [ (main :- again), (again :- \+ s(x), again) ]).
hog(inferences, [ (main :- lq(0)), (lq(N) :- M is N+1, lq(M)) ]).
hog(stack, [ (main :- lr(0)), (lr(N) :- M is N+1, lr(M), true) ]).
hog(stack, [ (main :- ls("abc")), (ls(S) :- string_concat(S, S, T), ls(T)) ]).
hog(stack, [ (main :- X is 7^7^7^7, X > 0) ]).
hog(state, [ (main :- between(1, inf, X), assertz(s(X)), fail) ]).
hog(tuples, [ (main :- between(1, inf, X), leave(s(X)), fail) ]).
hog(clones, [ (main :- clone(_), main) ]).
hog(messages, [ (main :- self(Me), between(1, inf, X), send(Me, X), fail) ]).
hog(messages, [ (main :- self(Me), catch(( between(1, inf, X), send(Me, X),
                                           fail ), _, true)) ]).
hog(log, [ (main :- between(1, inf, X), log(X), fail) ]).
hog(cells, [ (main :- dag(40, a, T), send(user, T)), dag(0, T, T),
             (dag(N, T0, T) :- N > 0, M is N-1, dag(M, f(T0,T0), T)) ]).
hog(cells, [ (main :- X = f(X), result(X)) ]).
hog(clause_cells, [ (main :- dag(40, a, T), assertz(s(T))), dag(0, T, T),
                    (dag(N, T0, T) :- N > 0, M is N-1,
                                      dag(M, f(T0,T0), T)) ]).

stays([ (main :- p), (p :- catch(lp, _, p)), (lp :- lp) ]).
stays([ (main :- findall(x, p, _)), (p :- catch(lp, _, p)), (lp :- lp) ]).
stays([ (main :- G = catch(lp, _, main), findall(x, G, _)), (lp :- lp) ]).

names(I) :-
    findall((s(J) :- Name),
            ( between(1, 200, J),
              atomic_list_concat([stranger, I, J], '_', Name) ),
            Clauses),
    agent_create(clauses([ (:- agent(names, [])), on_message(_, _)
                         | Clauses ]), _, [host(g)]).

stack_limit(Old, New) :-
    current_prolog_flag(stack_limit, Old),
    set_prolog_flag(stack_limit, New).

brim([ (main :- f, main), (f :- catch(f, _, f), f) ]).
brim([ (main :- f([])), (f(L) :- catch(f([x,y,z|L]), _, f(L)), f(L)) ]).
brim([ (main :- f(a)), (f(T) :- catch(f(s(T,T,T,T)), E, f(E)), f(T)) ]).
brim([ (main :- findall(x, ( repeat, catch(g(0), _, true) ), _)),
       (g(N) :- M is N+1, catch(g(M), _, g(M)), true) ]).

quotas([ stack(16 000 000), state(200 000), tuples(50), clones(20),
         messages(100), log(10) ]).

%   On a busy machine a hog of another resource takes long.

quota_of(seconds, [seconds(0.3)|Quotas]) :- !, quotas(Quotas).
quota_of(inferences, [inferences(100 000),seconds(60)|Quotas]) :-
    !,
    quotas(Quotas).
quota_of(_, [seconds(60)|Quotas]) :- quotas(Quotas).

is_of(What, What).
is_of(tripwire(max_integer_size, _), stack).    % in 9.2

:- begin_tests(quotas).

%   The results or the stack that receives them may exceed a quota first.

test(endless_findall_exceeds_a_quota,
     true(memberchk(What, [seconds, stack]))) :-
    quota_of(seconds, Quotas),
    with_hosts([g-[policy(guarded), cell(none), quota(Quotas)]],
               capturing(outcome([ (main :- findall(X, between(1, inf, X), _)) ],
                                 Outcome), _)),
    Outcome = raised(error(resource_error(What), _)).
%   An agent that catches the interrupt cannot continue by any goal.

test(caught_interrupt_ends_the_agent_at_once, [ forall(stays(Clauses)),
                                                true(Seconds < 3) ]) :-
    quota_of(seconds, Quotas),
    get_time(T0),
    with_hosts([g-[policy(guarded), cell(none), quota(Quotas)]],
               capturing(outcome(Clauses,
                                 raised(error(resource_error(seconds), _))),
                         _)),
    get_time(T1),
    Seconds is T1-T0.
%   An agent that repeatedly fills its stack to the limit would end the
%   process. The limit is four times the quota: more than the agent fills
%   between two checks.

test(stack_is_limited,
     [ forall(brim(Clauses)), setup(stack_limit(Old, 60 000 000)),
       cleanup(set_prolog_flag(stack_limit, Old)),
       Outcome = raised(error(resource_error(stack), _)) ]) :-
    with_hosts([g-[ policy(guarded), cell(none),
                    quota([seconds(60), stack(64 000 000)]) ]],
               capturing(outcome(Clauses, Outcome), _)).
test(exceeding_a_quota_ends_the_agent,
     [ forall(hog(What, Clauses)), true(is_of(Resource, What)) ]) :-
    quota_of(What, Quotas),
    with_hosts([g-[policy(guarded), cell(none), quota(Quotas)]],
               capturing(outcome(Clauses, Outcome), _)),
    Outcome = raised(error(resource_error(Resource), _)).
test(other_agents_continue, N == 20) :-
    quota_of(seconds, Quotas),
    with_hosts([g-[policy(guarded), cell(none), quota(Quotas)], t],
               capturing(( hog(seconds, Hog),
                           create(Hog, _, [host(g)]),
                           create([ (main :- lap(0)),
                                    (lap(20) :- !, result(20)),
                                    (lap(I) :- move(t), move(g), J is I+1,
                                               lap(J)) ], A, [host(g)]),
                           agent_result(A, N, 10) ), _)).
test(trusted_hosts_have_quotas_too,
     Outcome = raised(error(resource_error(seconds), _))) :-
    with_hosts([g-[quota([seconds(0.2)])]],
               capturing(outcome([ (main :- lp), (lp :- lp) ], Outcome), _)).

%   The cache of predicates that agents name is bounded.

test(cached_predicates_are_bounded, true(Count < 300)) :-
    with_settings([typhon_mobile:known=100],
                  with_hosts([g-[policy(guarded), cell(none)]],
                             forall(between(1, 4, I), names(I)))),
    state_size(typhon_mobile, Count).
test(no_such_quota, error(domain_error(quota, x(1)))) :-
    host_start(g, [quota([x(1)])]).

:- end_tests(quotas).
