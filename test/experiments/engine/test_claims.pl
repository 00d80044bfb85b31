:- module(test_claims, []).

% The language of claims: for each test and each expression a claim that holds,
% and one that must not, on made-up numbers.

:- use_module('../../lib/common').
:- use_module('../../../experiments/engine/claims').
:- use_module('../../../experiments/engine/found').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(random), [maybe/1, random_between/3, random_member/2]).
:- use_module(library(plunit)).

%   Two lines, k = a and k = b, along n: `up` rises on both, `bent` on a only,
%   `same` nowhere; `gap` has no value at n = 2.

point(a, 1, 10, 1, 5, 1).
point(a, 2, 20, 2, 5, none).
point(a, 3, 30, 3, 5, 3).
point(b, 1, 11, 3, 5, 4).
point(b, 2, 22, 1, 5, none).
point(b, 3, 33, 4, 5, 6).

points(Points) :-
    findall(case{k:K, n:N}-measures{up:Up, bent:Bent, same:Same, gap:Gap},
            point(K, N, Up, Bent, Same, Gap), Points).

holds(Test) :-
    points(Points),
    claim_holds(test_claims:Test, Points).

verdict(Test, Verdict) :-
    points(Points),
    claim_verdict(test_claims:Test, Points, Verdict).

%   A test, and a verdict on random points; then without some of the runs.

verdicts(Test, Before, After) :-
    findall(Case-Measures, random_point(Case, Measures), Points0),
    findall(Test0, ( holding(Test0) ; failing(Test0) ; unknown(Test0) ), Tests),
    random_member(Test, Tests),
    maplist(lost, Points0, Points),
    claim_verdict(test_claims:Test, Points0, Before),
    claim_verdict(test_claims:Test, Points, After).

random_point(case{k:K, n:N}, Measures) :-
    point(K, N, _, _, _, _),
    findall(Name-Value, ( member(Name, [up, bent, same, gap]), maybe(0.9),
                          random_between(1, 40, Value) ), Pairs),
    dict_create(Measures, measures, Pairs).

lost(Case-Measures, Case-Left) :-
    ( maybe(0.3) -> Left = missing ; Left = Measures ).

%   The verdict on the points without the runs of the cases with Name=Value.

verdict_without(Name=Value, Test, Verdict) :-
    points(Points0),
    findall(Case-Left, ( member(Case-Measures, Points0),
                         ( get_dict(Name, Case, Value) -> Left = missing
                         ; Left = Measures ) ), Points),
    claim_verdict(test_claims:Test, Points, Verdict).

%   holding(Test), and failing(Test).

holding(up < 34).
holding(up =< 33).
holding(up > 9).
holding(up >= 10).
holding(same =:= 5).
holding(same =\= 4).
holding(up =:= at([k=a], up) + (n * (up - at([k=a], up)) / n)).
holding(gap < 7).                       % none is not compared
holding(near(up, 20, 13)).
holding(between(up, 10, 33)).
holding(between(bent, n - 1, n + 2)).
holding(rises(up, along(n))).
holding(rises(gap, along(n))).
holding(falls(-up, along(n))).
holding(rises(bent, along(n), ends)).
holding(falls(-bent, along(n), ends)).
holding(least(up, k=a)).
holding(most(up, k=b)).
holding(at([k=a], rises(bent, along(n)))).
holding(at([k=a, n=3], up =:= 30)).
holding(some(bent =:= 4)).
holding((up > 9, same =:= 5)).
holding((up > 99 ; same =:= 5)).
holding(\+ up > 99).
holding(holds(six)).
holding(at([k=b], up) > at([k=a], up)).
holding(up =< at([n=3], up)).
holding(sum(same) =:= 30).
holding(mean(same) =:= 5).
holding(median(n) =:= 2).
holding(least(up) =:= 10).
holding(most(up) =:= 33).
holding(number(gap) =:= 4).
holding(at([k=a], number(gap)) =:= 2).
holding(at([k=a], sum(up) =:= 60)).
holding(rise(up, along(n)) >= 20).
holding(first(up, along(n)) =< up).
holding(last(up, along(n)) >= up).
holding(correlation(up, n) > 0.8).
holding(at([k=a], correlation(up, -n)) =:= -1).
holding(at([k=b], rise(up, along(n)) =:= 22)).
holding(at([k=b], rise(up, along(n))) > at([k=a], rise(up, along(n)))).
holding(2*n + 8 =< up).
holding(at([k=b, n=2], bent) =:= 1).

failing(up < 33).
failing(up =< 32).
failing(up > 10).
failing(up >= 11).
failing(bent =:= n).
failing(same =\= 5).
failing(near(up, 20, 12)).
failing(between(up, 11, 33)).
failing(between(up, 10, 32)).
failing(rises(same, along(n))).         % strictly
failing(falls(same, along(n))).
failing(rises(bent, along(n))).         % on one line only
failing(falls(bent, along(n), ends)).
failing(rises(same, along(n), ends)).
failing(least(up, k=b)).
failing(most(up, k=a)).
failing(least(same, k=a)).
failing(most(same, k=a)).
failing(correlation(up, -n) > 0).
failing(least(bent, k=a)).              % not with n = 2
failing(at([k=b], rises(bent, along(n)))).
failing(at([k=a, n=3], up =:= 31)).
failing(some(bent =:= 7)).
failing((up > 9, same =:= 6)).
failing((up > 99 ; same =:= 6)).
failing(\+ up > 9).
failing(holds(seven)).
failing(at([k=b], up) < at([k=a], up)).
failing(sum(same) =:= 29).
failing(mean(same) =:= 6).
failing(median(n) =:= 3).
failing(least(up) =:= 11).
failing(most(up) =:= 30).
failing(number(gap) =:= 6).
failing(rise(up, along(n)) > 20).
failing(first(up, along(n)) < up).
failing(last(up, along(n)) > up).

%   Claims about unknown values.

unknown(rises(up, along(k))).           % words do not rise, but see below
unknown(nothing > 1).
unknown(at([n=4], up > 1)).
unknown(at([n=4], up) > 1).
unknown(at([n=2], gap < 7)).
unknown(at([n=2], rises(up, along(n)))).
unknown(at([n=2], rise(gap, along(k))) > 0).
unknown(at([n=2], mean(gap)) > 0).
unknown(some(nothing > 1)).
unknown(least(up, k=c)).
unknown(at([k=a], least(up, k=a))).
unknown(at([k=c], holds(nine_of_them))).
unknown((nothing > 1, up > 9)).
unknown((nothing > 1 ; up > 99)).

six(Points) :-
    length(Points, 6).

seven(Points) :-
    length(Points, 7).

%   Derived parameters change with the others.

:- dynamic derive/3.

derive(agents, Case, N) :-
    N is Case.hosts // 5.

derived(Pairs, Test) :-
    findall(case{hosts:H, agents:N}-measures{m:M}, member(H-N-M, Pairs),
            Points),
    claim_holds(test_claims:Test, Points).

%   A case is missing.

holes(Test) :-
    Points = [ case{k:a, n:1}-measures{m:1}, case{k:a, n:2}-measures{m:2},
               case{k:b, n:1}-measures{m:3} ],
    claim_holds(test_claims:Test, Points).

problems(Test, Problems) :-
    findall(Problem, claim_shape(test_claims:Test, Problem), Problems).

names(Test, Names) :-
    findall(Name, claim_name(test_claims:Test, Name), Names0),
    sort(Names0, Names).

found(Test, Text) :-
    points(Points),
    claim_found(test_claims:Test, Points, [k, n], Text).

:- begin_tests(claims).

test(claim_holds, [forall(holding(Test)), nondet]) :-
    holds(Test).
test(failing_claim_does_not_hold, [forall(failing(Test)), fail]) :-
    holds(Test).
test(negated_failing_claim_holds, [forall(failing(Test)), nondet]) :-
    holds(\+ Test).
test(unknown_claim, [forall(( unknown(Test), Test \= rises(_, _) )), fail]) :-
    holds(Test).
test(unknown_claim_is_not_denied,
     [forall(( unknown(Test), Test \= rises(_, _) )), fail]) :-
    holds(\+ Test).
test(failing_claim_is_known, [forall(failing(Test)), Verdict == false]) :-
    verdict(Test, Verdict).
test(not_known, [ forall(( unknown(Test), Test \= rises(_, _) )),
                  Verdict == unknown ]) :-
    verdict(Test, Verdict).
test(without_runs_a_verdict_is_the_same_or_unknown) :-
    forall(between(1, 3000, _),
           ( verdicts(Test, Before, After),
             assertion(memberchk(After-Test, [Before-Test, unknown-Test])) )).
test(one_side_of_a_claim_is_missing,
     [ forall(( member(Missing, [k=a, k=b]),
                member(Test, [ at([k=a], up) < at([k=b], up),
                               at([k=b], rise(up, along(n))) > 21,
                               at([k=a], rise(up, along(n))) < 21,
                               rises(up, along(n)), least(up, k=a),
                               number(up) =:= 6, sum(up) > 1,
                               correlation(up, n) > 0.1, some(up > 99),
                               \+ some(up > 99), holds(six) ]),
                \+ ( Missing = (k=a), sub_term(k=b, Test),
                     sub_term(rise(_, _), Test) ),
                \+ ( Missing = (k=b), sub_term(k=a, Test),
                     sub_term(rise(_, _), Test) ) )),
       Verdict == unknown ]) :-
    verdict_without(Missing, Test, Verdict).
test(what_is_left_may_decide,
     [ forall(member(Test-Verdict0, [ (up < 11)-false, (up < 99)-unknown,
                                      some(up > 30)-true,
                                      (up < 11, gap > 0)-false,
                                      rises(same, along(n))-false,
                                      at([k=b], up > 10)-true ])),
       Verdict == Verdict0 ]) :-
    verdict_without(k=a, Test, Verdict).
test(another_case_is_not_the_case_itself,
     [ forall(member(Test, [ at([k=c], rise(up, along(n))) > 0,
                             at([k=c], first(up, along(n))) =< up,
                             at([k=c], number(up)) =:= 0 ])),
       Verdict == unknown ]) :-
    verdict(Test, Verdict).
test(half_known, nondet) :-
    holds((nothing > 1 ; up > 9)),
    holds(\+ (nothing > 1, up > 99)).

test(texts_are_in_the_order_of_the_study) :-
    holds(rises(up, along(k))).
test(numbers_are_in_numerical_order, fail) :-
    Points = [ case{n:3}-m{up:1}, case{n:1}-m{up:2}, case{n:2}-m{up:3} ],
    claim_holds(test_claims:rises(up, along(n)), Points).
test(numbers_of_two_kinds) :-
    Points = [ case{n:2}-m{up:3}, case{n:0.5}-m{up:1}, case{n:1}-m{up:2} ],
    claim_holds(test_claims:rises(up, along(n)), Points).

test(along_a_parameter_that_derives_others) :-
    derived([10-2-1, 20-4-2, 30-6-3], rises(m, along(hosts))).
test(at_a_parameter_that_derives_others) :-
    derived([10-2-1, 20-4-2], at([hosts=20], m) > at([hosts=10], m)).
test(least_with_derived_parameters) :-
    derived([10-2-1, 20-4-2], least(m, hosts=10)).
test(derived_parameter_can_be_compared, nondet) :-
    derived([10-2-1, 20-4-2], m < agents).
test(given_derived_parameter_forms_lines) :-
    derived([10-2-1, 10-4-9, 20-2-2, 20-4-10], rises(m, along(hosts))),
    derived([10-2-1, 10-4-9, 20-2-2, 20-4-10], rises(m, along(agents))).
test(given_derived_parameter_separates_lines, fail) :-
    derived([10-2-1, 10-4-9, 20-2-8, 20-4-5], rises(m, along(hosts))).

test(missing_case_is_not_another_case, fail) :-
    holes(at([n=2], at([k=b], m) > 0)).
test(missing_case_is_not_compared) :-
    holes(at([k=b], m) > at([k=a], m)).
test(missing_case_has_aggregates, nondet) :-
    holes(at([n=2], at([k=b], sum(m)) =:= 3)).

test(division_by_zero_has_no_value, nondet) :-
    holds(up / (n-1) < 23),
    \+ holds(up / (n-n) < 99).
test(claim_with_an_error, error(type_error(evaluable, _))) :-
    holds(foo(up) > 1).

:- end_tests(claims).

:- begin_tests(claim_shapes).

test(well_formed, [forall(( holding(T) ; failing(T) )), Problems == []]) :-
    problems(T, Problems).
test(no_test, [ forall(member(Test-Problem,
                              [ (up < 1, foo(up))-foo(up),
                                up-up,
                                "text"-"text",
                                at(k=a, up > 1)-(k=a),
                                at([k], up > 1)-[k],
                                (up < foo(n))-foo(n),
                                (at([k=a], up, 1) > 1)-at([k=a], up, 1),
                                rises(up, n)-rises(up, n),
                                some(least(up))-least(up),
                                holds(nine)-holds(nine) ])),
                Problems == [Problem] ]) :-
    problems(Test, Problems).
test(names, Names == [a, b, k, n, p, q]) :-
    names(( at([k=x], rises(a, along(n))) ; \+ sum(b) > at([p=3], q) ), Names).
test(names_of_extremes, Names == [a, k]) :-
    names(least(a, k=x), Names).

:- end_tests(claim_shapes).

:- begin_tests(claims_found).

test(lines, Text == 'up: a 10 20 30, b 11 22 33') :-
    found(rises(up, along(n)), Text).
test(same, Text == 'same: 5') :-
    found(same =:= 5, Text).
test(selected, Text == 'up: 30') :-
    found(at([k=a, n=3], up =:= 30), Text).
test(found_on_both_sides, Text == 'b up: 11 22 33; a up: 10 20 30') :-
    found(at([k=b], up) > at([k=a], up), Text).
test(numbers_are_named, Text == 'n=3 up: 30') :-
    found(at([k=a], at([n=3], up) =:= 30), Text).
test(found_other_case_inside_an_expression,
     Text == 'b up: 33; 2*a up: 60') :-
    found(at([n=3], at([k=b], up) > 2*at([k=a], up)), Text).
test(parts, Text == 'bent: a 1 2 3, b 3 1 4; same: 5') :-
    found(( bent > 0, \+ same < 4 ), Text).
test(found_nothing, Text == 'nothing: no value') :-
    found(nothing > 0, Text).
test(long_list_is_shortened, Text == 'm: 1 2 3 4 5 6 7 8 9 10 11 ...') :-
    findall(case{n:N}-m{m:N}, between(1, 13, N), Points),
    claim_found(test_claims:(m > 0), Points, [n], Text).
test(parameters_may_be_compound, Text == 'm: mix(1,2) 1 2, mix(2,1) 3') :-
    Points = [ case{k:mix(1,2), n:1}-measures{m:1},
               case{k:mix(1,2), n:2}-measures{m:2},
               case{k:mix(2,1), n:1}-measures{m:3} ],
    claim_found(test_claims:(m > 0), Points, [k, n], Text).

:- end_tests(claims_found).
