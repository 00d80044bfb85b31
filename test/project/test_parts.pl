:- module(test_parts, []).

% Without a part of app/packaging/parts.pl all others work, and what uses it
% raises an error, in one line, that names it.

:- use_module('../../app/packaging/parts', [part/3]).
:- use_module('../../doc/layers/parts', [parts_problem/1]).
:- use_module('../lib/common').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [delete_directory_and_contents/1, directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, nth1/3, subtract/3]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3]).

%   without(+Parts, -Dir): Dir is a copy of the tree, as far as programs need it,
%   without Parts, made once.

:- dynamic made/2.

without(Parts, Dir) :-
    made(Parts, Dir),
    !.
without(Parts, Dir) :-
    make_tmp_dir(Dir),
    assertz(made(Parts, Dir)),
    project_file('.', Root),
    process_create(path(cp),
                   ['-r', prolog, app, bridges, payloads, 'pack.pl', Dir],
                   [cwd(Root)]),
    forall(( member(Part, Parts), part(Part, _, Paths), member(Path, Paths) ),
           remove(Dir, Path)).

drop_trees :-
    forall(retract(made(_, Dir)), delete_directory_and_contents(Dir)).

remove(Dir, Path) :-
    directory_file_path(Dir, Path, File),
    (   exists_directory(File)
    ->  delete_directory_and_contents(File)
    ;   exists_file(File)
    ->  delete_file(File)
    ;   true
    ).

%   says(+Goals, +Dir, -Status, -Printed): for each of Goals the lines of errors
%   that one process with the library of Dir prints.

says(Goals, Dir, Status, Printed) :-
    directory_file_path(Dir, prolog, Library),
    atom_concat('library=', Library, Path),
    findall(Arg, ( member(Goal, Goals), goal_arg(Goal, Arg) ), Args),
    append(['-p', Path|Args], ['-t', halt], All),
    run_swipl(All, [timeout(120), cwd(Dir)], Status, _, Err),
    atomic_list_concat([Before|Texts], '@@\n', Err),
    assertion(Before == ''),
    maplist(nonempty_lines, Texts, Printed).

goal_arg(Goal, Arg) :-
    format(atom(Marked), 'format(user_error,"@@~~n",[]),\c
                          catch((~w),E,print_message(error,E))', [Goal]),
    member(Arg, ['-g', Marked]).

nonempty_lines(Text, Lines) :-
    split_string(Text, "\n", "\n", Lines0),
    subtract(Lines0, [""], Lines).

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

:- begin_tests(parts, [cleanup(drop_trees)]).

%   Of all goals in one process: the first three print nothing.

test(library_loads_silently_and_errors_name_what_is_left_out,
     [forall(product(Part)), Silent-Others == [[], [], []]-[]]) :-
    without([Part], Dir),
    findall(Goal-Name, ( use(Part, Goal, Name) ; loads(Part, Goal, Name) ),
            Tried),
    pairs_keys(Tried, Goals),
    says(['use_module(library(typhon))', 'host_start(a)',
          'agent_create(clauses([(:-agent(x,[])),main]),A),\c
           agent_join(A,done,20)'
         | Goals],
         Dir, exit(0), [A, B, C|Printed]),
    Silent = [A, B, C],
    findall(Goal-Lines,
            ( nth1(N, Tried, Goal-Name),
              nth1(N, Printed, Lines),
              \+ ( member(Line, Lines), absent(Name, Line) ) ),
            Others).

%   library(typhon/nxt) works without its old names.

loads(Part, Goal, Name) :-
    part(Part, Libraries, _),
    member(File, Libraries),
    atom_concat('prolog/', Base, File),
    file_name_extension(Library, pl, Base),
    Part-Library \== tartarus-'typhon/nxt',
    format(atom(Name), 'library(~w)', [Library]),
    format(atom(Goal), 'use_module(~w,[])', [Name]).

test(commands_name_what_is_left_out,
     [ forall(product(Part)), Others == [] ]) :-
    without([Part], Dir),
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
    without(Parts, Dir),
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
