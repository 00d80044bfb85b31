:- module(failing_disk,
          [ disk_can_fail/0,
            disk_fails/1,               % +Call
            disk_heals/0,
            with_failing_disk/2         % -Environment, :Goal
          ]).

/** <module> Processes whose disk fails when tests say so

A library, compiled from `failing_disk.c` and preloaded, lets calls of the system
fail while the file named by FAILING_DISK tells it to.

*Threading*: the main thread sets up; any thread of such a process lets its disk
fail.
*/

:- use_module(common, [project_file/2, with_tmp_dir/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(process), [process_create/3]).

:- meta_predicate with_failing_disk(-, 0).

%!  disk_can_fail is semidet.
%
%   There is a compiler.

disk_can_fail :-
    catch(with_tmp_dir(failing_disk:compiled), error(_, _), fail).

compiled(Dir) :-
    compiled(Dir, _).

compiled(Dir, Library) :-
    project_file('test/lib/failing_disk.c', Source),
    directory_file_path(Dir, 'failing_disk.so', Library),
    process_create(path(cc),
                   ['-shared', '-fPIC', '-o', Library, Source, '-ldl'],
                   [stderr(null)]).

%!  with_failing_disk(-Environment:list, :Goal) is semidet.
%
%   Run once(Goal), which starts processes with Environment.

with_failing_disk(Environment, Goal) :-
    with_tmp_dir(failing_disk:failing(Environment, Goal)).

failing(Environment, Goal, Dir) :-
    compiled(Dir, Library),
    directory_file_path(Dir, fails, File),
    Environment = ['LD_PRELOAD'=Library, 'FAILING_DISK'=File],
    once(Goal).

%!  disk_fails(+Call) is det.
%!  disk_heals is det.
%
%   From now on Call, `fsync`-Errno or `write`-Errno, fails in this process; no
%   call fails any more.

disk_fails(Call-Errno) :-
    getenv('FAILING_DISK', File),
    atom_concat(File, '.new', New),
    setup_call_cleanup(open(New, write, Out),
                       format(Out, '~w ~d~n', [Call, Errno]),
                       close(Out)),
    rename_file(New, File).

disk_heals :-
    getenv('FAILING_DISK', File),
    delete_file(File).
