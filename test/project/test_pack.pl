:- module(test_pack, []).

% Installed as a pack, offline and without questions, the library works from
% anywhere.  Each test has a home directory of its own.

:- use_module('../../app/packaging/parts', [installed/1, part/3]).
:- use_module('../lib/common').
:- use_module('../lib/texts', [write_file/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).

swipl_at_home(Home, Directory, Goals, Out) :-
    swipl_at_home(Home, Directory, Goals, Out, _).

swipl_at_home(Home, Directory, Goals, Out, Err) :-
    findall(Arg, goal_arg(Goals, Arg), Args),
    run_swipl(Args,
              [ cwd(Directory), timeout(120),
                environment([ 'HOME'=Home, 'XDG_DATA_HOME'=Home ])
              ],
              Status, Out, Err),
    assertion(Status+Err == exit(0)+Err).

goal_arg(Goals, Arg) :-
    member(Goal, Goals),
    member(Arg, ['-g', Goal]).
goal_arg(_, Arg) :-
    member(Arg, ['-t', halt]).

install(Spec, Options, Home, Directory) :-
    format(atom(Goal), 'pack_install(~q, ~q)',
           [Spec, [interactive(false),register(false)|Options]]),
    swipl_at_home(Home, Directory, [Goal], _, Err),
    assertion(\+ sub_string(Err, _, _, _, "make demo")),
    assertion(\+ sub_string(Err, _, _, _, "ERROR")),
    (   link_of(Home, Root)
    ->  format(string(Says), "the pack is a link: keep ~w", [Root]),
        assertion(sub_string(Err, _, _, _, Says))
    ;   assertion(\+ sub_string(Err, _, _, _, "is a link"))
    ).

%   link_of(+Home, -Root) is semidet: the pack of Home is a link to Root.

link_of(Home, Root) :-
    directory_file_path(Home, 'swi-prolog/pack/typhon', Pack),
    read_link(Pack, _, Target),
    ( atom_concat(Root, /, Target) -> true ; Root = Target ).

%   The goals that must succeed then, in a directory outside the project.

works(Home) :-
    with_tmp_dir(works_in(Home)).

works_in(Home, Dir) :-
    make_program(Dir, agents, mine),
    make_program(Dir, payloads, load),
    make_program(Dir, elsewhere, other),
    swipl_at_home(Home, Dir,
                  [ 'use_module(library(typhon))',
                    'use_module(library(typhon/kernel/program), [program_file/2])',
                    'assertz(user:file_search_path(agents, elsewhere))',
                    'forall(member(F, [agents(mine), payloads(load), \c
                                       agents(other), \c
                                       agents(supervisor)]), \c
                            ( program_file(F, P), \c
                              writeln(P) ))',
                    'host_start(here)',
                    'host_start(guarded, [policy(guarded), cell(none)])',
                    'agent_create(clauses([(:- agent(a, [])), (main)]), A)'
                  ], Out0),
    split_string(Out0, "\n", "\n", Lines),
    assertion(length(Lines, 4)).

make_program(Dir, Folder, Name) :-
    directory_file_path(Dir, Folder, Path),
    make_directory(Path),
    file_name_extension(Name, pl, Base),
    directory_file_path(Path, Base, File),
    write_file(File, ':- agent(~q, []).~nmain.~n', [Name]).

%   archive(+Create, +Archive): Create are the options of tar. A pack runs without
%   documents and tests.

archive(Create, Archive) :-
    project_file('.', Root),
    named(typhon, '', Name),
    format(atom(Transform), 's,^\\.,~w,', [Name]),
    process_create(path(tar),
                   [ '--exclude=./.git', '--exclude=./out', '--exclude=./doc',
                     '--exclude=./test', '--transform', Transform, Create,
                     Archive, '-C', Root, '.'
                   ], []).

%   A copy of the tree: since SWI-Prolog 9.3 an installation writes notes into
%   the directory from which it is made.

copied(Home, Root) :-
    directory_file_path(Home, 'typhon.tar', Archive),
    archive('-cf', Archive),
    process_create(path(tar), ['-xf', Archive, '-C', Home], []),
    named(typhon, '', Name),
    directory_file_path(Home, Name, Root).

%   named(+Kind, +Extension, -Name): the name of an archive of this version.

named(Kind, Extension, Name) :-
    project_file('pack.pl', File),
    read_file_to_terms(File, Terms, []),
    memberchk(version(Version), Terms),
    atomic_list_concat([Kind, -, Version, Extension], Name).

:- begin_tests(pack).

test(directory) :-
    with_tmp_dir(Home,
        ( copied(Home, Root),
          install('.', [], Home, Root),
          works(Home) )).
test(archive_url) :-
    with_tmp_dir(Home,
        ( named(typhon, '.tgz', Name),
          directory_file_path(Home, Name, Archive),
          archive('-czf', Archive),
          atom_concat('file://', Archive, URL),
          install(typhon, [url(URL)], Home, Home),
          assertion(compiled(Home)),
          works(Home) )).

%   Each file of the library has a .qlf file.

compiled(Home) :-
    directory_file_path(Home, 'swi-prolog/pack/typhon/prolog', Library),
    forall(directory_member(Library, File,
                            [extensions([pl]), recursive(true)]),
           ( file_name_extension(Stem, pl, File),
             file_name_extension(Stem, qlf, Compiled),
             exists_file(Compiled) )).

%   SWI-Prolog 9.1.18 and later call it by `swipl typhon`.

test(command_line, [condition(has_apps), Status == exit(0)]) :-
    with_tmp_dir(command_line(Status, Out)),
    assertion(sub_string(Out, 0, _, _, "Usage: swipl typhon COMMAND")),
    sub_string(Out, _, _, _, "diagnose"),
    !.

has_apps :-
    current_prolog_flag(version, Version),
    Version >= 90118.

command_line(Status, Out, Home) :-
    copied(Home, Root),
    install('.', [], Home, Root),
    run_swipl([typhon, '--help'],
              [ cwd(Home),
                environment(['HOME'=Home, 'XDG_DATA_HOME'=Home]) ],
              Status, Out, _).

test(releases_are_reproducible,
     [ condition(( a_clone, installed(development) )),
       true(Full-Small == Full1-Small1) ]) :-
    with_tmp_dir(released([Full, Small, Full1, Small1])).

%   A commit of the working tree, so that changed files do not matter, and a
%   clone of it: released in another second, as files have times in seconds.

a_clone :-
    absolute_file_name(path(git), _, [access(execute), file_errors(fail)]).

released(Sums, Dir) :-
    copied(Dir, Root),
    named(typhon, '.tgz', Name),
    format(atom(Script),
           "cd ~w && git init -q && git add -A && \c
            git -c user.name=t -c user.email=t commit -qm t && \c
            app/packaging/release ../out https://example.org/typhon && \c
            tar -xOzf ../out/~w --wildcards '*/pack.pl' | \c
            grep -q '^home(' && sleep 1.1 && git clone -q . ../again && \c
            ../again/app/packaging/release ../other https://example.org/typhon",
           [Root, Name]),
    process_create(path(sh), ['-c', Script],
                   [stdout(pipe(Out)), process(Pid)]),
    read_string(Out, _, Text),
    close(Out),
    process_wait(Pid, exit(0)),
    split_string(Text, "\n", "\n", Sums),
    small_works(Dir).

%   The small archive, unpacked, is installed with all that it has.

small_works(Home) :-
    named('typhon-core', '', Name),
    format(atom(Archive), 'out/~w.tgz', [Name]),
    process_create(path(tar), ['-xzf', Archive], [cwd(Home)]),
    directory_file_path(Home, Name, Root),
    atom_concat('file://', Root, URL),
    install(URL, [], Home, Home),
    assertion(compiled(Home)),
    works(Home),
    swipl_at_home(Home, Home, ['use_module(library(typhon/fipa))'], "", Err),
    assertion(sub_string(Err, _, _, _, "library(typhon/fipa) is not part of")).

library_of_part(Name) :-
    part(Part, Libraries, _),
    installed(Part),
    member(Library, Libraries),
    atom_concat('prolog/', Name, Library).

test(each_library_loads_by_its_file,
     [ forall(( Name = 'typhon.pl' ; library_of_part(Name) )),
       true(Status-Err == exit(0)-"") ]) :-
    atom_concat('prolog/', Name, Relative),
    project_file(Relative, File),
    format(atom(Load), 'use_module(~q)', [File]),
    run_swipl(['-f', none, '-g', Load, '-t', halt],
              [environment(['PATH'='/usr/bin:/bin'])], Status, _, Err).

%   The agents of a program that imports library(typhon) create agents, from a
%   clone of the repository as from a pack.

test(agents_of_a_clone_import_the_library, Status-Out == exit(0)-"done\n") :-
    project_file('prolog/typhon.pl', File),
    format(atom(Load), 'use_module(~q)', [File]),
    run_swipl(['-f', none, '-g', Load, '-g', 'host_start(a)',
               '-g', 'agent_create(clauses([(:- agent(parent)), \c
                          (:- use_module(library(typhon))), \c
                          (main :- agent_create(clauses([(:- agent(child)), \c
                                                         main]), C, []), \c
                                   agent_join(C, O, 10), result(O))]), A), \c
                      agent_result(A, O, 10), writeln(O)',
               '-t', halt],
              [environment(['PATH'='/usr/bin:/bin'])], Status, Out, _).

%   The library is a copy in a folder of another name, beside its agents.

test(folder_may_have_any_name, Status-Out-Err == exit(0)-Agent-"") :-
    with_tmp_dir(renamed(Status, Out, Err, Agent)).

renamed(Status, Out, Err, Agent, Dir) :-
    project_file(prolog, Library),
    directory_file_path(Dir, renamed, Copy),
    directory_file_path(Copy, 'typhon.pl', File),
    process_create(path(cp), ['-r', Library, Copy], []),
    directory_file_path(Dir, agents, Agents),
    make_program(Dir, agents, mine),
    directory_file_path(Agents, 'mine.pl', AgentFile),
    atom_string(AgentFile, Agent),
    format(atom(Load), 'use_module(~q),use_module(library(typhon/kernel/program))',
           [File]),
    run_swipl(['-f', none, '-g', Load,
               '-g', 'program_file(agents(mine), F), write(F)',
               '-t', halt],
              [cwd('/')], Status, Out, Err).

:- end_tests(pack).
