:- module(test_guard_escapes, []).
:- use_module('../../../../app/packaging/parts', [installed/1]).
:- use_module('../../../lib/allowed_goals').
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, numlist/3]).
:- use_module(library(typhon)).
:- use_module(library(yall)).

/** <module> Former escapes from the sandbox

A successful attack would set the flag typhon_guard_escaped.

*Threading*: one test at a time.
*/

harm(flag(typhon_guard_escaped, _, 1)).

escaped(Goal, Escaped) :-
    flag(typhon_guard_escaped, _, 0),
    call(Goal),
    flag(typhon_guard_escaped, Escaped, 0).

%   ways(+Goal, -Clauses): Goal written in the program, constructed and run by
%   the machine, constructed and run by Prolog, and constructed on another
%   host.

ways(Goal, [(main :- Goal)]).
ways(Goal, [(main :- goal(G), call(G)), goal(Goal)]).
ways(Goal, [(main :- goal(G), findall(x, G, _)), goal(Goal)]).
ways(Goal, [(main :- goal(G), move(g), call(G)), goal(Goal)]).

host_of([(main :- Body)|_], t) :- \+ Body \= (_, move(g), _), !.
host_of(_, g).

outcome(Clauses, Outcome) :-
    host_of(Clauses, Host),
    catch(( create(Clauses, A, [host(Host)]),
            agent_join(A, Outcome, 60) ),
          error(Formal, _), Outcome = raised(error(Formal, _))).

is_refused(raised(error(permission_error(call, sandboxed, _), _))).
is_refused(raised(error(move_refused(_, policy(_)), _))).
is_refused(raised(error(permission_error(_, _, _), _))).
is_refused(raised(error(existence_error(procedure, _), _))).
is_refused(raised(error(resource_error(tripwire(_, _)), _))).   % 9.2.9

%   let_through(+Goals, -Goals): the goals that are not refused in each of
%   these ways.

let_through(Goals, Through) :-
    on_hosts(findall(Goal-Outcome,
                     ( member(Goal, Goals),
                       ways(Goal, Clauses),
                       outcome(Clauses, Outcome),
                       \+ is_refused(Outcome) ),
                     Through)).

%   Agents have rules on g, and none on t.

:- meta_predicate on_hosts(0).

on_hosts(Goal) :-
    guarded(Spec),
    with_hosts([Spec, t], capturing(Goal, _)).

guarded(g-[policy(guarded), cell(none)]).

gives(Clauses, Result) :-
    guarded(Spec),
    result_on([Spec], Clauses, Result).

                /*******************************
                *         FORMAT STRINGS       *
                *******************************/

%   Modifiers, counts and characters before directives that call or print.

calling_format(Format) :-
    member(Format,
           [ "~@", "~:@", "~3:@", "~`x:@", "~`x@", "~`~@", "~::@", "~1234@",
             "~w~:@", "~~~:@", "~p", "~:p", "~:i~@", "~i~@", "~*@", "~*c~@",
             "~:d~@", '~:@', `~:@`, ['~', :, '@'], "~\u0663:@", "~\u06633@",
             "~k", "~", "~`", "~`x" ]).

calling(format(Sink, Format, [Harm, Harm])) :-
    harm(Harm),
    calling_format(Format),
    member(Sink, [string(_), codes(_)]).
calling(Goal) :-
    harm(Harm),
    member(Goal,
           [ format("~@", [Harm]),
             format("~:@"),
             format(atom(_), "~:@", [Harm]),
             format(user_error, "~:@", [Harm]),
             format(codes(_, _), "~:@", [Harm]),
             format(_, "~:@", [Harm]),
             format_atom("~:@", [Harm], _),
             sformat(_, "~:@", [Harm]),
             with_output_to(string(_), Harm),
             with_output_to(string(_), format("~:@", [Harm])),
             debug(typhon(x), "~:@", [Harm]),
             debug(_, "~@", Harm),
             print_message(error, format("~@", [Harm])),
             print_message_lines(user_error, '', ["~@"-[Harm]]),
             message_to_codes(format("~@", [Harm]), _, _),
             message_to_string(format("~@", [Harm]), _),
             '$messages':translate_message(format("~@", [Harm]), _, []),
             ansi_format([], "~@", [Harm]),
             assertion(Harm),
             format_predicate(w, Harm),
             current_format_predicate(_, _),
             format_time(string(_), "~@", 0),
             string_code(1, "a", _) ; Harm ]).

%   Formats that are known to be harmless are written.

written("~w ~q ~a ~d ~D ~s", [a+'B', 'B', c, 4, 5000, "six"],
        "a+B 'B' c 4 5,000 six").
written("~2d|~1e|~3f|~8r|~16R|~3c|~~|~n", [314, 1.0, 2.0, 8, 255, 0'x],
        "3.14|1.0e+00|2.000|10|FF|xxx|~|\n").
written("~w~t~5|~w~t~3+.", [a, b], "a    b  .").
written("~`-t~5|", [], "-----").
written('~w', x, "x").

:- begin_tests(format_strings).

test(calling_formats_are_refused, Escaped-Through == 0-[]) :-
    findall(Goal, calling(Goal), Goals),
    escaped(let_through(Goals, Through), Escaped).
test(harmless_formats_are_written,
     [forall(written(Format, Args, Text)), true(Result == Text)]) :-
    gives([(main :- format(string(S), Format, Args), result(S))], Result).
test(output_of_format_is_bounded,
     Outcome = raised(error(resource_error(clause_cells), _))) :-
    dag(Dag),
    on_hosts(outcome([ (main :- dag(40, a, T), format(string(_), "~w", [T]))
                     | Dag ], Outcome)).

:- end_tests(format_strings).

%   dag(-Clauses): dag(N, T0, T): T has 2^N times T0, and few cells.

dag([ dag(0, T0, T0),
      (dag(N0, T0, T) :- N0 > 0, N is N0-1, dag(N, f(T0,T0), T)) ]).

                /*******************************
                *        CHANGED GOALS         *
                *******************************/

%   changing(-Name, -Clauses): a goal is checked, and then changed by a goal
%   that it calls. hit/2 is harmless, set_flag/2 is not.

changing(call,
         [ (main :- closure(C), G = maplist(C, [c(C), 1]), call(G)) ]).
changing(once,
         [ (main :- closure(C), G = once(maplist(C, [c(C), 1])), call(G)) ]).
changing(findall,
         [ (main :- closure(C), G = maplist(C, [c(C), 1]),
                    findall(x, G, _)) ]).
changing(written_out,
         [ (main :- closure(C), maplist(C, [c(C), 1])) ]).
changing(condition,
         [ (main :- closure(C),
                    G = ( maplist(C, [c(C)]) -> maplist(C, [1]) ; true ),
                    call(G)) ]).
changing(catch,
         [ (main :- closure(C), G = catch(hit(C), _, maplist(C, [1])),
                    call(G)),
           (hit(C) :- hit(t, c(C)), throw(x)) ]).
changing(across_sleep,
         [ (main :- closure(C),
                    G = (hit(t, c(C)), sleep(0.001), maplist(C, [1])),
                    call(G)) ]).
changing(across_receive,
         [ (main :- closure(C), self(Me), send(Me, go),
                    G = (hit(t, c(C)), receive(_), maplist(C, [1])),
                    call(G)) ]).
changing(conjunction,
         [ (main :- closure(C), B = maplist(C, [1]), G = (hit(B), B),
                    call(G)),
           (hit(B) :- setarg(1, B, set_flag(typhon_guard_escaped))) ]).
changing(ignore,
         [ (main :- B = ignore(hit(typhon_guard_escaped, 1)),
                    G = (hit(B), B), call(G)),
           (hit(B) :- setarg(1, B, set_flag(typhon_guard_escaped, 1))) ]).
changing(lambda,
         [ (main :- C = [X]>>hit(typhon_guard_escaped, X),
                    maplist(C, [l(C), 1])) ]).
changing(parameters,
         [ (main :- P = [_], C = P>>set_flag(typhon_guard_escaped),
                    Q = C, G = maplist(Q, [l(C), 1]), call(G)),
           (set_flag(_) :- true) ]).
changing(foldl,
         [ (main :- C = call(hit3, typhon_guard_escaped),
                    G = foldl(C, [c(C), 1], 1, _), call(G)),
           (hit3(_, X, Y, Y) :- hit(t, X)) ]).

%   Of the closure call(hit, Flag) the first argument changes; of a lambda
%   expression the body, and parameters.

common([ closure(call(hit, typhon_guard_escaped)),
         (hit(_, c(C)) :- !, setarg(1, C, set_flag)),
         (hit(_, l(C)) :- !, setarg(1, C, []),
                          setarg(2, C, set_flag(typhon_guard_escaped))),
         hit(_, _) ]).

changing_program(Name, Clauses) :-
    changing(Name, Clauses0),
    common(Common),
    append(Clauses0, Common, Clauses).

:- begin_tests(changed_goals).

%   setarg/3 is allowed here, so that only the copy protects the goal.

test(checked_goal_is_the_executed_goal,
     [forall(changing_program(_, Clauses)), true(Escaped == 0)]) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, rules, File),
          write_file(File, "allow(setarg/3).~n", []),
          with_hosts([g-[policy(File), cell(none)], t],
                     capturing(escaped(outcome(Clauses, _), Escaped), _)) )).
test(destructive_assignment_is_refused, Through == []) :-
    findall(( X = f(a), Goal ),
            member(Goal, [ setarg(1, X, b), nb_setarg(1, X, b),
                           nb_linkarg(1, X, b) ]), Goals, Dicts),
    findall(( dict_create(D, _, [a-1]), Goal ),
            member(Goal, [ b_set_dict(a, D, 2), nb_set_dict(a, D, 2),
                           nb_link_dict(a, D, 2) ]), Dicts),
    let_through(Goals, Through).

:- end_tests(changed_goals).

                /*******************************
                *          CONSTRUCTS          *
                *******************************/

%   construct(-Goal): SWI-Prolog does not call a predicate of that name.

construct(Goal) :-
    harm(Harm),
    member(Goal,
           [ '|'(fail, Harm), '|'(Harm, true), '|'((true, fail), Harm),
             (true, '|'(fail, Harm)), \+ '|'(fail, Harm),
             call('|'(fail), Harm), call('|', fail, Harm),
             maplist('|'(fail), [Harm]), foldl(call('|'), [fail], Harm, _),
             maplist([_]>>'|'(fail, Harm), [1]),
             setof(x, X^'|'(X = 1, Harm), _), catch('|'(fail, Harm), _, true),
             $(Harm), call($, Harm), $, @(Harm, user), call(@(Harm), user),
             @('|'(fail, Harm), user), user:Harm, call(user:call, Harm),
             phrase(({Harm} *-> []), []), phrase(('|'([x], {Harm})), []),
             phrase(({Harm} -> []), []), phrase(call(Harm), []),
             phrase(!, []), phrase("x", []), phrase([x|{Harm}], []),
             phrase(user:x, []), phrase(phrase({Harm}), []),
             call(phrase, {Harm}, []), maplist(phrase({Harm}), [[]]),
             {Harm}, call({}, Harm), '[|]'(user, []), call([user]),
             '.'(_{}, put(Harm), _), ?=>(true, Harm),
             (true => Harm), (true --> Harm), [X]>>Harm, X/Harm, \X^Harm,
             apply(call, [Harm]), not(Harm), X^Harm, tnot(Harm),
             reset(Harm, _, _), shift(Harm), call_continuation([Harm]),
             findall(x, Harm), snapshot(Harm), undo(Harm), thread_idle(Harm, x),
             prolog_listen(x, Harm), when(true, Harm), freeze(X, Harm),
             arithmetic_expression_value(x, Harm) ]).

%   defining(-Clauses): the agent has a predicate with the name of a construct.

defining([ (main :- Goal), (Head :- true) ]) :-
    harm(Harm),
    member(Goal, [ '|'(fail, Harm), @(Harm, user), (Harm *-> true),
                   $(Harm), ignore(Harm), user:Harm, call(Harm, x) ]),
    functor(Goal, Name, Arity),
    functor(Head, Name, Arity).
defining([ (main :- assertz('|'(x, y)), assertz((p :- '|'(fail, Harm))),
                    p) ]) :-
    harm(Harm).
defining([ (main :- c(C), assertz(C), p), c((p :- '|'(fail, Harm))) ]) :-
    harm(Harm).
defining([ (main :- c(C), assertz(C), p), c((p :- @(Harm, user))) ]) :-
    harm(Harm).

:- begin_tests(constructs).

test(constructs_are_no_calls, Escaped-Through == 0-[]) :-
    findall(Goal, construct(Goal), Goals),
    escaped(let_through(Goals, Through), Escaped).
test(constructs_cannot_be_defined,
     [forall(defining(Clauses)), true(Escaped == 0)]) :-
    on_hosts(escaped(outcome(Clauses, Outcome), Escaped)),
    assertion(refused_or_unread(Outcome)).
test(grammar_rules_are_called, R == [x,y]) :-
    gives([ (main :- phrase(ab(X, Y), [x,y]),
                     findall(x, phrase(ab(_, _), [x,y,z], _), [_]),
                     result([X,Y])),
            (ab(A, B, [A,B|T], T) :- true) ], R).
test(facts_of_the_platform_stay, R == refused) :-
    gives([ (main :- c(C),
                     catch(( findall(x, retract(C), _), result(removed) ),
                           error(permission_error(_, _, _), _),
                           result(refused))),
            c('$owner'(_)) ], R).

:- end_tests(constructs).

                /*******************************
                *            CLAUSES           *
                *******************************/

%   hidden(-Clause): asserted unchanged, Clause would be a rule, not a fact.

hidden((p(X) => Harm)) :- harm(Harm), X = _.
hidden(?=>(p(_), Harm)) :- harm(Harm).
hidden((p(_), true => Harm)) :- harm(Harm).
hidden((p(_) --> {Harm})) :- harm(Harm).
hidden((:- Harm)) :- harm(Harm).
hidden(?-(Harm)) :- harm(Harm).

hiding(Clause, [(main :- assertz(Clause), catch(p(1), _, true))]).
hiding(Clause, [(main :- asserta(Clause), catch(p(1), _, true))]).
hiding(Clause, [ (main :- c(C), assertz(C), catch(p(1), _, true)),
                 c(Clause) ]).
hiding(Clause, [ (main :- c(C), findall(x, assertz(C), _),
                          catch(p(1), _, true)),
                 c(Clause) ]).
hiding(Clause, [ (main :- move(g), catch(p(1), _, true)), Clause ]).

:- begin_tests(clauses).

test(rule_is_not_accepted_as_a_fact, [Escaped-Through == 0-[]]) :-
    findall(Clause-Clauses, ( hidden(Clause), hiding(Clause, Clauses) ), All),
    on_hosts(escaped(findall(Clause-Outcome,
                             ( member(Clause-Clauses, All),
                               outcome(Clauses, Outcome),
                               \+ refused_or_unread(Outcome) ),
                             Through), Escaped)).
test(rule_is_not_accepted_as_a_state_fact, [Escaped-Through == 0-[]]) :-
    on_hosts(escaped(findall(Clause, ( hidden(Clause), comes_with(Clause) ),
                             Through), Escaped)).
test(rules_of_a_service_are_protected, R == kept) :-
    with_tmp_dir(service_rules(R)).

:- end_tests(clauses).

refused_or_unread(Outcome) :-
    is_refused(Outcome).
refused_or_unread(raised(error(domain_error(_, _), _))).
refused_or_unread(raised(error(type_error(_, _), _))).

comes_with(Clause) :-
    catch(( agent_create(clauses([ (:- agent(x, [])),
                                   (main :- catch(p(1), _, true)) ]), A,
                         [host(g), facts([Clause])]),
            agent_join(A, _, 10) ),
          error(_, _), fail).

service_rules(R, Dir) :-
    directory_file_path(Dir, 'place.pl', File),
    write_file(File, ":- service(sv/1).~n\c
                      :- dynamic sv/1.~n\c
                      sv(X) => X = kept.~n", []),
    with_hosts([g-[policy(guarded), cell(none), consult(File)]],
               ( capturing(outcome([(main :- sv(_), C = (sv(_) => _),
                                             retract(C))], _), _),
                 create([(main :- sv(X), result(X))], A, [host(g)]),
                 agent_result(A, R, 10) )).

:- begin_tests(programs_of_peers).

%   A program that a peer sends may name any file as its library.

test(programs_of_peers_load_no_library,
     [forall(( comes(How), wrapped(Program, Sent) )), Escaped == 0]) :-
    with_tmp_dir(loads_library(How, Program, Sent, Escaped)).


%   detach/1 would abolish the predicates that an image names.

test(image_names_no_predicates_of_modules,
     [ forall(member(Payloads, [ [x-[user:(p/1)]], [x-[(user:p)/1]], [x-_],
                                 [x-[p/1|_]], _ ])),
       error(type_error(agent_image, _)) ]) :-
    Life = life(none, 1, inf, [], Payloads, false, []),
    typhon_image:image_label(image('x.1.0@g@127.0.0.1:1', hash, Life,
                                   state([], []), [], [], 0.0), _).
test(image_names_predicates_of_the_agent) :-
    Life = life(none, 1, inf, [], [x-[p/1,q/0]], false, []),
    typhon_image:image_label(image('x.1.0@g@127.0.0.1:1', hash, Life,
                                   state([], []), [], [], 0.0), _).

:- end_tests(programs_of_peers).

wrapped(Program, Program).
wrapped(Program, Program-[]).
wrapped(Program, signed(Program, signature)).
wrapped(Program, signed(signed(Program-[], signature), signature)).

comes(with_agent).
comes(by_order).

loads_library(How, Program, Sent, Escaped, Dir) :-
    directory_file_path(Dir, 'library.pl', File),
    write_file(File, ":- module(harm, []).~n:- ~q.~n",
                     [flag(typhon_guard_escaped, _, 1)]),
    Program = program(x, [], [File-all], [(main :- true)]),
    typhon_code:program_hash(Program, Hash),
    with_hosts([g-[policy(guarded), cell(none)]],
               escaped(come(How, Hash, Sent), Escaped)).

come(with_agent, Hash, Sent) :-
    typhon_agents:make_life(inf, [], [], false, Life),
    typhon_gate:gate(g, from('127.0.0.1:1', Sent, papers(Sent))
                        - entrant(x, Hash, Life, state([], []), []),
                     =(ok), refused(policy(_))).
come(by_order, Hash, Sent) :-
    create([on_message(_, _)], A, [host(g)]),
    message_queue_create(Queue),
    typhon_orders:order_take(A, asked(change(program(Hash, Sent)),
                                      queue(Queue))),
    thread_get_message(Queue, error(permission_error(call, sandboxed, _)),
                       [timeout(30)]),
    message_queue_destroy(Queue).

                /*******************************
                *         SHARED TERMS         *
                *******************************/

%   storing(-Body): T is small, and 2^60 parts when it is written out.

storing(Body, T) :-
    member(Body,
           [ receive(_-T, 0.1), receive(T), sleep(T), move(T),
             (sleep(0.001), hit(T)),
             (self(Me), send(Me, x), receive(_), hit(T)), (clone(_), hit(T)),
             (clone(T, _), hit(T)), (hit(T), fail), (hit(T), throw(x), hit(T)),
             (hit(T), X is foo+T, hit(X)), miss(T), throw(error(T, _)),
             result(T), enter(T), message_failed(x, T),
             message_failed(T, x), assertz(s(T)),
             (catch(sleep(T), _, sleep(T)), hit(T)) ]).
storing(emit(T), T) :-
    installed(migration).

storing_program(Clauses) :-
    storing(Body, T),
    dag(Dag),
    append([ (main :- dag(60, a, T), Body), hit(_), (miss(_) :- fail) ], Dag,
           Clauses).
storing_program([ (main :- dag(60, true, G), call(G)),
                  dag(0, G0, G0),
                  (dag(N0, G0, G) :- N0 > 0, N is N0-1, dag(N, (G0,G0), G)) ]).
storing_program([ (main :- dag(60, true, G), findall(x, G, _)),
                  dag(0, G0, G0),
                  (dag(N0, G0, G) :- N0 > 0, N is N0-1, dag(N, \+ (G0;G0), G)) ]).

%   A goal that fails or raises without T is kept unchanged.

too_large(failed).
too_large(raised(x)).
too_large(raised(error(resource_error(_), _))).
too_large(raised(error(type_error(_, _), _))).
too_large(raised(error(permission_error(call, sandboxed, throw/1), _))).

:- begin_tests(shared_terms).

test(shared_terms_are_not_stored,
     [forall(storing_program(Clauses)), true(too_large(Outcome))]) :-
    on_hosts(( create(Clauses, A, [host(g)]), agent_join(A, Outcome, 10) )).
test(other_agents_are_not_delayed, R == ok) :-
    dag(Dag),
    on_hosts(( create([ (main :- dag(60, a, T), receive(_-T, 1)) | Dag ], A,
                      [host(g)]),
               create([(main :- sleep(0.01), result(ok))], B, [host(g)]),
               agent_result(B, R, 10),
               agent_join(A, raised(_), 10) )).

%   Large data may be in goals that are not stored.

test(goal_with_a_large_argument_runs, R == 300 000) :-
    gives([ (main :- numlist(1, 300 000, L), G = count(L), call(G)),
            (count(L) :- length(L, N), result(N)) ], R).

:- end_tests(shared_terms).

                /*******************************
                *           HUGE TERMS         *
                *******************************/

%   huge(-Goal): Goal crashes SWI-Prolog 9.0.4.

huge(Goal) :-
    member(Arity, [ 4611686018427387903, 4611686018427387904,
                    9223372036854775807 ]),
    member(Goal, [ functor(_, a, Arity), functor(_, a, Arity, _),
                   functor(_, a, Arity, compound),
                   compound_name_arity(_, a, Arity),
                   length(_, Arity), length([a|_], Arity),
                   maplist(length, [_], [Arity]) ]).

:- begin_tests(huge_terms).

test(term_size_is_bounded, Through == []) :-
    findall(Goal, huge(Goal), Goals),
    let_through(Goals, Through).
test(terms_of_allowed_size_are_made,
     true(subsumes_term([f(_,_), a, 3, g(_), [f,1]], R))) :-
    gives([ (main :- functor(A, f, 2), functor(B, a, 0),
                     functor(x(1,2,3), _, C), compound_name_arity(D, g, 1),
                     f(1) =.. E, length(E, 2), length([x], 1),
                     result([A,B,C,D,E])) ], R).

:- end_tests(huge_terms).

                /*******************************
                *             TEXT             *
                *******************************/

long_text(Length, Text) :-
    numlist(1, Length, Numbers),
    findall(0'a, member(_, Numbers), Codes),
    string_codes(Text, Codes).

has_long_atom(Term) :-
    sub_term_(Atom, Term),
    atom(Atom),
    atom_length(Atom, Length),
    Length > 1000,
    !.

sub_term_(X, X).
sub_term_(X, Term) :-
    compound(Term),
    arg(_, Term, Arg),
    sub_term_(X, Arg).

given(Text, Text).
given(Text, Codes) :- string_codes(Text, Codes).
given(Text, Chars) :- string_chars(Text, Chars).

%   A permitted goal with a long text as one argument, short ones as the
%   others, and a variable at one of them.

text_goal(Text, Goal) :-
    allowed_goal(Goal, free),
    functor(Goal, Name, Arity),
    between(1, 5, Arity),
    \+ memberchk(Name, [ move, clone, receive, send, log, leave, leave_new,
                         result, enter, emit, take, sense, withdraw, detach,
                         message_failed, pheromone ]),
    between(1, Arity, I),
    given(Text, Given),
    arg(I, Goal, Given),
    others(Arity, I, Free, Value),
    forall_args(1, Arity, I, Free, Value, Goal).

%   others(+Arity, +I, -Free, -Value): each other argument is Value, but Free.

others(_, I, I, _).
others(Arity, I, Free, Value) :-
    member(Value, ["x", 0]),
    between(1, Arity, Free),
    once(( Free == I ; Arity > 2 )).

forall_args(N, Arity, _, _, _, _) :-
    N > Arity,
    !.
forall_args(N, Arity, I, Free, Value, Goal) :-
    (   memberchk(N, [I,Free])
    ->  true
    ;   arg(N, Goal, Value0),
        copy_term(Value, Value0)
    ),
    N1 is N+1,
    forall_args(N1, Arity, I, Free, Value, Goal).

long_atom(Goal) :-
    long_text(1200, Text),
    text_goal(Text, Goal),
    catch(call_with_inference_limit(once(typhon_vocabulary:Goal), 10 000, _),
          error(_, _), fail),
    has_long_atom(Goal).

text_attack(Goal) :-
    member(Goal,
           [ setrand(seed(1)), setrand(1), getrand(_),
             term_to_atom(_, `{|html||x|}`),
             term_to_atom(_, ['{', '|', h, '|', '|', x, '|', '}']),
             term_string(_, `{|html||x|}`), term_string(_, "{|html||x|}"),
             atom_to_term(`{|html||x|}`, _, _),
             atom_to_term(['{', '|', h, '|', '|', x, '|', '}'], _, _) ]).
text_attack(Goal) :-
    long_text(1001, Text),
    string_codes(Text, Codes),
    member(Goal, [ upcase_atom(Text, _), downcase_atom(Text, _),
                   upcase_atom(Codes, _),
                   sub_atom(Text, 0, 1001, _, _), sub_atom(Text, _, _, _, _),
                   sub_atom_icasechk(Text, _, a),
                   atom_string(_, Text), atom_codes(_, Codes),
                   atomic_list_concat([Text], _),
                   atomic_list_concat([x,y], Text, _),
                   atom_concat(Text, x, _), hash_atom(Codes, _),
                   file_base_name(Text, _), file_name_extension(Text, x, _),
                   uri_components(Text, _), uri_iri(Text, _),
                   term_to_atom(_, Text), term_to_atom(f(Text), _),
                   term_string(_, Text), atom_to_term(Text, _, _) ]).
text_attack(( string_codes(S, `xxxxxxxxxxxxxxxxxxxx`),
              atomic_list_concat([a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,
                                  a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,
                                  a,a,a,a,a,a,a,a,a,a,a,a,a,a,a,a], S, _) )).
text_attack(( X is 7**10000, atom_number(_, X) )).

%   Atoms of allowed length are held until a quota ends the agent.

holding(state,
        [ (main :- long(L), between(1, inf, I), atom_concat(L, I, A),
                   assertz(s(A)), I > 1 000 000),
          long(Long) ]) :-
    long_atom_900(Long).
holding(stack,
        [ (main :- long(L), findall(A, ( between(1, inf, I),
                                         atom_concat(L, I, A) ), _)),
          long(Long) ]) :-
    long_atom_900(Long).
holding(stack,
        [ (main :- long(L), findall(A, ( repeat,
                                         sub_atom(L, _, _, _, A) ), _)),
          long(Long) ]) :-
    long_atom_900(Long).
holding(cells,
        [ (main :- long(L), text(11, L, S), self(Me), send(Me, S)),
          long(Text),
          text(0, S, S),
          (text(N0, S0, S) :- N0 > 0, N is N0-1, string_concat(S0, S0, S1),
                              text(N, S1, S)) ]) :-
    long_text(900, Text).

long_atom_900(Long) :-
    long_text(900, Text),
    atom_string(Long, Text).

:- begin_tests(texts).

test(long_atoms_are_refused, Through == []) :-
    findall(Goal, text_attack(Goal), Goals),
    let_through(Goals, Through).
test(no_predicate_makes_long_atoms, Goals == []) :-
    on_hosts(true),                     % the tables are made
    findall(Name/Arity, ( long_atom(Goal), functor(Goal, Name, Arity) ),
            Goals0),
    sort(Goals0, Goals).
test(text_of_atoms_counts,
     [forall(holding(What, Clauses)), true(Passed == What)]) :-
    with_hosts([g-[ policy(guarded), cell(none),
                    quota([ seconds(60), stack(4 000 000), state(100 000),
                            log(1000) ]) ]],
               capturing(outcome(Clauses, Outcome), _)),
    Outcome = raised(error(resource_error(Passed), _)).
%   Removed text does not count.

test(collected_text_does_not_count, Outcome == done) :-
    long_atom_900(Long),
    with_hosts([g-[ policy(guarded), cell(none),
                    quota([seconds(60), state(200 000)]) ]],
               capturing(outcome([ (main :- forall(between(1, 2000, I),
                                                   step(I))),
                                   (step(I) :- long(L), atom_concat(L, I, A),
                                               assertz(s(A)),
                                               retract(s(A))),
                                   long(Long) ], Outcome), _)).
test(short_texts_pass, R == ['ABC', bc, 'a,b', f(x), "f(x)", 12]) :-
    gives([ (main :- upcase_atom(abc, A), sub_atom(abc, 1, 2, _, B),
                     atomic_list_concat([a,b], ',', C), term_to_atom(D, 'f(x)'),
                     term_string(f(x), E), atom_number('12', F),
                     result([A,B,C,D,E,F])) ], R).

:- end_tests(texts).

                /*******************************
                *      FILES AND AGENTS        *
                *******************************/

%   A new agent would carry the content of a file, or its error would show it.

reads(create(self, _, [payloads([Spec])]), File) :- member(Spec, [File, (a)/File]).
reads(create(self, _, [payloads=[File]]), File).
reads(create(self, _, _{payloads: [File]}), File).
reads(create(self, _, [payloads([payloads('..'/File)])]), File).
reads(create(File, _, []), File).
reads(attach(File), File).

ends(monitor(A, [shared(agent)]), A).
ends(monitor(A, [shared(true)]), A).
ends(dispose(A), A).
ends(dispose(A, [force(0)]), A).

:- begin_tests(files_and_agents).

test(no_file_is_read_for_an_agent, Through == []) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, secret, File),
          write_file(File, ":- payload(x, [provides([s/1])]).~ns(1).~n", []),
          findall(Goal, reads(Goal, File), Goals),
          let_through(Goals, Through) )).
test(agent_cannot_end_others, Through-State == []-waiting) :-
    with_hosts([u], ( create([(main :- receive(_))], A, [host(u)]),
                      wait_state(A, waiting),
                      findall(Goal, ends(Goal, A), Goals),
                      let_through(Goals, Through),
                      agent_property(A, state(State)) )).
test(agent_ends_its_followers, Outcome == disposed) :-
    on_hosts(( create([ (main :- create(clauses([ (:- agent(b, [])),
                                                  (main :- receive(_)) ]),
                                        B, [follows(true)]),
                                 dispose(B), result(B)) ], A, [host(g)]),
               agent_result(A, B, 10),
               agent_join(B, Outcome, 10) )).
test(library_typhon_is_the_vocabulary,
     Formal == existence_error(procedure, agent_dispose/1)) :-
    gives([ (:- use_module(library(typhon))),
            (main :- self(Me), catch(agent_dispose(Me), error(F, _), true),
                     F = existence_error(K, _:PI),
                     result(existence_error(K, PI))) ], Formal).

:- end_tests(files_and_agents).
