:- module(test_sieve, []).
:- use_module('../../lib/common').
:- use_module('../../lib/networks').
:- use_module('../../lib/event_log').
:- use_module('../../lib/fake_agent', [alike/2]).
:- use_module('../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(lists), [member/2, numlist/3, sum_list/2]).
:- use_module(library(option), [select_option/4]).
:- use_module(library(typhon)).
:- use_module('../../../agents/sieve/operator').
:- include('../../../agents/sieve/idiotypic').

:- discontiguous payload/2.
payload(bits, _).
:- include('../../../payloads/sieve/bits').

/** <module> The idiotypic sieve

Equations compared with numbers; guard and antibodies on one host; complete
sieves on networks.
*/

bits(Name, Bits) :-
    atom_chars(Name, Chars),
    maplist(atom_number, Chars, Bits).

%   gammas(+Reading, +Antigen, +Cells, -Gammas): Cells are
%   Gamma-[Antigen-Xi, ...].

gammas(Reading, Antigen, Pairs, Gammas) :-
    met(Reading, Antigen, 0.5-0.5, Pairs, Gammas).

%   met(+Reading, +Antigen, +Constants, +Cells, -Gammas): Constants are kt-ku.

met(Reading, Antigen, Constants, Pairs, Gammas) :-
    length(Pairs, N),
    numlist(1, N, Ids),
    maplist(cell, Ids, Pairs, Cells),
    interaction(Reading, Antigen, Constants, Cells, Gammas).

cell(Id, Gamma-Memory, cell(Id, Gamma, Memory)).

%   equation(Name, Goal, Value, Expected): Value is of Goal. Section 3.6 has
%   the third affinity, and the feedbacks.

equation(equation_3_6, affinity(Antigen, Antibody, Psi), Psi, Is) :-
    member(A-P-Is, [ '00000'-'11111'-5, '00000'-'11110'-4, '00011'-'11111'-3,
                     '10101'-'01000'-4, '10101'-'10101'-0 ]),
    maplist(bits, [A, P], [Antigen, Antibody]).
equation(feedbacks_of_section_3_6, feedback(Antigen, [1,1,1,1,0], X), X, Is) :-
    member(A-Is, ['00000'-30, '00001'-31, '00011'-29]),
    bits(A, Antigen).
equation(kinds_that_can_serve_figures_3_3_and_3_4,
         aggregate_all(count, servant(Names), Count), Count, Is) :-
    member(Names-Is, [ ['00000', '11111', '10101']-16,
                       ['00000', '00001', '00011']-13 ]).
equation(equation_3_2, squashed(Xi, 10, 0.5, S), S, Is) :-
    member(Xi, [31, 30, 29, 27, 23, 20, 16, 0]),
    Is is 1/(1 + exp(-0.5*(Xi - 20))).
equation(equation_3_1, stimulated(1.25, 0.5, Gamma), Gamma, 1.75).
equation(memory_keeps_the_last_feedback, learnt([a-1, b-2], b, 3, Memory),
         Memory, [b-3, a-1]).
equation(equation_3_3,
         gammas(current, a, [1.0-[a-31], 1.0-[a-30], 1.0-[a-16]], Gs),
         Gs, [2.0, 1.0, 0.0]).
equation(equation_3_4,                  % 1 + 0.5 * 0.8/(3 - 1)
         met(current, a, 0.5-0, [1.0-[a-31], 0.8-[a-30, b-1, c-1]], Gs),
         Gs, [1.2, 0.8]).
equation(equation_3_5,                  % 0.75 - 0.5 * 1/(3 - 1)
         met(current, a, 0-0.5, [1.0-[a-31, b-1, c-1], 0.75-[a-30]], Gs),
         Gs, [1.0, 0.5]).
equation(Name, gammas(Reading, Antigen, [G1-M1, G2-M2], Gammas), Gammas, Is) :-
    affects(Name, Reading, Antigen, G1-M1, G2-M2, Is).
equation(fates, fate(Gamma, 0.5, 1.5, Fate), Fate, Is) :-
    member(Gamma-Is, [1.51-clone, 1.5-stay, 0.5-stay, 0.49-die]).
equation(roulette, roulette([1-a, 2-b, 0-c, 1-d], Turn, Chosen), Chosen, Is) :-
    member(Turn-Is, [0.0-a, 0.24-a, 0.26-b, 0.74-b, 0.76-d, 1.0-d]).

servant(Names) :-
    antigen(Antibody),
    \+ \+ ( member(Name, Names), bits(Name, Antigen),
            affinity(Antigen, Antibody, Psi), Psi >= 4 ).

%   affects(Name, Reading, Antigen, Cell, Cell, Gammas)

affects(better_one_is_stimulated_worse_one_suppressed, current, a,
        1.0-[a-31], 1.0-[a-30], [1.5, 0.5]).
affects(effect_follows_the_other_potential, current, a,
        1.0-[a-31], 0.6-[a-30], [1.3, 0.1]).
affects(equal_antibodies_do_not_affect_each_other, current, a,
        1.0-[a-30], 1.0-[a-30], [1.0, 1.0]).
affects(agent_without_the_antigen_is_unaffected, current, a,
        1.0-[a-31], 1.0-[b-30], [1.0, 1.0]).
affects(unmatched_antigens_divide_the_effect, current, a,
        1.0-[a-31], 1.0-[a-30, b-1, c-1], [1.25, 0.5]).
affects(dissimilar_antigens_do_not_count_together, similar, [1,1,1,1,1],
        1.0-[[1,1,1,1,1]-31], 1.0-[[1,1,1,1,1]-23, [1,0,1,0,1]-29], [1.5, 0.5]).
affects(similar_antigens_count_together, similar, [0,0,0,0,1],
        1.0-[[0,0,0,0,0]-31], 1.0-[[0,0,0,0,0]-30, [0,0,0,0,1]-31],
        [0.5, 1.5]).
affects(total_prefers_the_generalist, total, a,
        1.0-[a-31], 1.0-[a-23, b-29], [0.5, 1.5]).
affects(common_compares_shared_antigens, common, a,
        1.0-[a-31], 1.0-[a-23, b-29], [1.5, 0.5]).
affects(common_adds_up_shared_antigens, common, c,
        1.0-[a-31, b-10], 1.0-[a-30, b-20], [0.5, 1.5]).

:- begin_tests(sieve_bits).

test(equation, [ forall(equation(_, Goal, Value, Expected)),
                 true(alike(Expected, Value)) ]) :-
    call(Goal).
test(similar_is_as_current_for_dissimilar_antigens, Similar == Current) :-
    Cells = [1.0-[[1,1,1,1,1]-31], 1.0-[[1,1,1,1,1]-23, [1,0,1,0,1]-29]],
    gammas(similar, [1,1,1,1,1], Cells, Similar),
    gammas(current, [1,1,1,1,1], Cells, Current).
test(drawn_antibodies_have_five_bits_and_differ) :-
    numlist(1, 200, Draws),
    typhon_prng:chance_seed(7, Chance),
    foldl(draw, Draws, []-Chance, Drawn-_),
    sort(Drawn, Kinds),
    length(Kinds, Count),
    Count > 28,
    forall(member(Kind, Kinds), antigen(Kind)).

draw(_, Drawn-Chance0, [Antibody|Drawn]-Chance) :-
    random_antibody(Chance0, Antibody, Chance).

test(roulette_without_weights, fail) :-
    roulette([0-a], 0.5, _).
test(roulette_chooses_each_as_often_as_its_weight,
     [ forall(member(Weighted, [[3-a, 1-b, 0-c, 4-d], [5-a, 2-b], [1-a]])),
       Counted == Weighted ]) :-
    findall(Chosen, ( even_turn(Weighted, Turn),
                      roulette(Weighted, Turn, Chosen) ), All),
    findall(Count-Thing, ( member(_-Thing, Weighted),
                           aggregate_all(count, member(Thing, All), Count) ),
            Counted).

even_turn(Weighted, Turn) :-
    pairs_keys(Weighted, Weights),
    sum_list(Weights, Sum),
    between(1, Sum, Number),
    Turn is (Number - 0.5)/Sum.

:- end_tests(sieve_bits).

                /*******************************
                *            HOSTS             *
                *******************************/

%   sieve(+Topology, +Options, +Settings, -Hosts, -File, :Goal): with guards on
%   all hosts, and a log.  One of Settings may be application(Payload).

:- meta_predicate sieve(+, +, +, -, -, 0).

sieve(Topology, Options, Settings0, Hosts, File, Goal) :-
    select_option(application(Application), Settings0, Settings,
                  payloads(sieve/bits)),
    with_logged_network(
        Topology, [clock(20), seed(1)|Options], Hosts, File,
        ( sieve_start(Hosts, Application,
                      [settings([seed-1|Settings])]),
          sieve_start(Hosts, Application, []), % no second guard
          forall(member(Host, Hosts), remote(Host, host_load(1))),
          Goal ), _).

%   The events so far, in order.

log_entries(File, Whats) :-
    logged(File, Events),
    findall(What, member(event(_, _, _, What), Events), Whats).

count(File, Pattern, Count) :-
    log_entries(File, All),
    aggregate_all(count, ( member(Told, All), \+ Told \= Pattern ), Count).

settled(File, Attacks) :-
    wait_until(( count(File, served(_, _, _, _), Served),
                 count(File, generated(_, _, _), Generated),
                 Served + Generated =:= Attacks ), 30).

%   An antibody with a memory, Name-[Antigen-Xi, ...].

release(Host, Settings, Name-Memory, Agent) :-
    bits(Name, Antibody),
    findall(setting(S, V), member(S-V, Settings), Facts),
    agent_create(agents(sieve/antibody), Agent,
                 [ host(Host), payloads([payloads(sieve/bits)]),
                   facts([ antibody(Antibody), gamma(1.0), memory(Memory),
                           wins(0), expiry(inf), shunned([])|Facts ])
                 ]).

:- begin_tests(sieve_host).

test(host_without_help_draws_an_antibody) :-
    sieve(ring(1), [], [patience-20], [Host], File,
        ( bits('00000', Antigen),
          antigen_attack([Host], Antigen),
          settled(File, 1),
          wait_until(count(File, born(host, _), 1), 10),
          log_entries(File, All),
          member(generated(Antigen, Antibody, Wait), All),
          affinity(Antigen, Antibody, Psi),
          Psi >= 4,
          Wait >= 20,
          antigen_attack([Host], Antigen),    % now there is an antibody
          settled(File, 2),
          log_entries(File, Later),
          memberchk(served(Antigen, Antibody, _, 1), Later) )).

%   Whichever agent is chosen, the better one clones.

test(better_clones_and_identical_is_redundant) :-
    sieve(ring(1), [], [gather-10, patience-400], [Host], File,
        ( bits('00000', Antigen),
          bits('11111', Best),
          release(Host, [], '11111'-[Antigen-31], _),
          release(Host, [], '11111'-[Antigen-31], _),
          release(Host, [], '11110'-[Antigen-30], _),
          release(Host, [], '00111'-[], _),   % cannot help
          antigen_attack([Host], Antigen),
          settled(File, 1),
          wait_until(count(File, born(clone, Best), 1), 10),
          log_entries(File, All),
          memberchk(served(Antigen, _, _, 2), All),
          count(File, born(clone, _), 1) )).
test(at_most_one_memory_cell) :-
    sieve(ring(1), [], [gather-1, patience-400, memory_cells-1, memory_wins-1],
          [Host], File,
        ( bits('00000', Antigen),
          release(Host, [], '11111'-[], _),
          antigen_attack([Host], Antigen),
          settled(File, 1),
          wait_until(count(File, memory_cell(_), 1), 10),
          antigen_attack([Host, Host], Antigen),
          settled(File, 3),
          count(File, memory_cell(_), 1) )).
test(no_clone_above_the_crowding_limit) :-
    sieve(ring(1), [], [gather-1], Hosts, File, crowd(Hosts, File)).

crowd([Host], File) :-
    bits('00000', Antigen),
    release(Host, [crowd-1], '11111'-[], _),
    antigen_attack([Host, Host], Antigen),
    settled(File, 2),
    count(File, born(clone, _), 0).
test(guard_survives_unknown_antigens) :-
    sieve(ring(1), [], [patience-0.5], [Host], File,
        ( bits('00000', Antigen),
          antigen_attack([Host], bolt),
          antigen_attack([Host], Antigen),
          settled(File, 1),
          count(File, unanswered(bolt), 1) )).
test(failed_draw_gives_no_answer) :-
    sieve(ring(1), [], [patience-0.5, draws-0], [Host], File,
        ( bits('00000', Antigen),
          antigen_attack([Host], Antigen),
          wait_until(count(File, unanswered(Antigen), 1), 20),
          count(File, generated(_, _, _), 0) )).
test(unknown_guard, error(existence_error(guard, _))) :-
    with_hosts([alpha], ( address(alpha, Address),
                          antigen_attack([Address], x) )).

:- end_tests(sieve_host).

:- begin_tests(sieve_network).

test(ten_hosts_in_two_processes) :-
    sieve(random(10, 0.3), [processes(2), hop_time(uniform(0.2, 0.4))],
          [patience-4, gather-2], Hosts, File, attacks(Hosts, File)).

attacks(Hosts, File) :-
    bits('00000', A),
    bits('11111', B),
    antigen_attack(Hosts, A),
    settled(File, 10),
    log_entries(File, First),           % later antigens get these antibodies
    aggregate_all(count, member(generated(_, _, _), First), Drawn),
    Drawn > 0,
    wait_until(count(File, born(host, _), Drawn), 20),
    antigen_attack(Hosts, A),
    antigen_attack(Hosts, B),
    settled(File, 30),
    log_entries(File, All),
    forall(( member(served(Antigen, Antibody, _, Kinds), All) ),
           ( affinity(Antigen, Antibody, Psi), Psi >= 4,
             between(1, 6, Kinds) )),
    aggregate_all(count, member(served(A, _, _, _), All), Served),
    Served > 0,
    memberchk(born(clone, _), All).

%   Another application: programs are sieved.

test(programs_are_sieved) :-
    sieve(ring(1), [],
          [application(payloads(sieve/maze)), gather-2, patience-400],
          [Host], File,
        ( First = [(left:-wall(ahead)), (right:-free(right),after(forward))],
          Second = [(forward:-after(left)), (right:-goal(right))],
          forall(member(Program, [First, Second]),
                 antibody_release(Host, payloads(sieve/maze), Program, [], _)),
          antigen_attack([Host], wall(left)),
          settled(File, 1),
          log_entries(File, All),
          member(served(wall(left), Program, _, _), All),
          memberchk(Program, [First, Second]) )).
test(clones_age) :-
    sieve(ring(3), [hop_time(uniform(0.2, 0.4))],
          [omega-3, gather-1, patience-100], Hosts, File,
        ( Hosts = [Host|_],
          bits('00000', Antigen),
          bits('11111', Antibody),
          release(Host, [omega-3], '11111'-[], _),
          antigen_attack(Hosts, Antigen),
          wait_until(( count(File, born(clone, Antibody), Clones),
                       Clones > 0 ), 20),
          wait_until(( count(File, died(aged, Antibody), Died),
                       Died > 0 ), 20) )).

%   No more agents than the hosts admit, however many attacks there are.

test(attack_storm) :-
    sieve(ring(4), [hosts([capacity(5)]), hop_time(uniform(0.1, 0.2))],
          [patience-0.4, gather-0.2, crowd-5], Hosts, File, storm(Hosts, File)).

storm(Hosts, File) :-
    numlist(1, 12, Times),
    findall(A, antigen(A), Antigens),
    forall(( member(Time, Times), nth1(Time, Antigens, Antigen) ),
           antigen_attack(Hosts, Antigen)),
    watch(File, 48, Most),
    Most =< 20,
    count(File, born(_, _), Born),
    count(File, died(_, _), Died),
    Born - Died =< 16.                  % and four guards

%   The largest number of agents at a time, until all attacks are settled.

watch(File, Attacks, Most) :-
    nb_setval(most, 0),
    wait_until(( aggregate_all(count, agent_property(_, host(_)), Count),
                 nb_getval(most, Most0),
                 Most1 is max(Most0, Count),
                 nb_setval(most, Most1),
                 count(File, served(_, _, _, _), Served),
                 count(File, generated(_, _, _), Generated),
                 Served + Generated =:= Attacks ), 60),
    nb_getval(most, Most).

:- end_tests(sieve_network).
