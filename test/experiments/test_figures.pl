:- module(test_figures, []).

% The figures of chapter 5: which runs they need, what is said of them, and
% how they are drawn; and one of them from the command line to the picture.

:- use_module('../lib/common',
              [project_file/2, run_swipl/5, with_tmp_dir/1]).
:- use_module(library(apply)).
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(pairs)).
:- use_module(library(plunit)).
:- use_module(library(readutil)).
:- use_module('../../experiments/lib/chart').
:- use_module('../../experiments/sync/claimed').
:- use_module('../../experiments/sync/healing').
:- use_module('../../experiments/sync/potentials').
:- use_module('../../experiments/sync/scenarios').
:- use_module('../../experiments/sync/statements').

                /*******************************
                *             CASES            *
                *******************************/

:- begin_tests(cases).

test(figures_have_cases, Counts == [ '5.2'-0, '5.5'-4, '5.6'-20, '5.7a'-16,
                                     '5.7b'-16, '5.8'-1, '5.9'-8, '5.10'-8,
                                     '5.11'-4, '5.12'-2 ]) :-
    findall(F-N, ( figure(F, _), figure_cases(F, Cs), length(Cs, N) ),
            Counts).
test(keys_differ, [forall(figure(F, _)), true(Keys == Distinct)]) :-
    figure_cases(F, Cases),
    pairs_keys(Cases, Keys),
    list_to_set(Keys, Distinct).
test(shared_by_figures, [forall(member(F, ['5.6', '5.7a', '5.7b'])),
                         true(Shared == 4)]) :-
    figure_cases('5.5', Cases5),
    figure_cases(F, Cases),
    pairs_values(Cases5, Wanted),
    pairs_values(Cases, Found),
    findall(C, ( member(C, Wanted), memberchk(C, Found) ), Cs),
    length(Cs, Shared).
test(all_topologies_have_sixty_hosts, Sizes == [60, 60, 60, 60]) :-
    findall(N, ( topology(_, _, T, _), T =.. [_|Args],
                 foldl([X, A, B]>>(B is A * X), Args, 1, N) ), Sizes).
test(arguments, As == [ '--topology=ring(60)', '--delta=0.8', '--clock=20',
                        '--seed=7' ]) :-
    figure_cases('5.5', Cases),
    memberchk(ring-Case, Cases),
    case_arguments(Case, 7, [clock(20)], As).
test(names_differ, Names == Distinct) :-
    findall(Case, ( figure(F, _), figure_cases(F, Cs), member(_-Case, Cs) ),
            Cases0),
    sort(Cases0, Cases),
    maplist([C, N]>>case_name(C, 1, N), Cases, Names0),
    msort(Names0, Names),
    sort(Names, Distinct).

:- end_tests(cases).

                /*******************************
                *      HEALING, POTENTIALS     *
                *******************************/

%   T1, T2, T3 on a and b; b loses T1 at 7, while T3 has begun, and is
%   healed; what was executed again ends at 9.

wounded([ execution(1, a, 0, 1), execution(1, b, 0, 1),
          execution(2, a, 3, 4), execution(2, b, 3, 4),
          execution(3, a, 6, 8), execution(1, b, 8, 9),
          execution(3, b, 10, 11) ]).

:- begin_tests(healing).

test(failures, Fs == [failure(3, b, 1), failure(5, a, 2)]) :-
    failures([ event(5, a, w, failed(main, 2)), event(4, a, w, other),
               event(3, b, w, failed(main, 1)) ], Fs).
test(no_failure_one_phase, Phases == [Es]) :-
    wounded(Es),
    phases(none, Es, [], Phases).
test(atomic, Redone == [execution(1, b, 8, 9)]) :-
    wounded(Es),
    phases(atomic(1, 1, 3), Es, [failure(7, b, 1)], [Others, Redone]),
    length(Others, 6).
test(cascaded, After == [execution(1, a, 9, 10), execution(1, b, 9, 10)]) :-
    phases(cascaded(1, 2, 1),
           [ execution(1, a, 0, 1), execution(2, b, 7.5, 8),
             execution(1, a, 9, 10), execution(1, b, 9, 10) ],
           [failure(7, a, 1), failure(8, b, 1)], [_, After]).
test(measures, Measures == [ failed_at(7), failed_by(7), lost(1),
                             lost_hosts(1), redone(1), healed_at(9),
                             meanwhile(0), healing_tau(3),
                             later_tau(2) ]) :-
    wounded(Es),
    healing(Es, [failure(7, b, 1)], [0-1, 7-3, 9-2], Measures).
test(not_healed, Redone == 0) :-
    healing([execution(1, a, 0, 1)], [failure(2, a, 1)], [0-1], Measures),
    memberchk(redone(Redone), Measures).
test(lost_before_it_was_completed, Lost == 0) :-
    healing([execution(1, a, 3, 4)], [failure(2, a, 1)], [0-1], Measures),
    memberchk(lost(Lost), Measures).

:- end_tests(healing).

:- begin_tests(potentials).

test(first_steps) :-
    potential_steps(0.5, [], Steps),
    Steps = [step(0, 100, 15), step(1, P, Theta)|_],
    Theta =:= 15.5,
    P =:= 84.5.
test(until_zero, N-P == 37-0) :-
    potential_steps(0.5, [], Steps),
    last(Steps, step(N, P, _)).
test(reward) :-
    potential_steps(0.5, [2], Steps),
    memberchk(step(1, P1, _), Steps),
    memberchk(step(2, P2, Theta), Steps),
    Theta =:= (15 + 15.5)/2 * 84.5/100,
    P2 =:= P1 + Theta.

:- end_tests(potentials).

                /*******************************
                *            CLAIMS            *
                *******************************/

%   Data of which every claim holds, and of which none does.

data('5.2', true, Curves) :-
    findall(curve(D, [2, 5], Steps),
            ( member(D, [0.2, 0.5, 1.0]),
              potential_steps(D, [2, 5], Steps) ),
            Curves).
data('5.2', false, [curve(0.2, [2], A), curve(0.5, [2], B)]) :-
    A = [ step(0, 100, 15), step(1, 99, 1), step(2, 99, 0), step(3, 90, 9),
          step(4, 0, 90) ],
    B = [ step(0, 100, 15), step(1, 99, 1), step(2, 99, 0), step(3, 95, 4),
          step(4, 0, 80) ].
data('5.5', Held, Data) :-
    idles(Held, Idles),
    findall(Name-[Run, Run],
            ( member(Name-Idle, Idles), run(Held, [idle(Idle)], Run) ), Data).
data('5.6', true, Data) :-
    findall(Name-Delta-[Run],
            ( topology(Name, _, _, Best),
              member(Delta, [0.2, 0.5, 0.8, 1.0]),
              Idle is 50 / Delta,
              ( Delta > Best, Name \== ring
              -> Overlaps is integer(Delta * 10), Tau = 3
              ;  Overlaps = 0, Tau = 2
              ),
              run(true, [idle(Idle), overlaps(Overlaps), tau(Tau)], Run) ),
            Data).
data('5.6', false, Data) :-
    findall(Name-Delta-[Run],
            ( topology(Name, _, _, _),
              member(Delta, [0.2, 0.5, 0.8, 0.9, 1.0]),
              Idle is 50 * Delta,
              Overlaps is integer((2 - Delta) * 10),
              run(false, [idle(Idle), overlaps(Overlaps), tau(2)], Run) ),
            Data).
data('5.7a', true, Data) :-
    findall(Name-Agents-[Run],
            ( member(Name-Idles, [ tree-[98, 48, 116],
                                   star_bus-[9, 8, 9], ring-[7, 8, 9],
                                   grid-[9, 8, 9] ]),
              nth0(I, [5, 10, 20], Agents),
              nth0(I, Idles, Idle),
              run(true, [idle(Idle), overlaps(8)], Run) ),
            Data).
data('5.7a', false, Data) :-
    findall(Name-Agents-[Run],
            ( topology(Name, _, _, _),
              member(Agents, [5, 10, 20]),
              Idle is 1000 / Agents,
              run(false, [idle(Idle), overlaps(9)], Run) ),
            Data).
data('5.7b', Held, Data) :-
    findall(Name-Hosts-[Run],
            ( topology(Name, _, _, _), member(Hosts, [30, 60]),
              run(Held, [], Run) ),
            Data).
data('5.8', Held, [grid-[Run]]) :-
    run(Held, [], Run).
data('5.9', Held, Data) :-
    member(Held-Sign, [true-1, false-(-1)]),
    findall(Model-Agents-[Run],
            ( member(Model, [dynamic_1, dynamic_2]),
              member(Agents, [5, 10]),
              Idle is 100 + Sign * Agents,
              run(Held, [idle(Idle)], Run) ),
            Data).
data('5.10', Held, Data) :-
    member(Held-Factor, [true-1.9, false-0.9]),
    findall(Model-Agents-[Run],
            ( member(Model-F, [dynamic_1-1, dynamic_2-Factor]),
              member(Agents, [5, 10]),
              Total is 100 * F,
              run(Held, [total(Total)], Run) ),
            Data).
data('5.11', Held, Data) :-
    findall(Name-[Run], ( topology(Name, _, _, _), run(Held, [], Run) ),
            Data).
data('5.12', true, [grid-[Run], dynamic_2-[Run]]) :-
    run(true, [lost(180), redone(180), lost_hosts(60), healing_tau(2)], Run).
data('5.12', false, [grid-[Run], dynamic_2-[Run]]) :-
    run(false, [lost(180), redone(179), lost_hosts(60), healing_tau(3)], Run).

idles(true, [star_bus-66, ring-32, tree-142, grid-25]).
idles(false, [star_bus-2, ring-3, tree-1, grid-4]).

run(Held, Given, Run) :-
    measures(Held, Measures),
    append(Given, Measures, Run).

measures(true, [ overlaps(0), tau(2), idle(10), out_of_order(0), gaps([5]),
                 bursts([19, 5]), last_starts([8, 50]), starts([0, 37]),
                 agents(10), ended(10), executions(380), lost(20),
                 redone(20), healing_tau(3), meanwhile(5), later_tau(2),
                 claims([ claim(Once, true, x), claim(Order, true, x) ]) ]) :-
    texts(Once, Order).
measures(false, [ overlaps(1), tau(3), idle(10), out_of_order(1), gaps([0]),
                  bursts([5, 6]), last_starts([10, 50]), starts([0, 100]),
                  agents(10), ended(9), executions(379), lost(20),
                  redone(19), healing_tau(2), meanwhile(0), later_tau(3),
                  claims([ claim(Once, false, x), claim(Order, false, x) ])
                ]) :-
    texts(Once, Order).

texts('every host executes every task exactly once',
      'no host executes a task before the earlier ones').

:- begin_tests(statements).

test(every_claim, [ forall(( figure(F, _), member(Held, [true, false]) )),
                    true(Others-Empty == []-false) ]) :-
    data(F, Held, Data),
    !,
    statements(F, Data, Claims),
    findall(Text-Found, ( member(claim(Text, H, Found), Claims), H \== Held ),
            Others),
    ( Claims == [] -> Empty = true ; Empty = false ).
test(number_of_claims, Count == 29) :-
    data('5.5', true, Data),
    statements('5.5', Data, Claims),
    length(Claims, Count).
test(says_in_how_many_runs, Found == 'in 1 of 2 runs') :-
    run(true, [], Good),
    run(false, [], Bad),
    statements('5.8', [grid-[Good, Bad]], Claims),
    memberchk(claim('no overlapped executions', false, Found), Claims).
test(sentence, S == '2 of 4 claims did not hold: 1 of the 2 of Figure 5.2, \c
1 of the 1 of Figure 5.8.') :-
    figures_sentence([ '5.2'-claim(a, true, x), '5.2'-claim(b, false, x),
                       '5.8'-claim(c, false, x), '5.9'-claim(d, true, x) ],
                     S).
test(sentence_held, S == 'All 1 claims held.') :-
    figures_sentence(['5.2'-claim(a, true, x)], S).
test(one_case_only, Texts == ['all agents end by themselves']) :-
    statements('5.9', [x-1-[[agents(1), ended(1)]]], Claims),
    findall(T, member(claim(T, _, _), Claims), Texts).

:- end_tests(statements).

                /*******************************
                *            DRAWING           *
                *******************************/

gnuplot :-
    absolute_file_name(path(gnuplot), _,
                       [access(execute), file_errors(fail)]).

:- begin_tests(drawing).

test(median, Ms == [2, 2.5, 7]) :-
    maplist(median, [[3, 1, 2], [4, 1, 2, 3], [7]], Ms).
test(no_median, [fail]) :-
    median([], _).
test(chart, [condition(gnuplot)]) :-
    with_tmp_dir(chart_drawn).
test(potentials, [condition(gnuplot)]) :-
    with_tmp_dir(potentials_drawn).

%   A line with a gap, one point marked: median, least, greatest.

chart_drawn(Dir) :-
    draw_chart(Dir, c,
               [ title('T'), subtitle('S'), x('x'),
                 panels([ panel('P', y,
                                [series(a, 0, [1-[5, 1, 3], 2-[2]], 2)]) ])
               ]),
    drawn(Dir, c),
    directory_file_path(Dir, 'c-1-0.dat', Data),
    read_file_to_string(Data, Text, []),
    split_string(Text, "\n", "", Lines),
    Lines == [ "1.0000 3 1 5", "2.0000 2 2 2", "", "",
               "1.0000 5 0 0", "1.0000 1 0 0", "1.0000 3 0 0",
               "2.0000 2 0 0", "", "", "2.0000 2 0 0", "" ].

potentials_drawn(Dir) :-
    potential_steps(0.5, [2], Steps),
    draw_potentials(Dir, p, 'T', [curve(0.5, [2], Steps)]),
    drawn(Dir, p).

drawn(Dir, Name) :-
    forall(member(Extension, [png, svg]),
           ( file_name_extension(Name, Extension, File0),
             directory_file_path(Dir, File0, File),
             size_file(File, Size),
             Size > 2000 )).

:- end_tests(drawing).

                /*******************************
                *           AS A WHOLE         *
                *******************************/

figures(Dir, More, Status, Out, Err) :-
    project_file('experiments/figures.pl', Script),
    append([Script, '--', '--out', Dir], More, Arguments),
    run_swipl(Arguments, [timeout(60)], Status, Out, Err).

:- begin_tests(figures).

test(small_figure) :-
    with_tmp_dir(figure_made).
test(unknown_figure, [Status == exit(1), nondet]) :-
    with_tmp_dir(refused(Status, Err)),
    sub_string(Err, _, _, _, "figure").

refused(Status, Err, Dir) :-
    figures(Dir, ['--figure', '9'], Status, _, Err).

%   The second time nothing is run.

figure_made(Dir) :-
    More = ['--figure', '5.8', '--runs', '1', '--clock', '40',
            '--processes', '1'],
    figures(Dir, More, exit(0), Out, _),
    once(sub_string(Out, _, _, _, "Figure 5.8")),
    once(sub_string(Out, _, _, _, "all agents end by themselves: in 1 of 1")),
    forall(member(Name, [ 'claims.csv', 'claims.md', 'figure-5.8/runs.csv',
                          'figure-5.8/claims.pl', 'figure-5.8/starts.dat' ]),
           ( directory_file_path(Dir, Name, File), size_file(File, Size),
             Size > 0 )),
    figures(Dir, More, exit(0), Out, Err),
    \+ sub_string(Err, _, _, _, "runs").

:- end_tests(figures).
