:- module(test_agent_lib, []).

%   What agents include from agents/lib. The agents' own words are those of
%   this module; test_starts has the hosts where agents start.

:- use_module('../lib/common').
:- use_module('../lib/fixtures',
              [create/3, wait_state/2, with_hosts/2]).
:- use_module('../lib/texts', [write_file/2]).
:- use_module('../../agents/allocation/auctions', []).
:- use_module('../../agents/allocation/operator', []).
:- use_module('../../agents/hierarchy/operator', []).
:- use_module('../../agents/learning/operator', []).
:- use_module('../../agents/lib/settings').
:- use_module('../../agents/population/operator', []).
:- use_module('../../agents/sieve/operator', []).
:- use_module('../../agents/sync/operator', []).
:- use_module('../../prolog/typhon/kernel/base/prng', []).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, max_list/2, member/2, min_list/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

:- include('../../agents/lib/parameters').
:- include('../../agents/lib/keep').
:- include('../../agents/lib/chance').
:- include('../../agents/lib/clones').

:- dynamic
    '$memory'/1,
    here/1,
    kept/2,
    refusing/1,
    setting/2.

default(seed, random, [random], "").
default(pause, 5, range(0, 10, 1), "").

%   Words of agents.

clone(Branch) :-
    refusing(Error),
    !,
    throw(error(Error, _)),
    Branch = none.
clone(parent(b)).

:- meta_predicate
    turns(+, 0, -),
    with_facts(+, 0).

with_facts(Facts, Goal) :-
    setup_call_cleanup(
        forall(member(Fact, Facts), assertz(Fact)),
        once(Goal),
        forall(member(Fact, Facts), forget(Fact))).

forget(Fact) :-
    functor(Fact, Name, Arity),
    functor(Any, Name, Arity),
    retractall(Any).

facts(Fact, Facts) :-
    findall(Fact, Fact, Facts).

%   turns(+Facts, :Seeding, -Turns): three random numbers of an agent.

turns(Facts, Seeding, [A, B, C]) :-
    with_facts(Facts, ( Seeding, chance_turn(A), chance_turn(B),
                        chance_turn(C) )).

all_between(Turns, Least, Most) :-
    min_list(Turns, Min),
    max_list(Turns, Max),
    Least =< Min,
    Max =< Most.

%   with_program(+Libs, +Lines, -File, :Goal): Lines is an agent that includes
%   Libs of agents/lib.

:- meta_predicate with_program(+, +, -, 0).

with_program(Libs, Lines, File, Goal) :-
    findall(Line, included(Libs, Line), Includes),
    Lines = [Declaration|Clauses],
    append([Declaration|Includes], Clauses, All),
    atomic_list_concat(All, '\n', Text),
    with_tmp_dir(Dir, ( directory_file_path(Dir, 'tried.pl', File),
                        write_file(File, Text),
                        once(Goal) )).

included(Libs, Line) :-
    member(Lib, Libs),
    format(atom(Line), ':- include(agents(lib/~w)).', [Lib]).

ordered(Start, A) :-
    with_program([parameters, await_order],
                 [ ':- agent(ordered, [state([setting/2])]).',
                   'default(start, now, [now, order], "").',
                   'main :- await_order, result(began).',
                   '' ],
                 File,
                 agent_create(File, A, [host(alpha),
                                        facts([setting(start, Start)])])).

teller(To, A) :-
    with_program([tell],
                 [ ':- agent(teller, [state([to/1])]).',
                   'main :- to(To), told(To, First), receive(_-again),',
                   '    told(To, Second), result([First, Second]).',
                   'told(To, told) :- tell(To, hello), !.',
                   'told(_, not_told).',
                   '' ],
                 File, agent_create(File, A, [host(alpha), facts([to(To)])])).

:- begin_tests(agent_lib).

test(parameter, [ forall(member(Facts-Value, [ []-5, [setting(pause, 7)]-7,
                                               [setting(other, 7)]-5 ])),
                  true(Value0 == Value) ]) :-
    with_facts(Facts, parameter(pause, Value0)).
test(setting_replaces_the_default_that_is_asked_for, fail) :-
    with_facts([setting(pause, 7)], parameter(pause, 5)).
test(parameter_without_a_default, fail) :-
    parameter(unknown, _).

test(fact_replaces_those_of_its_name_and_arity, Kept == [kept(c, 3)]) :-
    with_facts([kept(a, 1), kept(b, 2)],
               ( keep(kept(c, 3)), facts(kept(_, _), Kept) )).

test(same_seed_and_subject_same_turns, Again == Turns) :-
    turns([setting(seed, 1)], seed_chance(a), Turns),
    turns([setting(seed, 1)], seed_chance(a), Again),
    all_between(Turns, 0, 1).
test(other_seed_or_subject_other_turns,
     [ forall(member(Seed-Subject, [2-a, 1-b, random-a])),
       true(Others \== Turns) ]) :-
    turns([setting(seed, 1)], seed_chance(a), Turns),
    turns([setting(seed, Seed)], seed_chance(Subject), Others).
test(no_two_turns_are_alike, Count == 3) :-
    turns([setting(seed, 1)], seed_chance(a), Turns),
    sort(Turns, Sorted),
    length(Sorted, Count).
test(seed_of_a_host_is_that_of_its_name, Turns == Named) :-
    turns([setting(seed, 1), here('alpha@b:1')], seed_chance_here, Turns),
    turns([setting(seed, 1)], seed_chance(alpha), Named).

test(branch_of_a_clone, Branch == parent(b)) :-
    clone_if_room(Branch).
test(refused_clone, Branch == refused) :-
    with_facts([refusing(move_refused(h, capacity))], clone_if_room(Branch)).
test(other_error_of_a_clone, throws(error(existence_error(host, h), _))) :-
    with_facts([refusing(existence_error(host, h))], clone_if_room(_)).
test(clone_knows_no_visits, Visits == []) :-
    with_facts(['$memory'(a)],
               ( forget_visits, facts('$memory'(_), Visits) )).

%   Agents that include the file itself.

test(agent_begins_when_it_is_ordered_to, Result == began) :-
    with_hosts([alpha],
               ( ordered(order, A),
                 wait_state(A, waiting),
                 agent_send(A, begin),
                 agent_result(A, Result, 10) )).
test(agent_that_needs_no_order_begins_at_once, Result == began) :-
    with_hosts([alpha], ( ordered(now, A), agent_result(A, Result, 10) )).
test(messages_are_told_to_agents_that_live,
     Message-Told == hello-[told, not_told]) :-
    with_hosts([alpha],
               ( create([(main :- receive(_-M), result(M))], A, [host(alpha)]),
                 teller(A, B),
                 agent_result(A, Message, 10),
                 agent_send(B, again),
                 agent_result(B, Told, 10) )).

                /*******************************
                *            SETTINGS          *
                *******************************/

test(settings_as_facts,
     [ forall(member(Options-Facts,
                     [ []-[], [settings([])]-[], [other(x)]-[],
                       [settings([delta-1, strategy-random])]
                       - [setting(delta, 1), setting(strategy, random)] ])),
       true(Facts0 == Facts) ]) :-
    setting_facts(sequence_start, Options, Facts0).
test(settings_of_payloads, Facts == [setting(size, 5)]) :-
    setting_facts(learning_start, [settings([size-5])], Facts).
test(unknown_setting_is_refused,
     throws(error(domain_error(setting, c-1),
                  context(_, 'there are watch, patience')))) :-
    setting_facts(robot_start, [settings([watch-10, c-1])], _).
test(settings_that_are_no_pairs, error(type_error(_, _))) :-
    setting_facts(sequence_start, [settings([a])], _).
test(defaults_are_in_their_ranges, Wrong == []) :-
    findall(Name-Value, ( declared(Predicate, Name, Value, _),
                          \+ accepted(Predicate, Name-Value) ), Wrong).
test(values_in_ranges_are_accepted, Refused == []) :-
    findall(Name-Value, ( declared(Predicate, Name, _, Range),
                          inside(Range, Value),
                          \+ accepted(Predicate, Name-Value) ), Refused).
test(values_beyond_a_range_are_refused_by_name, Wrong == []) :-
    findall(Name-Beyond, ( declared(Predicate, Name, _, Range),
                           beyond(Range, Beyond, Named),
                           \+ refused(Predicate, Name-Beyond, Named) ), Wrong).
test(integers_only,
     throws(error(domain_error(setting, window-1.5),
                  context(_, 'window is an integer above 0: length of the history')))) :-
    setting_facts(sequence_start, [settings([window-1.5])], _).

%   Each mechanism checks before it does anything else.

test(mechanism_refuses, [ forall(mechanism(Goal, Setting)),
                          error(domain_error(setting, Setting)) ]) :-
    call(Goal).

:- end_tests(agent_lib).

declared(Predicate, Name, Value, Range) :-
    agent_settings:takes(Predicate, _, _, _),
    setting_declared(Predicate, Declared),
    member(default(Name, Value, Range, _), Declared).

%   inside(+Range, -Value), beyond(+Range, -Value, -Named): the error for Value
%   names Named.

inside(range(From, To, _), Value) :-
    ( Value = From ; Value = To ; Value is 10*To ).
inside(within(From, To, _), Value) :-
    ( Value = From ; Value = To ).
inside([One|Others], Value) :-
    member(Choice, [One|Others]),
    ( compound(Choice) -> inside(Choice, Value) ; Value = Choice ).

beyond(range(From, _, Step), Value, 0) :-
    ( From > 0 -> Value = 0 ; Value is -Step ).
beyond(within(From, To, Step), Value, Named) :-
    ( Value is From-Step, Named = From ; Value is To+Step, Named = To ).
beyond([One|Others], Value, Named) :-
    member(Choice, [One|Others]),
    ( compound(Choice) -> beyond(Choice, Value, Named) ; Value = no(Choice), Named = Choice ).

accepted(Predicate, Pair) :-
    catch(setting_facts(Predicate, [settings([Pair])], _), error(_, _), fail).

refused(Predicate, Pair, Named) :-
    catch(( setting_facts(Predicate, [settings([Pair])], _), fail ),
          error(domain_error(setting, Pair), context(_, Text)), true),
    nonvar(Text),
    format(atom(Part), '~w', [Named]),
    sub_atom(Text, _, _, _, Part).

mechanism(sync_operator:sequence_start(s, [], [t-true], [settings([delta-0])], _),
          delta-0).
mechanism(population_operator:population_start(s, [], [], [settings([tick-0])], _),
          tick-0).
mechanism(learning_operator:learning_start([], none, [], [settings([epsilon-2])], _),
          epsilon-2).
mechanism(sieve_operator:sieve_start([], none, [settings([calls-0])]), calls-0).
mechanism(allocation_operator:task_allocate(task(t, [1-[a]], []), nowhere,
                                            [settings([bi_min-(-1)])], _),
          bi_min-(-1)).
mechanism(allocation_operator:robot_start(nowhere, [], [settings([watch-0])]),
          watch-0).
mechanism(auction_operator:auction_start(anta, [], [settings([tries-(-1)])]),
          tries-(-1)).
mechanism(hierarchy_operator:hierarchy_start([], none, [settings([workers-0])], _),
          workers-0).
