:- module(test_guard_rules, []).
:- use_module('../../../lib/common').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/guard), []).

/** <module> What the guard accepts and refuses, without a host

Each rule is tried at its bound: what it allows last, and what it refuses
first.

*Threading*: one test at a time.
*/

:- initialization(typhon_allowed:policy_read(guarded)).

%   program(+State, +Imports, +Clauses, -Verdict) and called(+Goal, -Verdict):
%   Verdict is `yes`, or refused(Culprit).

program(State, Imports, Clauses, Verdict) :-
    verdict(typhon_guard_clauses:guard_program(
                guarded, program(x, State, Imports, Clauses), _), Verdict).

called(Goal, Verdict) :-
    called(guarded, Goal, Verdict).

called(Policy, Goal, Verdict) :-
    verdict(typhon_guard_calls:guard_call(Policy, none, Goal, [], _), Verdict).

fact(Fact, Verdict) :-
    verdict(typhon_guard_clauses:guard_state(guarded, state([], [Fact]), _),
            Verdict).

:- meta_predicate verdict(0, -).

verdict(Goal, Verdict) :-
    catch(( call(Goal), Verdict = yes ), error(Formal, _),
          because(Formal, Verdict)).

because(permission_error(call, sandboxed, Culprit), refused(Culprit)) :-
    !.
because(resource_error(What), refused(What)) :-
    !.
because(Formal, Formal).

%   defines(+Name, -Way, -Verdict): an agent gets a predicate Name/1.

defines(Name, Way, Verdict) :-
    Head =.. [Name,a],
    PI = Name/1,
    member(Way-Goal,
           [ static-program([], [], [Head], Verdict),
             rule-program([], [], [(Head :- true)], Verdict),
             state-program([PI], [], [], Verdict),
             arriving-fact(Head, Verdict),
             empty-verdict(typhon_guard_clauses:guard_state(
                               guarded, state([PI], []), _), Verdict),
             payload-verdict(typhon_guard_clauses:guard_declares(guarded, PI),
                             Verdict),
             clauses-verdict(typhon_guard_clauses:guard_clauses(
                                 guarded, [(Head :- true)], _), Verdict),
             assert-called(assert(Head), Verdict),
             asserta-called(asserta(Head), Verdict),
             assertz-called(assertz(Head), Verdict),
             assert_rule-called(assertz((Head :- true)), Verdict),
             retract-called(retract(Head), Verdict),
             retract_rule-called(retract((Head :- _)), Verdict),
             retractall-called(retractall(Head), Verdict),
             clause-called(clause(Head, _), Verdict) ]),
    call(Goal).

:- begin_tests(guard_definitions).

test(agents_have_no_predicates_of_the_platform,
     [forall(member(Name, ['$x','$mobile','$other',$,'mobile main'])),
      Accepted == []]) :-
    findall(Way, ( defines(Name, Way, Verdict), Verdict == yes ), Accepted).
test(agents_have_predicates_of_other_names,
     [forall(member(Name, [x,plan,mobile,'a$','a mobile b'])),
      Refused == []]) :-
    findall(Way-Verdict, ( defines(Name, Way, Verdict), Verdict \== yes ),
            Refused).
test(agents_have_no_facts_that_are_clauses_of_others,
     [forall(member(Fact, [ ((p :- a) :- b), (a --> b), (a => b),
                            ?=>(a, b), (:- p), (?- p), (user:p(1)),
                            (p, q), (p ; q), (p -> q), (p *-> q), \+ p, !,
                            call(p), once(p), catch(p, _, q), '|'(p, q),
                            @(p, m), $, $(p), call(p, q) ])),
      Verdicts = [refused(_),refused(_),refused(_)]]) :-
    program([], [], [Fact], V1),
    fact(Fact, V2),
    called(assertz(Fact), V3),
    Verdicts = [V1,V2,V3].
test(agents_have_no_dynamic_predicates_of_names_that_are_taken,
     [forall(member(Name/Arity, [ write/1, halt/0, halt/1, assertz/1, open/3,
                                  shell/1, consult/1, deliver/1 ])),
      Verdicts = [refused(_),refused(_)]]) :-
    functor(Head, Name, Arity),
    program([Name/Arity], [], [], V1),
    called(assertz(Head), V2),
    Verdicts = [V1,V2].
test(static_predicates_hide_those_of_the_system, Verdict == yes) :-
    program([], [], [write(_), (main :- write(x))], Verdict).
test(facts_of_the_platform_stay, Verdicts == [yes,yes,yes,yes,yes,yes]) :-
    maplist(fact, [ '$global'(a, b), '$legacy'(x), '$memory'(x), '$owner'(x),
                    '$trail'(a, b, c, d), '$signed'(a, b) ], Verdicts).
test(declarations_of_the_platform_stay, Verdict == yes) :-
    verdict(typhon_guard_clauses:guard_state(
                guarded, state(['$legacy'/1,'$trail'/4], []), _), Verdict).
test(other_facts_of_the_platform_are_refused,
     [forall(member(Fact, [ '$owner'(a, b), '$legacy'(a, b), '$other'(a),
                            '$tokens'([red]), ('$legacy'(_) :- true) ])),
      Verdict = refused(_)]) :-
    fact(Fact, Verdict).
test(state_has_names_and_arities,
     Refused =@= ["x"/1, x/(-1), x/256, x/_, _/1, x/1.0, x, _]) :-
    findall(PI,
            ( member(PI, [ x/0, x/255, "x"/1, x/(-1), x/256, x/_, _/1, x/1.0,
                           x, _ ]),
              program([PI], [], [], Verdict),
              Verdict = refused(_) ),
            Refused).

:- end_tests(guard_definitions).

                /*******************************
                *           LIBRARIES          *
                *******************************/

libraries([ aggregate, apply, assoc, error, heaps, lists, option, ordsets,
            pairs, random, rbtrees, solution_sequences, ugraphs, yall ]).

:- begin_tests(guard_libraries).

test(documented_libraries_are_allowed, [forall(library(L)), V == yes]) :-
    program([], [library(L)-all], [], V).
test(no_others_are,
     [forall(member(Spec, [ process, socket, sandbox, thread, prolog_stack,
                            filesex, readutil, debug, gensym, terms, _,
                            x/lists, lists(x) ])),
      Verdict = refused(_)]) :-
    program([], [library(Spec)-all], [], Verdict).
test(imports_are_names_and_arities, Verdicts == [yes,yes,no,no,no,no,no,no]) :-
    findall(V,
            ( member(Imports, [ all, [append/3], [append], [append/x],
                                ["append"/3], [append/3|_], except([]),
                                [_/3] ]),
              program([], [library(lists)-Imports], [], V0),
              ( V0 == yes -> V = yes ; V = no ) ),
            Verdicts).
test(library_typhon_is_not_imported, Libraries == [library(lists)-all]) :-
    typhon_guard_clauses:guard_program(
        guarded,
        program(x, [], [library(typhon)-all,library(lists)-all], []),
        program(_, _, Libraries, _)).

:- end_tests(guard_libraries).

library(L) :-
    libraries(Ls),
    member(L, Ls).

                /*******************************
                *            CALLS             *
                *******************************/

%   withheld(-Goal): library(sandbox) allows it.

withheld(Goal) :-
    member(Name/Arity,
           [ abort/0, sleep/2, writeln/1, print_message/2, message_to_string/2,
             format_time/3, format_time/4, normalize_space/2, b_getval/2,
             nb_getval/2, nb_current/2, abolish_all_tables/0, thread_self/1,
             statistics/2, is_stream/1, blob/2, current_prolog_flag/2,
             current_op/3, import_module/2, strip_module/3, current_type/3,
             variant_sha1/2, variant_hash/2, name/2, atomic_concat/3,
             get_attr/3, get_attrs/2, del_attr/2, del_attrs/1, copy_term/3,
             setarg/3, b_set_dict/3, nb_setarg/3, nb_linkarg/3, nb_set_dict/3,
             nb_link_dict/3, dcg_translate_rule/2, set_random/1, setrand/1,
             getrand/1, random_property/1, meta_options/3, foreach/2,
             term_string/3, deliver/1, undeliver/1, seal/3, unseal/2, (\)/1,
             (\)/2, (^)/2, '$btree_find_node'/5 ]),
    functor(Goal, Name, Arity),
    ( predicate_property(typhon_vocabulary:Goal, visible) -> true ; fail ).

:- begin_tests(guard_calls).

test(withheld_predicates_are_refused, Called == []) :-
    findall(Goal, ( withheld(Goal), called(Goal, yes) ), Called).
test(many_of_them_exist, true(Count > 40)) :-
    findall(x, withheld(_), Xs),
    length(Xs, Count).
test(harmless_predicates_are_called,
     [forall(member(Goal, [ X is 1+1, X = Y, append([], [], _), send(user, x),
                            self(_), findall(X, member(X, [1]), Y),
                            forall(member(X, [1]), integer(X)),
                            aggregate_all(count, member(X, [Y]), _),
                            maplist([X]>>integer(X), [1]), sleep(1),
                            phrase(x, []), unknown_name(1),
                            copy_term(X, Y), nb_unknown, setof(X, Y^p(X,Y), _),
                            number_codes(_, [0'1]), leave(x) ])),
      Verdict == yes]) :-
    called(Goal, Verdict).
test(each_part_of_a_construct_is_checked, Deviations == []) :-
    Bad = shell(x),
    findall(Goal-V,
            ( member(Goal, [ (Bad,true), (true,Bad), (Bad;true), (true;Bad),
                             (Bad->true), (true->Bad), (Bad*->true),
                             (true*->Bad), \+ Bad, call(Bad), once(Bad),
                             ignore(Bad), catch(Bad, _, true),
                             catch(true, _, Bad), call(shell, x),
                             findall(x, Bad, _), setof(x, _^Bad, _),
                             forall(true, Bad),
                             maplist([_]>>Bad, [1]),
                             maplist(/(_, [_]>>Bad), []),
                             maplist([_,_]>>(true,Bad), [], []) ]),
              program([], [], [(main :- Goal)], V),
              V \= refused(shell(_)) ),
            Deviations).
test(no_construct_is_allowed_by_a_rule, Verdicts == [refused]) :-
    Goals = [ a:b, @(a, b), '|'(a, b), $, $(a) ],
    with_rules([allow((:)/2), allow((@)/2), allow(('|')/2), allow(($)/0),
                allow(($)/1)], Policy,
               findall(V, ( member(G, Goals), called(Policy, G, V0),
                            ( V0 = refused(_) -> V = refused ; V = G ) ), Vs)),
    sort(Vs, Verdicts).
test(unbound_and_cyclic_goals_are_errors,
     Verdicts == [instantiation_error,refused(cyclic(f/1))]) :-
    F = f(F),
    called(_, V1),
    called(F, V2),
    Verdicts = [V1,V2].
test(goals_that_are_none_are_refused,
     [forall(member(Goal, [1, "x", 1.5, f(x):y])), Verdict == refused(Goal)]) :-
    called(Goal, Verdict).
test(payloads_are_attached_by_name,
     Verdicts == [yes,yes,no,no,no,no,no,no]) :-
    findall(V, ( member(Spec, [ payloads(x), payloads(x/y), payloads('../x'),
                                payloads('/x'), '/etc/passwd', library(x),
                                [], _ ]),
                 called(attach(Spec), V0),
                 ( V0 == yes -> V = yes ; V = no ) ), Verdicts).
test(culprit_of_large_terms_is_a_name, Culprits == [f/2, f(x)]) :-
    numlist(1, 1000, Ns),
    findall(Culprit,
            ( member(Arg, [Ns-Ns, x]),
              ( Arg == x -> Term = f(x) ; Term = f(Arg, Arg) ),
              catch(typhon_guard_limits:refuse(Term),
                    error(permission_error(call, sandboxed, Culprit), _),
                    true) ),
            Culprits).
test(only_lists_of_parameters_make_lambda_expressions,
     Verdicts == [yes,yes,yes,no,no]) :-
    findall(V, ( member(L, [ [_]>>true, [_,_]>>true, /(_, [_]>>true),
                             x>>true, [_|_]>>true ]),
                 called(maplist(L, [], []), V0),
                 ( V0 == yes -> V = yes ; V = no ) ), Verdicts).
test(parts_of_goals_are_bounded, Verdicts == [refused(clause_cells),yes]) :-
    tree(5, G),
    findall(V, ( member(Cells, [62,63]),
                 with_settings([typhon_guard_limits:clause_cells=Cells],
                               called(G, V)) ),
            Verdicts).
test(pending_goals_are_checked, Vs == [yes,yes,yes,no,no,no,no]) :-
    findall(V, ( member(G, [ true, '$fault'(x), '$at'(move(x), fail),
                             '$at'(x, true), shell(x), user:true,
                             '$cut'(1) ]),
                 verdict(typhon_guard_calls:guard_goals(guarded, user, [G], _),
                         V0),
                 ( V0 == yes -> V = yes ; V = no ) ), Vs).

:- end_tests(guard_calls).

%   tree(+N, -Goal): Goal has 2^N goals, most of them shared.

tree(0, true) :-
    !.
tree(N, (G,G)) :-
    M is N-1,
    tree(M, G).

                /*******************************
                *            BOUNDS            *
                *******************************/

text(N, Atom) :-
    length(Codes, N),
    maplist(=(0'x), Codes),
    atom_codes(Atom, Codes).

%   makes(+Text, -Goal): Goal makes atoms of Text, which is all its input.

makes(T, Goal) :-
    member(Goal,
           [ atom_concat(T, '', _), atom_concat('', T, _),
             atomic_list_concat([T], _), atomic_list_concat([T], x, _),
             atom_codes(T, _), atom_chars(T, _), atom_string(_, T),
             atom_number(T, _), upcase_atom(T, _), downcase_atom(T, _),
             sub_atom(T, _, _, _, _), sub_atom_icasechk(T, _, _),
             hash_atom([T], _), file_base_name(T, _),
             file_directory_name(T, _), file_name_extension(T, '', _),
             uri_components(_, uri_components(T, _, _, _, _)),
             uri_authority_components(T, _), uri_query_components(T, _),
             uri_encoded(_, T, _), uri_is_global(T), uri_iri(T, _),
             uri_normalized(T, _), uri_normalized(T, '', _),
             uri_normalized_iri(T, _), uri_normalized_iri(T, '', _),
             uri_resolve(T, '', _), iri_normalized(T, _),
             iri_normalized(T, '', _), term_to_atom(_, T), term_string(_, T),
             atom_to_term(T, _, _) ]).

:- begin_tests(guard_bounds).

test(texts_of_atoms_are_bounded, Deviations == []) :-
    with_settings([typhon_guard_limits:atom_chars=40],
                  ( text(38, Short), text(43, Long),
                    findall(Goal, text_deviates(Short, Long, Goal),
                            Deviations) )).
test(bound_of_texts_is_exact, Verdicts = [yes,refused(_)]) :-
    with_settings([typhon_guard_limits:atom_chars=40],
                  findall(V, ( member(N, [40,41]), text(N, T),
                               called(upcase_atom(T, _), V) ), Verdicts)).
test(separators_count, Verdicts = [yes,refused(_)]) :-
    with_settings([typhon_guard_limits:atom_chars=40],
                  findall(V, ( member(N, [10,11]), length(L, N),
                               maplist(=(abc), L),
                               called(atomic_list_concat(L, -, _), V) ),
                          Verdicts)).
test(digits_of_numbers_count, Verdicts = [yes,refused(_)]) :-
    with_settings([typhon_guard_limits:atom_chars=40],
                  findall(V, ( member(N, [39,40]), X is 10**N,
                               called(atom_concat(X, '', _), V) ), Verdicts)).
test(facts_are_bounded, Verdicts = [yes,refused(_)]) :-
    with_settings([typhon_guard_limits:clause_cells=100],
                  findall(V, ( member(N, [49,50]), numlist(1, N, L),
                               fact(s(L), V) ), Verdicts)).
test(asserted_facts_are_bounded, Verdicts = [yes,refused(_)]) :-
    with_settings([typhon_guard_limits:clause_cells=100],
                  findall(V, ( member(N, [49,50]), numlist(1, N, L),
                               called(assertz(s(L)), V) ), Verdicts)).
test(thrown_terms_are_bounded, Verdicts = [yes,refused(_)]) :-
    with_settings([typhon_guard_calls:ball_cells=100],
                  findall(V, ( member(N, [49,50]), numlist(1, N, L),
                               called(throw(s(L)), V) ), Verdicts)).
test(sizes_of_terms_are_bounded, Deviations == []) :-
    findall(Goal,
            ( member(N-Expected, [100 000 000-yes, 100 000 001-no, x-yes]),
              member(Goal, [ length(_, N), functor(_, f, N),
                             functor(_, f, N, compound),
                             compound_name_arity(_, f, N) ]),
              called(Goal, V0),
              ( V0 == yes -> V = yes ; V = no ),
              V \== Expected ),
            Deviations).
test(no_agent_throws_what_ends_a_thread,
     [forall(member(Ball, [ '$aborted', unwind(abort), unwind(halt(0)), _,
                            inference_limit_exceeded(x), depth_limit_exceeded,
                            time_limit_exceeded, time_limit_exceeded(1) ])),
      Verdict = refused(_)]) :-
    called(throw(Ball), Verdict).
test(formats_have_the_documented_directives, Allowed == `acdefgnqrstwDR+|~`) :-
    numlist(33, 126, Codes),
    findall(C, ( member(C, Codes), format_of([0'~,C], yes) ), Allowed0),
    msort(Allowed0, Sorted),
    Expected0 = `acdefgnqrstwDR+|~`,
    msort(Expected0, Expected),
    ( Sorted == Expected -> Allowed = Expected0 ; Allowed = Sorted ).
test(counts_of_formats_have_three_digits,
     Verdicts == [yes,yes,no,yes,no,no,no,no]) :-
    findall(V, ( member(F, [ "~9d", "~999d", "~1000d", "~`-t~30|", "~`-d",
                             "~:d", "~*c", "~" ]),
                 string_codes(F, Codes),
                 format_of(Codes, V) ), Verdicts).
test(formats_are_written_to_terms, Verdicts == [yes,yes,yes,no,no,no]) :-
    findall(V, ( member(Sink, [ string(_), codes(_), chars(_), atom(_),
                                user_error, _ ]),
                 called(format(Sink, "x", []), V0),
                 ( V0 == yes -> V = yes ; V = no ) ), Verdicts).
test(texts_with_quasi_quotations_are_not_read, Verdicts == [no,no,no,yes]) :-
    findall(V, ( member(G, [ term_to_atom(_, 'a{|x||y|}'),
                             term_string(_, "{|x||y|}"),
                             atom_to_term('{|x||y|}', _, _),
                             term_to_atom(_, '{x|y}') ]),
                 called(G, V0),
                 ( V0 == yes -> V = yes ; V = no ) ), Verdicts).

:- end_tests(guard_bounds).

text_deviates(Short, Long, Goal) :-
    member(Text-Expected, [Short-yes, Long-refused(_)]),
    makes(Text, Goal),
    \+ called(Goal, Expected).

format_of(Codes, Verdict) :-
    string_codes(Format, Codes),
    called(format(string(_), Format, []), Verdict0),
    ( Verdict0 == yes -> Verdict = yes ; Verdict = no ).

                /*******************************
                *            RULES             *
                *******************************/

:- meta_predicate with_rules(+, -, 0), in_rules(+, -, 0, +).

with_rules(Rules, Policy, Goal) :-
    with_tmp_dir(in_rules(Rules, Policy, Goal)).

in_rules(Rules, Policy, Goal, Dir) :-
    directory_file_path(Dir, 'rules.pl', Policy),
    rules_written(Policy, Rules),
    typhon_allowed:policy_read(Policy),
    call(Goal).

rules_written(File, Rules) :-
    setup_call_cleanup(
        open(File, write, Out),
        forall(member(Rule, Rules), format(Out, "~q.~n", [Rule])),
        close(Out)).

:- begin_tests(guard_policies).

test(rules_allow_and_refuse, Verdicts == [yes,no,no,no,yes,no]) :-
    with_rules([allow(getenv/2), refuse(send/2), refuse(catch/3),
                refuse(own/0)], Policy,
               findall(V, ( member(G, [ getenv(x, _), send(user, x),
                                        catch(true, _, true), own, true,
                                        shell(x) ]),
                            called(Policy, G, V0),
                            ( V0 == yes -> V = yes ; V = no ) ), Verdicts)).
test(rules_of_one_file_are_not_those_of_another, Verdicts == [yes,no,no]) :-
    with_rules([allow(getenv/2)], One,
               with_rules([], Two,
                   findall(V, ( member(Policy, [One,Two,guarded]),
                                called(Policy, getenv(x, _), V0),
                                ( V0 == yes -> V = yes ; V = no ) ),
                           Verdicts))).
test(rules_that_are_read_again_replace_the_former, Verdict = refused(_)) :-
    with_rules([allow(getenv/2)], Policy,
               ( rules_written(Policy, []),
                 typhon_allowed:policy_read(Policy),
                 called(Policy, getenv(x, _), Verdict) )).
test(rule_that_is_none_is_an_error,
     [forall(member(Rule, [ allow(x), permit(x/1), allow(x/_), allow("x"/1),
                            allow(x/y), allow(x/1, y), x ])),
      error(domain_error(policy_rule, _))]) :-
    with_rules([Rule], _, true).
test(refused_predicate_is_refused_as_it_continues,
     [forall(member(Goal-PI, [ sleep_until(1)-(sleep/1),
                               receive_until(_, 1)-(receive/2),
                               receive_until(_, 1, 2)-(receive/2),
                               move(x)-(move/1) ])),
      Verdicts = [yes,refused(_)]]) :-
    with_rules([refuse(PI)], Policy,
               findall(V, ( member(P, [guarded,Policy]), called(P, Goal, V) ),
                       Verdicts)).
test(own_predicate_of_a_refused_name_is_called, Verdict == yes) :-
    with_rules([refuse(emit/1)], Policy,
               verdict(typhon_guard_clauses:guard_program(
                           Policy, program(x, [], [], [emit(_),
                                                       (main :- emit(x))]),
                           _), Verdict)).
test(own_predicate_does_not_hide_a_refused_control_predicate,
     Verdict = refused(_)) :-
    with_rules([refuse(move/1)], Policy,
               verdict(typhon_guard_clauses:guard_program(
                           Policy, program(x, [], [], [move(_),
                                                       (main :- move(x))]),
                           _), Verdict)).

:- end_tests(guard_policies).
