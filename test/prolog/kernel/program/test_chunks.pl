:- module(test_chunks, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/random_programs').
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module(library(typhon/kernel/program),
              [ code_clear/0, fault/3, goals_body/2, machine_run/3,
                plain_goals/2 ]).

/** <module> Tests of typhon_chunks: compiled programs run as in the machine

`make fuzz-programs COUNT=10000` runs so many programs, from SEED on.
*/

:- begin_tests(chunks, [cleanup(code_clear)]).

test(compiled_programs_run_as_interpreted, Differing == []) :-
    number_from('TYPHON_PROGRAMS', 200, Count),
    number_from('TYPHON_SEED', 1, First),
    Last is First+Count-1,
    findall(Seed-Clauses-Difference,
            ( between(First, Last, Seed),
              set_random(seed(Seed)),
              once(random_program(Clauses)),
              engines_differ(Clauses, Difference)
            ),
            Differing).

%   The goals of each place at which an agent has stopped, with any values.

test(frame_is_turned_back_into_its_goals, Lost-Many == []-true) :-
    findall(Kept,
            ( between(1, 300, Seed),
              set_random(seed(Seed)),
              once(random_program(Clauses)),
              \+ engines_differ(Clauses, _),
              program_frames(Clauses, Frames),
              member(Frame-Goals-Again, Frames),
              (   Again =@= Goals
              ->  Kept = kept
              ;   Kept = lost(Frame, Goals, Again)
              )
            ),
            All),
    findall(F, ( member(F, All), F \== kept ), Lost),
    length(All, Count),
    ( Count > 5 -> Many = true ; Many = Count ).
test(goals_of_another_clause_form_no_frame, Goals-Outcome == [1,7]-done) :-
    Clauses = [ (:- agent(instance, [state([t_/1])])),
                (main :- p, q(7)),
                (p :- move(a), X = Y, t(Y), r(X), r(Y), Y = 1),
                (q(X) :- move(a), X = Y, t(Y), r(X), r(Y)),
                (t(X) :- ( var(X) -> assertz(t_(1)) ; assertz(t_(X)) )),
                r(_) ],
    stopped(Clauses, Module, Goals1),
    next(Module, Goals1, effect(move(a), true, Goals2)),
    next(Module, Goals2, Outcome),
    findall(T, chunks_agent:t_(T), Goals),
    abolish(chunks_agent:t_/1).
test(instance_of_the_goals_forms_no_frame) :-
    Clauses = [ (:- agent(instance, [])),
                (main :- move(a), X = f(Y), functor(X, _, _), Y == 1, move(b)) ],
    stopped(Clauses, Module, [true|Goals]),
    assertion(framed(Module, Goals)),
    copy_term(Goals, Bound),
    Bound = [_ = f(1)|_],
    assertion(\+ framed(Module, Bound)),
    copy_term(Goals, [_|General]),
    assertion(\+ framed(Module, [_ = _|General])),
    copy_term(Goals, Same),
    Same = [Z = f(Z)|_],
    assertion(\+ framed(Module, Same)),
    copy_term(Goals, Attributed),
    Attributed = [Frozen = _|_],
    freeze(Frozen, throw(woken)),
    assertion(\+ framed(Module, Attributed)).
test(frame_shares_no_variable_with_other_goals, nondet) :-
    Clauses = [ (:- agent(shared, [])),
                (main :- p(_), q),
                (p(Z) :- move(a), X = f(Z), functor(X, _, _), atom(X)),
                (q :- move(b)) ],
    stopped(Clauses, Module, [true|Goals]),
    Goals = [X = _|_],
    append(Own, [q], Goals),
    append(Own, [q(X)], Sharing),
    assertion(frame_of(Module, Goals, _, [_])),
    assertion(\+ frame_of(Module, Sharing, _, [_])).
%   SWI-Prolog compiles the first occurrence of a variable wrongly there.

test(new_variable_is_tested_in_optimised_code,
     [ setup(set_prolog_flag(optimise, true)),
       cleanup(set_prolog_flag(optimise, false)) ]) :-
    Clauses = [ (:- agent(optimised, [])),
                (main :- \+ nonvar(X), new(X), ( var(Y) -> new(Y) ; true ),
                         move(X-Y)),
                (new(X) :- var(X)) ],
    stopped(Clauses, _, Goals),
    assertion(Goals == [true]).
test(deeply_nested_clause_is_compiled_quickly,
     true(Within \== inference_limit_exceeded)) :-
    nested(40, Nested),
    Clauses = [(:- agent(deep, [])), (main :- Nested, move(a)), t(_)],
    call_with_inference_limit(stopped(Clauses, _, _), 1 000 000, Within).
test(frame_with_a_cut_ends_with_its_run, Frames == [frame,goals]) :-
    Clauses = [ (:- agent(cuts, [])),
                (main :- p, q),
                (p :- move(a), t(1)),
                (q :- move(b), !, t(2)),
                t(_) ],
    stopped(Clauses, Module, _),
    findall(Kind,
            ( member(Goal, [p,q]),
              machine_run(context(Module, chunks_agent), [Goal],
                          effect(_, _, [_,First|_])),
              ( First = '$k'(_, _) -> Kind = frame ; Kind = goals )
            ),
            Frames).
test(program_is_compiled_at_its_first_run) :-
    Clauses = [(:- agent(first, [])), (main :- p), (p :- move(a), t(1)), t(_)],
    stopped(Clauses, Module, Goals),
    assertion(Goals == [true,t(1)]),
    assertion('$get_predicate_attribute'(Module:'$goals'(_, _, _, _), defined, 1)).

%   The goals are too long to be recorded except at the end of the run; its
%   frame is not.

test(failure_inside_catch_is_reported_with_long_goals, Goal == (\+ n(1))) :-
    length(Long, 200),
    maplist(=(n(1)), Long),
    goals_body(Long, Body),
    Clauses = [ (:- agent(long, [state([t_/1, f/1, r/1])])),
                (main :- catch(p(1), oops, move(a))),
                (p(X) :- \+ n(X), move(a), Body),
                n(1) ],
    assertion(\+ engines_differ(Clauses, _)),
    installed(Clauses, Module),
    next(Module, [main], Outcome),
    fault(Outcome, [main], fault(Goal, _, _)).

test(stop_in_a_negation_faults_the_negation, Goals =@= [\+ r(_),\+ r(_)]) :-
    Clauses = [ (:- agent(negation, [state([r/1])])),
                (main :- \+ r(_), move(a)) ],
    installed(Clauses, Module),
    set_module(negation_agent:base(Module)),
    dynamic(negation_agent:r/1),
    retractall(negation_agent:r(_)),
    assertz(negation_agent:(r(_) :- move(b))),
    findall(Goal,
            ( member(Engine, [Module,reference_machine]),
              faulty(Engine, negation_agent, Goal, _)
            ),
            Goals).

%   a/1 has another clause, in which no goal is recorded.

test(long_failed_goal_is_named_at_a_choice,
     Names-Left =@= [n(1),n(_),n(_)]-[2,1,1]) :-
    findall(Goal-Count,
            ( member(Length-Engine, [1-Module,500-Module,500-reference_machine]),
              length(Long, Length),
              Clauses = [ (:- agent(silent, [])),
                          (main :- a(X, L), n(X), move(L)),
                          (a(1, Long)), (a(2, _) :- fail),
                          n(5) ],
              installed(Clauses, Module),
              faulty(Engine, Module, Goal, Goals),
              length(Goals, Count)
            ),
            Faults),
    pairs_keys_values(Faults, Names, Left).

%   No later goal uses the variable that q/1 binds.

test(fault_survives_garbage_collection,
     [ forall(member(Main, [ q(_), \+ q(_), ( q(X) -> t(1) ; t(X) ),
                             catch(q(_), oops, true) ])),
       true(Goals == [q(2),q(2)]) ]) :-
    Clauses = [ (:- agent(collected, [])),
                (main :- Main, move(a)),
                (q(2) :- garbage_collect, atom_length(_, _)),
                t(_) ],
    installed(Clauses, Module),
    findall(Goal,
            ( member(Engine, [Module,reference_machine]),
              faulty(Engine, Module, Goal, _)
            ),
            Goals).

%   A clause that is being added is in its table and not visible yet, as for
%   other threads until a transaction ends.

test(frames_are_looked_up_while_the_first_is_added, Outcome == done) :-
    Clauses = [ (:- agent(adding, [])),
                (main :- move(a), X = f(_), functor(X, _, _), atom(a)) ],
    installed(Clauses, Module),
    set_module(chunks_agent:base(Module)),
    machine_run(context(Module, chunks_agent), [main], effect(_, true, Frames)),
    thread_self(Me),
    setup_call_cleanup(
        thread_create(transaction(( plain_goals(Frames, Goals),
                                    thread_send_message(Me, left(Goals)),
                                    thread_get_message(seen) )),
                      Adding),
        ( thread_get_message(Me, left(Left), [timeout(60)]),
          '$get_predicate_attribute'(Module:'$frame'(_, _, _, _, _), defined, 1),
          next(Module, Left, Outcome)
        ),
        ( thread_send_message(Adding, seen),
          thread_join(Adding)
        )).

nested(0, t(0)) :-
    !.
nested(N, ( (t(N),Nested -> true ; fail) -> t(N) ; t(0) )) :-
    N1 is N-1,
    nested(N1, Nested).

%   stopped(+Clauses, -Module, -Goals): the goals left at the first stop.

stopped(Clauses, Module, Goals) :-
    installed(Clauses, Module),
    set_module(chunks_agent:base(Module)),
    next(Module, [main], effect(_, true, Goals)).

next(Module, Goals, Outcome) :-
    machine_run(context(Module, chunks_agent), Goals, Outcome0),
    (   Outcome0 = effect(Control, Hole, Left0)
    ->  plain_goals(Left0, Left),
        Outcome = effect(Control, Hole, Left)
    ;   Outcome = Outcome0
    ).

installed(Clauses, Module) :-
    program_installed(Clauses, Module, _),
    nb_setval(random_program, Module).

%   faulty(+Program, +Agent, -Goal, -Goals): main/0 of Agent fails or raises in
%   Goal, the first of Goals.

faulty(Program, Agent, Goal, Goals) :-
    machine_run(context(Program, Agent), [main], Outcome),
    fault(Outcome, [main], fault(Goal, Goals, _)).

framed(Module, Goals) :-
    frame_of(Module, Goals, _, _).

frame_of(Module, Goals, Frame, Rest) :-
    Goals = [First|_],
    '$get_predicate_attribute'(Module:'$frame'(_, _, _, _, _), defined, 1),
    Module:'$frame'(First, Goals, 0, Frame, Rest).

%   program_frames(+Clauses, -Frames): each as Frame-Goals-Again, where Again are
%   the goals of the frame that is made of Goals.

program_frames(Clauses, Frames) :-
    installed(Clauses, Module),
    findall('$k'(Place, Vars)-Goals-Again,
            ( clause(Module:'$goals'(Place, Vars, Goals, []), true),
              numbervars(Vars, 0, _),
              frame_of(Module, Goals, Frame, []),
              plain_goals([Frame], Again)
            ),
            Frames).

number_from(Variable, Default, Number) :-
    (   getenv(Variable, Text)
    ->  atom_number(Text, Number)
    ;   Number = Default
    ).

:- end_tests(chunks).
