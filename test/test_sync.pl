:- use_module(common, [project_file/2]).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(readutil)).
:- include('../agents/sync/potential').

/** <module> Synchronised execution: equations and decisions

No network here: the agents' decisions are tried on a host that is a few
facts.  The whole is tried in test_demo.pl.
*/

                /*******************************
                *           EQUATIONS          *
                *******************************/

%   steps(+Delta, +Rewarded, -ToOne, -ToZero): the number of steps until the
%   potential is at most 1, and until it is 0, of an agent that is rewarded
%   in the steps Rewarded and penalised in all others.

steps(Delta, Rewarded, ToOne, ToZero) :-
    drive_after(Delta, Rewarded, 1, 0, drive(100, [15]), ToOne),
    drive_after(Delta, Rewarded, 0, 0, drive(100, [15]), ToZero).

drive_after(_, _, Level, N, drive(P, _), N) :-
    P =< Level,
    !.
drive_after(Delta, Rewarded, Level, N0, Drive0, N) :-
    N1 is N0 + 1,
    (   memberchk(N1, Rewarded)
    ->  rewarded(Drive0, 100, 15, _, Drive)
    ;   penalised(Drive0, 100, 15, Delta, _, Drive)
    ),
    drive_after(Delta, Rewarded, Level, N1, Drive, N).

close_to(X, Y) :-
    abs(X - Y) < 1.0e-9.

:- begin_tests(potential).

test(theta_of_a_full_potential, Theta =:= 15) :-
    theta([15], 100, 100, 0, Theta).
test(theta_scales_with_potential, Theta =:= 6) :-
    theta([15, 9], 50, 100, 0, Theta).
test(theta_averages_what_is_there, Theta =:= 5.5) :-
    theta([2, 4, 9], 100, 100, 0.5, Theta).
test(bias_is_outside_the_product, Theta =:= 0.8) :-
    theta([15], 0, 100, 0.8, Theta).
test(no_more_than_the_maximum, P =:= 100) :-
    increase(95, 15, 100, P).
test(no_less_than_zero, P =:= 0) :-
    decrease(3, 3.1, P).
test(window_grows, H == [1, 2, 3]) :-
    slide(3, [1, 2], 3, H).
test(window_slides, H == [2, 3, 4]) :-
    slide(3, [1, 2, 3], 4, H).
test(two_penalties_by_hand) :-
    penalised(drive(100, [15]), 100, 15, 0.5, T1, D1),
    D1 = drive(P1, H1),
    close_to(T1, 15.5),
    close_to(P1, 84.5),
    H1 == [15, T1],
    penalised(D1, 100, 15, 0.5, T2, drive(P2, _)),
    close_to(T2, 13.38625),         % (15 + 15.5)/2 * 0.845 + 0.5
    close_to(P2, 71.11375).
test(reward_enters_the_window, Drive == drive(45, [10, 5])) :-
    rewarded(drive(40, [10]), 80, 15, 5, Drive).
test(steps, [ forall(member(Delta-ToOne/ToZero,
                            [ 0.2-72/76, 0.3-51/54, 0.5-35/37,
                              0.8-25/26, 1.0-22/23 ])),
              One/Zero == ToOne/ToZero ]) :-
    steps(Delta, [], One, Zero).
test(rewards_only_postpone,
     [ forall(member(Delta-ToZero,
                     [ 0.2-90, 0.3-67, 0.5-48, 0.8-37, 1.0-34 ])),
       Zero == ToZero ]) :-
    steps(Delta, [1, 2, 3, 5, 7, 10, 13], _, Zero).
test(stalls_without_bias, true(P > 10)) :-
    numlist(1, 2000, Steps),
    foldl(unbiased, Steps, drive(100, [15]), drive(P, _)).

unbiased(_, Drive0, Drive) :-
    penalised(Drive0, 100, 15, 0, _, Drive).

:- end_tests(potential).

                /*******************************
                *           DECISIONS          *
                *******************************/

%   A host that is facts: tuple/1 is its tuple space, did/1 what an agent
%   did there, in order.

:- dynamic
    fake_host:tuple/1,
    fake_host:did/1.

fake_host:leave(Fact) :- assertz(fake_host:tuple(Fact)).
fake_host:take(Fact)  :- retract(fake_host:tuple(Fact)), !.
fake_host:sense(Fact) :- fake_host:tuple(Fact).
fake_host:log(What)   :- assertz(fake_host:did(log(What))).
fake_host:send(Id, M) :- assertz(fake_host:did(send(Id, M))).
fake_host:self(me).

%   fake_agent(+Program, +Facts, +Tuples): an agent of Program in module
%   fake_agent, on a host with Tuples.

fake_agent(Program, Facts, Tuples) :-
    forget_agent,
    retractall(fake_host:tuple(_)),
    retractall(fake_host:did(_)),
    add_import_module(fake_agent, fake_host, start),
    project_file(Program, File),
    load_clauses(File),
    forall(member(Fact, Facts), assertz(fake_agent:Fact)),
    forall(member(Tuple, Tuples), assertz(fake_host:tuple(Tuple))).

forget_agent :-
    forall(( current_predicate(fake_agent:Name/Arity),
             functor(Head, Name, Arity),
             \+ predicate_property(fake_agent:Head, imported_from(_))
           ),
           retractall(fake_agent:Head)).

load_clauses(File) :-
    read_file_to_terms(File, Terms, []),
    forall(member(Term, Terms), load_clause(Term, File)).

load_clause((:- agent(_, Options)), _) :-
    !,
    forall(( member(state(PIs), Options), member(PI, PIs) ),
           dynamic(fake_agent:PI)).
load_clause((:- include(Name)), File) :-
    !,
    file_directory_name(File, Dir),
    atomic_list_concat([Dir, /, Name, '.pl'], Included),
    load_clauses(Included).
load_clause((:- Directive), _) :-
    !,
    call(fake_agent:Directive).
load_clause(Clause, _) :-
    assertz(fake_agent:Clause).

traveller(Facts, Tuples) :-
    fake_agent('agents/sync/traveller.pl',
               [ task(1, floor), task(2, walls), task(3, ceiling)
               | Facts
               ],
               Tuples),
    forall(member(Task, [1, 2, 3]), fake_agent:fill(Task)).

did(Acts) :-
    findall(Act, fake_host:did(Act), Acts).

tuples(Tuples) :-
    findall(Tuple, fake_host:tuple(Tuple), Tuples).

drive(Task, Potential, History) :-
    fake_agent:drive(Task, Potential, History).

%   As after a search that is over.

exhaust(Task) :-
    fake_agent:keep(Task, drive(0, [15, 0.2])).

:- begin_tests(decisions).

test(begins_full, P-H == 100-[15]) :-
    traveller([], []),
    drive(2, P, H).
test(settings_replace_defaults, P-H == 80-[10]) :-
    traveller([setting(maximum, 80), setting(theta, 10)], []),
    drive(2, P, H).
test(searches_the_first_task_first, Task == 1) :-
    traveller([], []),
    fake_agent:current(Task).
test(then_the_next, Task == 2) :-
    traveller([], []),
    exhaust(1),
    fake_agent:current(Task).
test(then_it_is_over, fail) :-
    traveller([], []),
    forall(member(Task, [1, 2, 3]), exhaust(Task)),
    fake_agent:current(_).
test(services_a_host_that_lacks_the_task) :-
    traveller([], [worker(w)]),
    exhaust(1),
    fake_host:leave(task(1, completed)),
    fake_agent:keep(2, drive(50, [10])),
    fake_agent:visit(2),
    tuples(Tuples),
    Tuples == [task(1, completed), task(2, executing)],
    did(Acts),
    Acts == [send(w, execute(2, walls)), log(reward(2, 55, 5))],
    drive(2, 55, [10, 5]).
test(leaves_an_executing_host_alone) :-
    traveller([], [task(1, executing)]),
    fake_agent:visit(1),
    did(Acts),
    Acts == [],
    drive(1, 100, [15]).
test(is_penalised_where_the_task_is_completed) :-
    traveller([], [worker(w), task(1, completed)]),
    fake_agent:visit(1),
    tuples(Tuples),
    Tuples == [task(1, completed), worker(w)],
    did(Acts),
    Acts == [log(penalty(1, 84.5, 15.5))],
    drive(1, 84.5, [15, 15.5]).
test(services_an_earlier_task_it_finds_missing) :-
    traveller([], [worker(w), task(1, completed), task(3, completed)]),
    exhaust(1),
    exhaust(2),
    fake_agent:keep(3, drive(40, [15, 10])),
    fake_agent:visit(3),
    did(Acts),
    Acts == [ log(revived(2, 10)),
              send(w, execute(2, walls)),
              log(reward(2, 11.5, 1.5))
            ],
    drive(2, 11.5, [15, 1.5]),
    drive(3, 40, [15, 10]),
    fake_agent:current(Task),
    Task == 2.
test(the_first_one_missing_is_serviced_first) :-
    traveller([], [worker(w)]),
    exhaust(1),
    exhaust(2),
    fake_agent:visit(3),
    tuples(Tuples),
    Tuples == [task(1, executing)].
test(worker_says_it_is_free, Tuples == [worker(me)]) :-
    fake_agent('agents/sync/worker.pl', [], []),
    fake_agent:main,
    tuples(Tuples).
test(worker_executes) :-
    fake_agent('agents/sync/worker.pl', [], [task(1, executing)]),
    fake_agent:on_message(someone, execute(1, leave(tile))),
    tuples(Tuples),
    Tuples == [tile, task(1, completed), worker(me)],
    did(Acts),
    Acts == [log(executing(1)), log(completed(1))].
test(task_that_raises_is_not_completed) :-
    fake_agent('agents/sync/worker.pl', [], [task(1, executing)]),
    fake_agent:on_message(someone, execute(1, atom_length(_, _))),
    tuples(Tuples),
    Tuples == [worker(me)],
    did(Acts),
    Acts == [ log(executing(1)),
              log(raised(1, instantiation_error)),
              log(failed(1))
            ].
test(task_that_fails_is_not_completed, Tuples == [worker(me)]) :-
    fake_agent('agents/sync/worker.pl', [], [task(1, executing)]),
    fake_agent:on_message(someone, execute(1, fail)),
    tuples(Tuples).
test(task_taken_away_is_not_completed, Tuples == [worker(me)]) :-
    fake_agent('agents/sync/worker.pl', [], []),
    fake_agent:on_message(someone, execute(1, true)),
    tuples(Tuples).

:- end_tests(decisions).
