:- module(test_kept_runs, []).

% A run is repeated if its sources have changed, and only then.

:- use_module('../../lib/common').
:- use_module('../../lib/study_files', [save_lines/3]).
:- use_module('../../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../../experiments/engine/run', [run_make/4]).
:- use_module('../../../experiments/engine/sources').
:- use_module('../../../experiments/engine/store').
:- use_module('../../../experiments/engine/studies', [study_load/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [directory_file_path/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, memberchk/2, selectchk/4]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

%   file(Name, Lines): the files of the study below.

file('ground.pl',
     [ ':- use_module(metrics).',
       ':- use_module(rows, [rows/2]).',
       'label(m, "What is measured").',
       'run(Case, Network) :- start(Case, Network).',
       'start(_, Network) :- network_property(Network, hosts([Home|_])),',
       '    agent_create(walker, _, [host(Home)]).' ]).
file('metrics.pl',
     [ ':- module(metrics, [metric/2]).',
       ':- use_module(deeper).',
       'metric(_, 1).' ]).
file('deeper.pl', [ ':- module(deeper, []).', 'deep(1).' ]).
file('rows.pl', [ ':- module(rows, [rows/2]).', 'rows(_, []).' ]).
file('study.pl',
     [ ':- include(ground).',
       'study(toy, "A toy").',
       'vary(a, [1, 2]).',
       'fixed(b, 3, assumed("so")).',
       'network(_, ring(2), []).',
       'measure(m, Log, M) :- metric(Log, M), helper(M).',
       'helper(M) :- M > 0.',
       'claim("positive", [], holds(positive)).',
       'positive(Points) :- Points = [_|_].',
       'plot(p, "A picture", script(\'p.gp\', [rows-rows], [])).' ]).
file('walker.pl', [ ':- agent(walker, []).', 'main.' ]).
file('other.pl', [ 'unrelated.' ]).

%   changed(File, Line, New, -A, -B): hashes before and after.

changed(File, Old, New, A, B) :-
    with_tmp_dir(Dir, changed(File, Old, New, A, B, Dir)).

changed(File, Old, New, A, B, Dir) :-
    forall(file(Name, Lines), save_lines(Dir, Name, Lines)),
    hash(Dir, A),
    file(File, Lines0),
    assertion(memberchk(Old, Lines0)),
    selectchk(Old, Lines0, New, Lines),
    save_lines(Dir, File, Lines),
    hash(Dir, B).

%   In a process of its own, as another session would.

hash(Dir, Hash) :-
    project_file('experiments/engine/sources', Sources),
    directory_file_path(Dir, 'study.pl', File),
    format(atom(Goal), 'use_module(~q), sources_hash(~q, H), write(H)',
           [Sources, File]),
    run_swipl(['-g', Goal, '-t', halt], [], exit(0), Hash, "").

makes_anew('study.pl', 'network(_, ring(2), []).', 'network(_, ring(3), []).').
makes_anew('study.pl', 'helper(M) :- M > 0.', 'helper(M) :- M > 1.').
makes_anew('study.pl', ':- include(ground).',
           ':- include(ground).\n:- use_module(library(lists)).').
makes_anew('ground.pl', 'run(Case, Network) :- start(Case, Network).',
           'run(_, _).').
makes_anew('metrics.pl', 'metric(_, 1).', 'metric(_, 2).').
makes_anew('deeper.pl', 'deep(1).', 'deep(2).').
makes_anew('walker.pl', 'main.', 'main :- log(here).').

stays('study.pl', 'study(toy, "A toy").', 'study(toy, "Another").').
stays('study.pl', 'vary(a, [1, 2]).', 'vary(a, [1, 2, 3]).').
stays('study.pl', 'fixed(b, 3, assumed("so")).',
      'fixed(b, 3, printed("there")).').
stays('study.pl', 'claim("positive", [], holds(positive)).',
      'claim("positive", [], m > 0).').
stays('study.pl', 'positive(Points) :- Points = [_|_].',
      'positive(_).').
stays('study.pl', 'plot(p, "A picture", script(\'p.gp\', [rows-rows], [])).',
      '').
stays('study.pl', 'helper(M) :- M > 0.', '% A comment.\nhelper(N) :- N > 0.').
stays('ground.pl', 'label(m, "What is measured").', 'label(m, "M").').
stays('rows.pl', 'rows(_, []).', 'rows(_, [1]).').
stays('other.pl', 'unrelated.', 'related.').

:- begin_tests(sources).

test(changed_source_repeats_the_runs,
     [forall(makes_anew(File, Old, New)), true(A \== B)]) :-
    changed(File, Old, New, A, B).
test(runs_stay, [forall(stays(File, Old, New)), A == B]) :-
    changed(File, Old, New, A, B).
test(thesis_counts_its_agents, true(Missing == [])) :-
    project_file('experiments/sync/figure_5_6.pl', Study),
    sources_hash(Study, _),
    findall(File, ( member(Name, [ 'agents/sync/worker.pl',
                                   'agents/lib/settings.pl',
                                   'experiments/sync/ground.pl',
                                   'experiments/sync/metrics.pl',
                                   'prolog/typhon/kernel/host/hosts.pl' ]),
                    project_file(Name, File),
                    exists_file(File),
                    \+ study_sources:( hashed(Study, _, Times),
                                       memberchk(File-_, Times) ) ),
            Missing).
test(changed_while_it_is_read, Base == 'walker.pl') :-
    with_tmp_dir(Dir,
        ( forall(file(Name, Lines), save_lines(Dir, Name, Lines)),
          directory_file_path(Dir, 'study.pl', Study),
          directory_file_path(Dir, 'walker.pl', Walker),
          sources_hash(Study, _),
          assertion(\+ sources_changed(Study, _)),
          set_time_file(Walker, _, [modified(1000)]),
          findall(File, sources_changed(Study, File), [File]),
          file_base_name(File, Base) )).

:- end_tests(sources).

computing([ 'study(toy, "A toy").',
            'vary(a, [1, \'x/y\']).',
            'fixed(b, 3, assumed("so")).',
            'measure(m, Log, M) :- M = Log.case.a.',
            'measure(n, _, none).' ]).

:- meta_predicate with_runs(-, -, 0).

with_runs(Root, Runs, Goal) :-
    with_tmp_dir(Dir, runs_in(Dir, Root, Runs, Goal)).

runs_in(Dir, Root, Runs, Goal) :-
    computing(Lines),
    save_lines(Dir, 'study.pl', Lines),
    directory_file_path(Dir, 'study.pl', File),
    study_load(File, Study),
    study_cases(Study, [], Cases),
    findall(run(Study, Case, Seed),
            ( member(Case, Cases), member(Seed, [1, 2]) ), Runs),
    directory_file_path(Dir, runs, Root),
    call(Goal).

directories(Bases, Root, Runs) :-
    findall(Base,
            ( member(Run, Runs), run_directory(Root, Run, Directory),
              file_directory_name(Directory, Above),
              file_directory_name(Above, Root),
              file_base_name(Directory, Base) ),
            Bases).

lacks_its_log(Root, [Run|_]) :-
    part(Root, Run, Directory, Part),
    run_facts(Part, Facts),
    result_save(Part, [events(1)|Facts]),
    part_install(Part, Directory, false),
    assertion(run_done(Root, false, Run)),
    assertion(\+ run_done(Root, true, Run)).

another_parameter(Root, [Run|_]) :-
    Run = run(Study, Case, Seed),
    run_directory(Root, Run, Directory),
    run_directory(Root, run(Study, Case.put(b, 4), Seed), Other),
    assertion(Directory \== Other).

ends_with_hash(Root, [Run|_]) :-
    Run = run(Study, _, _),
    run_directory(Root, Run, Directory),
    sources_hash(Study, Hash),
    assertion(atom_concat(_, Hash, Directory)).

part(Root, Run, Directory, Part) :-
    Run = run(Study, Case, Seed),
    run_directory(Root, Run, Directory),
    part_directory(Directory, 17, Part),
    part_begin(Part),
    run_make(Study, Case, Seed, Part).

installed(Measures, Root, [Run|_]) :-
    part(Root, Run, Directory, Part),
    assertion(\+ run_done(Root, false, Run)),
    part_install(Part, Directory, false),
    assertion(run_done(Root, false, Run)),
    assertion(run_done(Root, true, Run)),       % it has no log
    assertion(\+ exists_directory(Part)),
    run_result(Root, Run, Measures).

failed(Text, Root, [Run|_]) :-
    part(Root, Run, Directory, Part),
    save_lines(Part, output, ["it says"]),
    part_fail(Part, Directory, "why\nso\n", failed(Failed, Cause)),
    assertion(Cause == "why"),
    assertion(atom_concat(Directory, '.failed', Failed)),
    assertion(\+ exists_directory(Part)),
    assertion(\+ run_done(Root, false, Run)),
    directory_file_path(Failed, output, File),
    read_file_to_string(File, Text, []),
    part(Root, Run, _, Part),
    part_install(Part, Directory, false),
    assertion(\+ exists_directory(Failed)).

%   Runs of this process, of one that has ended, and of one on another machine,
%   whose state is unknown here.

begun(Left, Root, [Run|_]) :-
    Run = run(Study, _, _),
    run_directory(Root, Run, Directory),
    current_prolog_flag(pid, Mine),
    process_create(path(true), [], [process(Ended)]),
    process_wait(Ended, _),
    part_directory(Directory, Mine, PartOfMine),
    part_directory(Directory, Ended, PartOfEnded),
    atomic_list_concat([Directory, 'else.where', Ended, part], '.', Elsewhere),
    maplist(part_begin, [PartOfMine, PartOfEnded, Elsewhere]),
    left_parts_remove(Root, Study),
    maplist(is_there, [PartOfMine, PartOfEnded, Elsewhere], Left).

is_there(Directory, Is) :-
    (   exists_directory(Directory)
    ->  Is = true
    ;   Is = false
    ).

logs(Left, Root, [Run|_]) :-
    part(Root, Run, Directory, Part),
    save_lines(Part, 'events.pl', ["event."]),
    part_install(Part, Directory, Left),
    directory_file_path(Directory, 'events.pl', Log),
    (   Left == true
    ->  assertion(exists_file(Log))
    ;   assertion(\+ exists_file(Log))
    ).

log_comes_later(Root, [Run|_]) :-
    part(Root, Run, Directory, Part),
    part_install(Part, Directory, false),
    part(Root, Run, Directory, Part),
    save_lines(Part, 'events.pl', ["event."]),
    part_install(Part, Directory, true),
    directory_file_path(Directory, 'events.pl', Log),
    assertion(exists_file(Log)),
    assertion(\+ exists_directory(Part)).

:- begin_tests(store).

test(each_run_has_a_directory, Count == 4) :-
    with_runs(Root, Runs, directories(Bases, Root, Runs)),
    sort(Bases, Distinct),
    length(Distinct, Count),
    assertion(once(( member(Base, Bases),
                     sub_atom(Base, 0, _, _, 'a=x:y,seed=1-') ))).
test(run_that_lacks_its_log_is_done_only_without_logs) :-
    with_runs(Root, Runs, lacks_its_log(Root, Runs)).
test(another_fixed_parameter_is_another_run) :-
    with_runs(Root, Runs, another_parameter(Root, Runs)).
test(name_of_a_run_ends_with_the_hash_of_its_sources) :-
    with_runs(Root, Runs, ends_with_hash(Root, Runs)).
test(long_names_are_cut, true(Length < 150)) :-
    computing(Lines),
    with_tmp_dir(Dir, long(Lines, Length, Dir)).
test(installed, M-N == 1-none) :-
    with_runs(Root, Runs, installed(Measures, Root, Runs)),
    M = Measures.m,
    N = Measures.n.
test(failed, Text == "it says\nwhy\nso\n") :-
    with_runs(Root, Runs, failed(Text, Root, Runs)).
test(two_sessions) :-
    with_runs(Root, [Run|_],
        ( part(Root, Run, Directory, Part),
          part_directory(Directory, 18, Other),
          part_begin(Other),
          Run = run(Study, Case, Seed),
          run_make(Study, Case, Seed, Other),
          part_install(Part, Directory, false),
          part_install(Other, Directory, false),
          assertion(run_done(Root, false, Run)),
          assertion(\+ exists_directory(Other)) )).
test(left_behind, Left == [true, false, true]) :-
    with_runs(Root, Runs, begun(Left, Root, Runs)).
test(logs, [forall(member(Left, [true, false]))]) :-
    with_runs(Root, Runs, logs(Left, Root, Runs)).
test(log_comes_later) :-
    with_runs(Root, Runs, log_comes_later(Root, Runs)).
test(facts_of_a_run) :-
    with_runs(Root, [Run|_],
        ( part(Root, Run, _, Part),
          run_facts(Part, Facts) )),
    forall(member(Fact, [ seed(1), parameter(a, 1), parameter(b, 3),
                          sources(_), version(prolog, _),
                          version(typhon, _), bits(_), processors(_),
                          wall(_), cpu(_), measure(m, 1) ]),
           assertion(memberchk(Fact, Facts))).

:- end_tests(store).

long([Study|Lines], Length, Dir) :-
    length(Codes, 300),
    maplist(=(0'a), Codes),
    atom_codes(Long, Codes),
    save_lines(Dir, 'study.pl', [Study|Lines]),
    directory_file_path(Dir, 'study.pl', File),
    study_load(File, Loaded),
    study_cases(Loaded, [a-Long], [Case]),
    run_directory(Dir, run(Loaded, Case, 1), Directory),
    file_base_name(Directory, Base),
    atom_length(Base, Length).
