:- module(test_program, []).
:- use_module(library(plunit)).
:- use_module('../../lib/common').
:- use_module('../../lib/texts').
:- use_module('../../lib/fixtures').
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/program),
              [payload_load/2, program_hash/2, program_load/6]).

/** <module> Tests of agent programs: loading, and errors

Programs are written to files here, so that positions in files are tested as
users see them.
*/


%   program_load(+Spec, -Program, -Initial): without the cache.

program_load(Spec, Program, Initial) :-
    program_load(Spec, Program, Initial, _, _, _).

%   with_file(+Lines, :Goal): Goal(File) for a file of these lines.

:- meta_predicate with_file(+, 1), with_files(+, 1).

with_file(Lines, Goal) :-
    with_files([a-Lines], Goal).

%   with_files(+Files, :Goal): Goal(File) for the first of Files, each
%   Name-Lines.

with_files(Files, Goal) :-
    with_tmp_dir(test_program:in_dir(Files, Goal)).

in_dir(Files, Goal, Dir) :-
    forall(member(Name-Lines, Files), write_lines(Dir, Name, Lines)),
    Files = [First-_|_],
    path(Dir, First, File),
    call(Goal, File).

path(Dir, Name, File) :-
    file_name_extension(Name, pl, Base),
    directory_file_path(Dir, Base, File).

write_lines(Dir, Name, Lines) :-
    path(Dir, Name, File),
    atomic_list_concat(Lines, '\n', Text),
    write_file(File, '~w~n', [Text]).

%   error_of(+What, +Lines, -Formal, -Line, +Advice): the error when a file of
%   Lines is loaded; the message has its place and the words Advice.

error_of(What, Lines, Formal, Line, Advice) :-
    with_file(Lines, test_program:error_in_file(What, Formal, Line, Advice)).

error_in_file(What, Formal, Line, Advice, File) :-
    catch(( call(What, File), Error = none ), Error, true),
    Error = error(Formal, at(File:Line, Said, _)),
    message_text(Error, Text),
    format(string(Place), '~w:~d', [File, Line]),
    assertion(sub_string(Text, _, _, _, Place)),
    assertion(sub_atom(Said, _, _, _, Advice)).

%   Root may read any file.

reads_all :-
    with_file([], test_program:reads_forbidden).

reads_forbidden(File) :-
    chmod(File, -u),
    access_file(File, read).

not_for_us(File) :-
    chmod(File, -u),
    load(File).

load(File) :-
    program_load(File, _, _).

payload(File) :-
    payload_load(File, _).

syntax_line(Line, File) :-
    catch(load(File),
          error(syntax_error(_), at(file(File, Line, _, _), _, _)), true),
    nonvar(Line).

load_quietly(File) :-
    catch(load(File), error(_, _), true).

without_extension(Name, File) :-
    file_name_extension(Base, pl, File),
    program_load(Base, program(Name, _, _, _), _).

last_clause(Clause, File) :-
    clauses_of(Clauses, File),
    last(Clauses, Clause).

clauses_of(Clauses, File) :-
    program_load(File, program(_, _, _, Clauses), _).

error_in(Name, Line, Formal, File) :-
    catch(load(File), error(Formal, at(Where:Line, _, _)), true),
    nonvar(Where),
    file_base_name(Where, Base),
    file_name_extension(Name, pl, Base).

:- meta_predicate with_library(+, 0).

with_library(Name, Goal) :-
    with_tmp_dir(test_program:in_library(Name, Goal)).

in_library(Name, Goal, Dir) :-
    format(string(Head), ':- module(~w, [op(700, xfx, ::=)]).', [Name]),
    write_lines(Dir, Name, [Head]),
    setup_call_cleanup(
        asserta(user:file_search_path(library, Dir), Ref),
        call(Goal),
        erase(Ref)).

check(Lines, Messages) :-
    capturing(with_file(Lines, agent_check), Messages0),
    findall(M, ( member(M0, Messages0), short(M0, M) ), Messages).

short(Kind-error(_, at(_:Line, _, _)), Kind-Line).
short(Kind-typhon(checked(_, Errors, Doubts, Undefined)),
      Kind-checked(Errors, Doubts, Undefined)).

final(Clauses, Facts) :-
    with_hosts([alpha], final_(Clauses, Facts)).

%   on_message/2 keeps the agent for inspection.

final_(Clauses, Facts) :-
    create([on_message(_, _)|Clauses], Agent),
    wait_state(Agent, resident),
    facts(Agent, Facts).

%   problem(-Lines, -Formal, -Line, -Advice): the error that a program of Lines
%   raises, and words of its advice.

problem([':- agent(a).', Second, 'main.'], Formal, 2, Advice) :-
    second(Second, Formal, Advice).
problem(['% nothing', 'main.'], existence_error(declaration, agent), 2,
        'begin the file with :- agent(Name').
problem(['main.', ':- agent("census", []).'],
        existence_error(declaration, agent), 2, '').
problem([':- agent(a).', 'main.', ':- agent(b).'],
        permission_error(declare, agent, b), 3, 'one declaration').
problem([':- agent(a).', 'main :- true, 3.'], type_error(callable, (true,3)),
        2, '').
problem([':- agent(a).', 'main.', 'move(_).'],
        permission_error(modify, control_predicate, move/1), 3, 'rename').
problem([':- agent(a).', 'p(1).'], existence_error(entry, main/0), 1,
        'define main/0').
problem([':- agent(a).', 'mian.', 'on_message(_).'],
        existence_error(entry, main/0), 1, 'did you mean main/0 by mian/0?').
problem([':- agent(a, [colour(red)]).', 'main.'],
        domain_error(agent_declaration, colour(red)), 1, '').
problem(['% a file', ':- agent(a, [state([p/1, seen])]).', 'main.'],
        type_error(predicate_indicator, seen), 2, 'state([Name/Arity').
problem([':- agent(a, [state([p/1|_])]).', 'main.'],
        domain_error(agent_declaration, state(_)), 1, '').
problem([':- agent(a, [state([sleep/1])]).', 'main.'],
        permission_error(modify, control_predicate, sleep/1), 1, '').
problem([':- agent(a).', '', 'main.',
         'p(L) :- findall(X, ( member(X, [a]), move(X) ), L).'],
        permission_error(call, control_predicate, move/1), 4, Advice) :-
    member(Advice, ['inside findall/3', 'recursive predicate']).
problem([':- agent(a).', Main],
        permission_error(call, control_predicate, move/1), 2, '') :-
    member(Goal, [ 'forall(q(X), move(X))', '\\+ move(a)',
                   'findnsols(2, X, move(X), _)', 'maplist(move, [a])',
                   'foldl([X,_,_]>>move(X), [a], 0, _)' ]),
    main_line(Goal, Main).
problem([':- agent(a).', 'main :- forall(true, tour).', 'tour :- stop.',
         'stop :- sleep(1).'],
        permission_error(call, control_predicate, tour/0), 2, '').
problem([':- agent(a).', 'p(1).', Main],
        permission_error(modify, static_procedure, p/1), 3, 'state([p/1])') :-
    member(Goal, [ 'assertz(p(2))', 'retract(p(_))',
                   'forall(true, retractall(p(_)))' ]),
    main_line(Goal, Main).
problem([':- agent(a).', '1.', ':- foo.', 'main :- 3.'],
        type_error(callable, 1), 2, '').

main_line(Goal, Line) :-
    atomic_list_concat(['main :- ', Goal, '.'], Line).

%   second(-Text, -Formal, -Advice): of the second line of a program.

second(':- payload(b, []).', permission_error(declare, payload, b), '').
second(':- op(700, xfx, user:(===>)).',
       domain_error(directive, op(700, xfx, user:(===>))), '').
second(':- op(700, x, ===>).', domain_error(operator_specifier, x), '').
second(':- encoding(iso_latin_1).',
       domain_error(directive, encoding(iso_latin_1)), '').
second(':- initialization(main).',
       domain_error(directive, initialization(main)),
       'nothing runs at load time').
second(':- nb_setval(test_program_ran, yes).', domain_error(directive, _), '').
second(':- X.', instantiation_error, '').
second(':- use_module(foo).', domain_error(directive, use_module(foo)), '').
second(':- use_module(library(no_such_thing)).',
       existence_error(library, no_such_thing), 'no such library').
second(':- dynamic p/1, seen.', type_error(predicate_indicator, seen),
       'Name/Arity').
second(':- dynamic assertz/1.',
       permission_error(modify, static_procedure, assertz/1), '').
second('X :- foo.', instantiation_error, '').
second('12 :- foo.', type_error(callable, 12), 'atom or a compound').
second('lists:p.', domain_error(clause_head, lists:p), '').
second('atom_length(_, 7).',
       permission_error(modify, static_procedure, atom_length/2), '').
second('(a *-> b).', permission_error(modify, static_procedure, _), '').
second('p(X) => q(X).', domain_error(clause, _), '').
second('1 --> foo.', type_error(callable, 1), '').
second(':- include(b).', existence_error(source_sink, b), 'cannot include').
second(':- include(a).', permission_error(include, source_sink, a), '').

payload_problem(['p(1).'], existence_error(declaration, payload), 1,
                'begin the file with :- payload(Name').
payload_problem([':- payload(a, [offers([])]).'],
                domain_error(payload_declaration, offers([])), 1,
                'write payload(Name, [provides([Name/Arity, ...])])').
payload_problem([':- payload(a).', 'p(1).', '5.'], type_error(callable, 5), 3,
                '').

:- begin_tests(load_errors).

test(problem, [ forall(problem(Lines, Formal, Line, Advice)),
                setup(nb_setval(test_program_ran, no)),
                true(subsumes_term(Formal-Line, F-L)) ]) :-
    error_of(load, Lines, F, L, Advice),
    assertion(\+ current_op(_, _, ===>)),
    assertion(nb_getval(test_program_ran, no)).
test(payload_problem, [ forall(payload_problem(Lines, Formal, Line, Advice)),
                        F-L == Formal-Line ]) :-
    error_of(payload, Lines, F, L, Advice).
test(no_program, [ forall(member(Program-Error,
                                 [ no_such_census
                                   -existence_error(source_sink,
                                                    no_such_census),
                                   _-instantiation_error,
                                   7-type_error(callable, 7),
                                   clauses([])
                                   -existence_error(declaration, agent) ])),
                   error(Error) ]) :-
    load(Program).
test(line_of_a_syntax_error,
     [ forall(member(Lines-Line,
                     [ [':- agent(a).', 'main :-', '    foo,', '    bar baz.']
                       -4,
                       [':- agent(a).', 'main :- foo']-2,
                       ['#! /bin/x', ':- agent(a).', ':- op(700, xfx, ===>).',
                        'main :- a ===> b c.']-4 ])),
       L == Line ]) :-
    with_file(Lines, test_program:syntax_line(L)).
test(operators_of_the_program) :-
    with_file(['#!/usr/bin/env swipl', ':- encoding(utf8).', ':- agent(a).',
               ':- op(700, xfx, ===>).', ':- op(200, xfy, [&, and]).',
               'main :- rule(a & b ===> c and d).', 'rule(_ ===> _).'],
              test_program:load),
    assertion(\+ current_op(_, _, ===>)).
test(all_problems_in_file_order, Lines == [1,2,3,4]) :-
    check([':- agent(a, [x]).', '1.', ':- foo.', 'p :- 3.', 'main.'], Told),
    findall(Line, member(error-Line, Told), Lines).

:- end_tests(load_errors).

%   chain(+Last, +Count, -Inferences): to load a program of Count predicates,
%   each of which calls the next, and the last Last.

chain(Last, Count, Inferences) :-
    findall((Head:-Body),
            ( between(1, Count, N),
              atom_concat(p, N, Head),
              (   N < Count
              ->  Next is N+1,
                  atom_concat(p, Next, Body)
              ;   Body = Last
              ) ),
            Clauses),
    statistics(inferences, Before),
    program_load(clauses([(:- agent(a)), main|Clauses]), _, _),
    statistics(inferences, After),
    Inferences is After-Before.

:- begin_tests(programs).

%   Peers send programs: a long chain of calls must not take seconds.

test(chain_of_calls,
     [ forall(member(Last, [true, move(x), call(_), state])),
       true(Inferences < 10 000 000) ]) :-
    chain(Last, 1000, Inferences).

test(parts, P-I =@= program(a, [p/1,q/1], [library(dcg/basics)-all],
                            [(main:-p(X), r(X)), r(_)])-[p(1),(q(Y):-p(Y))]) :-
    program_load(clauses([ (:- agent(a, [state([p/1])])),
                           (:- use_module(library(dcg/basics))),
                           (:- dynamic([q/1])),
                           (:- discontiguous(r/1)),
                           p(1), (main :- p(X), r(X)), r(_),
                           (q(Y) :- p(Y)) ]), P, I).
%   same_hash(-Clauses1, -Clauses2, -Same)

same_hash([(:- agent(a)), main], [(:- agent(b)), main], true).
same_hash([(:- agent(a, [state([p/1])])), main, p(1)],
          [(:- agent(a, [state([p/1])])), main], true).
same_hash([(:- agent(a)), (main :- p(_, _))],
          [(:- agent(a)), (main :- p(X, X))], false).

test(hash_of_a_program, [ forall(same_hash(Clauses1, Clauses2, Same)),
                          true(( Same == true -> H1 == H2 ; H1 \== H2 )) ]) :-
    hash(Clauses1, H1),
    hash(Clauses2, H2).

hash(Clauses, Hash) :-
    program_load(clauses(Clauses), Program, _),
    program_hash(Program, Hash).

test(operators_of_the_reader_do_not_change_the_hash, H1 == H2) :-
    program_load(clauses([(:- agent(a)), (main :- likes(a, b))]), P, _),
    program_hash(P, H1),
    setup_call_cleanup(op(700, xfx, user:likes),
                       program_hash(P, H2),
                       op(0, xfx, user:likes)).
test(unreadable_file,
     [ condition(\+ reads_all),
       error(permission_error(open, source_sink, _)) ]) :-
    with_file([':- agent(a).', 'main.'], test_program:not_for_us).
test(extension_may_be_left_out, N == a) :-
    with_file([':- agent(a).', 'main.'], test_program:without_extension(N)).
test(utf8, [C == p('Grüße, 東京')]) :-
    with_file([':- agent(a).', 'main.', 'p(\'Grüße, 東京\').'],
              test_program:last_clause(C)).
test(include, F == [main,p(1),p(2),q(3)]) :-
    with_files([ a-[':- agent(a).', 'main.', ':- include(b).', 'q(3).'],
                 b-['p(1).', 'p(2).'] ],
               test_program:clauses_of(F)).
test(error_in_an_included_file, L-E == 2-type_error(callable, 7)) :-
    with_files([ a-[':- agent(a).', 'main.', ':- include(b).'],
                 b-['p(1).', '7.'] ],
               test_program:error_in(b, L, E)).
test(mistyped_included_file) :-
    with_files([ a-[':- agent(a).', ':- include(helprs).', 'main.'],
                 helpers-['p(1).'] ],
               test_program:error_in_file(load, _, 2, 'did you mean helpers?')).
test(files_that_include_each_other,
     true(E-L == permission_error(include, source_sink, a)-1)) :-
    with_files([ a-[':- agent(a).', ':- include(b).', 'main.'],
                 b-[':- include(a).'] ],
               test_program:error_in(b, L, E)).
test(grammar, C =@= [main,(g-->[])]) :-
    with_file([':- agent(a).', 'main.', 'g --> [].'],
              test_program:clauses_of([main,(g(S,T):-S=T)])),
    C = [main,(g-->[])].
test(operators_of_a_library,
     [ forall(member(Use, [ library(test_operators_1),
                            ( library(test_operators_1),
                              [op(700, xfx, ::=)] ) ])),
       F == [main,'::='(a, b)] ]) :-
    format(atom(Directive), ':- use_module(~q).', [Use]),
    operators([ a-[':- agent(a).', Directive, 'main.', 'a ::= b.'] ], F).
test(operators_in_an_included_file, F == [main,'::='(a, b)]) :-
    operators([ a-[':- agent(a).', ':- use_module(library(test_operators_1)).',
                   'main.', ':- include(b).'],
                b-['a ::= b.'] ], F).

operators(Files, Clauses) :-
    with_library(test_operators_1,
                 with_files(Files, test_program:clauses_of(Clauses))),
    assertion(\+ current_op(_, _, '::=')).

test(reading_leaves_nothing) :-
    no_leaks(with_file([':- agent(a).', 'main.', '7.'],
                       test_program:load_quietly)).

:- end_tests(programs).

                /*******************************
                *           REMEMBERED         *
                *******************************/

%   loads(+File, -Fact): the last clause of File in the program from which
%   agents are created. File was read for that, or not.

loads(File, Fact) :-
    program_load(File, program(_, _, _, Clauses), _, _, _, _),
    last(Clauses, Fact).

reads(File, Fact) :-
    retractall(was_read(_)),
    loads(File, Fact),
    retract(was_read(File)).

remembers(File, Fact) :-
    \+ reads(File, _),
    loads(File, Fact).

:- dynamic was_read/1.
:- multifile typhon_programs:read_anew/4.

typhon_programs:read_anew(File, _, _, _) :-
    assertz(test_program:was_read(File)).

%   set_age(+Seconds, +File): File was changed Seconds ago.

set_age(Seconds, File) :-
    get_time(Now),
    Time is Now-Seconds,
    set_time_file(File, _, [modified(Time)]).

change(Dir, Name, Lines, Age) :-
    write_lines(Dir, Name, Lines),
    path(Dir, Name, File),
    set_age(Age, File).

two_files(Age, Goal) :-
    with_tmp_dir(test_program:in_two_files(Age, Goal)).

in_two_files(Age, Goal, Dir) :-
    change(Dir, a, [':- agent(a).', 'main.', ':- include(b).'], Age),
    change(Dir, b, ['p(1).'], Age),
    path(Dir, a, File),
    call(Goal, Dir, File).

old_files(Dir, File) :-
    reads(File, p(1)),
    remembers(File, p(1)),
    change(Dir, b, ['p(2).'], 50),
    loads(File, p(2)),
    change(Dir, a, [':- agent(a).', 'main.', 'p(3).'], 100),
    loads(File, p(3)),
    set_age(70, File),
    loads(File, p(3)).

new_files(Dir, File) :-
    reads(File, p(1)),
    reads(File, p(1)),
    change(Dir, b, ['p(2).'], 1),
    loads(File, p(2)).

gone(Dir, File) :-
    loads(File, p(1)),
    path(Dir, b, Included),
    delete_file(Included),
    catch(loads(File, _), error(existence_error(_, _), _), true).

another(Dir, File) :-
    change(Dir, a, [':- agent(a).', 'main.', ':- include(\'b\').'], 100),
    loads(File, p(1)),
    path(Dir, b, Included),
    file_name_extension(Base, pl, Included),
    write_file(Base, 'p(4).~n', []),
    loads(File, p(4)).

many(Dir, _) :-
    findall(File, ( member(Name, [c1, c2, c3, c4, c5]),
                    change(Dir, Name, [':- agent(a).', 'main.'], 100),
                    path(Dir, Name, File),
                    reads(File, main) ), [First,Second|Last]),
    forall(member(File, Last), remembers(File, main)),
    forall(member(File, [First,Second]), reads(File, main)).

:- begin_tests(program_cache).

test(program_is_cached_until_its_file_changes) :-
    two_files(100, test_program:old_files).
test(new_file_is_not_cached) :-
    two_files(1, test_program:new_files).
test(missing_file_is_not_cached) :-
    two_files(100, test_program:gone).
test(relative_name_of_another_file_is_not_cached) :-
    two_files(100, test_program:another).
test(cache_is_bounded) :-
    with_settings([typhon_loaded:files=3],
                  two_files(100, test_program:many)).

:- end_tests(program_cache).

:- begin_tests(agent_check).

test(correct_program, M == [informational-checked(0, 0, 0)]) :-
    check([':- agent(a, [state([p/1])]).',
           'main :- p(X), q(X), member(Y, [X]), here(_), move(Y).',
           'q(_).'], M).
test(all_problems, M == [error-3, error-4, warning-2,
                         informational-checked(2, 0, 1)]) :-
    check([':- agent(a).',
           'main :- nowhere(1).',
           '1.',
           ':- foo.'], M).
test(undefined_in_a_meta_call,
     M == [warning-2, informational-checked(0, 0, 1)]) :-
    check([':- agent(a).', 'main :- findall(X, nowhere(X), _).'], M).
test(exports_of_a_library, M == [informational-checked(0, 0, 0)]) :-
    check([':- agent(a).', ':- use_module(library(dcg/basics)).',
           'main :- phrase(integer(_), `12`).'], M).
test(misplaced_control, M == [error-2, informational-checked(1, 0, 0)]) :-
    check([':- agent(a).', 'main :- forall(true, move(a)).'], M).
test(missing_file, error(existence_error(source_sink, no_such_census))) :-
    agent_check(no_such_census).

:- end_tests(agent_check).

:- begin_tests(state).

%   final(-Behaviour, -Clauses, -Facts)

final(facts, [s(1), s(2), (main :- retract(s(1)), assertz(s(3)))],
      [s(2),s(3)]).
final(rule_replaced_during_its_run,
      [ (main :- r(1), r(1)),
        (r(1) :- retract((r(1) :- _)), assertz((r(1) :- assertz(s(new)))),
                 assertz(s(old))) ],
      [(r(1) :- assertz(s(new))), s(old), s(new)]).
final(rule_that_calls_control,
      [ (main :- assertz(s(1)),
                 assertz((r(X) :- receive(_, 0.01) -> true ; assertz(s(X)))),
                 r(2)) ],
      [(r(X) :- receive(_, 0.01) -> true ; assertz(s(X))), s(1), s(2)]).
final(predicates_not_declared_are_state, [(main :- assertz(new(1)))],
      [new(1)]).
final(own_grammar, [ (list([X|Xs]) --> [X], list(Xs)), (list([]) --> []),
                     (main :- phrase(list(L), [1,2]), assertz(s(L))) ],
      [s([1,2])]).

test(final, [forall(final(_, Clauses, Facts)), true(F =@= Facts)]) :-
    final(Clauses, F).
test(rule_replaced_by_one_that_moves, F == [s(here),s(alpha),s(beta)]) :-
    with_hosts([alpha,beta],
               ( create([ on_message(_, _),
                          (main :- r(beta), change, r(beta), name(N),
                                   assertz(s(N))),
                          (r(_) :- assertz(s(here)), name(N), assertz(s(N))),
                          (change :- retract((r(_) :- _)),
                                     assertz((r(H) :- move(H)))),
                          (name(N) :- here(A), atomic_list_concat([N,_],
                                                                  @, A)) ],
                        Agent),
                 wait_state(Agent, resident),
                 findall(s(X), fact_of(Agent, s(X)), F) )).
test(state_named_like_a_library_predicate, F == [last(1,2)]) :-
    with_hosts([alpha],
               ( agent_create(clauses([(:- agent(t, [state([last/2])])),
                                       on_message(_, _),
                                       last(1, 1),
                                       (main :- last(1, X), retract(last(1, X)),
                                                assertz(last(1, 2)))]), A),
                 wait_state(A, resident),
                 agent_property(A, facts(F)) )).
test(two_agents_do_not_share_state, F1-F2 == [s(1)]-[s(2)]) :-
    with_hosts([alpha],
               ( P = [on_message(_, _)],
                 create(P, A1, [facts([s(1)])]),
                 create(P, A2, [facts([s(2)])]),
                 agent_property(A1, facts(F1)),
                 agent_property(A2, facts(F2)) )).
test(library_with_operators_and_predicates, F == [s(12)]) :-
    with_hosts([alpha],
               ( agent_create(clauses([(:- agent(t, [state([s/1])])),
                                       (:- use_module(library(dcg/basics))),
                                       on_message(_, _),
                                       (main :- phrase(number(X), `12`),
                                                assertz(s(X)))]), A),
                 wait_state(A, resident),
                 agent_property(A, facts(F)) )).
:- end_tests(state).
