:- module(test_parts, []).

% Without a part of app/packaging/parts.pl all others work, and what uses it
% raises an error, in one line, that names it.

:- use_module('../../app/packaging/parts', [part/3]).
:- use_module('../../doc/layers/parts', [parts_problem/1]).
:- use_module('../lib/common').
:- use_module(library(filesex),
              [delete_directory_and_contents/1, directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3]).

%   without(+Parts, :Goal): call(Goal, Dir), Dir being a copy of the tree, as
%   far as programs need it, without Parts.

:- meta_predicate without(+, 1).

without(Parts, Goal) :-
    with_tmp_dir(Dir,
        ( project_file('.', Root),
          process_create(path(cp),
                         ['-r', prolog, app, bridges, payloads, 'pack.pl', Dir],
                         [cwd(Root)]),
          forall(( member(Part, Parts), part(Part, _, Paths),
                   member(Path, Paths) ),
                 remove(Dir, Path)),
          call(Goal, Dir) )).

remove(Dir, Path) :-
    directory_file_path(Dir, Path, File),
    (   exists_directory(File)
    ->  delete_directory_and_contents(File)
    ;   exists_file(File)
    ->  delete_file(File)
    ;   true
    ).

%   says(+Goals, +Dir, -Status, -Lines): what a process with the library of Dir
%   prints of errors.

says(Goals, Dir, Status, Lines) :-
    directory_file_path(Dir, prolog, Library),
    atom_concat('library=', Library, Path),
    findall(Arg, ( member(Goal, Goals), member(Arg, ['-g', Goal]) ), Args),
    append(['-p', Path|Args], ['-t', halt], All),
    run_swipl(All, [timeout(120), cwd(Dir)], Status, _, Err),
    split_string(Err, "\n", "\n", Lines0),
    ( Lines0 == [""] -> Lines = [] ; Lines = Lines0 ).

absent(Name, Line) :-
    format(string(End), "~w is not part of this installation: \c
                         install the full archive", [Name]),
    sub_string(Line, _, _, 0, End).

product(Part) :-
    part(Part, _, [Path|_]),
    sub_atom(Path, 0, _, _, 'prolog/').

%   use(?Part, ?Goal, ?Name): Goal, at host `a`, raises the error of Name.

use(bridges, 'python_start(a,"x.py",[])', 'library(typhon/python)').
use(bridges, 'mqtt_start(a,\'mqtt://localhost\',[])', 'library(typhon/mqtt)').
use(bridges, 'gpio_start(a,[],[])', 'library(typhon/gpio)').
use(bridges, 'ros_start(a,ros2,[])', 'library(typhon/ros)').
use(fipa, 'fipa_start(a,\'http://localhost:0\',[])', 'library(typhon/fipa)').
use(postgresql, 'host_start(b,[journal(\'postgresql://localhost\')])',
    postgresql).
use(postgresql, 'host_start(b,[journal(postgresql(\'postgresql://x\'))])',
    postgresql).
use(migration, 'remote(a,next_host(random,_))', migration).
use(migration, 'remote(a,emit(fire))', migration).
use(migration, 'agent_create(clauses([(:-agent(x)),(main:-withdraw(x))]),A),\c
                agent_join(A,raised(E),20),throw(E)', migration).
use(replay, 'use_module(library(typhon/tools/page)),\c
             typhon_page:page_export(log,\'page.html\',[])', replay).

command(bridges, [diagnose, python], bridges).
command(bridges, [host, a, '--mqtt=mqtt://localhost'],
        'library(typhon/mqtt)').
command(nxt, [diagnose, nxt, 'COM1'], 'library(typhon/nxt)').
command(fipa, [diagnose, fipa, 'http://localhost'], 'library(typhon/fipa)').
command(replay, [page, log, '--export=page.html'], replay).
command(postgresql, [host, a, '--journal=postgresql://localhost'],
        postgresql).

shown(Goal, Text) :-
    format(atom(Text),
           'use_module(library(typhon)),host_start(a),\c
            catch((~w),E,(print_message(error,E)))', [Goal]).

:- begin_tests(parts).

test(without_a_part_the_library_loads_silently,
     [forall(product(Part)), Status-Lines == exit(0)-[]]) :-
    without([Part], loads(Status, Lines)).

loads(Status, Lines, Dir) :-
    says(['use_module(library(typhon))', 'host_start(a)',
          'agent_create(clauses([(:-agent(x,[])),main]),A),\c
           agent_join(A,done,20)'],
         Dir, Status, Lines).

test(use_names_what_is_left_out,
     [ forall(product(Part)), Others == [] ]) :-
    without([Part], uses(Part, Others)).

uses(Part, Others, Dir) :-
    findall(Goal-Lines,
            ( use(Part, Goal, Name),
              shown(Goal, Shown),
              says([Shown], Dir, _, Lines),
              \+ ( member(Line, Lines), absent(Name, Line) ) ),
            Others).

test(library_names_itself,
     [ forall(product(Part)), Others == [] ]) :-
    without([Part], library_alone(Part, Others)).

library_alone(Part, Others, Dir) :-
    part(Part, Libraries, _),
    findall(Library-Lines,
            ( member(File, Libraries),
              atom_concat('prolog/', Base, File),
              file_name_extension(Library, pl, Base),
              format(atom(Load), 'use_module(library(~w))', [Library]),
              says([Load], Dir, _, Lines),
              \+ names_itself(Part, Library, Lines) ),
            Others).

%   library(typhon/nxt) works without its old names.

names_itself(tartarus, 'typhon/nxt', []) :- !.
names_itself(_, Library, [_, Line]) :-
    format(atom(Name), 'library(~w)', [Library]),
    absent(Name, Line).

test(commands_name_what_is_left_out,
     [ forall(product(Part)), Others == [] ]) :-
    without([Part], commands(Part, Others)).

commands(Part, Others, Dir) :-
    directory_file_path(Dir, 'app/typhon.pl', App),
    findall(Args-Status-Err,
            ( command(Part, Args, Name),
              run_swipl([App|Args], [timeout(60), cwd(Dir)], Status, _, Err),
              \+ ( Status == exit(1),
                   split_string(Err, "\n", "\n", [Line]),
                   absent(Name, Line) ) ),
            Others).

test(core_is_compiled_silently, Status-Out-Err == exit(0)-""-"") :-
    findall(Part, product(Part), Parts),
    without(Parts, compiled(Status, Out, Err)).

compiled(Status, Out, Err, Dir) :-
    directory_file_path(Dir, 'app/typhon/compile.pl', Program),
    run_swipl([Program], [timeout(120)], Status, Out, Err).

:- end_tests(parts).

%   imports(+File, +Target): a tree in which File imports Target, alone.

:- begin_tests(parts_check, [cleanup(retractall(layers_tree:import(_, _, _)))]).

problems(File0, Target0, Parts) :-
    project_file(File0, File),
    project_file(Target0, Target),
    retractall(layers_tree:import(_, _, _)),
    assertz(layers_tree:import(File, Target, all)),
    findall(Part, parts_problem(needs_part(_, _, Part)), Parts0),
    sort(Parts0, Parts).

test(core_needs_no_part, Parts == [fipa]) :-
    problems('prolog/typhon/network/plan.pl',
             'prolog/typhon/bridges/fipa/acl.pl', Parts).
test(core_needs_no_library_of_a_part, Parts == [bridges]) :-
    problems('test/lib/peers.pl', 'prolog/typhon/mqtt.pl', Parts).
test(earlier_part_does_not_need_a_later_one, Parts == [studies]) :-
    problems('prolog/typhon/options/migration/memory.pl',
             'agents/sync/operator.pl', Parts).
test(later_part_may_need_an_earlier_one, Parts == []) :-
    problems('agents/sync/operator.pl',
             'prolog/typhon/options/migration/strategy.pl', Parts).
test(library_of_a_part_imports_it, Parts == []) :-
    problems('prolog/typhon/fipa.pl',
             'prolog/typhon/bridges/fipa/service.pl', Parts).

test(each_path_is_there, Paths == []) :-
    retractall(layers_tree:import(_, _, _)),
    findall(Path, parts_problem(no_such_path(_, Path)), Paths).

:- end_tests(parts_check).
