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

attack(Goal) :-
    member(Name/Arity,
           [ halt/0, halt/1, abort/0, close/1, close/2, set_output/1, see/1,
             open/3, write/1, writeln/1, nl/0, print/1, read/1, read_term/3,
             read_term_from_atom/3, consult/1, load_files/2, use_module/1,
             use_foreign_library/1, open_shared_object/2, shell/1,
             process_create/3, delete_file/1, exists_file/1, getenv/2,
             setenv/2, working_directory/2, thread_create/2, thread_self/1,
             thread_exit/1, thread_signal/2, thread_send_message/2,
             thread_get_message/1, thread_join/2, mutex_lock/1, with_mutex/2,
             message_queue_create/1, set_prolog_flag/2, current_prolog_flag/2,
             create_prolog_flag/3, set_stream/2, op/3, nb_setval/2, b_setval/2,
             nb_getval/2, nb_current/2, flag/3, set_flag/2, recorda/2,
             abolish/1, (dynamic)/1, predicate_property/2, current_predicate/1,
             current_module/1, module/1, set_module/1, add_import_module/3,
             import_module/2, catch_with_backtrace/3,
             call_with_inference_limit/3, call_with_time_limit/2,
             prolog_cut_to/1, '$set_source_module'/1, '$destroy_module'/1,
             prolog_current_frame/1, prolog_skip_level/2, put_attr/3,
             freeze/2, when/2, dif/2, del_attrs/1, tnot/1,
             abolish_all_tables/0, garbage_collect/0, garbage_collect_atoms/0,
             trim_stacks/0, trace/0, spy/1, protocol/1,
             message_to_string/2, assertion/1, debug/1, format/2,
             normalize_space/2, sformat/3, set_random/1, tcp_socket/1,
             variant_sha1/2 ]),
    functor(Goal, Name, Arity).
attack(Goal) :-
    member(Goal,
           [ asserta(user:portray(_)), assertz((user:portray(_) :- true)),
             assertz((portray(_) :- halt)), assertz((p(X) :- user:X)),
             assertz('$mobile'(_, _, _, _, _, _)),
             assertz('mobile main'([], [], _)),
             assertz((term_expansion(_, _) :- shell(x))),
             assertz((goal_expansion(_, _) :- shell(x))),
             assertz((attr_unify_hook(_, _) :- halt)),
             retract(typhon_agents:agent(_, _, _, _, _)),
             retract((user:portray(_) :- _)), retractall(system:foo(_)),
             retractall('$tuple'(_)), clause(typhon_words:send(_, _), _),
             @(true, user), user:true, system:halt,
             typhon_place:place_destroy(x), findall(_, user:true, _),
             setof(_, _^halt, _), setof(_, _^user:true, _), forall(true, halt),
             \+ halt, (catch(true, _, halt) ; halt), catch(halt, _, true),
             catch(throw(x), _, halt), throw('$aborted'),
             throw(unwind(halt(0))), throw(inference_limit_exceeded(_)),
             (length(L, 20000), throw(L)), '$cut'(1), '$at'(x, halt),
             '$fault'(x), format(user_error, "~w", [x]),
             format(string(_), "~@", [halt]), format(string(_), "~p", [x]),
             format(string(_), "~*c", [100000000, 0'x]),
             format(string(_), "~9999999|", []), format(atom(_), "~w", [x]),
             term_to_atom(_, '{|html||x|}'), term_string(_, "{|html||x|}"),
             maplist(halt, []), maplist([X]>>shell(X), [true]),
             maplist(user:foo, [1]),
             foldl([X,Y,Y]>>(call(user:X)), [true], a, _),
             aggregate_all(count, shell(_), _),
             aggregate_all(count, user:true, _),
             aggregate_all(bag(x), _^shell(x), _),
             maplist(aggregate_all(bag(x)), [_^shell(x)], _),
             aggregate_all(count, x, _^shell(x), _),
             group_by(x, x, _^shell(x), _), once(ignore((true, halt))),
             (true -> halt ; true), (fail *-> true ; halt),
             attach('/etc/passwd'), attach(library(lists)),
             attach(payloads('../../x')), host_stop(g), host_start(other),
             remote(g, halt), agent_dispose(x), agent_create(x, _),
             deliver(x), undeliver(x), call(user:true), call(call, halt),
             call(call(call), shell, x), call(',', true, halt),
             call((',')/2, true), apply(halt, []), not(halt), phrase(halt, []),
             phrase({halt}, []), phrase(user:x, []), call_cleanup(true, halt),
             setup_call_cleanup(true, true, halt),
             with_output_to(string(_), halt), (sleep(1, 2, 3) ; consult(x)),
             print_message(error, format("~@", [halt])) ]).

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

:- meta_predicate with_place(+, 0).

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

%   ran(-Name, -Clauses, -Result): what an agent of Clauses that begins on g, or
%   on t if it has to arrive, gives.

ran(ordinary, g,
    [ (main :- assertz(s(ok)), numlist(1, 4, Ns),
               include([X]>>(0 is X mod 2), Ns, Even),
               pairs_keys_values(Ps, Even, [a,b]), each(go, [t,g]),
               findall(F, s(F), Fs), result(Ps-Fs)),
      each(_, []),
      (each(G, [X|Xs]) :- call(G, X), each(G, Xs)),
      (go(H) :- sleep(0.001), move(H)) ], [2-a,4-b]-[ok]).
ran(moves_inside_a_constructed_goal, t,
    [ (main :- G = (move(t), move(g)), call(G), here(H),
               sub_atom(H, 0, 2, _, Start), result(Start)) ], 'g@').
ran(carried_clauses_are_checked, t,
    [ (main :- assertz((s(_) :- halt)), catch(move(g), E, true),
               result(E)) ], error(move_refused(_, policy(halt)), _)).
ran(pending_goals_are_checked, t,
    [ (main :- G = (move(g), shell(x)), catch(call(G), E, true), result(E)) ],
    error(move_refused(_, policy(shell(x))), _)).

guarded([g-[policy(guarded), cell(none)], t]).

test(permitted_goals_run,
     [forall(ran(_, Host, Clauses, Expected)), true(Result = Expected)]) :-
    guarded(Hosts),
    with_hosts(Hosts, ( create(Clauses, A, [host(Host)]),
                        agent_result(A, Result, 5) )).

%   A place with the service open/1, and what an agent of Body gives there.

with_place(Options, Goal) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'place.pl', File),
          write_file(File, ":- service(open/1).~n:- dynamic open/1.~n\c
                            open(1).~nopen(2).~nhidden(1).~n", []),
          with_hosts([g-[policy(guarded), cell(none), consult(File)|Options]],
                     capturing(Goal, _)) )).

test(only_services_of_the_place_are_callable, Rs == [open(1),hidden]) :-
    with_place([],
               ( create([ (main :- once(open(X)),
                                   catch(( hidden(_), Y = seen ), _,
                                         Y = hidden),
                                   result([open(X),Y])) ], A, [host(g)]),
                 agent_result(A, Rs, 5) )).

%   Twice in a second, each time with two answers.

test(service_calls_are_limited,
     [true(Often-More = done-raised(error(resource_error(calls(open/1)), _)))]) :-
    with_place([quota([owner(calls(open/1, 2))])],
               ( outcome([ (main :- forall(open(_), true),
                                    forall(open(_), true)) ], Often),
                 outcome([ (main :- repeat, catch(open(_), _, true),
                                    fail) ], More) )).

%   The agent's own predicate of that name precedes the service.

test(services_cannot_be_changed_or_read, Rs-Left == [[],[],[],[x],[x]]-[1,2]) :-
    with_place([],
               ( create([ (main :- once(open(_)), Gs = [ retract(open(1)),
                                       clause(open(_), _),
                                       retract(hidden(_)),
                                       retractall(open(_)),
                                       assertz(open(9)) ],
                                   findall(R, ( member(G, Gs),
                                                findall(x, catch(G, _, fail),
                                                        R) ), Rs0),
                                   result(Rs0)) ], A, [host(g)]),
                 agent_result(A, Rs, 5),
                 remote(g, findall(X, open(X), Left)) )).
test(rules_in_a_file, [O1,O2] == [done,refused]) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, rules, File),
          write_file(File, "allow(current_op/3).~nrefuse(send/2).~n", []),
          with_hosts([g-[policy(File), cell(none)]],
                     ( outcome([(main :- once(current_op(_, _, mod)))], O1),
                       catch(outcome([(main :- send(user, x))], O2),
                             error(move_refused(_, policy(send(_, _))), _),
                             O2 = refused) )) )).
test(check_reports_refusals_beforehand,
     [forall(member(Goal-Count, [halt-1, self(_)-0])), true(Said == Count)]) :-
    capturing(ignore(agent_check(clauses([(:- agent(x, [])), (main :- Goal)]),
                                 [policy(guarded)])), Ms),
    findall(W, member(error-typhon(not_let_in(W, _)), Ms), Ws),
    length(Ws, Said).
test(changed_policy_applies_from_now_on,
     O = error(move_refused(_, policy(halt)), _)) :-
    with_hosts([g-[cell(none)]],
               ( host_change(g, policy(guarded)),
                 catch(create([(main :- halt)], _, [host(g)]), O, true) )).
test(no_such_policy, error(existence_error(_, _))) :-
    host_start(g, [policy('/no/such/file')]).

:- end_tests(guard).

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

%   On a host with Quotas, Outcome is that of an agent of Clauses.

on_quota(Quotas, Clauses, Outcome) :-
    with_hosts([g-[policy(guarded), cell(none), quota(Quotas)]],
               capturing(outcome(Clauses, Outcome), _)).

is_of(What, What).
is_of(tripwire(max_integer_size, _), stack).    % in 9.2

:- begin_tests(quotas).

%   The results or the stack that receives them may exceed a quota first.

test(endless_findall_exceeds_a_quota,
     true(memberchk(What, [seconds, stack]))) :-
    quota_of(seconds, Quotas),
    on_quota(Quotas, [(main :- findall(X, between(1, inf, X), _))], Outcome),
    Outcome = raised(error(resource_error(What), _)).
%   An agent that catches the interrupt cannot continue by any goal.

test(caught_interrupt_ends_the_agent_at_once, [ forall(stays(Clauses)),
                                                true(soon(Seconds, 3)) ]) :-
    quota_of(seconds, Quotas),
    get_time(T0),
    on_quota(Quotas, Clauses, raised(error(resource_error(seconds), _))),
    get_time(T1),
    Seconds is T1-T0.
%   An agent that repeatedly fills its stack to the limit would end the
%   process. The limit is four times the quota: more than the agent fills
%   between two checks.

test(stack_is_limited,
     [ forall(brim(Clauses)), setup(stack_limit(Old, 60 000 000)),
       cleanup(set_prolog_flag(stack_limit, Old)),
       Outcome = raised(error(resource_error(stack), _)) ]) :-
    on_quota([seconds(60), stack(64 000 000)], Clauses, Outcome).
test(exceeding_a_quota_ends_the_agent,
     [ forall(hog(What, Clauses)), true(is_of(Resource, What)) ]) :-
    quota_of(What, Quotas),
    on_quota(Quotas, Clauses, raised(error(resource_error(Resource), _))).
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
