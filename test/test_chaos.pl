:- module(test_chaos, []).
:- use_module(library(plunit)).
:- use_module(common).
:- use_module(chaos/attack).
:- use_module(chaos/faults, [scenario/3, schedule/5]).
:- use_module(chaos/verdict, [finding_kind/3]).
:- use_module(library(lists)).
:- use_module(library(solution_sequences)).

/** <module> Forty seconds of the suite that attacks

The long form is `make chaos`, see doc/chaos.md.
*/

:- dynamic report/2.                    % Scenario, Findings

attack(Dir) :-
    chaos([ seconds(40), seed(1), processes(3), agents(24), settle(20),
            out(Dir) ],
          Reports),
    forall(member(report(Scenario, _, Findings), Reports),
           assertz(report(Scenario, Findings))).

found(Scenario, Kind, Found) :-
    report(Scenario, Findings),
    findall(What, limit(3, member(finding(Kind, What), Findings)), Found).

:- begin_tests(chaos).

test(attack) :-
    no_leaks(with_tmp_dir(test_chaos:attack)).
test(nothing_wrong,
     [ forall(( scenario(Scenario, _, _), finding_kind(Kind, wrong, _) )),
       true(Found == []) ]) :-
    found(Scenario, Kind, Found).

:- end_tests(chaos).

:- begin_tests(chaos_schedule).

test(follows_from_the_seed, [forall(scenario(Scenario, _, _)), nondet]) :-
    schedule(Scenario, 7, 30, [a,b,c], Events),
    schedule(Scenario, 7, 30, [a,b,c], Again),
    schedule(Scenario, 8, 30, [a,b,c], Other),
    assertion(Events == Again),
    assertion(Events \== Other).

:- end_tests(chaos_schedule).
