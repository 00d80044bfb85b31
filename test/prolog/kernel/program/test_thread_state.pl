:- module(test_thread_state, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/random_programs', [program_installed/3]).
:- use_module(library(gensym)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/program), [machine_run/3]).

/** <module> What agents change in their thread, and what they may not change

*Threading*: one test at a time.
*/

%   outcome(+Clauses, -Outcome): an agent of Clauses runs in this thread, from
%   stop to stop.

outcome(Clauses, Outcome) :-
    program_installed([(:- agent(test, [state([later/0])]))|Clauses], Module,
                      _),
    gensym('test agent ', Agent),
    setup_call_cleanup(
        ( set_module(Agent:class(temporary)),
          set_module(Agent:base(Module)),
          add_import_module(Agent, typhon_vocabulary, end) ),
        steps(context(Module, Agent), [main], Outcome),
        '$destroy_module'(Agent)).

steps(Context, Goals0, Outcome) :-
    machine_run(Context, Goals0, Outcome0),
    (   Outcome0 = effect(_, true, Goals)
    ->  steps(Context, Goals, Outcome)
    ;   Outcome = Outcome0
    ).

%   way(+Goal, -Clauses) is nondet: programs that call Goal in all ways.

way(Goal, [(main :- Goal)]).
way(Goal, [(main :- Goal, sleep(0))]).
way(Goal, [(main :- catch((true, Goal), none, true))]).
way(Goal, [(main :- findall(x, (Goal, true), _))]).
way(Goal, [(main :- sleep(0), forall((true ; fail), (true, Goal)))]).
way(Goal, [(main :- run(Goal)), (run(G) :- call(G))]).
way(Goal, [(main :- run(Goal)), (run(G) :- findall(x, G, _))]).
way(Goal, [(main :- run(Goal), throw(end)), (run(G) :- G, sleep(0))]).
way(Goal, [(main :- run(Goal), abort), (run(G) :- G)]).

%   changes(?Goal, -Look): Goal changes what Look of this thread shows.

changes(set_output(S), current_output) :- null(S).
changes(set_input(S), current_input) :-
    stream_property(S, alias(test_null_in)).
changes(tell('/dev/null'), current_output).
changes(append('/dev/null'), current_output).
changes(see('/dev/null'), current_input).
changes(set_prolog_flag(Flag, Value), current_prolog_flag(Flag)) :-
    flag(Flag, Value).
changes(style_check(-discontiguous), style).
changes(prompt(_, 'test> '), prompt).
changes(set_random(seed(1)), random_property).
changes(( locale_create(L, 'C', [decimal_point(',')]), set_locale(L) ),
        current_locale).
changes(set_prolog_stack(global, spare(400 000)), spare_stack).
changes(mutex_lock(test_thread_state), status(test_thread_state)).
changes(nb_setval(test_key, 1), nb_current(test_key)).
changes(b_setval(test_key, 1), nb_current(test_key)).
changes(nb_setval(typhon_turns, none), nb_current(typhon_turns)).

flag(Flag, Value) :-
    member(Flag-Value,
           [ occurs_check-true, occurs_check-error, double_quotes-atom,
             (user:double_quotes)-atom, unknown-fail, iso-true,
             prefer_rationals-true, optimise-true, last_call_optimisation-false,
             generate_debug_info-false, character_escapes-false,
             float_zero_div-infinity, stack_limit-500 000 000, gc-false ]).

null(S) :-
    stream_property(S, alias(test_null)).

%   look(+Look, -Seen)

look(style, Seen) :- !, '$style_check'(Seen, Seen).
look(prompt, Seen) :- !, prompt(Seen, Seen).
look(spare_stack, Seen) :- !, prolog_stack_property(global, spare(Seen)).
look(random_property, Seen) :- !, random_property(state(Seen)).
look(status(Mutex), Seen) :-
    !,
    ( catch(mutex_property(Mutex, status(S)), error(_, _), fail) -> Seen = S
    ; Seen = unlocked
    ).
look(Look, Seen) :-
    (   call(Look, Value)
    ->  Seen = value(Value)
    ;   Seen = none
    ).

left_changed(Goal-Clauses) :-
    changes(Goal, Look),
    look(Look, Before),
    way(Goal, Clauses),
    outcome(Clauses, _),
    look(Look, After),
    After \== Before.

with_streams(Goal) :-
    setup_call_cleanup(
        ( open('/dev/null', write, Out, [alias(test_null)]),
          open('/dev/null', read, In, [alias(test_null_in)]) ),
        Goal,
        ( set_output(user_output), set_input(user_input),
          close(Out), close(In) )).

refused(Goal) :-
    thread_self(Me),
    member(Goal,
           [ format_predicate(_, _), trace, trace(_), trace(_, _), spy(_),
             nospyall, debug, nodebug, leash(_), visible(_), tspy(_),
             set_breakpoint(_, _, _, _), abort, thread_exit(_), at_halt(_),
             on_signal(_, _, _), working_directory(_, '/'), umask(_, 0),
             setlocale(ctype, _, 'C.UTF-8'),
             thread_detach(Me), cancel_halt(_), protocol(_), detach_IO,
             chdir('/'), set_stream(user_output, tty(false)),
             set_stream(_, alias(user_error)), redefine_system_predicate(_) ]).

not_refused(Goal, Clauses, Outcome) :-
    refused(Goal),
    functor(Goal, Name, Arity),
    way(Goal, Clauses),
    outcome(Clauses, Outcome),
    \+ Outcome = raised(error(permission_error(call, process_predicate,
                                               Name/Arity), _)).

:- begin_tests(thread_state).

test(a_step_leaves_the_thread_as_it_was, Found == []) :-
    with_streams(findall(Change, test_thread_state:left_changed(Change),
                         Found)).
test(predicates_that_would_break_the_process_raise, Found == []) :-
    findall(Goal-Clauses-Outcome,
            test_thread_state:not_refused(Goal, Clauses, Outcome), Found).
test(a_program_may_define_them, Outcome == done) :-
    outcome([(main :- spy(a), visible(a), nb_setval(1)),
             spy(a), visible(a), nb_setval(1)], Outcome).
test(they_are_as_always_in_another_thread, Outcome == done) :-
    outcome([(main :- thread_create(( nb_setval(test_key, 1),
                                      nb_getval(test_key, 1),
                                      set_prolog_flag(occurs_check, true) ),
                                    Id),
                      thread_join(Id, true),
                      \+ nb_current(test_key, _))], Outcome).

test(variables_survive_a_stop, Outcome == done) :-
    outcome([ (main :- nb_setval(n, 1), b_setval(l, [a,B,B]), sleep(0),
                       nb_getval(n, N), b_getval(l, [a,X,Y]), X == Y,
                       N1 is N+1, nb_setval(n, N1), sleep(0),
                       findall(K, nb_current(K, _), Ks),
                       msort(Ks, [l,n]), nb_getval(n, 2),
                       nb_delete(l), sleep(0), \+ nb_current(l, _)) ],
            Outcome).
test(backtracking_restores_what_b_setval_set, Outcome == done) :-
    outcome([(main :- nb_setval(n, 0), ( b_setval(n, 1), fail ; true ),
                      nb_getval(n, 0), sleep(0), nb_getval(n, 0))],
            Outcome).
test(a_variable_that_does_not_exist,
     Outcome = raised(error(existence_error(variable, n), _))) :-
    outcome([(main :- nb_getval(n, _))], Outcome).
test(values_that_no_fact_can_have_end_with_the_step, Outcome == done) :-
    outcome([(main :- freeze(X, true), nb_setval(n, X), C = f(C),
                      nb_setval(c, C), sleep(0),
                      \+ nb_current(n, _), \+ nb_current(c, _))], Outcome).
test(variables_travel_and_are_cloned, Values == [1,1]) :-
    with_hosts([alpha,beta], test_thread_state:travelled(Values)).
test(an_agent_that_is_aborted_is_reported, Kinds == [aborted]) :-
    with_hosts([alpha], test_thread_state:aborted(Kinds)).
test(an_abort_cannot_be_caught,
     [ forall(catches(Goal)), true(Outcome-Left == disposed-[]) ]) :-
    with_hosts([alpha],
               ( capturing(( create([(main :- Goal, leave(survived))], A),
                             joined(A, Outcome) ), _),
                 remote(alpha, findall(X, sense(X), Left)) )).

:- end_tests(thread_state).

catches(catch(system:abort, _, true)).
catches(catch(( sleep(0), system:abort ), _, true)).
catches(catch(( sleep(0), catch(system:abort, _, true) ), _, sleep(0))).
catches(catch(system:abort, _, ( true ; sleep(0) ))).

travelled([Value,Cloned]) :-
    create([ (main :- nb_setval(n, 1), move(beta), nb_getval(n, N),
                      clone(Role),
                      ( Role = clone(_) -> nb_getval(n, C), leave(cloned(C))
                      ; leave(moved(N)) )) ], A, [host(alpha)]),
    agent_join(family(A), [_-done,_-done], 20),
    remote(beta, (take(moved(Value)), take(cloned(Cloned)))).

aborted(Kinds) :-
    capturing(( create([(main :- system:abort)], A, [host(alpha)]),
                joined(A, disposed) ), Messages),
    findall(aborted, member(warning-typhon(aborted(A)), Messages), Kinds).
