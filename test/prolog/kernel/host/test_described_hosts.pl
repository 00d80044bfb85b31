:- module(test_described_hosts, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(typhon)).

/** <module> Hosts that are given by a description, any(Tags)

An option chooses the host; here the suite does so.

*Threading*: one test at a time; agents choose in workers.
*/

:- dynamic
    tagged/2,                           % Tags, Address
    chosen/1.                           % Tags: of each choice

:- multifile typhon_hosts:one_of/2.

typhon_hosts:one_of(any(Tags), Address) :-
    test_described_hosts:choice(Tags, Address).

choice(none, _) :-
    existence_error(tag, none).
choice(Tags, Address) :-
    tagged(Tags, Address),
    assertz(chosen(Tags)).

%   with_tags(+Specs, +Tags, :Goal): Tags is a list of Tags-Host.

:- meta_predicate with_tags(+, +, 0).

with_tags(Specs, Tags, Goal) :-
    with_hosts(Specs,
               setup_call_cleanup(
                   forall(( member(Tag-Host, Tags), address(Host, Address) ),
                          tag(Tag, Address)),
                   Goal,
                   ( retractall(tagged(_, _)), retractall(chosen(_)) ))).

tag(Tag, Address) :-
    assertz(tagged(Tag, Address)).

choices(Tags) :-
    findall(Tag, retract(chosen(Tag)), Tags).

%   said(+Main, -Result): Result is that of an agent on alpha, which has caught
%   the error of Main, or `none`.

said(Main, Result) :-
    create([ (main :- catch(( Main, R = none ), error(R, _), true),
                      here(Here), result(R-Here)) ],
           Agent, [host(alpha)]),
    agent_result(Agent, Result, 20).

:- begin_tests(described_hosts).

test(agent_moves_to_the_host_that_was_chosen,
     [ forall(member(Options, [[], [hop_time(uniform(0.01, 0.02))]])),
       Result-Chosen == (none-Beta)-[camera] ]) :-
    with_tags([alpha-Options, beta], [camera-beta],
              ( address(beta, Beta),
                said(move(any(camera)), Result),
                choices(Chosen) )).
test(list_of_tags_describes_a_host, Result == none-Beta) :-
    with_tags([alpha, beta], [[robot,camera]-beta],
              ( address(beta, Beta),
                said(move(any([robot,camera])), Result) )).
test(agent_stays_on_the_host_that_was_chosen,
     Result-Chosen == (none-Alpha)-[camera]) :-
    with_tags([alpha, beta], [camera-alpha],
              ( address(alpha, Alpha),
                said(move(any(camera)), Result),
                choices(Chosen) )).
test(clone_begins_on_the_host_that_was_chosen, Chosen == [camera]) :-
    with_tags([alpha, beta], [camera-beta],
              ( address(beta, Beta),
                create([ (main :- clone(any(camera), Who),
                                  ( Who = clone(_) -> receive(_) ; true )) ],
                       A, [host(alpha)]),
                agent_join(family(A), [A-done, Clone-timeout], 0.5),
                assertion(agent_property(Clone, host(Beta))),
                agent_dispose(Clone),
                joined(Clone, disposed),
                choices(Chosen) )).
test(agent_is_created_on_the_host_that_was_chosen, Chosen == [camera]) :-
    with_tags([alpha, beta], [camera-beta],
              ( address(beta, Beta),
                create([on_message(_, _)], A, [host(any(camera))]),
                assertion(agent_property(A, host(Beta))),
                choices(Chosen) )).
test(order_leads_to_the_host_that_was_chosen, Chosen == [camera]) :-
    with_tags([alpha, beta], [camera-beta],
              ( address(beta, Beta),
                create([on_message(_, _)], A, [host(alpha)]),
                agent_move(A, any(camera), [wait(10)]),
                assertion(agent_property(A, host(Beta))),
                choices(Chosen) )).
test(host_of_another_process_can_be_chosen, Result == none-Beta) :-
    with_tags([alpha], [],
              with_peers([beta],
                         ( peer_host(beta, Beta),
                           tag(camera, Beta),
                           said(move(any(camera)), Result) ))).
test(goal_runs_on_the_host_that_was_chosen, Here == Beta) :-
    with_tags([alpha, beta], [camera-beta],
              ( address(beta, Beta),
                remote(any(camera), here(Here)) )).
test(error_of_the_choice_is_raised_at_the_move,
     Formal == existence_error(tag, none)) :-
    with_tags([alpha], [], said(move(any(none)), Formal-_)).
test(error_of_the_choice_is_raised_at_the_creation,
     error(existence_error(tag, none))) :-
    with_tags([alpha], [], create([main], _, [host(any(none))])).
test(nothing_is_chosen_without_a_fleet,
     Formal == existence_error(fleet, any(lamp))) :-
    with_tags([alpha], [], said(move(any(lamp)), Formal-_)).
test(nothing_is_chosen_without_a_fleet_at_a_creation,
     error(existence_error(fleet, any(lamp)))) :-
    with_tags([alpha], [], create([main], _, [host(any(lamp))])).
test(other_terms_are_no_hosts,
     [ forall(member(Host, [any([]), any(_), any([a|_]), any("a"), one(a)])),
       error(_) ]) :-
    with_tags([alpha], [], create([main], _, [host(Host)])).

:- end_tests(described_hosts).
