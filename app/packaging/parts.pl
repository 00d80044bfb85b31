:- module(parts,
          [ part/3,                     % ?Part, ?Libraries, ?Paths
            part_file/2,                % ?Part, +File
            installed/1,                % +Part
            left_out/2,                 % ?File, ?Part
            left_out/0
          ]).

/** <module> Parts of the project that can be left out

    git ls-files | swipl -g left_out -t halt app/packaging/parts.pl

prints the files that the small archive lacks, as `File Part`; in that archive
the file LEFT_OUT has these lines. What is of no part is the core: the kernel,
the language, options, networks and tools, with their suites and documents.

*Threading*: any thread.
*/

:- use_module(library(lists), [member/2]).
:- use_module(library(readutil),
              [read_file_to_string/3, read_line_to_string/2]).

:- dynamic root/1.

:- prolog_load_context(directory, Dir),
   absolute_file_name('../..', Root, [relative_to(Dir)]),
   retractall(root(_)),
   assertz(root(Root)).

%!  part(?Part, ?Libraries:list, ?Paths:list) is nondet.
%
%   Paths are the files and folders of Part from the root of the tree; a path
%   that ends with a hyphen is the begin of names. Libraries are files of the
%   core which import Part for programs of users. `make check` reports other
%   files of the core that import it, but by autoload/2, and files of earlier
%   parts.

part(bridges,
     [ 'prolog/typhon/mqtt.pl', 'prolog/typhon/python.pl',
       'prolog/typhon/ros.pl', 'prolog/typhon/gpio.pl' ],
     [ 'prolog/typhon/bridges/mqtt', 'prolog/typhon/bridges/gpio', 'prolog/typhon/bridges/python',
       'prolog/typhon/bridges/ros', 'bridges/mqtt', 'bridges/python',
       'bridges/ros', 'bridges/gpio', 'app/typhon/bridges', '.ci/ros-tools',
       '.ci/requirements/ros-tools.in', '.ci/requirements/ros-tools.txt',
       'doc/boards.md', 'doc/bridges.md', 'doc/bridges-ros.md',
       'test/prolog/bridges/gpio', 'test/prolog/bridges/mqtt',
       'test/prolog/bridges/python', 'test/prolog/bridges/ros',
       'test/prolog/bridges/helper', 'test/lib/brokers.pl',
       'test/lib/python_functions.py', 'test/lib/ros_agents.pl',
       'test/lib/ros_peer.py', 'test/lib/rosbridge_server.pl' ]).
part(nxt,
     [ 'prolog/typhon/nxt.pl' ],
     [ 'prolog/typhon/bridges/nxt', 'bridges/nxt', 'app/typhon/nxt',
       'doc/robots.md', 'doc/brick.md', 'test/prolog/bridges/nxt',
       'test/bridges/nxt', 'test/lib/brick_scenarios.pl',
       'test/lib/nxt_bricks.pl', 'test/lib/nxt_fixtures.pl',
       'test/lib/nxt_peer.py', 'test/lib/nxt_wrapper.py' ]).
part(tartarus,                          % and the names of SWI-PRO-NXT
     [ 'prolog/tartarus.pl', 'prolog/typhon/nxt.pl' ],
     [ 'prolog/tartarus', 'prolog/typhon/bridges/nxt/swi_pro_nxt.pl',
       'prolog/typhon/bridges/nxt/old_devices.pl', 'bridges/tartarus',
       'doc/tartarus.md', 'test/prolog/tartarus',
       'test/lib/quick_tartarus.pl', 'test/lib/tartarus_nodes.pl' ]).
part(fipa,
     [ 'prolog/typhon/fipa.pl' ],
     [ 'prolog/typhon/bridges/fipa', 'app/typhon/fipa', 'payloads/fipa',
       'examples/fipa.pl', 'doc/bridges-fipa.md', 'test/prolog/bridges/fipa',
       'test/lib/fipa', 'test/lib/fipa_agents.pl', 'test/lib/jade.pl' ]).
part(postgresql,
     [],
     [ 'prolog/typhon/options/journal/postgresql.pl',
       'test/prolog/options/journal/test_postgresql.pl',
       'test/lib/postgres.pl' ]).
part(replay,
     [],
     [ 'prolog/typhon/tools/page/replay.pl',
       'test/prolog/tools/page/test_page_replay.pl' ]).
part(migration,
     [],
     [ 'prolog/typhon/options/migration', 'examples/pheromone.pl',
       'test/prolog/options/migration' ]).
part(studies,                           % mechanisms, experiments, applications
     [],
     [ 'agents/allocation', 'agents/hierarchy', 'agents/learning',
       'agents/population', 'agents/robots', 'agents/sieve', 'agents/sync',
       'payloads/allocation', 'payloads/hierarchy', 'payloads/learning',
       'payloads/robots', 'payloads/sieve', experiments,
       'examples/applications', 'examples/studies', 'examples/hierarchy.pl',
       'examples/people',
       'app/demo_page.pl', 'app/demo_ros.pl', 'app/playground/begin.js',
       'app/playground/build.js', 'app/playground/index.html',
       'app/playground/play.css', 'app/playground/play.js',
       'app/playground/playground.pl', 'app/playground/session.pl',
       'app/playground/share.js', 'app/playground/sw.js',
       'app/playground/worker.js', '.ci/pandas',
       '.ci/requirements/pandas.in', '.ci/requirements/pandas.txt',
       'doc/algorithms.md', 'doc/allocation.md', 'doc/analysis.md',
       'doc/application-studies.md', 'doc/applications.md',
       'doc/auctions.md', 'doc/browser.md', 'doc/course',
       'doc/demos.md', 'doc/equations.md', 'doc/fidelity',
       'doc/fidelity.md', 'doc/hierarchy.md', 'doc/learning.md', 'doc/mechanisms.md',
       'doc/population.md', 'doc/robot-studies.md', 'doc/sieve.md',
       'doc/studies.md',
       'doc/synchronisation.md', 'doc/img/algorithms-',
       'doc/img/application-', 'doc/img/hierarchy.png',
       'doc/img/penalty-', 'doc/img/pole.png', 'doc/img/population.png',
       'doc/img/sieve-', 'doc/img/surface.png',
       'doc/img/synchronisation.png', 'test/agents', 'test/experiments',
       'test/editors', 'test/examples/test_applications.pl',
       'test/examples/test_fire.pl', 'test/examples/test_irrigation.pl',
       'test/examples/test_irrigation_mqtt.pl',
       'test/examples/test_people_examples.pl',
       'test/examples/test_solar.pl', 'test/examples/test_warehouse.pl',
       'test/app/test_playground_page.pl',
       'test/app/test_playground_firefox.pl', 'test/doc/test_course.pl',
       'test/doc/test_equations.pl',
       'test/doc/test_fidelity.pl', 'test/project/test_locale.pl',
       'test/prolog/network/test_saving.pl',
       'test/prolog/tools/test_mistyped.pl', 'test/lib/algorithms_bench.pl',
       'test/lib/event_log.pl', 'test/lib/playground_scenes.pl',
       'test/lib/quick_study.pl',
       'test/lib/wasm/sessions.js', 'test/lib/fake_node.pl', 'test/lib/project_studies.pl',
       'test/lib/robot_logs.pl', 'test/lib/study_files.pl',
       'test/lib/toy_study.pl' ]).
part(development,                       % checks and measurements of all parts
     [],
     [ bench, '.ci/run', '.github', 'doc/layers', 'doc/layers.pl',
       'doc/pictures', 'doc/pictures.pl', 'test/mutants', 'test/portability',
       'test/promises', 'test/promises.pl', 'test/doc/test_picture_names.pl',
       'test/doc/test_pictures.pl',
       'test/doc/test_shell.pl', 'test/app/test_arguments.pl',
       'test/project/test_downloads.pl', 'test/project/test_make.pl',
       'test/project/test_mutants.pl', 'test/project/test_parts.pl',
       'test/project/test_project_documents.pl',
       'test/project/test_quick.pl',
       'test/project/test_thrown_errors.pl' ]).

%!  part_file(?Part, +File) is semidet.
%
%   File belongs to Part, whose path is the longest that leads to File.

part_file(Part, File) :-
    findall(Length-Of, leads_to(Of, File, Length), Owners0),
    sort(0, @>=, Owners0, [_-Part|_]).

leads_to(Part, File, Length) :-
    part(Part, _, Paths),
    member(Path, Paths),
    atom_concat(Path, Rest, File),
    once(( Rest == ''
         ; sub_atom(Rest, 0, _, _, /)
         ; sub_atom(Path, _, _, 0, -)
         )),
    atom_length(Path, Length).

%!  installed(+Part) is semidet.
%
%   The files of Part are in this tree.

installed(Part) :-
    part(Part, _, [Path|_]),
    root(Root),
    format(atom(File), '~w/~w', [Root, Path]),
    ( exists_file(File) ; exists_directory(File) ),
    !.

%!  left_out(?File, ?Part) is nondet.
%
%   File, of Part, is left out of the archive that this tree is from.

:- table left_out/2.

left_out(File, Part) :-
    root(Root),
    atom_concat(Root, '/LEFT_OUT', List),
    exists_file(List),
    read_file_to_string(List, Text, []),
    split_string(Text, "\n", "\n", Lines),
    member(Line, Lines),
    atomic_list_concat([File, Part], ' ', Line).

%!  left_out is det.

left_out :-
    repeat,
    read_line_to_string(user_input, Line),
    (   Line == end_of_file
    ->  !
    ;   atom_string(File, Line),
        part_file(Part, File),
        format('~w ~w~n', [File, Part]),
        fail
    ).
